//! ASCII texts.

use core::fmt::{self, Write};

use crate::Meaning;
use crate::plumbing::{ByteRun, Raw};

/// A text of at most `N` ASCII characters. The bytes after a shorter text are `FILL`.
///
/// ```
/// use canspec_runtime::Text;
///
/// let name = Text::<4>::new("A1").expect("two characters");
/// assert_eq!(name.as_bytes(), b"A1\0\0");
/// let name = Text::<4, b' '>::new("A1").expect("two characters");
/// assert_eq!((name.as_bytes(), name.as_str()), (b"A1  ", Some("A1")));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Text<const N: usize, const FILL: u8 = 0>([u8; N]);

impl<const N: usize, const FILL: u8> Text<N, FILL> {
    /// Takes a text of at most `N` ASCII characters without NUL, or returns `None` for any other
    /// text.
    pub fn new(text: &str) -> Option<Self> {
        let mut bytes = [FILL; N];
        bytes.iter_mut().zip(text.bytes()).for_each(|(byte, letter)| *byte = letter);
        (text.len() <= N && text.bytes().all(is_character)).then_some(Self(bytes))
    }

    #[cfg(feature = "serde")]
    pub(crate) const fn from_bytes(bytes: [u8; N]) -> Self {
        Self(bytes)
    }

    /// Returns the bytes of the frame.
    pub const fn as_bytes(&self) -> &[u8; N] {
        &self.0
    }

    /// Returns the text. It is `None` unless the bytes are ASCII characters without NUL, with only
    /// `FILL` after them. Line ends and other control characters belong to the text.
    pub fn as_str(&self) -> Option<&str> {
        let length = self.0.iter().rposition(|byte| *byte != FILL).map_or(0, |last| last.saturating_add(1));
        let text = self.0.get(..length)?;
        text.iter().all(|byte| is_character(*byte)).then(|| core::str::from_utf8(text).ok()).flatten()
    }
}

pub const fn is_character(byte: u8) -> bool {
    matches!(byte, 1..=0x7F)
}

/// Tests whether a text is shown with escapes.
pub fn needs_escapes(text: &str) -> bool {
    text.contains(|letter: char| letter.is_control() || letter == '\\')
}

/// Writes control characters and backslashes as escapes.
pub struct Escaped<'w, W>(pub &'w mut W);

impl<W: Write> Write for Escaped<'_, W> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.chars().try_for_each(|letter| match letter {
            '\\' => self.0.write_str("\\\\"),
            '\n' => self.0.write_str("\\n"),
            '\r' => self.0.write_str("\\r"),
            '\t' => self.0.write_str("\\t"),
            _ if letter.is_control() => write!(self.0, "\\x{:02X}", u32::from(letter)),
            _ => self.0.write_char(letter),
        })
    }
}

impl<const N: usize, const FILL: u8> Default for Text<N, FILL> {
    fn default() -> Self {
        Self([FILL; N])
    }
}

impl<const N: usize, const FILL: u8> fmt::Display for Text<N, FILL> {
    /// Writes the text with control characters and backslashes as escapes, and all bytes so if they are no text.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.as_str() {
            Some(text) if !needs_escapes(text) => formatter.pad(text),
            Some(text) => Escaped(formatter).write_str(text),
            None => self.0.escape_ascii().fmt(formatter),
        }
    }
}

impl<const N: usize, const FILL: u8> fmt::Debug for Text<N, FILL> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "\"{}\"", self.0.escape_ascii())
    }
}

// A signal has at most eight bytes. What is longer stands in a long message, as a run of bytes.
impl<const N: usize, const FILL: u8> Raw for Text<N, FILL> {
    fn from_bits(bits: u64) -> Self {
        bits.to_be_bytes().last_chunk().map_or_else(Self::default, |text| Self(*text))
    }

    fn to_bits(self) -> u64 {
        let mut bytes = [0; 8];
        if let Some(text) = bytes.last_chunk_mut() {
            *text = self.0;
        }
        u64::from_be_bytes(bytes)
    }

    fn meaning(&self) -> Meaning<'_> {
        self.as_str().map_or(Meaning::None, Meaning::Text)
    }

    fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
        let Meaning::Text(text) = meaning else { return None };
        Self::new(text)
    }
}

impl<const N: usize, const FILL: u8> ByteRun for Text<N, FILL> {
    const MOST: usize = N;
    const FILL: Option<u8> = Some(FILL);

    fn from_slice(bytes: &[u8]) -> Self {
        let mut text = Self::default();
        text.0.iter_mut().zip(bytes).for_each(|(byte, given)| *byte = *given);
        text
    }

    fn as_slice(&self) -> &[u8] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    #[test]
    fn a_text_stands_in_the_order_of_its_bytes() {
        let text = Text::<4>::new("AB12").expect("four letters");
        assert_eq!(text.to_bits(), 0x4142_3132);
        assert_eq!(Text::<4>::from_bits(0x4142_3132), text);
        assert_eq!(text.to_string(), "AB12");
    }

    #[test]
    fn a_short_text_is_filled_up_with_zeros() {
        assert_eq!(Text::<4>::new("A").map(Raw::to_bits), Some(0x4100_0000));
        assert_eq!(Text::<4>::from_bits(0x4100_0000).as_str(), Some("A"));
    }

    #[test]
    fn a_text_ends_before_the_bytes_that_fill_it_up() {
        let text = |bits| Text::<4, b' '>::from_bits(bits);
        assert_eq!(text(0x4142_2020).as_str(), Some("AB"));
        assert_eq!(text(0x2041_2042).as_str(), Some(" A B"));
        assert_eq!(text(0x2020_2020), Text::default());
        assert_eq!(text(0x4142_0000).as_str(), None, "NUL is no character");
        assert_eq!(Text::<4, b' '>::new("A").map(Raw::to_bits), Some(0x4120_2020));
    }

    #[test]
    fn control_characters_belong_to_a_text_and_are_shown_as_escapes() {
        let text = Text::<6>::new("A\r\n\t\\\u{1B}").expect("six characters");
        assert_eq!(text.to_bits(), 0x410D_0A09_5C1B);
        assert_eq!(text.as_str(), Some("A\r\n\t\\\u{1B}"));
        assert_eq!(text.to_string(), r"A\r\n\t\\\x1B");
        assert_eq!(text.meaning().to_string(), r"A\r\n\t\\\x1B");
        assert_eq!(Text::<2>::from_bits(0x7F01).to_string(), r"\x7F\x01");
    }

    #[test]
    fn what_is_no_ascii_is_no_text() {
        assert_eq!(Text::<4>::new("ABCDE"), None);
        assert_eq!(Text::<4>::new("é"), None);
        assert_eq!(Text::<4>::from_bits(0x4100_4200).as_str(), None);
        assert_eq!(Text::<1>::from_bits(0x8A).to_string(), "\\x8a");
    }
}
