//! The words of the language that a key chooses from.

use crate::model::{Numeral, Origin, OutOfRange, Severity, Side, Who};

/// How a number, a text or raw bytes are written in bits.
#[derive(Clone, Copy)]
pub enum NumberFormat {
    Integer(Numeral),
    Float,
    Text,
    Bytes,
}

/// What may stand after `as`.
pub const NUMBER_FORMATS: [(&str, NumberFormat); 6] = [
    ("unsigned", NumberFormat::Integer(Numeral::Unsigned)),
    ("signed", NumberFormat::Integer(Numeral::Signed)),
    ("bcd", NumberFormat::Integer(Numeral::Bcd)),
    ("float", NumberFormat::Float),
    ("text", NumberFormat::Text),
    ("bytes", NumberFormat::Bytes),
];

/// What may stand after `absent`, and whether all ones mean that there is no value.
pub const ABSENT: [(&str, bool); 2] = [("none", false), ("ones", true)];

/// What may stand after `out_of_range`.
pub const OUT_OF_RANGE: [(&str, OutOfRange); 3] =
    [("refused", OutOfRange::Refused), ("ignored", OutOfRange::Ignored), ("limited", OutOfRange::Limited)];

/// What may stand after `power_off`, and whether the value is kept.
pub const POWER_OFF: [(&str, bool); 2] = [("kept", true), ("lost", false)];

/// What may stand after `outside`.
pub const OUTSIDE: [&str; 1] = ["refused"];

/// What may stand after `expect`, and whether reserved bits are free.
pub const EXPECTED: [(&str, bool); 2] = [("sent", false), ("any", true)];

/// The severities of a status bit.
pub const SEVERITIES: [(&str, Severity); 3] =
    [("state", Severity::State), ("alarm", Severity::Alarm), ("fault", Severity::Fault)];

/// Who may answer.
pub const ANSWERS: [(&str, Who); 4] =
    [("one", Who::One), ("each", Who::Each), ("coordinator", Who::Coordinator), ("nobody", Who::Nobody)];

/// Who may send reports.
pub const SIDES: [(&str, Side); 2] = [("module", Side::Module), ("controller", Side::Controller)];

/// Where an example can come from, if not from the document.
pub const ORIGINS: [(&str, Origin); 2] = [("ours", Origin::Ours), ("captured", Origin::Captured)];

/// What may be wrong with a document.
pub const ERRATUM_KINDS: [&str; 6] = ["vendor", "translation", "ocr", "unclear", "gap", "note"];
