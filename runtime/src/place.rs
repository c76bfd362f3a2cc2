//! Places of signals: bits of a word, and words of the payload.

use crate::plumbing::Raw;

/// The eight data bytes of a classic CAN frame. A shorter frame leaves the last ones 0.
pub type Data = [u8; 8];

/// A run of bits in a word of up to 64 bits. Bit 0 is the least significant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Bits {
    shift: u8,
    width: u8,
}

impl Bits {
    /// Returns the bits from `high` down to `low`.
    ///
    /// # Panics
    ///
    /// Panics unless `63 >= high >= low`. In a constant this is a compile error.
    pub const fn new(high: u8, low: u8) -> Self {
        assert!(high < 64 && low <= high, "bits run from the high one, at most 63, down to the low one");
        Self { shift: low, width: high - low + 1 }
    }

    /// Returns how many bits the word has below this run.
    pub const fn shift(self) -> u8 {
        self.shift
    }

    /// Returns the number of bits, `1..=64`.
    pub const fn width(self) -> u8 {
        self.width
    }

    /// Returns the largest number that fits.
    #[inline(always)]
    pub const fn max(self) -> u64 {
        u64::MAX.wrapping_shr(64_u32.wrapping_sub(self.width as u32))
    }

    /// Returns the bits of the word that belong to this run.
    #[inline(always)]
    pub const fn mask(self) -> u64 {
        self.max().wrapping_shl(self.shift as u32)
    }

    /// Returns these bits of `word` as a number.
    #[inline(always)]
    pub const fn get(self, word: u64) -> u64 {
        word.wrapping_shr(self.shift as u32) & self.max()
    }

    /// Returns these bits of an identifier.
    #[expect(clippy::cast_possible_truncation, reason = "an identifier has at most 29 bits")]
    #[inline(always)]
    pub const fn of(self, id: u32) -> u32 {
        self.get(id as u64) as u32
    }

    /// Returns the low eight of these bits of an identifier.
    #[expect(clippy::cast_possible_truncation, reason = "it drops the others")]
    #[inline(always)]
    pub const fn byte(self, id: u32) -> u8 {
        self.get(id as u64) as u8
    }

    /// Returns these bits of an identifier as a raw value.
    #[inline(always)]
    pub fn read<R: Raw>(self, id: u32) -> R {
        R::from_bits(self.get(id.into()))
    }

    /// Returns an identifier with the low bits of a raw value in these bits, and zeros elsewhere.
    #[expect(clippy::cast_possible_truncation, reason = "an identifier has at most 29 bits")]
    #[inline(always)]
    pub fn write(self, raw: impl Raw) -> u32 {
        self.put(0, raw.to_bits()) as u32
    }

    /// Returns these bits of `word` as a number in two's complement.
    #[inline(always)]
    pub const fn get_signed(self, word: u64) -> i64 {
        let unused = 64_u32.wrapping_sub(self.width as u32);
        (self.get(word).wrapping_shl(unused) as i64).wrapping_shr(unused)
    }

    /// Returns `word` with these bits replaced by the low bits of `raw`.
    #[must_use]
    #[inline(always)]
    pub const fn put(self, word: u64, raw: u64) -> u64 {
        let mask = self.mask();
        (word & !mask) | (raw.wrapping_shl(self.shift as u32) & mask)
    }
}

/// Which end of a word comes first on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ByteOrder {
    /// The most significant byte comes first.
    Big,
    /// The least significant byte comes first.
    Little,
}

impl ByteOrder {
    #[inline(always)]
    const fn load(self, data: Data) -> u64 {
        match self {
            Self::Big => u64::from_be_bytes(data),
            Self::Little => u64::from_le_bytes(data),
        }
    }

    #[inline(always)]
    const fn store(self, word: u64) -> Data {
        match self {
            Self::Big => word.to_be_bytes(),
            Self::Little => word.to_le_bytes(),
        }
    }
}

