//! Classic CAN data frames.

use core::fmt;

use embedded_can::{ExtendedId, Id, StandardId};

use crate::Data;

mod candump;

pub use candump::NotAFrame;

/// A classic CAN data frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    id: u32,
    extended: bool,
    length: u8,
    /// Fills the struct up. Otherwise a copy keeps what was in memory there, by instructions of its own.
    filling: Filling,
    data: Data,
}

/// Two bytes without a meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u16)]
enum Filling {
    Zeros,
}

impl Frame {
    /// Returns a frame with the low 29 or 11 bits of `id` and the first `length` bytes of `data`, at most 8.
    #[inline]
    pub const fn new_raw(id: u32, extended: bool, data: Data, length: u8) -> Self {
        let id = id & if extended { 0x1FFF_FFFF } else { 0x7FF };
        let (length, data) = cut(data, length);
        Self { id, extended, length, filling: Filling::Zeros, data }
    }

    /// Returns the identifier as a number.
    #[inline]
    pub const fn raw_id(&self) -> u32 {
        self.id
    }

    /// Returns eight bytes. Those beyond the frame's length are 0.
    #[inline]
    pub const fn bytes(&self) -> Data {
        self.data
    }

    /// Returns eight bytes. Those beyond the frame's length are those of `beyond`.
    #[inline(always)]
    pub(crate) const fn bytes_before(&self, beyond: Data) -> Data {
        let (_, first) = cut(beyond, self.length);
        let beyond = u64::from_be_bytes(beyond) & !u64::from_be_bytes(first);
        (u64::from_be_bytes(self.data) | beyond).to_be_bytes()
    }

    /// Returns the same frame in the type of a driver, which may refuse it.
    pub fn to<F: embedded_can::Frame>(&self) -> Option<F> {
        F::new(embedded_can::Frame::id(self), embedded_can::Frame::data(self))
    }

    /// Returns the same data under the low bits of another identifier.
    pub(crate) fn with_id(&self, id: u64) -> Self {
        let id = u32::try_from(id).unwrap_or(self.id);
        Self::new_raw(id, self.extended, self.data, self.length)
    }

    /// Returns the first `length` bytes of other data, at most 8, under the same identifier.
    #[inline]
    pub(crate) const fn with(&self, data: Data, length: u8) -> Self {
        let (length, data) = cut(data, length);
        Self { id: self.id, extended: self.extended, length, filling: Filling::Zeros, data }
    }

    /// Returns other data of the same length.
    pub(crate) fn with_data(&self, data: Data) -> Self {
        self.with(data, self.length)
    }

    /// Copies the data of a classic data frame, which must have `length` bytes if that is known.
    #[inline(always)]
    pub(crate) fn copied(
        id: u32,
        extended: bool,
        length: Option<u8>,
        frame: &impl embedded_can::Frame,
    ) -> Option<Self> {
        if frame.is_data_frame() { Self::of_data(id, extended, length, frame.data()) } else { None }
    }

    /// Copies data, which must have `length` bytes if that is known, and at most eight.
    #[inline(always)]
    pub(crate) fn of_data(id: u32, extended: bool, length: Option<u8>, bytes: &[u8]) -> Option<Self> {
        let is_right = length.is_none_or(|length| usize::from(length) == bytes.len());
        let actual = u8::try_from(bytes.len()).ok().filter(|actual| is_right && *actual <= 8)?;
        Some(Self { id, extended, length: length.unwrap_or(actual), filling: Filling::Zeros, data: padded(bytes) })
    }

    #[inline]
    pub(crate) fn length(&self) -> usize {
        self.length.into()
    }

    #[inline]
    pub(crate) const fn byte_count(&self) -> u8 {
        self.length
    }

    /// Tests whether it has one of several numbers of data bytes, or `length` if there are none.
    #[inline(always)]
    pub(crate) fn has_length(&self, length: usize, several: &[u8]) -> bool {
        if several.is_empty() { self.length() == length } else { several.contains(&self.length) }
    }

    /// Writes the identifier: three digits, or eight of an extended one.
    pub(crate) fn write_id(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = if self.extended { 8 } else { 3 };
        write!(formatter, "{:0digits$X}", self.id)
    }

    /// Writes the data, two digits of each byte.
    pub(crate) fn write_data(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        embedded_can::Frame::data(self).iter().try_for_each(|byte| write!(formatter, "{byte:02X}"))
    }
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let (raw, extended) = raw_id(id.into());
        let length = u8::try_from(data.len()).ok().filter(|length| *length <= 8)?;
        Some(Self::new_raw(raw, extended, padded(data), length))
    }

    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }

    #[inline]
    fn is_extended(&self) -> bool {
        self.extended
    }

    #[inline]
    fn is_remote_frame(&self) -> bool {
        false
    }

    #[inline]
    fn id(&self) -> Id {
        if self.extended {
            Id::Extended(ExtendedId::new(self.id).unwrap_or(ExtendedId::ZERO))
        } else {
            Id::Standard(u16::try_from(self.id).ok().and_then(StandardId::new).unwrap_or(StandardId::ZERO))
        }
    }

    #[inline]
    fn dlc(&self) -> usize {
        self.length.into()
    }

    #[inline]
    fn data(&self) -> &[u8] {
        self.data.get(..self.length.into()).unwrap_or(&self.data)
    }
}

