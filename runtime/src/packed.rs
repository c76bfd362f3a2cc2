//! Packed values: several numbers and texts that are written as one text.

use core::fmt::{self, Write};

use crate::plumbing::{Legend, Raw, Word};
use crate::text::is_character;
use crate::{Data, Place, bcd};

/// A piece of a packed value's text. Places count from the first byte of the value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Piece {
    /// The same characters in every text.
    Literal(&'static str),
    /// The ASCII characters at a place.
    Text(Place),
    /// A number in decimal digits.
    Number {
        /// Place of the number.
        place: Place,
        /// Number of digits; 0 for as many as it needs.
        digits: u8,
        /// The smallest and the largest number.
        limits: (u64, u64),
        /// Whether each digit has four bits of its own.
        is_decimal: bool,
    },
}

impl Piece {
    /// Returns a number with as many digits as it needs. Its raw value has the type `R`.
    pub const fn number<R: Raw>(place: Place) -> Self {
        Self::digits::<R>(place, 0)
    }

    /// Returns a number of `digits` digits, with zeros in front. Its raw value has the type `R`.
    pub const fn digits<R: Raw>(place: Place, digits: u8) -> Self {
        Self::Number { place, digits, limits: (0, place.max()), is_decimal: R::IS_DECIMAL }
    }

    /// Sets the limits of a number.
    #[must_use]
    pub const fn limits(self, minimum: u64, maximum: u64) -> Self {
        match self {
            Self::Number { place, digits, is_decimal, .. } => {
                Self::Number { place, digits, limits: (minimum, maximum), is_decimal }
            }
            other @ (Self::Literal(_) | Self::Text(_)) => other,
        }
    }

    fn write(&self, data: Data, formatter: &mut impl Write) -> fmt::Result {
        match *self {
            Self::Literal(literal) => formatter.write_str(literal),
            Self::Text(place) => {
                let letters = place.get(&data).to_be_bytes().into_iter().skip(8_usize.saturating_sub(bytes(place)));
                letters.map(char::from).try_for_each(|letter| formatter.write_char(letter))
            }
            Self::Number { place, digits, is_decimal, .. } => {
                let (bits, width) = (place.get(&data), usize::from(digits));
                match if is_decimal { bcd::number(bits) } else { Some(bits) } {
                    Some(number) => write!(formatter, "{number:0width$}"),
                    None => write!(formatter, "{bits:#X}"),
                }
            }
        }
    }

    /// Reads this piece at the front of a text, and returns the rest.
    fn parse<'t>(&self, text: &'t str, is_last: bool, data: &mut Data) -> Option<&'t str> {
        match *self {
            Self::Literal(literal) => text.strip_prefix(literal),
            Self::Text(place) => {
                let (letters, rest) = text.split_at_checked(bytes(place))?;
                place.put(data, letters.bytes().fold(0, |bits, byte| bits << 8 | u64::from(byte)));
                letters.bytes().all(is_character).then_some(rest)
            }
            Self::Number { place, digits, limits: (minimum, maximum), is_decimal } => {
                let length = match digits {
                    0 if is_last => text.len(),
                    0 => text.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(text.len()),
                    digits => digits.into(),
                };
                let (number, rest) = text.split_at_checked(length)?;
                let is_plain = number.bytes().all(|byte| byte.is_ascii_digit());
                let number = number.parse().ok().filter(|number| is_plain && (minimum..=maximum).contains(number))?;
                let bits = if is_decimal { bcd::bits(number) } else { Some(number) };
                place.put(data, bits.filter(|bits| *bits <= place.max())?);
                Some(rest)
            }
        }
    }
}

/// Returns the number of whole bytes in a place.
fn bytes(place: Place) -> usize {
    usize::from(place.width() / 8)
}

/// The text of a packed value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PackedText {
    data: Data,
    pieces: &'static [Piece],
}

impl fmt::Display for PackedText {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(formatter)
    }
}

impl PackedText {
    fn write(&self, formatter: &mut impl Write) -> fmt::Result {
        self.pieces.iter().try_for_each(|piece| piece.write(self.data, formatter))
    }

    /// Tests whether the text gives the same value.
    fn is_exact(&self) -> bool {
        let mut written = Buffer::default();
        self.write(&mut written).is_ok()
            && written.as_str().and_then(|text| parse_data(text, self.pieces)) == Some(self.data)
    }
}

/// Writes a packed value, if its text gives the same value.
pub(crate) fn text<W: Word>(value: W) -> Option<PackedText> {
    let Legend::Text(bytes, pieces) = W::LEGEND else { return None };
    let text = PackedText { data: left_aligned(value.to_bits(), bytes), pieces };
    text.is_exact().then_some(text)
}

/// Writes the parts of a packed value in the documented form, even if the text is not exact.
pub(crate) fn write<W: Word>(value: W, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
    let Legend::Text(bytes, pieces) = W::LEGEND else { return Ok(()) };
    PackedText { data: left_aligned(value.to_bits(), bytes), pieces }.write(formatter)
}

