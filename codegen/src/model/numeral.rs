//! Numerals: which integer the bits of a number are.

use serde::{Deserialize, Serialize};

/// How bits write an integer.
///
/// A raw value is what a frame holds: its bits, in two's complement with their sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Numeral {
    /// Binary, from 0 on.
    Unsigned,
    /// Two's complement.
    Signed,
    /// Decimal digits of four bits each, the first digit highest.
    Bcd,
}

impl Numeral {
    /// Tests whether raw values have a sign.
    pub fn is_signed(self) -> bool {
        match self {
            Self::Unsigned | Self::Bcd => false,
            Self::Signed => true,
        }
    }

    /// Tests whether raw values are the integers themselves.
    pub fn is_raw(self) -> bool {
        match self {
            Self::Unsigned | Self::Signed => true,
            Self::Bcd => false,
        }
    }

    /// Returns the least and the greatest raw value of a width.
    pub fn raw_limits(self, width: u8) -> (i128, i128) {
        if self.is_signed() { (-(1 << (width - 1)), (1 << (width - 1)) - 1) } else { (0, (1 << width) - 1) }
    }

    /// Returns the least and the greatest integer of a width.
    pub fn limits(self, width: u8) -> (i128, i128) {
        match self {
            Self::Unsigned | Self::Signed => self.raw_limits(width),
            Self::Bcd => (0, 10_i128.pow(u32::from(width / 4)) - 1),
        }
    }

    /// Returns the integer of a raw value, if it has one.
    pub fn integer(self, raw: i128) -> Option<i128> {
        match self {
            Self::Unsigned | Self::Signed => Some(raw),
            Self::Bcd => format!("{raw:X}").parse().ok(),
        }
    }

    /// Returns the raw value of an integer, of any width, if there is one.
    pub fn raw(self, integer: i128) -> Option<i128> {
        match self {
            Self::Unsigned | Self::Signed => Some(integer),
            Self::Bcd => i128::from_str_radix(&integer.to_string(), 16).ok().filter(|raw| *raw >= 0),
        }
    }
}
