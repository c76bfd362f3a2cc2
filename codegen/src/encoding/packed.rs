//! One text that is made of several parts.

use super::text::{Text, formless};
use super::{Allowed, Input, Room, Value, bits, escape};
use crate::model::{Misfit, NoteRule, PartId, Piece, Signal, Table};

pub struct Packed<'a> {
    pub signal: &'a Signal,
    pub pieces: &'a [Piece],
    pub parts: &'a Table<PartId, Signal>,
}

impl Room for Packed<'_> {
    fn value(&self, bits: u64) -> Value {
        self.text(bits).map_or(Value::None, Value::Text)
    }

    fn raw(&self, input: &Input, _: &Allowed) -> Result<u64, String> {
        match input {
            Input::Raw(raw) => bits(self.signal, *raw),
            Input::Text(text) => {
                self.bits(text).ok_or_else(|| format!("`{}` is not of the documented form", escape::written(text)))
            }
            Input::Integer(_) | Input::Number(_) | Input::Bytes { .. } | Input::Status { .. } => {
                Err(input.is_not("a text"))
            }
        }
    }

    fn parse(&self, text: &str, _: bool) -> Result<u64, Misfit> {
        let bits = self.bits(&escape::read(text)?);
        bits.ok_or_else(|| format!("`{text}` is not of the form of `{}`", self.signal.name).into())
    }

    fn typed(&self, text: &str) -> Result<Input, String> {
        escape::read(text).map(Input::Text)
    }

    fn oddity(&self, _: u64, value: &Value) -> Option<(NoteRule, String)> {
        formless(self.signal, value)
    }
}

impl Packed<'_> {
    /// Reads a text; `None` if it has another form or a part does not fit.
    fn bits(&self, text: &str) -> Option<u64> {
        let mut data = [0; 8];
        let mut rest = text;
        for (index, piece) in self.pieces.iter().enumerate() {
            match piece {
                Piece::Literal(literal) => rest = rest.strip_prefix(literal.as_str())?,
                Piece::Part { part, digits } => {
                    let part = &self.parts[*part];
                    let is_last = index + 1 == self.pieces.len();
                    let (piece, after) = rest.split_at_checked(length(part, *digits, rest, is_last))?;
                    part.place.put(&mut data, bits_of_part(part, piece)?);
                    rest = after;
                }
            }
        }
        rest.is_empty().then(|| self.signal.place.get(&data))
    }

    /// Writes a text; `None` if it would not give the same bits.
    fn text(&self, bits: u64) -> Option<String> {
        let mut data = [0; 8];
        self.signal.place.put(&mut data, bits);
        let texts = self.pieces.iter().map(|piece| self.piece(piece, data));
        let text = texts.collect::<Option<String>>()?;
        (self.bits(&text) == Some(bits)).then_some(text)
    }

    fn piece(&self, piece: &Piece, data: [u8; 8]) -> Option<String> {
        match piece {
            Piece::Literal(literal) => Some(literal.clone()),
            Piece::Part { part, digits } => {
                let part = &self.parts[*part];
                let raw = part.place.get(&data);
                if let Some(text) = Text::of(part) {
                    return text.text(raw);
                }
                let number = part.encoding.numeral().integer(raw.into())?;
                Some(format!("{number:0width$}", width = digits.unwrap_or(1)))
            }
        }
    }
}

/// Returns how many bytes of the rest of a text belong to a part.
fn length(part: &Signal, digits: Option<usize>, rest: &str, is_last: bool) -> usize {
    if let Some(text) = Text::of(part) {
        return text.lengths()[1];
    }
    match digits {
        Some(digits) => digits,
        None if is_last => rest.len(),
        None => rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len()),
    }
}

fn bits_of_part(part: &Signal, text: &str) -> Option<u64> {
    if let Some(part) = Text::of(part) {
        return part.bits(text).ok();
    }
    let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let number: i128 = digits.then(|| text.parse().ok()).flatten()?;
    let is_in_range = part.range.is_none_or(|range| range.has_whole(number));
    is_in_range.then(|| part.bits_of(part.encoding.numeral().raw(number)?)).flatten()
}
