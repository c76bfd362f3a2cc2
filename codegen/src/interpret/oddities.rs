//! What a value has that its document does not expect.

use std::fmt::Display;

use super::{Note, Reading, Value};
use crate::encoding::Words;
use crate::model::{Message, ModelId, NoteRule, Protocol, Range, Signal};

/// Notes a value that is odd, or that the device model does not have. `shortest` is the least number of data bytes that
/// carry the message.
pub fn signal_note(
    protocol: &Protocol,
    (message, shortest): (&Message, usize),
    model: Option<ModelId>,
    reading: &Reading,
) -> Option<Note> {
    let signal = message[reading.signal].on(model);
    let lack = |model| reading.words(signal).find_map(|bits| protocol.lack(message, signal, model, bits));
    if let Some(text) = model.and_then(lack) {
        return Some(Note { rule: NoteRule::ModelDependent, text });
    }
    if let Some(model) = model.filter(|model| !signal.is_of(*model)) {
        let is_longer = reading.reach(signal) > shortest;
        return is_longer.then(|| longer_note(protocol, signal, model));
    }
    let oddity = Words::from(protocol).with(signal, |room| room.oddity(reading.bits, &reading.value));
    if let Some((rule, text)) = oddity {
        return Some(Note { rule, text });
    }
    match &reading.value {
        Value::Integer(value) => range_note(signal, model, value, |range| range.has_whole(*value)),
        Value::Number(value) => range_note(signal, model, value, |range| signal.is_within(range, *value)),
        Value::None | Value::Name(_) | Value::Text(_) | Value::Status { .. } => None,
    }
}

/// Says that a message is long enough for a signal that the device model does not have.
fn longer_note(protocol: &Protocol, signal: &Signal, model: ModelId) -> Note {
    let text = format!("{} has no `{}`, for which the message is long enough", protocol[model].name, signal.name);
    Note { rule: NoteRule::ModelDependent, text }
}

fn range_note(
    signal: &Signal,
    model: Option<ModelId>,
    shown: impl Display,
    is_inside: impl FnOnce(&Range) -> bool,
) -> Option<Note> {
    let range = signal.range_for(model).filter(|range| !is_inside(range))?;
    let unit = signal.unit_text();
    let text = format!("{} {shown}{unit} is outside {}..{}{unit}", signal.name, range.minimum, range.maximum);
    Some(Note { rule: NoteRule::OutOfRange, text })
}
