//! Raw bytes.

use core::fmt;

use crate::Meaning;
use crate::plumbing::{ByteRun, Raw};

/// Raw bytes, which are shown in hexadecimal. The first one stands at the most significant byte of
/// the place.
///
/// ```
/// use canspec_runtime::Bytes;
///
/// let code = Bytes::new([0x0A, 0x1B, 0x2C]);
/// assert_eq!(Bytes::from_hex("0A1B2C"), Some(code));
/// assert_eq!(format!("{code}"), "0A1B2C");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Bytes<const N: usize>([u8; N]);

impl<const N: usize> Bytes<N> {
    /// Takes the bytes of the frame.
    pub const fn new(bytes: [u8; N]) -> Self {
        Self(bytes)
    }

    /// Takes two hexadecimal digits for each byte, or returns `None` for any other text.
    pub fn from_hex(text: &str) -> Option<Self> {
        let mut digits = text.chars().map(|digit| digit.to_digit(16));
        let mut bytes = [0; N];
        for byte in &mut bytes {
            let (high, low) = (digits.next()??, digits.next()??);
            *byte = u8::try_from(high << 4 | low).ok()?;
        }
        digits.next().is_none().then_some(Self(bytes))
    }

    /// Returns the bytes of the frame.
    pub const fn as_bytes(&self) -> &[u8; N] {
        &self.0
    }
}

impl<const N: usize> Default for Bytes<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

impl<const N: usize> fmt::Display for Bytes<N> {
    /// Writes two upper-case hexadecimal digits for each byte.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write(&self.0, formatter)
    }
}

impl<const N: usize> fmt::Debug for Bytes<N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write(&self.0, formatter)
    }
}

/// Writes bytes in hexadecimal.
pub(crate) fn write(bytes: &[u8], formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
    bytes.iter().try_for_each(|byte| write!(formatter, "{byte:02X}"))
}

impl<const N: usize> Raw for Bytes<N> {
    fn from_bits(bits: u64) -> Self {
        let mut bytes = [0; N];
        for (byte, value) in bytes.iter_mut().rev().zip(bits.to_le_bytes()) {
            *byte = value;
        }
        Self(bytes)
    }

    fn to_bits(self) -> u64 {
        self.0.iter().fold(0, |bits, byte| bits << 8 | u64::from(*byte))
    }

    fn meaning(&self) -> Meaning<'_> {
        Meaning::Bytes(&self.0)
    }

    fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
        match meaning {
            Meaning::Bytes(bytes) => bytes.try_into().ok().map(Self),
            Meaning::Text(text) => Self::from_hex(text),
            Meaning::Number(_) | Meaning::Name(_) | Meaning::Packed(_) | Meaning::Status(..) | Meaning::None => None,
        }
    }
}

impl<const N: usize> ByteRun for Bytes<N> {
    const MOST: usize = N;
    const FILL: Option<u8> = None;

    fn from_slice(bytes: &[u8]) -> Self {
        let mut own = Self::default();
        own.0.iter_mut().zip(bytes).for_each(|(byte, given)| *byte = *given);
        own
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
    fn bytes_stand_in_their_order_and_are_shown_with_all_their_digits() {
        let code = Bytes::<3>::from_bits(0x000A_1B2C);
        assert_eq!(code.as_bytes(), &[0x0A, 0x1B, 0x2C]);
        assert_eq!(code.to_bits(), 0x000A_1B2C);
        assert_eq!((code.to_string(), code.meaning().to_string()), ("0A1B2C".into(), "0A1B2C".into()));
    }

    #[test]
    fn a_text_of_other_digits_is_refused() {
        assert_eq!(Bytes::from_hex("0a1B"), Some(Bytes::new([0x0A, 0x1B])));
        for text in ["", "0A1", "0A1B2", "0A1B2C", "0A1G", "+A1B", "0A 1B"] {
            assert_eq!(Bytes::<2>::from_hex(text), None, "{text}");
        }
    }

    #[test]
    fn bytes_are_sent_as_bytes_or_as_a_text() {
        let sent = Bytes::<2>::from_meaning;
        assert_eq!(sent(Meaning::Bytes(&[1, 2])), Some(Bytes::new([1, 2])));
        assert_eq!(sent(Meaning::Text("0102")), Some(Bytes::new([1, 2])));
        assert_eq!(sent(Meaning::Bytes(&[1, 2, 3])), None);
        assert_eq!(sent(Meaning::None), None);
    }
}
