//! Whole bytes as a text: ASCII that is filled up with NUL or another byte, or hexadecimal digits.

use super::{Allowed, Input, Room, Value, bits, escape};
use crate::model::{Misfit, NoteRule, Signal, TextForm};
use crate::words::hex;

pub struct Text<'a> {
    pub signal: &'a Signal,
    pub form: TextForm,
}

impl Room for Text<'_> {
    fn value(&self, bits: u64) -> Value {
        super::value_of_bytes(self.signal, self.bytes_of(&bits.to_be_bytes()))
    }

    fn raw(&self, input: &Input, _: &Allowed) -> Result<u64, String> {
        if let Input::Raw(raw) = input {
            bits(self.signal, *raw)
        } else {
            Ok(joined(&super::bytes_of(self.signal, input)?))
        }
    }

    fn parse(&self, text: &str, _: bool) -> Result<u64, Misfit> {
        Ok(self.bits(&escape::read(text)?)?)
    }

    fn typed(&self, text: &str) -> Result<Input, String> {
        escape::read(text).map(Input::Text)
    }

    fn oddity(&self, _: u64, value: &Value) -> Option<(NoteRule, String)> {
        formless(self.signal, value)
    }
}

/// Says that bits are no text, if they are none.
pub fn formless(signal: &Signal, value: &Value) -> Option<(NoteRule, String)> {
    let text = || format!("{} is not a text of the documented form", signal.name);
    (*value == Value::None).then(|| (NoteRule::UnknownValue, text()))
}

impl<'a> Text<'a> {
    /// Returns the text that a signal is, if it is one.
    pub fn of(signal: &'a Signal) -> Option<Self> {
        signal.encoding.text_form().map(|form| Self { signal, form })
    }

    /// Returns the least and the greatest number of bytes.
    pub fn lengths(&self) -> [usize; 2] {
        let length = u16::from(self.signal.place.width() / 8);
        self.signal.run.map_or([length; 2], |run| [run.least, run.most]).map(usize::from)
    }

    /// Writes the number of bytes.
    fn count(&self) -> String {
        let [least, most] = self.lengths();
        if least == most { most.to_string() } else { format!("{least} to {most}") }
    }

    /// Returns the bytes of a text, as few as there may be.
    ///
    /// # Errors
    ///
    /// Says how long the text may be.
    pub fn bytes(&self, text: &str) -> Result<Vec<u8>, String> {
        let ([least, most], name) = (self.lengths(), &self.signal.name);
        match self.form {
            TextForm::Ascii { fill } => {
                let fits = text.len() <= most && text.bytes().all(is_character);
                let missing = least.saturating_sub(text.len());
                let bytes = || text.bytes().chain(std::iter::repeat_n(fill, missing)).collect();
                fits.then(bytes).ok_or_else(|| {
                    let text = escape::written(text);
                    format!("`{text}` is not a text of at most {most} ASCII characters without NUL for `{name}`")
                })
            }
            TextForm::Hexadecimal => {
                let bytes = hex::bytes(text).filter(|bytes| (least..=most).contains(&bytes.len()));
                bytes.ok_or_else(|| {
                    let (text, count) = (escape::written(text), self.count());
                    format!("`{text}` is not {count} bytes of two hexadecimal digits each for `{name}`")
                })
            }
        }
    }

    /// Returns the bytes that are given, unless the text beside them is another one.
    ///
    /// # Errors
    ///
    /// Says how many bytes there may be, or how long the text may be.
    pub fn given(&self, bytes: &[u8], text: Option<&str>) -> Result<Vec<u8>, String> {
        let [least, most] = self.lengths();
        let fits = (least..=most).contains(&bytes.len());
        match text {
            Some(text) if !fits || self.form.text(bytes).as_deref() != Some(text) => self.bytes(text),
            _ if fits => Ok(bytes.to_vec()),
            _ => Err(format!("raw 0x{} has {} bytes instead of {}", hex::digits(bytes), bytes.len(), self.count())),
        }
    }

    /// Returns the bits of a text.
    ///
    /// # Errors
    ///
    /// Says how long the text may be.
    pub fn bits(&self, text: &str) -> Result<u64, String> {
        Ok(joined(&self.bytes(text)?))
    }

    /// Returns those bytes of eight that a place has.
    fn bytes_of<'b>(&self, bytes: &'b [u8; 8]) -> &'b [u8] {
        &bytes[8 - usize::from(self.signal.place.width() / 8)..]
    }

    /// Returns the text of raw bits. It is `None` if the text would not give the same bits.
    pub fn text(&self, bits: u64) -> Option<String> {
        self.form.text(self.bytes_of(&bits.to_be_bytes()))
    }
}

impl TextForm {
    /// Returns the text of bytes, without those that fill it up. It is `None` for bytes that no text gives.
    pub fn text(self, bytes: &[u8]) -> Option<String> {
        match self {
            Self::Ascii { fill } => {
                let length = bytes.iter().rposition(|byte| *byte != fill).map_or(0, |last| last + 1);
                let text = std::str::from_utf8(&bytes[..length]).ok()?;
                text.bytes().all(is_character).then(|| text.to_owned())
            }
            Self::Hexadecimal => Some(hex::digits(bytes)),
        }
    }
}

/// Returns the number that bytes write, the first one highest.
fn joined(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0, |bits, byte| bits << 8 | u64::from(*byte))
}

/// Tests a byte for an ASCII character. NUL is none, since what stands behind it is seldom a part of a text.
fn is_character(byte: u8) -> bool {
    matches!(byte, 1..=0x7F)
}
