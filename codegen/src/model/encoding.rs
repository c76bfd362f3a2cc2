//! What bits mean: the encodings, and the compiler's questions about them.
//!
//! `crate::encoding` turns bits into values and back.

use serde::{Deserialize, Serialize};

use super::{EnumerationId, Numeral, OfModel, PartId, Range, Signal, StatusWordId, Table};
use crate::words::number::Rational;

/// What a signal's bits mean.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Encoding {
    /// physical = integer * scale + offset.
    Number {
        /// Which integer the bits are.
        numeral: Numeral,
        /// Physical value of one step.
        scale: Rational,
        /// Physical value of 0.
        offset: Rational,
    },
    /// A number whose scale, offset or unit depends on the device model. Without a model it has no
    /// physical value.
    ByModel {
        /// Which integer the bits are.
        numeral: Numeral,
        /// The signal on each device model that says what a step is.
        signals: Vec<OfModel<Signal>>,
    },
    /// IEEE 754 single precision.
    Float,
    /// Values with names.
    Named(EnumerationId),
    /// Conditions, one a bit.
    Status(StatusWordId),
    /// Whole bytes as a text, which begins at the most significant byte of the place.
    Text(TextForm),
    /// One text made of several parts.
    Packed {
        /// What the text consists of, in order.
        pieces: Vec<Piece>,
        /// Bits of the payload that the pieces name.
        parts: Table<PartId, Signal>,
    },
}

/// How bytes are written as a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TextForm {
    /// ASCII characters, filled up with a byte.
    Ascii {
        /// The byte after the last character.
        fill: u8,
    },
    /// Two hexadecimal digits a byte.
    Hexadecimal,
}

/// Turns an integer into a number: physical = integer * scale + offset.
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    /// Which integer the bits are.
    pub numeral: Numeral,
    /// Physical value of one step.
    pub scale: Rational,
    /// Physical value of 0.
    pub offset: Rational,
}

impl Linear {
    /// Returns the exact physical value of an integer; `None` on overflow.
    pub fn value(&self, integer: i128) -> Option<Rational> {
        Rational::integer(integer).times(self.scale)?.plus(self.offset)
    }

    /// Returns the least and the greatest integer whose exact values lie within a range; `None` on
    /// overflow. If there are none, the first lies above the second.
    pub fn integers(&self, range: Range) -> Option<[i128; 2]> {
        let steps = |end: Rational| end.minus(self.offset)?.over(self.scale);
        let (one, other) = (steps(range.minimum)?, steps(range.maximum)?);
        Some([one.min(other).ceiling(), one.max(other).floor()])
    }

    /// Returns the nearest values below and above a range; `None` on overflow.
    pub fn beyond(&self, range: Range) -> Option<[Rational; 2]> {
        let [first, last] = self.integers(range)?;
        let (one, other) = (self.value(first - 1)?, self.value(last + 1)?);
        Some([one.min(other), one.max(other)])
    }
}

/// Each question is an exhaustive match, so a new encoding must answer it.
impl Encoding {
    /// Returns the scale and the offset of numbers that have them. A number that depends on the device
    /// model counts its raw steps.
    #[inline]
    pub fn linear(&self) -> Option<Linear> {
        match *self {
            Self::Number { numeral, scale, offset } => Some(Linear { numeral, scale, offset }),
            Self::ByModel { numeral, .. } => Some(Linear { numeral, scale: Rational::ONE, offset: Rational::ZERO }),
            Self::Float | Self::Named(_) | Self::Status(_) | Self::Text(_) | Self::Packed { .. } => None,
        }
    }

    /// Returns the names of the values.
    pub fn enumeration(&self) -> Option<EnumerationId> {
        match self {
            Self::Named(id) => Some(*id),
            Self::Number { .. }
            | Self::ByModel { .. }
            | Self::Float
            | Self::Status(_)
            | Self::Text(_)
            | Self::Packed { .. } => None,
        }
    }

    /// Returns the conditions of a status word.
    pub fn status_word(&self) -> Option<StatusWordId> {
        match self {
            Self::Status(id) => Some(*id),
            Self::Number { .. }
            | Self::ByModel { .. }
            | Self::Float
            | Self::Named(_)
            | Self::Text(_)
            | Self::Packed { .. } => None,
        }
    }

    /// Returns what the text of a packed value consists of, and the signals in it.
    pub fn packed(&self) -> Option<(&[Piece], &Table<PartId, Signal>)> {
        match self {
            Self::Packed { pieces, parts } => Some((pieces, parts)),
            Self::Number { .. }
            | Self::ByModel { .. }
            | Self::Float
            | Self::Named(_)
            | Self::Status(_)
            | Self::Text(_) => None,
        }
    }