impl fmt::Display for Frame {
    /// Writes `029C03F0#000B71B000003A98`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_id(formatter)?;
        formatter.write_str("#")?;
        self.write_data(formatter)
    }
}

/// Returns an identifier as a number, and whether it is an extended one.
#[inline]
pub fn raw_id(id: Id) -> (u32, bool) {
    match id {
        Id::Standard(id) => (id.as_raw().into(), false),
        Id::Extended(id) => (id.as_raw(), true),
    }
}

/// Returns a length, at most 8, and the data with zeros beyond it.
#[inline(always)]
const fn cut(data: Data, length: u8) -> (u8, Data) {
    let length = if length < 8 { length } else { 8 };
    let kept = if length == 0 { 0 } else { u64::MAX << (64 - 8 * length) };
    (length, (u64::from_be_bytes(data) & kept).to_be_bytes())
}

/// Copies a classic data frame.
pub fn classic(frame: &impl embedded_can::Frame) -> Option<Frame> {
    let (id, extended) = raw_id(frame.id());
    Frame::copied(id, extended, None, frame)
}

/// Returns the first eight of `bytes`, filled up with zeros.
///
/// Nothing is called here: a call would make its callers save registers, also for frames of eight bytes.
#[inline]
pub fn padded(bytes: &[u8]) -> Data {
    bytes.first_chunk().copied().unwrap_or_else(|| {
        let places = [56, 48, 40, 32, 24, 16, 8, 0];
        bytes.iter().zip(places).fold(0, |word, (byte, place)| word | u64::from(*byte) << place).to_be_bytes()
    })
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use embedded_can::Frame as _;

    use super::*;

    #[test]
    fn bytes_are_filled_up_with_zeros() {
        let bytes = [0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88, 0x99];
        for length in 0..=bytes.len() {
            let mut filled = [0; 8];
            filled.iter_mut().zip(&bytes[..length]).for_each(|(place, byte)| *place = *byte);
            assert_eq!(padded(&bytes[..length]), filled);
        }
    }

    #[test]
    fn a_frame_is_written_as_in_a_log() {
        let frame = Frame::new_raw(0x029C_03F0, true, [0x00, 0x0B, 0x71, 0xB0, 0x00, 0x00, 0x3A, 0x98], 8);
        assert_eq!(frame.to_string(), "029C03F0#000B71B000003A98");
        assert_eq!(Frame::new_raw(0x83, false, [0x55, 1, 2, 3, 4, 5, 6, 7], 2).to_string(), "083#5501");
    }

    #[test]
    fn a_frame_keeps_identifier_and_data() {
        let id = ExtendedId::new(0x029C_03F0).expect("29 bits");
        let frame = Frame::new(id, &[1, 2, 3]).expect("three bytes");
        assert_eq!((frame.id(), frame.dlc(), frame.data()), (Id::Extended(id), 3, &[1, 2, 3][..]));
        assert_eq!(frame.bytes(), [1, 2, 3, 0, 0, 0, 0, 0]);
        let id = StandardId::new(0x7FF).expect("11 bits");
        let frame = Frame::new(id, &[]).expect("no bytes");
        assert_eq!((frame.id(), frame.dlc(), frame.data()), (Id::Standard(id), 0, &[][..]));
    }

    #[test]
    fn a_known_length_must_be_that_of_the_data() {
        let [seven, eight] = [7, 8].map(|length| Frame::new_raw(0x0107_F003, true, [1; 8], length));
        let copied = |length, frame: &Frame| Frame::copied(frame.raw_id(), true, length, frame);
        assert_eq!([copied(Some(8), &eight), copied(None, &eight)], [Some(eight); 2]);
        assert_eq!((copied(Some(8), &seven), copied(None, &seven)), (None, Some(seven)));
    }

    #[test]
    fn nine_bytes_and_remote_frames_are_refused() {
        assert_eq!(Frame::new(StandardId::ZERO, &[0; 9]), None);
        assert_eq!(Frame::new_remote(StandardId::ZERO, 0), None);
    }

    #[test]
    fn bits_and_bytes_that_no_frame_has_are_dropped() {
        let frame = Frame::new_raw(u32::MAX, false, [0xFF; 8], 200);
        assert_eq!((frame.raw_id(), frame.dlc()), (0x7FF, 8));
        let short = Frame::new_raw(0x83, false, [0xFF; 8], 3);
        assert_eq!((short.bytes(), short.data()), ([0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 0], &[0xFF; 3][..]));
        assert_eq!(Frame::new_raw(0x83, false, [0xFF; 8], 0), Frame::new_raw(0x83, false, [0; 8], 0));
    }

    #[test]
    fn a_frame_becomes_the_frame_of_a_driver() {
        let frame = Frame::new_raw(0x029C_03F0, true, [1, 2, 3, 0, 0, 0, 0, 0], 3);
        assert_eq!(frame.to::<Frame>(), Some(frame));
    }
}
