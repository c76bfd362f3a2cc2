//! Filters: what a frame must show, as mask and value over identifier and data.

use crate::frame::{padded, raw_id};
use crate::{AddressType, Bits, Data, Error, Frame, Place};

/// A field of the data that chooses the message, or says whether a request was accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Selector {
    /// Name of the field.
    pub name: &'static str,
    /// Place in the data.
    pub place: Place,
    normal: Option<u64>,
}

impl Selector {
    /// Returns a selector.
    pub const fn new(name: &'static str, place: Place) -> Self {
        Self { name, place, normal: None }
    }

    /// Sets the value that a reply has if it reports no error.
    #[must_use]
    pub const fn normal(self, normal: u64) -> Self {
        Self { normal: Some(normal), ..self }
    }

    /// Tests whether it says that a reply reports no error.
    pub(crate) const fn has_normal(&self) -> bool {
        self.normal.is_some()
    }

    #[inline]
    pub(crate) fn is_normal(&self, raw: u64) -> bool {
        self.normal.is_none_or(|normal| raw == normal)
    }
}

/// What identifiers of a protocol must show. Generated code builds it from constants and addresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct IdFilter {
    mask: u32,
    value: u32,
}

impl IdFilter {
    /// Accepts every identifier.
    pub const ANY: Self = Self { mask: 0, value: 0 };
    /// Accepts no identifier: none has more than 29 bits.
    pub(crate) const NONE: Self = Self { mask: u32::MAX, value: u32::MAX };

    /// Requires a value in a field.
    #[must_use]
    #[inline(always)]
    pub const fn id(self, bits: Bits, value: u32) -> Self {
        Self { mask: put(self.mask, bits, u32::MAX), value: put(self.value, bits, value) }
    }

    /// Requires an address in a field.
    #[must_use]
    #[inline(always)]
    pub const fn address(self, bits: Bits, kind: &AddressType, number: i32) -> Self {
        self.id(bits, kind.raw(number))
    }

    /// Tests whether it requires a value in a field.
    pub(crate) const fn requires(self, bits: Bits) -> bool {
        bits.of(self.mask) != 0
    }

    /// Tests an identifier of the right width.
    #[inline(always)]
    pub(crate) const fn matches(self, id: u32) -> bool {
        (id ^ self.value) & self.mask == 0
    }

    /// Requires an address in a field, if the document names it.
    ///
    /// # Errors
    ///
    /// Refuses an address that it does not name.
    #[inline(always)]
    pub const fn documented(self, bits: Bits, kind: &AddressType, number: i32) -> Result<Self, Error> {
        match kind.documented(number) {
            Ok(()) => Ok(self.address(bits, kind, number)),
            Err(error) => Err(error),
        }
    }
}

/// Bits that a frame must show. Bits of a value outside its mask are only written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Required {
    id: IdFilter,
    data_mask: Data,
    data_value: Data,
}

impl Required {
    /// Requires nothing, and writes zeros.
    pub(crate) const NOTHING: Self = Self { id: IdFilter::ANY, data_mask: [0; 8], data_value: [0; 8] };

    /// Requires a value in a field of the identifier.
    pub(crate) const fn id(mut self, bits: Bits, value: u32) -> Self {
        self.id = self.id.id(bits, value);
        self
    }

    /// Requires a value in the data.
    pub(crate) const fn data(mut self, place: Place, value: u64) -> Self {
        place.put(&mut self.data_mask, u64::MAX);
        place.put(&mut self.data_value, value);
        self
    }

    /// Accepts any value of some bits of a place in the data.
    pub(crate) const fn open(mut self, place: Place, bits: u64) -> Self {
        let counting = place.get(&self.data_mask) & !bits;
        place.put(&mut self.data_mask, counting);
        self
    }
}

/// What the identifier and the data of a frame must show, and what is written when such a frame is
/// built.
///
/// Bits of the value outside the mask are written, but accepted with any value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Filter {
    extended: bool,
    required: Required,
    selectors: &'static [Selector],
}