    /// Returns the signals in a packed value. Any other encoding has none.
    pub fn parts(&self) -> &[Signal] {
        self.packed().map_or(&[], |(_, parts)| parts)
    }

    /// Tests whether values have single precision.
    pub fn is_single(&self) -> bool {
        match self {
            Self::Float => true,
            Self::Number { .. }
            | Self::ByModel { .. }
            | Self::Named(_)
            | Self::Status(_)
            | Self::Text(_)
            | Self::Packed { .. } => false,
        }
    }

    /// Returns the signal on each device model that says what a step is, if that depends on the model.
    #[inline]
    pub fn by_model(&self) -> &[OfModel<Signal>] {
        match self {
            Self::ByModel { signals, .. } => signals,
            Self::Number { .. }
            | Self::Float
            | Self::Named(_)
            | Self::Status(_)
            | Self::Text(_)
            | Self::Packed { .. } => &[],
        }
    }

    /// Returns how bytes are written as a text, if they are a text of their own.
    pub fn text_form(&self) -> Option<TextForm> {
        match self {
            Self::Text(form) => Some(*form),
            Self::Number { .. }
            | Self::ByModel { .. }
            | Self::Float
            | Self::Named(_)
            | Self::Status(_)
            | Self::Packed { .. } => None,
        }
    }

    /// Returns the exact physical value of a raw number. It is `None` for other encodings, and on
    /// overflow.
    pub fn value_of(&self, raw: i128) -> Option<Rational> {
        let linear = self.linear()?;
        linear.value(linear.numeral.integer(raw)?)
    }

    /// Returns which integer the bits are, whatever the integer means.
    #[inline]
    pub fn numeral(&self) -> Numeral {
        match self {
            Self::Number { numeral, .. } | Self::ByModel { numeral, .. } => *numeral,
            Self::Float | Self::Named(_) | Self::Status(_) | Self::Text(_) | Self::Packed { .. } => Numeral::Unsigned,
        }
    }

    /// Tests whether the physical value is the integer that the bits are.
    pub fn is_unscaled(&self) -> bool {
        self.linear().is_some_and(|linear| linear.scale == Rational::ONE && linear.offset == Rational::ZERO)
    }
}

/// A piece of a packed value's text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Piece {
    /// A text that never changes.
    Literal(String),
    /// The text or the number of a part.
    Part {
        /// The part.
        part: PartId,
        /// Number of digits that zeros fill a number up to.
        digits: Option<usize>,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integers(scale: &str, offset: &str, range: [&str; 2]) -> Option<[i128; 2]> {
        let [scale, offset] = [scale, offset].map(Rational::parse);
        let [minimum, maximum] = range.map(Rational::parse);
        let linear = Linear { numeral: Numeral::Signed, scale: scale?, offset: offset? };
        linear.integers(Range { minimum: minimum?, maximum: maximum? })
    }

    #[test]
    fn a_range_has_the_integers_whose_values_lie_within() {
        assert_eq!(integers("1/10", "0", ["0.04", "20.06"]), Some([1, 200]));
        assert_eq!(integers("1/1000", "0", ["0.26", "25.7"]), Some([260, 25_700]));
        assert_eq!(integers("1/2", "-40", ["-40", "80"]), Some([0, 240]));
        // 10 - 0.5 n: 9.5 is n = 1, and 0.5 is n = 19.
        assert_eq!(integers("-1/2", "10", ["0.3", "9.9"]), Some([1, 19]));
    }

    #[test]
    fn the_steps_beyond_a_range_are_the_nearest_outside() {
        let beyond = |scale: &str, offset: &str, range: [&str; 2]| {
            let [scale, offset] = [scale, offset].map(Rational::parse);
            let [minimum, maximum] = range.map(Rational::parse);
            let linear = Linear { numeral: Numeral::Signed, scale: scale?, offset: offset? };
            linear.beyond(Range { minimum: minimum?, maximum: maximum? })
        };
        let values = |texts: [&str; 2]| Some(texts.map(|text| Rational::parse(text).unwrap_or(Rational::ZERO)));
        assert_eq!(beyond("1/10", "0", ["0.04", "20.06"]), values(["0", "20.1"]));
        assert_eq!(beyond("1/2", "-40", ["-40", "80"]), values(["-40.5", "80.5"]));
        assert_eq!(beyond("-1/2", "10", ["0.3", "9.9"]), values(["0", "10"]));
    }

    #[test]
    fn between_two_steps_there_is_no_integer() {
        assert_eq!(integers("10", "0", ["11", "19"]), Some([2, 1]));
    }
}
