#![doc = include_str!("../rules/default_value.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Encoding, Message, ModelId, Protocol, Signal};
use crate::rule::rules;

rules! {
    DEFAULT_VALUE "default_value" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            check_for(None, message, signal, diagnostics);
            protocol.models.ids().for_each(|model| check_for(Some(model), message, signal, diagnostics));
        }
    }
}

/// Tests the default that holds for a device model, or where none is chosen.
fn check_for(model: Option<ModelId>, message: &Message, signal: &Signal, diagnostics: &mut Diagnostics) {
    if !matches!(signal.encoding, Encoding::Number { .. }) {
        return;
    }
    let (Some(range), Some(raw)) = (signal.range_for(model), signal.default_for(model)) else { return };
    let value = signal.encoding.value_of(raw);
    let special = signal.specials.iter().any(|special| special.raw == raw);
    if !special && value.is_none_or(|value| value < range.minimum || value > range.maximum) {
        let value = value.map_or_else(|| raw.to_string(), |value| value.to_string());
        let text = format!(
            "the default {value} of `{}.{}` lies outside its range {}..{}",
            message.name, signal.name, range.minimum, range.maximum
        );
        let own = signal.model_defaults.iter().find(|own| Some(own.model) == model);
        let at = own.map_or(&signal.default_path, |own| &own.path).at_value();
        let help = "correct the default or the range";
        diagnostics.push_first(Diagnostic::error(&DEFAULT_VALUE, at, text).help(help));
    }
}
