//! ASCII in whole bytes, filled up with NUL or another byte.

use super::{Allowed, Input, Room, Value, bits};
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
        Ok(self.bits(text)?)
    }

    fn oddity(&self, _: u64, value: &Value) -> Option<(NoteRule, String)> {
        formless(self.signal, value)
    }

    fn description(&self) -> Vec<String> {
        let TextForm::Ascii { fill } = self.form;
        let filled = if fill == 0 { String::new() } else { format!(", filled with {fill:#04X}") };
        vec![format!("text of {} characters{filled}", self.length())]
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
        let bytes = self.length();
        let printable = text.bytes().all(|byte| byte == b' ' || byte.is_ascii_graphic());
        if !printable || text.len() > bytes {
            let name = &self.signal.name;
            return Err(format!("`{text}` is not a text of at most {bytes} printable ASCII characters for `{name}`"));
        }
        let TextForm::Ascii { fill } = self.form;
        let filled = text.bytes().chain(std::iter::repeat_n(fill, bytes - text.len()));
        Ok(filled.fold(0, |bits, byte| bits << 8 | u64::from(byte)))
    }

    /// Returns the text of raw bits, without what it is filled with. It is `None` if the text
    /// would not give the same bits.
    pub fn text(&self, bits: u64) -> Option<String> {
        let bytes = bits.to_be_bytes();
        let bytes = &bytes[8 - self.length()..];
        let TextForm::Ascii { fill } = self.form;
        let length = bytes.iter().rposition(|byte| *byte != fill).map_or(0, |last| last + 1);
        let text = std::str::from_utf8(&bytes[..length]).ok()?;
        (self.bits(text) == Ok(bits)).then(|| text.to_owned())
    }
}
