//! Finds a range that excludes a value which an example shows inside, or includes one shown
//! outside.
//!
//! The bytes and the meaning of such an example agree, so the range is probably wrong.

use super::shown;
use crate::interpret::{Decoded, Reading, Value};
use crate::model::{Example, MessageId, Protocol, Range, Signal};
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::tree::Path;
use crate::resolve::rules;

/// The range whose value is farthest outside, or nearest to one of its ends.
struct Limit<'a> {
    signal: &'a Signal,
    range: Range,
    at: Path,
    value: String,
    /// How far outside the value lies, as a fraction of the range. It is negative inside.
    beyond: f64,
}

/// Reports an example with a value outside a range that lacks the note, or with a note but no such
/// value. `place` is the example's.
pub fn report(protocol: &Protocol, example: &Example, decoded: &Decoded, place: At) -> Option<Diagnostic> {
    let readings = decoded.signals.iter().filter_map(|reading| limit(protocol, example, decoded.message, reading));
    let limit = readings.max_by(|one, other| one.beyond.total_cmp(&other.beyond))?;
    let Limit { signal, range, at, value, beyond } = limit;
    let unit = signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
    let range = format!("the range {}..{}{unit} of `{}`", range.minimum, range.maximum, signal.name);
    let (text, said, help) = if beyond > 0.0 {
        let help =
            "correct the range; if the document shows a value outside it, add `out_of_range` to the example's `notes`";
        (format!("{range} leaves out {value}, which an example shows"), "this frame has the note `out_of_range`", help)
    } else {
        let has_models = !signal.model_ranges.is_empty() && example.model.is_none();
        let help = if has_models {
            "name the device model whose range is smaller as `model` of the example, or correct the range"
        } else {
            "correct the range, or take `out_of_range` out of the example's `notes`"
        };
        (
            format!("{range} holds {value}, which an example shows outside it"),
            "this frame has no note `out_of_range`",
            help,
        )
    };
    Some(Diagnostic::error(&rules::EXAMPLE, at.at_value(), text).help(help).other(place, said))
}

fn limit<'a>(protocol: &'a Protocol, example: &Example, message: MessageId, reading: &Reading) -> Option<Limit<'a>> {
    let signal = protocol[message][reading.signal].on(example.model);
    let range = signal.range_for(example.model)?;
    let of_model = signal.model_ranges.iter().find(|own| Some(own.model) == example.model);
    let number = match reading.value {
        #[expect(clippy::cast_precision_loss, reason = "only compared with the ends")]
        Value::Integer(value) => value as f64,
        Value::Number(value) => value,
        Value::None | Value::Name(_) | Value::Text(_) | Value::Status { .. } => return None,
    };
    let (minimum, maximum) = (range.minimum.to_f64(), range.maximum.to_f64());
    let beyond = (minimum - number).max(number - maximum) / (maximum - minimum);
    let at = of_model.map_or(&signal.range_path, |own| &own.path).clone();
    Some(Limit { signal, range, at, value: shown(protocol, signal, reading), beyond })
}
