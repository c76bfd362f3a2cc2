//! Notes on recognised frames.

use serde::{Deserialize, Serialize};

use std::fmt;

/// Something that a document does not foresee in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum NoteRule {
    /// A reply does not have the `normal` value: it reports an error.
    ErrorCode,
    /// No addressing mode fits, or only one that the message does not have.
    Addressing,
    /// An address lies outside its range.
    Address,
    /// A value has no name, or a text is not of its form.
    UnknownValue,
    /// A status word has bits set that have no name.
    UnknownBit,
    /// A value lies outside its range.
    OutOfRange,
    /// A floating-point number is infinite or not a number.
    NotFinite,
    /// Bits are set that no field has.
    ReservedBit,
    /// The frame means something else on other device models, or nothing on the chosen model.
    ModelDependent,
    /// Nothing says how many elements of an array are real.
    Count,
}

impl NoteRule {
    /// Every rule with its word of the spec language and the output formats.
    pub const ALL: [(Self, &'static str); 10] = [
        (Self::ErrorCode, "error_code"),
        (Self::Addressing, "addressing"),
        (Self::Address, "address"),
        (Self::UnknownValue, "unknown_value"),
        (Self::UnknownBit, "unknown_bit"),
        (Self::OutOfRange, "out_of_range"),
        (Self::NotFinite, "not_finite"),
        (Self::ReservedBit, "reserved_bit"),
        (Self::ModelDependent, "model_dependent"),
        (Self::Count, "count"),
    ];

    /// Returns the word of the spec language.
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(rule, _)| *rule == self).map_or("", |(_, name)| name)
    }

    /// Returns the note's document in Markdown: what it says of a frame, and what to do about it.
    pub const fn document(self) -> &'static str {
        match self {
            Self::ErrorCode => include_str!("../../docs/notes/error_code.md"),
            Self::Addressing => include_str!("../../docs/notes/addressing.md"),
            Self::Address => include_str!("../../docs/notes/address.md"),
            Self::UnknownValue => include_str!("../../docs/notes/unknown_value.md"),
            Self::UnknownBit => include_str!("../../docs/notes/unknown_bit.md"),
            Self::OutOfRange => include_str!("../../docs/notes/out_of_range.md"),
            Self::NotFinite => include_str!("../../docs/notes/not_finite.md"),
            Self::ReservedBit => include_str!("../../docs/notes/reserved_bit.md"),
            Self::ModelDependent => include_str!("../../docs/notes/model_dependent.md"),
            Self::Count => include_str!("../../docs/notes/count.md"),
        }
    }
}

impl fmt::Display for NoteRule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}
