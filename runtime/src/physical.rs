//! The types of physical values.

use crate::error::Value;
use crate::plumbing::Scale;
use crate::raw::{Integer, Raw};
use crate::{Error, Meaning, Number, Payload, Signal};

/// The type of a signal's values and limits. Its raw values have the type `R`.
///
/// It is `R` itself if possible, so integers are compared as integers. If there is a scale, they
/// count its steps. A physical value with a scale, or a limit with a fraction, needs a
/// floating-point type.
pub trait Physical<R: Raw>: Copy + Sync + 'static {
    /// Whether this is the raw value, whatever the scale.
    const IS_RAW: bool;

    /// Returns the value of a raw value.
    fn of(raw: R, scale: Option<Scale>) -> Self;

    /// Returns the number: the physical value, or the raw value if this is it.
    fn number(self) -> Number;

    /// Returns what an error keeps of a refused value.
    #[doc(hidden)]
    fn told(self) -> Value;

    /// Tests whether this is a finite number.
    fn is_finite(self) -> bool;

    /// Tests whether this lies inside limits, both legal, as precisely as raw values can meet them.
    fn is_within(self, minimum: Self, maximum: Self) -> bool;

    /// Writes the raw value nearest to a number.
    ///
    /// # Errors
    ///
    /// The same as [`Signal::put`].
    fn write(signal: &'static Signal<R, Self>, number: Number, payload: &mut Payload) -> Result<(), Error>;
}

impl<R: Raw + 'static> Physical<R> for R {
    const IS_RAW: bool = true;

    #[inline]
    fn of(raw: R, _: Option<Scale>) -> Self {
        raw
    }

    #[inline(always)]
    fn number(self) -> Number {
        Raw::number(self)
    }

    #[inline(always)]
    fn told(self) -> Value {
        Value::Raw(self.to_bits())
    }

    #[inline]
    fn is_finite(self) -> bool {
        Raw::is_finite(self)
    }

    #[inline(always)]
    fn is_within(self, minimum: Self, maximum: Self) -> bool {
        Raw::is_within(self, minimum, maximum)
    }

    fn write(signal: &'static Signal<R, Self>, number: Number, payload: &mut Payload) -> Result<(), Error> {
        signal.write_raw(number, payload)
    }
}

/// Returns the physical value of a number of steps. All types of signals share the code.
pub(crate) fn of_steps(steps: Number, scale: Option<&Scale>) -> Number {
    match (scale, steps) {
        (Some(scale), Number::Signed(integer)) => scale.fraction(integer),
        (Some(scale), Number::Unsigned(integer)) => scale.fraction(integer as i64),
        _ => steps,
    }
}

/// Returns the physical values of limits in steps, the lower one first. All types of signals share the code.
pub(crate) fn limits_of_steps(steps: &(Number, Number), scale: Option<&Scale>) -> (Number, Number) {
    let (minimum, maximum) = *steps;
    let of = |steps| of_steps(steps, scale);
    if scale.is_some_and(|scale| scale.is_falling()) { (of(maximum), of(minimum)) } else { (of(minimum), of(maximum)) }
}

/// The type of scaled physical values: `f64`, or `f32` for processors that calculate in single precision only.
///
/// Each calculates only in its own precision.
pub trait Scaled: Copy + PartialOrd + Sealed + 'static {
    /// The greatest width for which [`raw_of`](Self::raw_of) tests all that the bits cannot hold.
    const TESTED: u8;

    /// Returns the physical value of `raw`. A constant scale folds.
    fn decoded(raw: i64, scale: Scale) -> Self;

    /// Returns the physical value of `raw`, as [`decoded`](Self::decoded) does. Small programs have the code once.
    #[inline]
    #[must_use]
    fn scaled(raw: i64, scale: Scale) -> Self {
        Self::decoded(raw, scale)
    }

    /// Returns the raw value nearest to this physical value, with ties away from zero. It is `None`
    /// if 64 bits cannot hold it.
    fn raw(self, scale: Scale) -> Option<i64>;

    /// Returns the same raw value as [`raw`](Self::raw), or `None` if `width` bits cannot hold it.
    fn raw_of(self, scale: Scale, width: u8, signed: bool) -> Option<i64>;

    /// Returns the raw value nearest to this physical value, which lies between two that `width` bits hold.
    fn raw_held(self, scale: Scale, width: u8, signed: bool) -> Option<i64>;

    /// Tests whether a raw value has exactly this physical value.
    fn is_step(self, scale: Scale) -> bool;

    /// Returns the value of this type nearest to a number.
    fn nearest(number: Number) -> Self;

    /// Returns the number.
    fn number(self) -> Number;

    /// Returns a limit as precisely as raw values of the type `R` can meet it.
    #[must_use]
    fn limit<R: Raw>(self) -> Self;
}