impl Filter {
    /// Accepts every frame with a 29-bit identifier.
    pub const EXTENDED: Self = Self { extended: true, required: Required::NOTHING, selectors: &[] };
    /// Accepts every frame with an 11-bit identifier.
    pub const STANDARD: Self = Self { extended: false, ..Self::EXTENDED };

    /// Requires a value in a field of the identifier.
    #[must_use]
    pub const fn id(mut self, bits: Bits, value: u32) -> Self {
        self.required = self.required.id(bits, value);
        self
    }

    /// Writes a value in a field of the identifier, and accepts any.
    #[must_use]
    pub const fn send_id(mut self, bits: Bits, value: u32) -> Self {
        let IdFilter { mask, value: others } = self.required.id;
        self.required.id = IdFilter { mask: put(mask, bits, 0), value: put(others, bits, value) };
        self
    }

    /// Requires a value in the data.
    #[must_use]
    pub const fn data(mut self, place: Place, value: u64) -> Self {
        self.required = self.required.data(place, value);
        self
    }

    /// Accepts any value of some bits of a place in the data.
    #[must_use]
    pub const fn open(mut self, place: Place, bits: u64) -> Self {
        self.required = self.required.open(place, bits);
        self
    }

    /// Writes 1 to these bits of the data, and accepts any.
    #[must_use]
    #[inline(always)]
    pub(crate) const fn filled(mut self, ones: Data) -> Self {
        self.required.data_value = (word(self.required.data_value) | word(ones)).to_be_bytes();
        self
    }

    /// Writes into the selectors without a required value that the reply reports no error.
    #[must_use]
    pub const fn accepting(mut self) -> Self {
        let mut selectors = self.selectors;
        while let [selector, others @ ..] = selectors {
            if let (Some(normal), false) = (selector.normal, self.requires(selector.place)) {
                selector.place.put(&mut self.required.data_value, normal);
            }
            selectors = others;
        }
        self
    }

    /// Tests whether it requires a value at a place of the data.
    pub(crate) const fn requires(&self, place: Place) -> bool {
        word(place.mask()) & word(self.required.data_mask) != 0
    }

    /// Sets the selectors that such frames have in their data.
    #[must_use]
    pub const fn selectors(self, selectors: &'static [Selector]) -> Self {
        Self { selectors, ..self }
    }

    /// Requires these bits of the identifier, and does not change the others.
    #[must_use]
    #[inline]
    pub const fn id_bits(self, mask: u32, value: u32) -> Self {
        self.narrowed(IdFilter { mask, value: value & mask })
    }

    /// Also requires this of the identifier. If both require a bit, `other` counts.
    #[inline(always)]
    pub(crate) const fn narrowed(mut self, other: IdFilter) -> Self {
        let IdFilter { mask, value } = self.required.id;
        self.required.id = IdFilter { mask: mask | other.mask, value: (value & !other.mask) | other.value };
        self
    }

    /// Returns what identifiers must show, and that is also `other`. If both require a bit, `other` counts.
    #[inline(always)]
    pub(crate) const fn id_narrowed(&self, other: IdFilter) -> IdFilter {
        let IdFilter { mask, value } = self.required.id;
        let value = (value & mask & !other.mask) | (other.value & other.mask);
        IdFilter { mask: mask | other.mask, value }
    }

