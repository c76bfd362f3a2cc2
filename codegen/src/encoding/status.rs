//! Words whose bits are conditions.

use super::{Allowed, Input, Room, Value, bits};
use crate::model::{Misfit, NoteRule, Signal, StatusWord};

pub struct Status<'a> {
    pub signal: &'a Signal,
    pub word: &'a StatusWord,
}

impl Room for Status<'_> {
    fn value(&self, bits: u64) -> Value {
        let known = self.word.known();
        Value::Status { set: bits & known, unknown: bits & !known }
    }

    fn raw(&self, input: &Input, _: &Allowed) -> Result<u64, String> {
        match input {
            Input::Raw(raw) => bits(self.signal, *raw),
            Input::Status { set, unknown } => {
                let named = self.named(set)?;
                let misnamed = unknown & self.word.known();
                if misnamed != 0 {
                    return Err(format!("`unknown` has bits {misnamed:#X} that have a name"));
                }
                bits(self.signal, (named | unknown).into())
            }
            Input::Integer(_) | Input::Number(_) | Input::Text(_) | Input::Bytes { .. } => {
                Err(input.is_not("a set of bits"))
            }
        }
    }

    fn parse(&self, _: &str, _: bool) -> Result<u64, Misfit> {
        Err(format!(
            "`{}` is a status word; write the names of its set bits as a list, which is `[]` if none is set",
            self.signal.name
        )
        .into())
    }

    /// Reads `[fan_fault]`.
    fn typed(&self, text: &str) -> Result<Input, String> {
        let names = text.trim_start_matches('[').trim_end_matches(']').split(',').map(str::trim);
        let set = names.filter(|name| !name.is_empty()).map(str::to_owned).collect();
        Ok(Input::Status { set, unknown: 0 })
    }

    fn oddity(&self, _: u64, value: &Value) -> Option<(NoteRule, String)> {
        let Value::Status { unknown: unknown @ 1.., .. } = value else { return None };
        if self.word.bits.is_empty() {
            return None;
        }
        let text = || format!("{} has bits {unknown:#X} set that have no name", self.signal.name);
        Some((NoteRule::UnknownBit, text()))
    }
}

impl Status<'_> {
    /// Returns the raw bits that have these names.
    fn named(&self, names: &[String]) -> Result<u64, String> {
        names.iter().try_fold(0, |bits, name| {
            let bit = self.word.bits.iter().find(|bit| bit.name == *name);
            bit.map(|bit| bits | 1 << bit.bit).ok_or_else(|| format!("`{}` has no bit `{name}`", self.word.name))
        })
    }
}
