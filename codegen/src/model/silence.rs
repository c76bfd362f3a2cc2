//! What devices do after silence.

use serde::{Deserialize, Serialize};

use crate::model::Doc;

/// What the spec says of a device after the controller was silent.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Silence {
    /// What the spec says beside it.
    pub doc: Doc,
    /// What becomes of the output.
    pub output: AfterSilence,
}

/// What becomes of an output after silence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum AfterSilence {
    /// It goes off, and stays off until it is switched on.
    Off,
    /// It goes off, and comes back as it was when the device hears any request.
    Resumes,
    /// The device delivers by itself, also if it was switched off.
    Starts,
    /// It goes on as it was.
    Keeps,
    /// The document does not say it.
    Unknown,
}

impl AfterSilence {
    /// Everything that can become of an output.
    pub const ALL: [Self; 5] = [Self::Off, Self::Resumes, Self::Starts, Self::Keeps, Self::Unknown];

    /// Returns the word of the language.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Resumes => "resumes",
            Self::Starts => "starts",
            Self::Keeps => "keeps",
            Self::Unknown => "unknown",
        }
    }

    /// Returns what it means, for people: it goes on after the word `output`.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Off => "goes off, and stays off until it is switched on",
            Self::Resumes => "goes off, and comes back when the device hears any request",
            Self::Starts => "comes on by itself, also if it was switched off",
            Self::Keeps => "stays as it was",
            Self::Unknown => "may do anything: the document does not say it",
        }
    }
}
