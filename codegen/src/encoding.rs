//! Turns bits into values and back. Each encoding has a [`Room`], and [`Words::with`] is the door
//! to all of them.
//!
//! The interpreter, the stages that read values in a spec, and the command use it. A new encoding
//! is a file in this folder and an arm in [`Words::with`].

mod allowed;
mod by_model;
pub mod escape;
mod float;
mod named;
mod number;
mod packed;
mod quantity;
mod status;
mod text;

pub use allowed::Allowed;
use text::Text;

use crate::model::{
    DeviceModel, Encoding, Enumeration, EnumerationId, Misfit, ModelId, NoteRule, Protocol, Said, Signal, StatusWord,
    StatusWordId, Table,
};
use crate::words::hex;
use crate::words::number::Rational;

/// A physical value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number without a name, one that is not finite, or a text that would not give the same
    /// bytes.
    None,
    /// An unscaled number.
    Integer(i128),
    /// A scaled or floating-point number.
    Number(f64),
    /// The name of a named value.
    Name(String),
    /// A text, packed or in ASCII.
    Text(String),
    /// The set bits of a status word.
    Status {
        /// Set bits that have a name.
        set: u64,
        /// Set bits without a name.
        unknown: u64,
    },
}

/// A value to send.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// The raw value: sign-extended if the signal is signed, or the bit pattern.
    Raw(i128),
    /// An unscaled number, or a whole number that must still be scaled.
    Integer(i128),
    /// A physical value.
    Number(f64),
    /// A name, or a text.
    Text(String),
    /// The bytes of a text. Another text beside them counts alone.
    Bytes {
        /// The bytes, with those that fill the text up.
        bytes: Vec<u8>,
        /// The text, if it is given too.
        text: Option<String>,
    },
    /// The set bits of a status word.
    Status {
        /// Names of the set bits.
        set: Vec<String>,
        /// Set bits without a name.
        unknown: u64,
    },
}

impl Input {
    /// Says what the value is, and that something else is wanted.
    fn is_not(&self, wanted: &str) -> String {
        let what = match self {
            Self::Raw(raw) => format!("raw {raw}"),
            Self::Integer(value) => value.to_string(),
            Self::Number(value) => value.to_string(),
            Self::Text(text) | Self::Bytes { text: Some(text), .. } => format!("the text `{}`", escape::written(text)),
            Self::Bytes { bytes, text: None } => format!("raw 0x{}", hex::digits(bytes)),
            Self::Status { .. } => "a set of bits".to_owned(),
        };
        format!("{what} is not {wanted}")
    }
}

/// The questions that every encoding answers about a signal.
pub trait Room {
    /// Returns the physical value of raw bits.
    fn value(&self, bits: u64) -> Value;

    /// Returns the raw bits of a value to send, or says what the value must be.
    fn raw(&self, input: &Input, allowed: &Allowed) -> Result<u64, String>;

    /// Returns the raw bits of a value as a spec writes it, with its unit if `unit` says so.
    fn parse(&self, text: &str, unit: bool) -> Result<u64, Misfit>;

    /// Reads a value as a person types it, or says why it is none.
    fn typed(&self, text: &str) -> Result<Input, String> {
        Ok(Input::Text(text.to_owned()))
    }

    /// Returns what is odd about bits and their value, apart from the range.
    fn oddity(&self, bits: u64, value: &Value) -> Option<(NoteRule, String)>;
}

/// The tables that encodings refer to.
#[derive(Clone, Copy)]
pub struct Words<'a> {
    pub enumerations: &'a Table<EnumerationId, Enumeration>,
    pub statuses: &'a Table<StatusWordId, StatusWord>,
    pub models: &'a Table<ModelId, DeviceModel>,
}

impl<'a> From<&'a Protocol> for Words<'a> {
    fn from(protocol: &'a Protocol) -> Self {
        Self { enumerations: &protocol.enumerations, statuses: &protocol.status_words, models: &protocol.models }
    }
}

impl Words<'_> {
    /// Calls `ask` with the room of a signal's encoding.
    pub fn with<R>(self, signal: &Signal, ask: impl FnOnce(&dyn Room) -> R) -> R {
        match &signal.encoding {
            Encoding::Number { numeral, scale, offset } => {
                ask(&number::Number { signal, numeral: *numeral, scale: *scale, offset: *offset })
            }
            Encoding::ByModel { signals: own, .. } => ask(&by_model::ByModel { signal, own, models: self.models }),
            Encoding::Float => ask(&float::Float { signal }),
            Encoding::Named(id) => ask(&named::Named { signal, known: &self.enumerations[*id] }),
            Encoding::Status(id) => ask(&status::Status { signal, word: &self.statuses[*id] }),
            Encoding::Text(form) => ask(&Text { signal, form: *form }),
            Encoding::Packed { pieces, parts } => ask(&packed::Packed { signal, pieces, parts }),
        }
    }
}

/// Reads what an example says about a signal: a value, or a rounded number after `~`.
pub fn said(words: Words, signal: &Signal, text: &str) -> Result<Said, Misfit> {
    if let Some(known) = Text::of(signal).filter(|_| signal.run.is_some()) {
        let bytes = known.bytes(&escape::read(text)?)?;
        return Ok(Said::Text(known.form.text(&bytes).unwrap_or_default()));
    }
    let is_number = signal.encoding.linear().is_some() || signal.encoding.is_single();
    match text.strip_prefix('~').filter(|_| is_number) {
        Some(number) => quantity::rounded(signal, number).map(Said::Rounded),
        None => words.with(signal, |room| room.parse(text, true)).map(Said::Bits),
    }
}

/// Returns the value of a text's bytes.
pub fn value_of_bytes(signal: &Signal, bytes: &[u8]) -> Value {
    Text::of(signal).and_then(|known| known.form.text(bytes)).map_or(Value::None, Value::Text)
}

/// Returns the bytes of a text to send, or says what the text must be.
pub fn bytes_of(signal: &Signal, input: &Input) -> Result<Vec<u8>, String> {
    let known = Text::of(signal).ok_or_else(|| input.is_not("a value of this signal"))?;
    match input {
        Input::Text(text) => known.bytes(text),
        Input::Bytes { bytes, text } => known.given(bytes, text.as_deref()),
        Input::Raw(_) | Input::Integer(_) | Input::Number(_) | Input::Status { .. } => Err(input.is_not("a text")),
    }
}

/// Returns the bits of a raw value, unless the signal is too narrow for it.
fn bits(signal: &Signal, raw: i128) -> Result<u64, String> {
    signal.bits_of(raw).ok_or_else(|| {
        let (width, (first, last)) = (signal.place.width(), signal.raw_limits());
        format!("raw {raw} does not fit {width} bits, which hold {first}..{last}")
    })
}

/// Returns the raw bits of a number in a spec.
fn bits_of_spec(signal: &Signal, raw: i128) -> Result<u64, Misfit> {
    signal.bits_of(raw).ok_or_else(|| {
        let why = format!("the raw value {raw} does not fit the {} bits of `{}`", signal.place.width(), signal.name);
        let is_below = raw < 0 && !signal.encoding.numeral().is_signed();
        let below = is_below.then_some("numbers below 0 need `as: signed` or an `offset`");
        Misfit { why, help: about_offset(signal).or(below).map(str::to_owned) }
    })
}

/// Says how an offset counts, which many write in raw steps.
pub fn about_offset(signal: &Signal) -> Option<&'static str> {
    let linear = signal.encoding.linear().filter(|linear| linear.offset != Rational::ZERO);
    linear.map(|_| "the offset is physical: value = raw x scale + offset")
}
