//! Values of signals: as Rust writes them, and as generated code shows them.

use proc_macro2::TokenStream;

use crate::emit::Scaled;
use crate::emit::rust::manual::Manual;
use crate::emit::rust::plan;
use crate::interpret::{Value, escape};
use crate::model::{Encoding, Id, Signal};

/// Writes the value of a struct's field; `None` of one that has no short literal.
pub fn literal(manual: &Manual, planned: &plan::signal::Signal, signal: &Signal, bits: u64) -> Option<String> {
    let raw = signal.raw_of(bits);
    if signal.absent().is_some_and(|absent| absent.raw == raw) {
        return Some("None".to_owned());
    }
    match signal.encoding {
        Encoding::Number { .. } | Encoding::ByModel { .. } => Some(squeezed(&planned.coding.value_of(signal, raw))),
        Encoding::Float => Some(format!("{:?}", f32::from_bits(u32::try_from(bits).ok()?))),
        Encoding::Named(id) => {
            let place = manual.protocol[id].values.iter().position(|value| value.raw == raw)?;
            let known = manual.plan.enumerations.get(id.place())?;
            Some(format!("{}::{}", known.name, known.values.get(place)?.variant))
        }
        Encoding::Status(_) | Encoding::Text(_) | Encoding::Packed { .. } => None,
    }
}

/// Writes tokens of a literal or of a call without blanks.
pub fn squeezed(tokens: &TokenStream) -> String {
    tokens.to_string().replace(' ', "")
}

/// Writes a value with its unit as generated code shows it; `None` where the signal has none.
pub fn shown(manual: &Manual, signal: &Signal, value: &Value) -> Option<String> {
    let unit = signal.unit_text();
    match value {
        Value::None => None,
        Value::Integer(value) => Some(format!("{value}{unit}")),
        Value::Number(value) => Some(format!("{}{unit}", number(*value, manual.scaled, signal))),
        Value::Name(text) | Value::Text(text) => Some(escape::written(text)),
        Value::Status { set, unknown } => {
            let word = &manual.protocol[signal.encoding.status_word()?];
            let names = word.bits.iter().filter(|bit| set >> bit.bit & 1 == 1).map(|bit| bit.name.clone());
            let unknown = (*unknown != 0).then(|| format!("{unknown:#X}"));
            Some(format!("{{{}}}", names.chain(unknown).collect::<Vec<_>>().join(", ")))
        }
    }
}

/// Writes a number in the precision that it is calculated in.
#[expect(clippy::cast_possible_truncation, reason = "the nearest single is what is shown")]
fn number(value: f64, scaled: Scaled, signal: &Signal) -> String {
    match scaled {
        Scaled::F32 if !signal.encoding.is_single() => (value as f32).to_string(),
        Scaled::F32 | Scaled::F64 | Scaled::Steps => value.to_string(),
    }
}
