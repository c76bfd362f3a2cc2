//! What the user chooses about generated code.

/// What generated code has beside the codec.
///
/// Generated code depends on the runtime alone, which passes on the crates of the optional traits: a trait that is switched on
/// asks for the feature of `canspec-runtime` that has its name, and for nothing else.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Type of scaled values.
    pub float: Float,
    /// `serde::Serialize` and `serde::Deserialize` of every type that carries values: messages, the enum of them,
    /// identifiers, targets, named values, status words and packed values.
    ///
    /// Fields have the names of the struct, messages and targets the names of the spec. In formats for people named values
    /// go by their names, status words by those of their set bits, packed values by their text; what has no name goes by
    /// its number, so that every value comes back. Other formats carry raw values. What was received does not borrow from
    /// a format: write its frame, and decode it again.
    pub serde: Switch,
    /// `defmt::Format` of the same types, with the same names.
    pub defmt: Switch,
    /// `arbitrary::Arbitrary` of the structs of messages, out of eight bytes as of a frame: the values can be encoded,
    /// though a request refuses those outside its limits.
    ///
    /// The crate `arbitrary` needs the standard library; the generated code itself does not.
    pub arbitrary: Switch,
}

/// Type of scaled values in generated code.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Float {
    /// `f64`, which suits every spec.
    #[default]
    F64,
    /// `f32`, for processors that calculate in single precision only: decoding and encoding do no arithmetic in double.
    ///
    /// Not every spec suits it: [`check::fits`](crate::check::fits) says which signals do not.
    F32,
}

/// Whether generated code implements an optional trait.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Switch {
    /// It does not.
    #[default]
    Never,
    /// It does if the crate that includes the code has this feature, which turns on that of `canspec-runtime`:
    /// `serde = ["canspec-runtime/serde"]`.
    Gated(String),
    /// It does.
    Always,
}
