#![doc = include_str!("../../docs/rules/default_value.md")]

use crate::encoding::{Value, Words};
use crate::model::{Message, ModelId, Protocol, Range, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    DEFAULT_VALUE "default_value" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in protocol.contents() {
        for signal in &message.signals {
            check_for(protocol, None, message, signal, diagnostics);
            protocol.models.ids().for_each(|model| check_for(protocol, Some(model), message, signal, diagnostics));
        }
    }
}

/// Tests the default for a device model, or the default if no model is chosen.
fn check_for(
    protocol: &Protocol,
    model: Option<ModelId>,
    message: &Message,
    signal: &Signal,
    diagnostics: &mut Diagnostics,
) {
    let signal = signal.on(model);
    let (Some(range), Some(raw)) = (signal.range_for(model), signal.default_for(model)) else { return };
    let Some(value) = outside(protocol, signal, &range, raw) else { return };
    let text = format!(
        "the default {value} of `{}.{}` lies outside its range {}..{}",
        message.name, signal.name, range.minimum, range.maximum
    );
    let own = signal.model_defaults.iter().find(|own| Some(own.model) == model);
    let at = own.map_or(&signal.default_path, |own| &own.path).at_value();
    let help = "correct the default or the range";
    diagnostics.push_first(Diagnostic::error(&DEFAULT_VALUE, at, text).help(help));
}

/// Returns a number that lies outside a range. Named values and texts have no range.
fn outside(protocol: &Protocol, signal: &Signal, range: &Range, raw: i128) -> Option<String> {
    let bits = signal.bits_of(raw)?;
    match Words::from(protocol).with(signal, |room| room.value(bits)) {
        Value::Integer(value) => (!range.has_whole(value)).then(|| value.to_string()),
        Value::Number(value) => (!signal.is_within(range, value)).then(|| value.to_string()),
        Value::None | Value::Name(_) | Value::Text(_) | Value::Status { .. } => None,
    }
}
