//! Whole bytes as a text: ASCII that is filled up with NUL or another byte, or hexadecimal digits.

use super::{Allowed, Input, Room, Value, bits, escape};
use crate::hex;
use crate::model::{Misfit, NoteRule, Signal, TextForm};

pub struct Text<'a> {
    pub signal: &'a Signal,
    pub form: TextForm,
}

impl Room for Text<'_> {
    fn value(&self, bits: u64) -> Value {
        self.text(bits).map_or(Value::None, Value::Text)
    }

    fn raw(&self, input: &Input, _: &Allowed) -> Result<u64, String> {
        match input {
            Input::Raw(raw) => bits(self.signal, *raw),
            Input::Text(text) => self.bits(text),
            Input::Integer(_) | Input::Number(_) | Input::Status { .. } => Err(input.is_not("a text")),
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

    fn description(&self) -> Vec<String> {
        let length = self.length();
        match self.form {
            TextForm::Ascii { fill: 0 } => vec![format!("text of {length} characters")],
            TextForm::Ascii { fill } => vec![format!("text of {length} characters, filled with {fill:#04X}")],
            TextForm::Hexadecimal => vec![format!("{length} bytes in hexadecimal")],
        }
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

    /// Returns how many characters fit.
    pub fn length(&self) -> usize {
        usize::from(self.signal.place.width() / 8)
    }

    /// Returns the bits of a text.
    ///
    /// # Errors
    ///
    /// Says how long the text may be.
    pub fn bits(&self, text: &str) -> Result<u64, String> {
        let (count, name) = (self.length(), &self.signal.name);
        let bytes = match self.form {
            TextForm::Ascii { fill } => filled(text, count, fill).ok_or_else(|| {
                format!(
                    "`{}` is not a text of at most {count} ASCII characters without NUL for `{name}`",
                    escape::written(text)
                )
            }),
            TextForm::Hexadecimal => hex::bytes(text).filter(|bytes| bytes.len() == count).ok_or_else(|| {
                let text = escape::written(text);
                format!("`{text}` is not {count} bytes of two hexadecimal digits each for `{name}`")
            }),
        };
        Ok(bytes?.into_iter().fold(0, |bits, byte| bits << 8 | u64::from(byte)))
    }

    /// Returns the text of raw bits. It is `None` if the text would not give the same bits.
    pub fn text(&self, bits: u64) -> Option<String> {
        let bytes = &bits.to_be_bytes()[8 - self.length()..];
        match self.form {
            TextForm::Ascii { fill } => {
                let length = bytes.iter().rposition(|byte| *byte != fill).map_or(0, |last| last + 1);
                let text = std::str::from_utf8(&bytes[..length]).ok()?;
                text.bytes().all(is_character).then(|| text.to_owned())
            }
            TextForm::Hexadecimal => Some(hex::digits(bytes)),
        }
    }
}

/// Returns the bytes of a text of ASCII characters, filled up to `count`.
fn filled(text: &str, count: usize, fill: u8) -> Option<Vec<u8>> {
    let missing = count.checked_sub(text.len()).filter(|_| text.bytes().all(is_character))?;
    Some(text.bytes().chain(std::iter::repeat_n(fill, missing)).collect())
}

/// Tests a byte for an ASCII character. NUL is none, since what stands behind it is seldom a part of a text.
fn is_character(byte: u8) -> bool {
    matches!(byte, 1..=0x7F)
}
