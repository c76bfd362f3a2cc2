//! The options of generated code.

use crate::model::{Numeral, Signal};

/// Options of generated code.
///
/// Generated code depends only on the runtime, which re-exports the crates of the optional traits.
/// A trait that is switched on needs the feature of `canspec-runtime` with its name, and nothing
/// else.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// What scaled values are.
    pub scaled: Scaled,
    /// What programs are optimized for.
    pub goal: Goal,
    /// `serde::Serialize` and `serde::Deserialize` of every type that carries values: messages, the enum of them,
    /// identifiers, targets, named values, status words and packed values.
    ///
    /// Fields have the names of the struct. Messages and targets have the names of the spec.
    /// Formats for people write named values by name, status words by the names of their set bits,
    /// and packed values by their text. A value without a name is written as its number, so every
    /// value can be read back. Other formats carry raw values. Received messages cannot be read
    /// from a format. Write their frame, and decode it again.
    pub serde: Switch,
    /// `defmt::Format` of the same types, with the same names.
    pub defmt: Switch,
    /// `arbitrary::Arbitrary` of the structs of messages, made from the eight bytes of a frame. The
    /// values can be encoded, but a request refuses those outside its limits.
    ///
    /// The crate `arbitrary` needs the standard library. The generated code itself does not.
    pub arbitrary: Switch,
}

/// What scaled values are in generated code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scaled {
    /// `f64` in the unit of the spec, which suits every spec.
    #[default]
    F64,
    /// `f32` in the unit of the spec, for processors that only calculate in single precision.
    /// Decoding and encoding then never calculate in double.
    ///
    /// It does not suit every spec. [`check::fits`](crate::check::fits) reports the signals that
    /// need another choice.
    F32,
    /// Whole steps: the raw integer, and its limits as integers. This suits every spec, too.
    /// Decoding and encoding then never calculate in floating point.
    ///
    /// A field is called `voltage_mv` if the step is a thousandth of a volt, and `voltage_raw` if
    /// it is no decimal prefix of the unit. Its comment names the step. Readings and errors still
    /// have physical values.
    Steps,
}

impl Scaled {
    /// Returns what the values of a signal are. Decimal digits with a scale always count whole steps, since their bits
    /// may be no number.
    pub(crate) fn of(self, signal: &Signal) -> Self {
        let is_decimal = signal.encoding.linear().is_some_and(|linear| linear.numeral == Numeral::Bcd);
        if is_decimal && !signal.encoding.is_unscaled() { Self::Steps } else { self }
    }
}

/// What programs are optimized for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Goal {
    /// Speed: each place that builds a request has all code for it, and each direction is recognised on its own.
    #[default]
    Speed,
    /// Size: the compiler decides where that code stands, and what messages share of it. Both directions are
    /// recognised in one place, if each request has the selectors of its reply.
    Size,
}

/// Whether generated code implements an optional trait.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Switch {
    /// It does not.
    #[default]
    Never,
    /// It does if the crate that includes the code has this feature. The feature must turn on that
    /// of `canspec-runtime`: `serde = ["canspec-runtime/serde"]`.
    Gated(String),
    /// It does.
    Always,
}
