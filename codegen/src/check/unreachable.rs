#![doc = include_str!("../../docs/rules/unreachable.md")]

use super::ambiguous::{Ranges, accepted};
use crate::model::{AddressPattern, FieldId, Foreign, FrameLayout, IdentifierField, Message, Protocol, Table};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    UNREACHABLE "unreachable" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let frames: Vec<_> = protocol
            .layouts_of(message)
            .flat_map(|frame| protocol.patterns_of(frame).map(move |(_, pattern)| (frame, pattern)))
            .collect();
        if frames.is_empty() && message.set.is_none() {
            diagnostics.push(without_mode(message));
        }
        let mut owners = frames.iter().map(|(frame, pattern)| owner(protocol, frame, pattern));
        if let Some(Some(first)) = owners.next()
            && owners.all(|owner| owner.is_some())
        {
            diagnostics.push(claimed(message, first));
        }
    }
}

fn without_mode(message: &Message) -> Diagnostic {
    let text = format!("no frame is ever decoded as `{}`: no addressing mode is used with it", message.name);
    let help = "say in `answers` of its access in which addressing modes it is used, and who answers";
    Diagnostic::error(&UNREACHABLE, message.doc.path.key("access").at_key(), text).help(help)
}

fn claimed(message: &Message, foreign: &Foreign) -> Diagnostic {
    let text = format!("no frame is ever decoded as `{}`: all frames that it could have are foreign", message.name);
    let help = "correct the constants of the message, or narrow the foreign identifiers";
    let diagnostic = Diagnostic::error(&UNREACHABLE, message.doc.path.at_key(), text).help(help);
    diagnostic.other(foreign.doc.path.key("match").at_key(), "this takes them first")
}

/// Finds the foreign identifiers that claim all frames of a kind in an addressing pattern.
fn owner<'a>(protocol: &'a Protocol, frame: &FrameLayout, pattern: &AddressPattern) -> Option<&'a Foreign> {
    let fields = protocol.identifier.fields.entries();
    let values: Table<FieldId, _> = fields.map(|field| values(protocol, frame, pattern, field)).collect();
    protocol.foreign.iter().find(|foreign| {
        foreign.ranges.iter().all(|(field, first, last)| {
            let ranges = field.map_or_else(|| vec![whole(protocol, &values)], |field| values[field].clone());
            ranges.iter().all(|(low, high)| first <= low && high <= last)
        })
    })
}

/// Returns the values that a field of the identifier can have.
fn values(
    protocol: &Protocol,
    frame: &FrameLayout,
    pattern: &AddressPattern,
    (id, field): (FieldId, &IdentifierField),
) -> Ranges {
    let chosen = frame.identifier().find(|(field, _)| *field == id).map(|(_, value)| value);
    match field.constant.or(chosen) {
        Some(value) => vec![(value, value)],
        None => accepted(protocol, pattern, id),
    }
}

/// Returns the least and the greatest identifier.
fn whole(protocol: &Protocol, values: &Table<FieldId, Ranges>) -> (u32, u32) {
    let fixed = protocol.identifier.value;
    let fields = protocol.identifier.fields.iter().zip(values);
    fields.fold((fixed, fixed), |(low, high), (field, ranges)| {
        let least = ranges.iter().map(|range| range.0).min().unwrap_or(0);
        let greatest = ranges.iter().map(|range| range.1).max().unwrap_or(0);
        (low | least << field.shift, high | greatest << field.shift)
    })
}