/// The place of a signal in the payload.
///
/// ```
/// use canspec_runtime::Place;
///
/// const VOLTAGE: Place = Place::bytes(0, 3);
/// const SIGNAL: Place = Place::bytes(0, 1).bits(11, 0);
///
/// assert_eq!(VOLTAGE.get(&[0x00, 0x0B, 0x71, 0xB0, 0, 0, 0, 0]), 750_000);
/// assert_eq!(SIGNAL.get(&[0xF1, 0x23, 0, 0, 0, 0, 0, 0]), 0x123);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    order: ByteOrder,
    bits: Bits,
}

impl Place {
    /// Returns the word from byte `first` to byte `last`. Byte `first` is the most significant:
    /// `bytes(4, 7)` is big endian, `bytes(7, 4)` little endian.
    ///
    /// # Panics
    ///
    /// Panics if a byte is not in `0..=7`. In a constant this is a compile error.
    pub const fn bytes(first: u8, last: u8) -> Self {
        assert!(first < 8 && last < 8, "the payload has bytes 0 to 7");
        if first <= last {
            Self { order: ByteOrder::Big, bits: Bits::new(63 - 8 * first, 56 - 8 * last) }
        } else {
            Self { order: ByteOrder::Little, bits: Bits::new(8 * first + 7, 8 * last) }
        }
    }

    /// Returns one byte.
    ///
    /// # Panics
    ///
    /// Panics if the byte is not in `0..=7`. In a constant this is a compile error.
    pub const fn byte(byte: u8) -> Self {
        Self::bytes(byte, byte)
    }

    /// Returns the bits from `high` down to `low` of this word. Bit 0 is the least significant.
    ///
    /// # Panics
    ///
    /// Panics unless the word has these bits. In a constant this is a compile error.
    #[must_use]
    pub const fn bits(self, high: u8, low: u8) -> Self {
        assert!(high < self.bits.width, "the word has fewer bits");
        let Bits { shift, .. } = self.bits;
        Self { order: self.order, bits: Bits::new(shift + high, shift + low) }
    }

    /// Returns one bit of this word. Bit 0 is the least significant.
    ///
    /// # Panics
    ///
    /// Panics unless the word has this bit. In a constant this is a compile error.
    #[must_use]
    pub const fn bit(self, bit: u8) -> Self {
        self.bits(bit, bit)
    }

    /// Returns the byte order of the word.
    pub const fn order(self) -> ByteOrder {
        self.order
    }

    /// Returns the place of the bits in the eight bytes, read in this order.
    pub const fn bits_of_payload(self) -> Bits {
        self.bits
    }

    /// Returns the number of bits, `1..=64`.
    pub const fn width(self) -> u8 {
        self.bits.width
    }

    /// Returns the bits, sign-extended if they are `signed`. All types of signals share the code.
    #[inline(never)]
    pub(crate) const fn any_bits(self, data: Data, signed: bool) -> u64 {
        if signed { self.get_signed(&data) as u64 } else { self.get(&data) }
    }

    /// Returns the largest number that fits.
    #[inline(always)]
    pub const fn max(self) -> u64 {
        self.bits.max()
    }

    /// Returns the payload with only the bits of this place set.
    #[inline(always)]
    pub const fn mask(self) -> Data {
        self.order.store(self.bits.mask())
    }

    /// Tests whether the first `length` data bytes contain all of it.
    #[expect(clippy::cast_possible_truncation, reason = "it is below 8")]
    #[inline(always)]
    pub const fn is_within(self, length: usize) -> bool {
        length >= 8 || u64::from_be_bytes(self.mask()) & u64::MAX.wrapping_shr(8 * length as u32) == 0
    }

    /// Returns the number at this place.
    #[inline(always)]
    pub const fn get(self, data: &Data) -> u64 {
        self.bits.get(self.order.load(*data))
    }

    /// Returns the number in two's complement at this place.
    #[inline(always)]
    pub const fn get_signed(self, data: &Data) -> i64 {
        self.bits.get_signed(self.order.load(*data))
    }

