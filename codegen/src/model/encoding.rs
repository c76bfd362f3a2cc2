//! What bits mean: the encodings, and what the rest of the compiler asks about them.
//!
//! How each of them makes values of bits, and bits of values, is in `crate::encoding`.

use super::{EnumerationId, PartId, Signal, StatusWordId, Table};
use crate::number::Rational;

/// What a signal's bits mean.
#[derive(Clone, Debug)]
pub enum Encoding {
    /// physical = raw * scale + offset.
    Number {
        /// Two's complement.
        signed: bool,
        /// Physical value of one step.
        scale: Rational,
        /// Physical value of raw 0.
        offset: Rational,
    },
    /// IEEE 754 single precision.
    Float,
    /// Values with names.
    Named(EnumerationId),
    /// Conditions, one a bit.
    Status(StatusWordId),
    /// ASCII, the first character at the most significant byte of the place.
    Text,
    /// One text made of several parts.
    Packed {
        /// What the text consists of, in order.
        pieces: Vec<Piece>,
        /// Bits of the payload that the pieces name.
        parts: Table<PartId, Signal>,
    },
}

impl Encoding {
    /// Returns the exact physical value of a raw number; `None` of what is no number, and on overflow.
    pub fn value_of(&self, raw: i128) -> Option<Rational> {
        let Self::Number { scale, offset, .. } = self else { return None };
        Rational::integer(raw).times(*scale)?.plus(*offset)
    }

    /// Tests whether raw values are in two's complement.
    pub fn is_signed(&self) -> bool {
        matches!(self, Self::Number { signed: true, .. })
    }

    /// Tests whether values have single precision.
    pub fn is_single(&self) -> bool {
        matches!(self, Self::Float)
    }

    /// Tests whether it is ASCII.
    pub fn is_text(&self) -> bool {
        matches!(self, Self::Text)
    }

    /// Tests whether the physical value is a raw integer.
    pub fn is_unscaled(&self) -> bool {
        matches!(self, Self::Number { scale, offset, .. } if *scale == Rational::ONE && *offset == Rational::ZERO)
    }
}

/// A piece of a packed value's text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Piece {
    /// A text that stands as it is.
    Literal(String),
    /// The text or the number of a part.
    Part {
        /// The part.
        part: PartId,
        /// To how many digits a number is filled with zeros.
        digits: Option<usize>,
    },
}

/// Returns the least and the greatest raw value of a width.
pub fn raw_limits(width: u8, signed: bool) -> (i128, i128) {
    if signed { (-(1 << (width - 1)), (1 << (width - 1)) - 1) } else { (0, (1 << width) - 1) }
}