/// Reads a packed value.
pub(crate) fn parse<W: Word>(text: &str) -> Option<W> {
    let Legend::Text(bytes, pieces) = W::LEGEND else { return None };
    parse_data(text, pieces).map(|data| W::from_bits(right_aligned(data, bytes)))
}

fn parse_data(text: &str, pieces: &[Piece]) -> Option<Data> {
    let mut data = [0; 8];
    let (last, others) = pieces.split_last()?;
    let rest = others.iter().try_fold(text, |rest, piece| piece.parse(rest, false, &mut data))?;
    last.parse(rest, true, &mut data)?.is_empty().then_some(data)
}

/// Returns the first `bytes` data bytes from a word.
pub const fn left_aligned(word: u64, bytes: u8) -> Data {
    word.wrapping_shl(64_u32.wrapping_sub(8 * bytes as u32)).to_be_bytes()
}

/// Returns the word in the first `bytes` data bytes.
pub const fn right_aligned(data: Data, bytes: u8) -> u64 {
    u64::from_be_bytes(data).wrapping_shr(64_u32.wrapping_sub(8 * bytes as u32))
}

/// Takes a text of up to 96 bytes.
#[derive(Clone, Copy)]
struct Buffer {
    bytes: [u8; 96],
    length: usize,
}

impl Default for Buffer {
    fn default() -> Self {
        Self { bytes: [0; 96], length: 0 }
    }
}

impl Buffer {
    fn as_str(&self) -> Option<&str> {
        core::str::from_utf8(self.bytes.get(..self.length)?).ok()
    }
}

impl Write for Buffer {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.length.saturating_add(text.len());
        let free = self.bytes.get_mut(self.length..end).ok_or(fmt::Error)?;
        free.iter_mut().zip(text.bytes()).for_each(|(byte, letter)| *byte = letter);
        self.length = end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;
    use crate::{Payload, Signal, Text};

    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Barcode {
        letter: Text<1>,
        number: u64,
        suffix: u16,
    }

    impl Barcode {
        const LETTER: Place = Place::byte(0);
        const NUMBER: Place = Place::bytes(1, 5);
        const SUFFIX: Place = Place::bytes(6, 7);
    }

    impl Word for Barcode {
        type Raw = u64;
        const LEGEND: Legend<u64> = Legend::Text(
            8,
            &[
                Piece::digits::<u64>(Self::NUMBER, 12).limits(0, 999_999_999_999),
                Piece::Text(Self::LETTER),
                Piece::digits::<u16>(Self::SUFFIX, 4).limits(0, 9_999),
            ],
        );
        const FROM_RAW: fn(u64) -> Self = |raw| {
            let data = left_aligned(raw, 8);
            let [number, suffix] = [Self::NUMBER.get(&data), Self::SUFFIX.get(&data)];
            Self { letter: Self::LETTER.read(&data), number, suffix: Raw::from_bits(suffix) }
        };
        const RAW: fn(Self) -> u64 = |barcode| {
            let mut data = [0; 8];
            Self::LETTER.write(barcode.letter, &mut data);
            Self::NUMBER.write(barcode.number, &mut data);
            Self::SUFFIX.write(barcode.suffix, &mut data);
            right_aligned(data, 8)
        };
    }

    /// 0x130C15A3FB is 81807123451, 0x06A8 is 1704, 0x56 is `V`.
    const PRINTED: u64 = 0x5613_0C15_A3FB_06A8;

    #[test]
    fn a_barcode_is_written_and_read_as_printed() {
        let barcode = Barcode::FROM_RAW(PRINTED);
        assert_eq!((barcode.number, barcode.suffix), (81_807_123_451, 1704));
        assert_eq!(barcode.text().map(|text| text.to_string()).as_deref(), Some("081807123451V1704"));
        assert_eq!(Barcode::parse("081807123451V1704"), Some(barcode));
        assert_eq!(barcode.to_bits(), PRINTED);
    }

    #[test]
    fn a_text_of_another_form_is_refused() {
        for text in
            ["", "81807123451V1704", "081807123451V17045", "081807123451V170", "0818071234 1V1704", "+81807123451V1704"]
        {
            assert_eq!(Barcode::parse(text), None, "{text}");
        }
    }

    #[test]
    fn a_value_that_its_text_would_not_give_has_none() {
        assert_eq!(Barcode::FROM_RAW(0x5613_0C15_A3FB_2710).text(), None);
        assert_eq!(Barcode::FROM_RAW(0x00FF_FFFF_FFFF_0000).text(), None);
        assert_eq!(Barcode::FROM_RAW(u64::MAX).text(), None);
    }

    #[test]
    fn a_part_that_does_not_fit_is_refused() {
        const SIGNAL: Signal<Barcode> = Signal::new("value", Place::bytes(0, 7));
        let mut payload = Payload::new("barcode", [0; 8]);
        let barcode = Barcode { number: 1 << 40, ..Barcode::FROM_RAW(PRINTED) };
        assert!(SIGNAL.put(barcode, &mut payload).is_err());
        assert_eq!(SIGNAL.put(Barcode::FROM_RAW(u64::MAX), &mut payload), Ok(()));
        assert_eq!(payload.data(), &[0xFF; 8]);
    }
}