    /// Also requires what `other` requires. If both require a bit, `other` counts.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        self.requiring(other.required)
    }

    /// Also requires some bits, and those replace its own.
    #[inline(always)]
    pub(crate) const fn requiring(self, Required { id, data_mask, data_value }: Required) -> Self {
        let mask = word(data_mask);
        let mut both = self.id_bits(id.mask, id.value);
        both.required.data_value = ((word(self.required.data_value) & !mask) | (word(data_value) & mask)).to_be_bytes();
        both.required.data_mask = (word(self.required.data_mask) | mask).to_be_bytes();
        both
    }

    /// Writes some bits of the identifier, and accepts any.
    #[inline(always)]
    pub(crate) const fn sending(mut self, IdFilter { mask, value }: IdFilter) -> Self {
        let id = self.required.id;
        self.required.id = IdFilter { mask: id.mask & !mask, value: (id.value & !mask) | value };
        self
    }

    /// Tests whether a frame can show what both require.
    pub(crate) const fn overlaps(&self, other: &Self) -> bool {
        let (one, two) = (&self.required, &other.required);
        let data = (word(one.data_value) ^ word(two.data_value)) & word(one.data_mask) & word(two.data_mask);
        let id = (one.id.value ^ two.id.value) & one.id.mask & two.id.mask;
        self.extended == other.extended && id == 0 && data == 0
    }

    /// Tests a frame.
    #[inline]
    pub fn matches(&self, frame: &impl embedded_can::Frame) -> bool {
        let (id, extended) = raw_id(frame.id());
        extended == self.extended
            && self.matches_id(id)
            && self.matches_data(&padded(frame.data()))
            && frame.is_data_frame()
    }

    /// Tests an identifier of the right width.
    #[inline]
    pub const fn matches_id(&self, id: u32) -> bool {
        self.required.id.matches(id)
    }

    /// Tests data bytes.
    #[inline]
    pub const fn matches_data(&self, data: &Data) -> bool {
        (word(*data) ^ word(self.required.data_value)) & word(self.required.data_mask) == 0
    }

    /// Returns the selectors that such frames have in their data.
    #[inline]
    pub const fn data_selectors(&self) -> &'static [Selector] {
        self.selectors
    }

    /// Tests whether identifiers have 29 bits rather than 11.
    #[inline]
    pub const fn is_extended(&self) -> bool {
        self.extended
    }

    /// Returns the bits of the identifier that count: the mask of a hardware acceptance filter.
    pub const fn id_mask(&self) -> u32 {
        self.required.id.mask
    }

    /// Returns the value of these bits: the identifier of a hardware acceptance filter.
    pub const fn id_value(&self) -> u32 {
        self.required.id.value & self.required.id.mask
    }

    /// Returns the bits of the data that count.
    pub const fn data_mask(&self) -> Data {
        self.required.data_mask
    }

    /// Returns the bytes that are written when such a frame is built.
    #[inline]
    pub const fn data_value(&self) -> Data {
        self.required.data_value
    }

    /// Returns the identifier that is written when such a frame is built.
    #[inline]
    pub(crate) const fn sent_id(&self) -> u32 {
        self.required.id.value
    }

    /// Returns the frame that shows what the filter requires. Elsewhere it has what the spec sends,
    /// or zeros. A reply reports no error.
    pub const fn frame(&self, length: u8) -> Frame {
        Frame::new_raw(self.required.id.value, self.extended, self.required.data_value, length)
    }
}

#[inline]
const fn word(data: Data) -> u64 {
    u64::from_be_bytes(data)
}