    /// Returns the raw value at this place.
    #[inline(always)]
    pub fn read<R: Raw>(self, data: &Data) -> R {
        R::from_bits(if R::SIGNED { self.get_signed(data) as u64 } else { self.get(data) })
    }

    /// Writes the low bits of a raw value to this place, and does not change other bits.
    #[inline(always)]
    pub fn write(self, raw: impl Raw, data: &mut Data) {
        self.put(data, raw.to_bits());
    }

    /// Writes the low bits of `raw` to this place, and does not change other bits.
    #[inline(always)]
    pub const fn put(self, data: &mut Data, raw: u64) {
        *data = self.order.store(self.bits.put(self.order.load(*data), raw));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNTING: Data = [0x01, 0x23, 0x45, 0x67, 0x89, 0xAB, 0xCD, 0xEF];

    #[test]
    fn bytes_upwards_are_big_endian() {
        assert_eq!(Place::bytes(0, 7).get(&COUNTING), 0x0123_4567_89AB_CDEF);
        assert_eq!(Place::bytes(2, 4).get(&COUNTING), 0x0045_6789);
    }

    #[test]
    fn bytes_downwards_are_little_endian() {
        assert_eq!(Place::bytes(7, 0).get(&COUNTING), 0xEFCD_AB89_6745_2301);
        assert_eq!(Place::bytes(4, 2).get(&COUNTING), 0x0089_6745);
    }

    #[test]
    fn bits_count_from_the_least_significant_bit_of_the_word() {
        assert_eq!(Place::bytes(0, 1).bits(11, 0).get(&COUNTING), 0x123);
        assert_eq!(Place::bytes(1, 0).bits(15, 12).get(&COUNTING), 0x2);
        assert_eq!(Place::byte(7).bit(4).get(&COUNTING), 0);
        assert_eq!(Place::byte(7).bit(5).get(&COUNTING), 1);
    }

    #[test]
    fn bits_of_bits_count_from_the_inner_word() {
        assert_eq!(Place::bytes(0, 3).bits(19, 4).bits(7, 4).get(&COUNTING), 0x5);
    }

    #[test]
    fn signed_numbers_of_odd_width_cross_byte_borders() {
        // Bytes 73 AA 0E from the low end make 0x0EAA73, whose bits 23..12 are 0x0EA.
        let report = [0x73, 0xAA, 0x0E, 0x6E, 0x28, 0x23, 0x03, 0x11];
        assert_eq!(Place::bytes(7, 0).bits(23, 12).get_signed(&report), 234);
        let minus_two = [0x00, 0xE0, 0xFF, 0, 0, 0, 0, 0];
        assert_eq!(Place::bytes(7, 0).bits(23, 12).get_signed(&minus_two), -2);
        assert_eq!(Place::bytes(0, 7).get_signed(&[0xFF; 8]), -1);
        assert_eq!(Place::byte(3).bit(0).get_signed(&[0xFF; 8]), -1);
    }

    #[test]
    fn every_width_at_every_shift_comes_back_and_touches_nothing_else() {
        for (first, last) in [(0, 7), (7, 0)] {
            let word = Place::bytes(first, last);
            for low in 0..64 {
                for high in low..64 {
                    let place = word.bits(high, low);
                    let mut data = [0; 8];
                    place.put(&mut data, u64::MAX);
                    assert_eq!(data, place.mask());
                    assert_eq!(place.get(&data), place.max());
                    assert_eq!(word.get(&data).count_ones(), u32::from(place.width()));
                    let mut full = [0xFF; 8];
                    place.put(&mut full, 0);
                    assert_eq!(word.get(&full), !word.get(&data));
                }
            }
        }
    }

    #[test]
    fn putting_replaces_the_earlier_number() {
        let mut data = COUNTING;
        Place::bytes(2, 3).put(&mut data, 0x0F0F);
        assert_eq!(data, [0x01, 0x23, 0x0F, 0x0F, 0x89, 0xAB, 0xCD, 0xEF]);
    }
}
