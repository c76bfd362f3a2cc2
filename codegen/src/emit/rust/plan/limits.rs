//! How limits are compared with values: as raw values where they can be.

use proc_macro2::TokenStream;

use super::literal::Precision;
use super::raw::{raw_number, raw_type};
use crate::emit::Scaled;
use crate::model::{Encoding, Range, Signal};
use crate::words::number::Rational;

/// How the limits of a signal are compared with its values.
#[derive(Clone, Copy)]
pub enum Limits {
    /// As raw values.
    Raw,
    /// As physical values of this type.
    Physical(Precision),
}

impl Limits {
    /// Chooses for a signal.
    pub fn new(signal: &Signal, scaled: Scaled) -> Self {
        match Precision::of(scaled.of(signal)) {
            Some(precision) if !are_raw(signal, precision) => Self::Physical(precision),
            _ => Self::Raw,
        }
    }

    /// Returns the type of a limit.
    pub fn kind(self, signal: &Signal) -> TokenStream {
        match self {
            Self::Raw => raw_type(signal),
            Self::Physical(precision) => precision.kind(),
        }
    }

    /// Returns a range of physical values as it is compared: that of the integers in it, if they are raw.
    pub fn range(self, signal: &Signal, range: Range) -> Range {
        let linear = signal.encoding.linear().filter(|_| matches!(self, Self::Raw));
        let integers = linear.and_then(|linear| linear.integers(range)).map(|ends| ends.map(Rational::integer));
        integers.map_or(range, |[minimum, maximum]| Range { minimum, maximum })
    }

    /// Writes the ends of a range that [`range`](Self::range) returned.
    pub fn ends(self, signal: &Signal, Range { minimum, maximum }: Range) -> [TokenStream; 2] {
        let (ends, linear) = ([minimum, maximum], signal.encoding.linear());
        match (self, linear) {
            (Self::Physical(precision), _) => {
                let beyond = linear.and_then(|linear| linear.beyond(Range { minimum, maximum }));
                beyond.map_or_else(|| ends.map(|end| precision.nearest(end)), |beyond| precision.inside(ends, beyond))
            }
            (Self::Raw, None) => ends.map(|end| Precision::Single.nearest(end)),
            (Self::Raw, Some(linear)) => {
                ends.map(|end| raw_number(signal, linear.numeral.raw(end.numerator()).unwrap_or(0)))
            }
        }
    }
}

/// Tests whether limits can be raw values if scaled values are floating-point numbers. Without limits, any unscaled
/// number passes.
fn are_raw(signal: &Signal, precision: Precision) -> bool {
    let is_free = signal.limits().next().is_none();
    match signal.encoding {
        Encoding::Number { numeral, .. } => {
            signal.encoding.is_unscaled() && (is_free || numeral.is_raw() && signal.has_whole_limits())
        }
        Encoding::Float => is_free || precision == Precision::Single,
        Encoding::ByModel { .. }
        | Encoding::Named(_)
        | Encoding::Status(_)
        | Encoding::Text(_)
        | Encoding::Packed { .. } => true,
    }
}
