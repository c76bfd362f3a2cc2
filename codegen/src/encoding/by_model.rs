//! Numbers whose scale depends on the device model. Without a model they have only their raw value.

use super::{Allowed, Input, Room, Value, bits, bits_of_spec};
use crate::model::{DeviceModel, Misfit, ModelId, NamedValue, NoteRule, OfModel, Signal, Table};
use crate::words::number::Rational;

pub struct ByModel<'a> {
    pub signal: &'a Signal,
    /// The signal on each device model.
    pub own: &'a [OfModel<Signal>],
    pub models: &'a Table<ModelId, DeviceModel>,
}

impl Room for ByModel<'_> {
    fn value(&self, bits: u64) -> Value {
        let raw = self.signal.raw_of(bits);
        let special = self.signal.specials.iter().find(|special| special.raw == raw);
        special.map_or(Value::None, |special| Value::Name(special.name.clone()))
    }

    fn raw(&self, input: &Input, allowed: &Allowed) -> Result<u64, String> {
        match input {
            Input::Raw(raw) => {
                if self.signal.specials.iter().all(|special| special.raw != *raw) {
                    allowed.check_whole(self.signal, *raw)?;
                }
                bits(self.signal, *raw)
            }
            Input::Text(name) if let Some(special) = self.special(name) => bits(self.signal, special.raw),
            Input::Integer(_) | Input::Number(_) | Input::Text(_) | Input::Bytes { .. } | Input::Status { .. } => {
                Err(format!("its scale depends on the device model; choose {}", self.names(" or ")))
            }
        }
    }

    fn parse(&self, text: &str, _: bool) -> Result<u64, Misfit> {
        let raw = self.special(text).map(|special| special.raw);
        let raw = raw.or_else(|| Rational::parse(text).and_then(Rational::to_integer));
        let raw = raw.ok_or_else(|| {
            let why = format!("the scale of `{}` depends on the device model", self.signal.name);
            Misfit::with_help(why, format!("name the model: {}; or write the raw number", self.names(" or ")))
        })?;
        bits_of_spec(self.signal, raw)
    }

    fn oddity(&self, bits: u64, value: &Value) -> Option<(NoteRule, String)> {
        let (name, raw) = (&self.signal.name, self.signal.raw_of(bits));
        let text = || format!("the scale of {name} (raw {raw}) is known of {}", self.names(" and "));
        (*value == Value::None).then(|| (NoteRule::ModelDependent, text()))
    }
}

impl ByModel<'_> {
    fn special(&self, name: &str) -> Option<&NamedValue> {
        self.signal.specials.iter().find(|special| special.name == name)
    }

    /// Names the device models that have a scale.
    fn names(&self, between: &str) -> String {
        let names: Vec<_> = self.own.iter().map(|own| self.models[own.model].name.as_str()).collect();
        match names.split_last() {
            Some((last, others)) if !others.is_empty() => format!("{}{between}{last}", others.join(", ")),
            _ => names.concat(),
        }
    }
}
