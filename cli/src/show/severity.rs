//! The severities of status bits, by their words in a spec.

use canspec_codegen::model;
use clap::ValueEnum;

/// How grave a condition is; the gravest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Severity {
    Fault,
    Alarm,
    State,
}

impl Severity {
    pub const ALL: [Self; 3] = [Self::Fault, Self::Alarm, Self::State];

    /// Returns the severity of a status bit, if the document says it.
    pub fn of(bit: &model::StatusBit) -> Option<Self> {
        bit.severity.map(|severity| match severity {
            model::Severity::Fault => Self::Fault,
            model::Severity::Alarm => Self::Alarm,
            model::Severity::State => Self::State,
        })
    }

    /// Returns the word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Fault => "fault",
            Self::Alarm => "alarm",
            Self::State => "state",
        }
    }
}