#[expect(clippy::cast_possible_truncation, reason = "an identifier has at most 29 bits")]
#[inline]
const fn put(id: u32, bits: Bits, value: u32) -> u32 {
    bits.put(id as u64, value as u64) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMMAND: Bits = Bits::new(21, 16);
    const ERROR: Bits = Bits::new(28, 26);
    const FUNCTION: Place = Place::byte(0);

    fn frame(id: u32, first: u8) -> Frame {
        Frame::new_raw(id, true, [first, 0, 0, 0, 0, 0, 0, 0], 8)
    }

    #[test]
    fn only_the_bits_of_the_mask_count() {
        let filter = Filter::EXTENDED.id(COMMAND, 0x1C).send_id(ERROR, 2);
        assert_eq!((filter.id_mask(), filter.id_value()), (0x003F_0000, 0x001C_0000));
        assert!(filter.matches(&frame(0x029C_03F0, 7)));
        assert!(filter.matches(&frame(0x1FDC_FFFF, 7)) && filter.matches(&frame(0x001C_0000, 7)));
        assert!(!filter.matches(&frame(0x029B_03F0, 7)));
        assert_eq!(filter.frame(8), frame(0x081C_0000, 0));
    }

    #[test]
    fn data_are_tested_too() {
        let filter = Filter::EXTENDED.data(FUNCTION, 0x41);
        assert!(filter.matches(&frame(0, 0x41)));
        assert!(!filter.matches(&frame(0, 0x42)));
        assert_eq!(filter.frame(2).bytes(), [0x41, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn a_field_can_have_one_of_several_values() {
        // Bits 3 and 2 say how many of four bytes are filled up.
        let filter = Filter::EXTENDED.data(FUNCTION, 0x43).open(FUNCTION, 0x0C);
        let accepted = |value: &u8| filter.matches(&frame(0, *value));
        assert!((0..=u8::MAX).filter(accepted).eq([0x43, 0x47, 0x4B, 0x4F]));
        assert_eq!((filter.frame(1).bytes()[0], filter.data_mask()[0]), (0x43, 0xF3));
    }

    #[test]
    fn bits_that_nothing_names_are_written_as_ones_and_accepted_as_they_are() {
        let filter = Filter::EXTENDED.data(FUNCTION, 0x41).filled([0, 0xF0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(filter.frame(3).bytes(), [0x41, 0xF0, 0, 0, 0, 0, 0, 0]);
        assert!(filter.matches(&frame(0, 0x41)) && !filter.matches(&frame(0, 0x42)));
    }

    #[test]
    fn what_says_that_a_reply_is_no_error_is_written_where_nothing_is_required() {
        const RESULT: Selector = Selector::new("result", Place::byte(1)).normal(0xF0);
        let reply = Filter::EXTENDED.selectors(&[RESULT]).data(FUNCTION, 0x41);
        assert_eq!(reply.accepting().frame(8).bytes(), [0x41, 0xF0, 0, 0, 0, 0, 0, 0]);
        assert!(reply.accepting().matches(&frame(0, 0x41)));
        let refused = reply.data(RESULT.place, 0xF2);
        assert_eq!(refused.accepting(), refused);
    }

    #[test]
    fn filters_overlap_unless_they_require_different_values_of_one_bit() {
        let one = Filter::EXTENDED.id(COMMAND, 0x1C).data(FUNCTION, 0x41);
        assert!(one.overlaps(&one) && one.overlaps(&Filter::EXTENDED));
        assert!(one.overlaps(&Filter::EXTENDED.id(ERROR, 2).data(Place::byte(1), 0)));
        assert!(!one.overlaps(&Filter::EXTENDED.id(COMMAND, 0x1D)));
        assert!(!one.overlaps(&Filter::EXTENDED.data(FUNCTION, 0x42)));
        assert!(!one.overlaps(&Filter::STANDARD));
    }

    #[test]
    fn the_width_of_the_identifier_counts() {
        let standard = Frame::new_raw(0x7FF, false, [0; 8], 8);
        assert!(Filter::STANDARD.matches(&standard));
        assert!(!Filter::EXTENDED.matches(&standard));
    }

    #[test]
    fn a_later_requirement_replaces_an_earlier_one() {
        let filter = Filter::EXTENDED.id(COMMAND, 0x3F).id(COMMAND, 0x01).id_bits(0x0F, 0x05);
        assert_eq!((filter.id_mask(), filter.id_value()), (0x003F_000F, 0x0001_0005));
        assert_eq!(filter.send_id(COMMAND, 0).id_mask(), 0x0F);
    }

    #[test]
    fn two_filters_together_require_what_each_of_them_does() {
        let one = Filter::EXTENDED.id(COMMAND, 0x1C).data(FUNCTION, 0x41).send_id(ERROR, 2);
        let both = one.and(Filter::EXTENDED.data(Place::bytes(2, 3), 0x0102).id(Bits::new(7, 0), 0xF0));
        assert_eq!((both.id_mask(), both.id_value(), both.sent_id()), (0x003F_00FF, 0x001C_00F0, 0x081C_00F0));
        assert_eq!(both.data_mask(), [0xFF, 0, 0xFF, 0xFF, 0, 0, 0, 0]);
        assert_eq!(both.data_value(), [0x41, 0, 1, 2, 0, 0, 0, 0]);
        assert_eq!(one.and(Filter::EXTENDED.data(FUNCTION, 0x42)), one.data(FUNCTION, 0x42));
    }
}
