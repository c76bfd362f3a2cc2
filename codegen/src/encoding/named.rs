//! Values that have names and are no quantities.

use super::{Allowed, Input, Room, Value, bits, bits_of_spec};
use crate::model::{Enumeration, Misfit, NamedValue, NoteRule, Signal};
use crate::words::number::Rational;

pub struct Named<'a> {
    pub signal: &'a Signal,
    pub known: &'a Enumeration,
}

impl Room for Named<'_> {
    fn value(&self, bits: u64) -> Value {
        self.known.named(bits).map_or(Value::None, |value| Value::Name(value.name.clone()))
    }

    fn raw(&self, input: &Input, _: &Allowed) -> Result<u64, String> {
        match input {
            Input::Raw(raw) => bits(self.signal, *raw),
            Input::Text(name) => bits(self.signal, self.called(name).ok_or_else(|| self.unnamed(name))?.raw),
            Input::Integer(_) | Input::Number(_) | Input::Bytes { .. } | Input::Status { .. } => {
                Err(input.is_not("the name of a value"))
            }
        }
    }

    fn parse(&self, text: &str, _: bool) -> Result<u64, Misfit> {
        let named = self.called(text).map(|value| value.raw);
        let raw = named.or_else(|| Rational::parse(text).and_then(Rational::to_integer));
        bits_of_spec(self.signal, raw.ok_or_else(|| self.unnamed(text))?)
    }

    fn oddity(&self, bits: u64, value: &Value) -> Option<(NoteRule, String)> {
        let text = || format!("{} {bits:#X} has no name", self.signal.name);
        (*value == Value::None).then(|| (NoteRule::UnknownValue, text()))
    }
}

impl Named<'_> {
    fn called(&self, name: &str) -> Option<&NamedValue> {
        self.known.values.iter().find(|value| value.name == name)
    }

    /// Says which names a signal has. A number is no name, since people count states in different ways.
    fn unnamed(&self, text: &str) -> String {
        let raw = Rational::parse(text).and_then(Rational::to_integer);
        let meant = self.known.values.iter().find(|value| raw == Some(value.raw));
        if let Some(value) = meant {
            return format!("`{}` takes names, and {text} is `{}`", self.signal.name, value.name);
        }
        let names: Vec<_> = self.known.values.iter().map(|value| format!("`{}`", value.name)).collect();
        format!("`{}` has no value `{text}`; it has {}", self.signal.name, names.join(", "))
    }
}
