//! Numbers of any of the types that signals have.

use core::fmt;

/// The sign of a double.
const SIGN: u64 = 1 << 63;
/// The bits of a double that is infinite.
const INFINITE: u64 = f64::INFINITY.to_bits();

/// A number as a signal carries it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Number {
    /// An unsigned integer.
    Unsigned(u64),
    /// A signed integer.
    Signed(i64),
    /// A number in single precision.
    Single(f32),
    /// A scaled or floating-point number.
    Float(f64),
    /// A scaled number that is counted in whole steps, as the exact fraction that it is.
    Fraction {
        /// What is divided.
        numerator: i64,
        /// What it is divided by.
        denominator: i64,
    },
}

impl Number {
    /// Returns the nearest double.
    #[expect(clippy::cast_precision_loss, reason = "the nearest double is what is asked for")]
    pub const fn to_f64(self) -> f64 {
        match self {
            Self::Unsigned(number) => number as f64,
            Self::Signed(number) => number as f64,
            Self::Single(number) => number as f64,
            Self::Float(number) => number,
            Self::Fraction { numerator, denominator } => numerator as f64 / denominator as f64,
        }
    }

    /// Tests whether this is neither infinite nor an error of a calculation. It looks at the bits: many processors have no
    /// instruction that compares doubles.
    pub(crate) const fn is_finite(self) -> bool {
        match self {
            Self::Single(number) => number.is_finite(),
            Self::Float(number) => number.to_bits() & INFINITE != INFINITE,
            Self::Unsigned(_) | Self::Signed(_) | Self::Fraction { .. } => true,
        }
    }

    /// Tests whether this is the error of a calculation.
    pub(crate) const fn is_nan(self) -> bool {
        match self {
            Self::Single(number) => number.is_nan(),
            Self::Float(number) => number.to_bits() & !SIGN > INFINITE,
            Self::Unsigned(_) | Self::Signed(_) | Self::Fraction { .. } => false,
        }
    }

    /// Returns the nearest single.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "the nearest single is what is asked for"
    )]
    pub const fn to_f32(self) -> f32 {
        match self {
            Self::Unsigned(number) => number as f32,
            Self::Signed(number) => number as f32,
            Self::Single(number) => number,
            Self::Float(_) | Self::Fraction { .. } => self.to_f64() as f32,
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsigned(number) => number.fmt(formatter),
            Self::Signed(number) => number.fmt(formatter),
            Self::Single(number) => number.fmt(formatter),
            Self::Float(_) | Self::Fraction { .. } => self.to_f64().fmt(formatter),
        }
    }
}