/// Limits the types of scaled physical values to the two that the rules on scales know.
pub trait Sealed {}

impl Sealed for f32 {}

impl Sealed for f64 {}

impl Scaled for f64 {
    const TESTED: u8 = 32;

    #[inline(always)]
    fn decoded(raw: i64, scale: Scale) -> Self {
        scale.physical(raw)
    }

    #[inline]
    fn raw(self, scale: Scale) -> Option<i64> {
        scale.raw(self)
    }

    #[inline(always)]
    fn raw_of(self, scale: Scale, width: u8, signed: bool) -> Option<i64> {
        scale.raw_of(self, width, signed)
    }

    #[inline(always)]
    fn raw_held(self, scale: Scale, width: u8, signed: bool) -> Option<i64> {
        scale.raw_held(self, width, signed)
    }

    #[inline(always)]
    #[expect(clippy::float_cmp, reason = "a step is met exactly")]
    fn is_step(self, scale: Scale) -> bool {
        match scale.raw(self) {
            Some(raw) => scale.physical(raw) == self,
            None => false,
        }
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
    fn limit<R: Raw>(self) -> Self {
        R::limit(self)
    }
}

impl Scaled for f32 {
    const TESTED: u8 = 22;

    #[inline(always)]
    fn decoded(raw: i64, scale: Scale) -> Self {
        scale.physical_f32(raw)
    }

    #[inline]
    fn raw(self, scale: Scale) -> Option<i64> {
        scale.raw_f32(self)
    }

    #[inline(always)]
    fn raw_of(self, scale: Scale, width: u8, signed: bool) -> Option<i64> {
        scale.raw_of_f32(self, width, signed)
    }

    #[inline(always)]
    fn raw_held(self, scale: Scale, width: u8, signed: bool) -> Option<i64> {
        scale.raw_held_f32(self, width, signed)
    }

    #[inline(always)]
    #[expect(clippy::float_cmp, reason = "a step is met exactly")]
    fn is_step(self, scale: Scale) -> bool {
        match scale.raw_f32(self) {
            Some(raw) => scale.physical_f32(raw) == self,
            None => false,
        }
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
    fn limit<R: Raw>(self) -> Self {
        self
    }
}

macro_rules! scaled {
    ($($type:ty, $raw:ident;)*) => {$(
        impl<R: $raw> Physical<R> for $type {
            const IS_RAW: bool = false;

            #[inline]
            fn of(raw: R, scale: Option<Scale>) -> Self {
                match scale {
                    Some(scale) => Scaled::scaled(raw.to_bits() as i64, scale),
                    None => Scaled::nearest(raw.number()),
                }
            }

            #[inline(always)]
            fn number(self) -> Number {
                Scaled::number(self)
            }

            #[inline(always)]
            fn told(self) -> Value {
                Value::Number(Scaled::number(self))
            }

            #[inline]
            fn is_finite(self) -> bool {
                self.is_finite()
            }

            #[inline]
            fn is_within(self, minimum: Self, maximum: Self) -> bool {
                let is_within = |minimum, maximum| (minimum..=maximum).contains(&self);
                is_within(minimum, maximum) || is_within(minimum.limit::<R>(), maximum.limit::<R>())
            }

            fn write(signal: &'static Signal<R, Self>, number: Number, payload: &mut Payload) -> Result<(), Error> {
                write(signal, number, payload)
            }
        }
    )*};
}

// A raw `f32` is its own physical value in single precision.
scaled! {
    f64, Raw;
    f32, Integer;
}

/// Writes a number by the scale, or as its own raw value.
fn write<R: Raw, F: Physical<R> + Scaled>(
    signal: &'static Signal<R, F>,
    number: Number,
    payload: &mut Payload,
) -> Result<(), Error> {
    match R::from_meaning(Meaning::Number(number)) {
        Some(raw) if !signal.is_scaled() => {
            if matches!(number, Number::Single(_) | Number::Float(_)) {
                signal.check_asked(F::nearest(number), payload)?;
            }
            signal.put(raw, payload)
        }
        _ => signal.encode(F::nearest(number), payload),
    }
}
