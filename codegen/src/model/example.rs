//! The document's frames and what they mean.

use serde::{Deserialize, Serialize};

use crate::model::{Doc, Kind, LongMessageId, MessageId, ModelId, NoteRule, Range, Signal, SignalId};
use crate::report::tree::Path;

/// A frame of the document and what it means.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Example {
    /// What the spec says beside it.
    pub doc: Doc,
    /// What the spec says the frame is for.
    pub kind: Kind,
    /// Identifier.
    pub id: u32,
    /// 29-bit identifier rather than 11-bit.
    pub extended: bool,
    /// Data bytes; `None` if the document prints only an identifier.
    pub data: Option<Vec<u8>>,
    /// The message that it carries; `None` if it carries none.
    pub message: Option<MessageId>,
    /// The device model of the frame.
    pub model: Option<ModelId>,
    /// What the example says about signals of the message, not necessarily all.
    pub means: Vec<Meaning>,
    /// Rules of the notes that decoding must report.
    pub notes: Vec<NoteRule>,
    /// How the frame must fail, if at all.
    pub fails: Option<Failure>,
    /// Where the frame comes from.
    pub origin: Origin,
    /// Its position in its list. A reply answers the request before it.
    pub position: usize,
}

impl Example {
    /// Tests whether the document prints the frame.
    pub fn is_documented(&self) -> bool {
        self.origin == Origin::Document
    }
}

/// All frames of a long message, and what they say together.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LongExample {
    /// What the spec says beside it.
    pub doc: Doc,
    /// What the spec says the frames are for.
    pub kind: Kind,
    /// The long message.
    pub long: LongMessageId,
    /// Identifiers and data bytes of the frames, in the order of the document.
    pub frames: Vec<(u32, Vec<u8>)>,
    /// The device model of the frames.
    pub model: Option<ModelId>,
    /// How many elements the array of varying length has, if the example says it.
    pub count: Option<u16>,
    /// What the example says about signals of the long message, not necessarily all.
    pub means: Vec<Meaning>,
    /// Rules of the notes that decoding must report.
    pub notes: Vec<NoteRule>,
    /// Where the frames come from.
    pub origin: Origin,
}

/// Where an example comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Origin {
    /// The document prints it.
    Document,
    /// The author of the spec made it.
    Ours,
    /// It was captured on a real bus.
    Captured,
}

/// What an example says about one signal.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Meaning {
    /// The signal.
    pub signal: SignalId,
    /// As written in the spec.
    pub text: String,
    /// What the text stands for, or the reason why it is no value of the signal.
    pub said: Result<Said, Misfit>,
    /// Place in the spec.
    pub path: Path,
}

impl Meaning {
    /// Tests whether bits of a signal mean this.
    pub fn is(&self, signal: &Signal, bits: u64) -> bool {
        self.said.as_ref().is_ok_and(|said| said.is(signal, bits))
    }

    /// Returns the raw bits, unless the text is rounded or no value of the signal.
    pub fn bits(&self) -> Option<u64> {
        match self.said {
            Ok(Said::Bits(bits)) => Some(bits),
            Ok(Said::Rounded(_) | Said::Text(_)) | Err(_) => None,
        }
    }
}

/// What a text of an example stands for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Said {
    /// Raw bits.
    Bits(u64),
    /// A rounded number: every value that gives it.
    Rounded(Range),
    /// A text that is a run, as it is shown.
    Text(String),
}

impl Said {
    /// Tests whether bits of a signal mean this.
    pub fn is(&self, signal: &Signal, bits: u64) -> bool {
        match self {
            Self::Bits(said) => *said == bits,
            Self::Rounded(range) => signal.is_in(range, bits),
            Self::Text(_) => false,
        }
    }
}

/// Why a text is no value of a signal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Misfit {
    /// What is wrong, in one sentence.
    pub why: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl From<String> for Misfit {
    fn from(why: String) -> Self {
        Self { why, help: None }
    }
}

impl Misfit {
    pub(crate) fn with_help(why: String, help: impl Into<String>) -> Self {
        Self { why, help: Some(help.into()) }
    }
}

/// How a printed frame fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failure {
    /// Its identifier has the wrong width or a wrong fixed bit, or does not show its direction.
    Identifier,
    /// Its identifier belongs to another device.
    Foreign,
    /// It has another number of data bytes.
    Length,
    /// No message has its constants.
    UnknownMessage,
    /// It decodes as another message.
    Message,
    /// It decodes to other values.
    Values,
    /// It shows an addressing mode that the message does not have, or none.
    Addressing,
}

impl Failure {
    /// Every failure with its word of the spec language.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::Identifier, "identifier"),
        (Self::Foreign, "foreign"),
        (Self::Length, "length"),
        (Self::UnknownMessage, "unknown_message"),
        (Self::Message, "message"),
        (Self::Values, "values"),
        (Self::Addressing, "addressing"),
    ];

    /// Returns the word of the spec language.
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(failure, _)| *failure == self).map_or("", |(_, name)| name)
    }
}

/// Bytes of a type, and their value.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ValueExample {
    /// What the spec says beside it.
    pub doc: Doc,
    /// The type as a signal at the first byte.
    pub signal: Signal,
    /// The bytes, followed by zeros.
    pub data: [u8; 8],
    /// The value of the bytes.
    pub meaning: Meaning,
}
