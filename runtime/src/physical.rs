//! The types of physical values.

use crate::{Number, Raw, Scale};

/// The type of scaled physical values: `f64`, or `f32` for processors that calculate in single precision only.
///
/// Each calculates in its own precision alone.
pub trait Physical: Copy + PartialOrd + Sealed + 'static {
    /// Returns the physical value of `raw`.
    fn scaled(raw: i64, scale: Scale) -> Self;

    /// Returns the raw value nearest to this physical value, ties away from zero, or `None` for what 64 bits cannot hold.
    fn raw(self, scale: Scale) -> Option<i64>;

    /// Returns the value of this type nearest to a number.
    fn nearest(number: Number) -> Self;

    /// Returns the number.
    fn number(self) -> Number;

    /// Tests whether this is neither infinite nor no number at all.
    fn is_finite(self) -> bool;

    /// Tests whether this is no number at all.
    fn is_nan(self) -> bool;

    /// Returns a limit as precisely as raw values of the type `R` can meet it.
    #[must_use]
    fn limit<R: Raw>(self) -> Self;
}

/// Keeps the types of physical values to the two that the rules on scales know.
pub trait Sealed {}

impl Sealed for f32 {}

impl Sealed for f64 {}

impl Physical for f64 {
    #[inline]
    fn scaled(raw: i64, scale: Scale) -> Self {
        scale.physical(raw)
    }

    #[inline]
    fn raw(self, scale: Scale) -> Option<i64> {
        scale.raw(self)
    }

    #[inline]
    fn nearest(number: Number) -> Self {
        number.to_f64()
    }

    #[inline]
    fn number(self) -> Number {
        Number::Float(self)
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.is_finite()
    }

    #[inline]
    fn is_nan(self) -> bool {
        self.is_nan()
    }

    #[inline]
    fn limit<R: Raw>(self) -> Self {
        R::limit(self)
    }
}

impl Physical for f32 {
    #[inline]
    fn scaled(raw: i64, scale: Scale) -> Self {
        scale.physical_f32(raw)
    }

    #[inline]
    fn raw(self, scale: Scale) -> Option<i64> {
        scale.raw_f32(self)
    }

    #[inline]
    fn nearest(number: Number) -> Self {
        number.to_f32()
    }

    #[inline]
    fn number(self) -> Number {
        Number::Single(self)
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.is_finite()
    }

    #[inline]
    fn is_nan(self) -> bool {
        self.is_nan()
    }

    #[inline]
    fn limit<R: Raw>(self) -> Self {
        self
    }
}
