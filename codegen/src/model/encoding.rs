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

/// How a number is made of a raw one: physical = raw * scale + offset.
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    /// Two's complement.
    pub signed: bool,
    /// Physical value of one step.
    pub scale: Rational,
    /// Physical value of raw 0.
    pub offset: Rational,
}

/// What others ask, each an exhaustive match: a new encoding has to answer.
impl Encoding {
    /// Returns how numbers are made, if that is by a scale.
    pub fn linear(&self) -> Option<Linear> {
        match *self {
            Self::Number { signed, scale, offset } => Some(Linear { signed, scale, offset }),
            Self::Float | Self::Named(_) | Self::Status(_) | Self::Text | Self::Packed { .. } => None,
        }
    }

    /// Returns the names of the values.
    pub fn enumeration(&self) -> Option<EnumerationId> {
        match self {
            Self::Named(id) => Some(*id),
            Self::Number { .. } | Self::Float | Self::Status(_) | Self::Text | Self::Packed { .. } => None,
        }
    }

    /// Returns the conditions of a status word.
    pub fn status_word(&self) -> Option<StatusWordId> {
        match self {
            Self::Status(id) => Some(*id),
            Self::Number { .. } | Self::Float | Self::Named(_) | Self::Text | Self::Packed { .. } => None,
        }
    }

    /// Returns what the text of a packed value consists of, and the signals in it.
    pub fn packed(&self) -> Option<(&[Piece], &Table<PartId, Signal>)> {
        match self {
            Self::Packed { pieces, parts } => Some((pieces, parts)),
            Self::Number { .. } | Self::Float | Self::Named(_) | Self::Status(_) | Self::Text => None,
        }
    }

    /// Returns the signals in a packed value; of any other, none.
    pub fn parts(&self) -> &[Signal] {
        self.packed().map_or(&[], |(_, parts)| parts)
    }

    /// Tests whether values have single precision.
    pub fn is_single(&self) -> bool {
        match self {
            Self::Float => true,
            Self::Number { .. } | Self::Named(_) | Self::Status(_) | Self::Text | Self::Packed { .. } => false,
        }
    }

    /// Tests whether it is ASCII.
    pub fn is_text(&self) -> bool {
        match self {
            Self::Text => true,
            Self::Number { .. } | Self::Float | Self::Named(_) | Self::Status(_) | Self::Packed { .. } => false,
        }
    }

    /// Returns the exact physical value of a raw number; `None` of what is no number, and on overflow.
    pub fn value_of(&self, raw: i128) -> Option<Rational> {
        let Linear { scale, offset, .. } = self.linear()?;
        Rational::integer(raw).times(scale)?.plus(offset)
    }

    /// Tests whether raw values are in two's complement.
    pub fn is_signed(&self) -> bool {
        self.linear().is_some_and(|linear| linear.signed)
    }

    /// Tests whether the physical value is a raw integer.
    pub fn is_unscaled(&self) -> bool {
        self.linear().is_some_and(|linear| linear.scale == Rational::ONE && linear.offset == Rational::ZERO)
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
