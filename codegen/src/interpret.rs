//! The interpreter: decodes and encodes by the model, at run time.

mod decode;
mod encode;
mod request;
mod value;

pub use decode::decode;
pub use encode::encode;
pub use request::{Target, parse_input, request};
pub use value::{physical, raw_of};

use std::fmt;

use crate::model::{Kind, Protocol};

/// A frame as it stood on the bus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    pub id: u32,
    /// 29-bit identifier rather than 11-bit.
    pub extended: bool,
    /// Data bytes, at most 8.
    pub data: Vec<u8>,
    pub form: Form,
}

/// What sort of frame it is; only data frames are ever recognised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Data,
    Remote,
    Error,
    /// CAN FD.
    Fd,
}

/// A recognised frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// Index into [`Protocol::messages`].
    pub message: usize,
    /// Index into [`Protocol::accesses`].
    pub access: usize,
    pub kind: Kind,
    /// Index into [`Protocol::modes`], if one fits.
    pub addressing: Option<usize>,
    /// Values of [`crate::model::Identifier::fields`], in order.
    pub identifier: Vec<u32>,
    /// Payload selectors: index into [`Protocol::selectors`] and raw value.
    pub selectors: Vec<(usize, u64)>,
    pub signals: Vec<Reading>,
    /// Set bits of the data bytes that nothing covers, first byte first.
    pub reserved: [u8; 8],
    /// Data bytes of the frame.
    pub length: usize,
    pub notes: Vec<Note>,
}

/// What a frame says of one signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Index into the message's signals.
    pub signal: usize,
    /// The bits, as the low bits of a number; not sign-extended.
    pub bits: u64,
    pub value: Value,
}

/// A physical value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Unnamed, not finite, or a text that would not give the same bytes.
    None,
    /// An unscaled number.
    Integer(i128),
    /// A scaled or floating-point number.
    Number(f64),
    /// The name of a named value.
    Name(String),
    Text(String),
    /// Bit numbers that are set and have a name, and the set bits without one.
    Status { set: Vec<u8>, unknown: u64 },
}

/// Something about a recognised frame that the document does not foresee.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// `error_code`, `reserved_bit`, `unknown_value`, `unknown_bit`, `address`, `addressing`, `access`, `out_of_range`, `not_finite`, `constant`.
    pub rule: &'static str,
    pub text: String,
}

/// A frame that is not recognised, as far as it could be split.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unrecognised {
    pub problem: Problem,
    pub text: String,
    /// Values of the identifier's fields, in order; empty if it was not split.
    pub identifier: Vec<u32>,
    /// Payload selectors: index into [`Protocol::selectors`] and raw value.
    pub selectors: Vec<(usize, u64)>,
}

/// Why a frame is not recognised, in the order of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// A remote, error or FD frame.
    Frame,
    Foreign,
    /// Width, a fixed bit, or a direction that cannot be known.
    Identifier,
    UnknownMessage,
    Length,
}

impl Problem {
    /// Returns the word of the output formats.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frame => "frame",
            Self::Foreign => "foreign",
            Self::Identifier => "identifier",
            Self::UnknownMessage => "unknown_message",
            Self::Length => "length",
        }
    }
}

/// What [`encode`] makes a frame of: the content of a decoded line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Content {
    pub message: String,
    pub access: Option<String>,
    pub kind: Option<Kind>,
    /// Named fields of the identifier and their raw values.
    pub identifier: Vec<(String, u64)>,
    pub selectors: Vec<(String, u64)>,
    pub signals: Vec<(String, Input)>,
    /// Bits to set beside the signals, first byte first.
    pub reserved: Vec<u8>,
}

/// A value to send.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// The raw value: sign-extended where the signal is signed, or the bit pattern.
    Raw(i128),
    Integer(i128),
    Number(f64),
    /// A name, or a text.
    Text(String),
    /// Names of the set bits, and set bits without a name.
    Status { set: Vec<String>, unknown: u64 },
}

/// Why a frame was not made; names message, signal, value, unit and limits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal(pub String);

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

/// Shows an address field as documents print it.
fn hexadecimal(value: u32) -> String {
    format!("0x{value:02X}")
}

/// Returns the name of a mode, for texts.
fn mode_name(protocol: &Protocol, mode: usize) -> &str {
    protocol.modes.get(mode).map_or("", |mode| mode.name.as_str())
}
