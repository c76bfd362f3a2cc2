#![doc = include_str!("../../docs/rules/no_match.md")]

use crate::model::{AddressPattern, FrameLayout, IdentifierField, Message, Mode, Protocol, Way};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    NO_MATCH "no_match" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let mut open = protocol.frames_of(message).filter(|frame| frame.constants.is_empty());
        if let Some((mode, field)) = open.find_map(|frame| taken(protocol, frame)) {
            diagnostics.push(report(message, mode, field));
        }
    }
}

/// Finds a mode whose frames are taken for such a frame, and a field that tells them apart.
fn taken<'a>(protocol: &'a Protocol, frame: &FrameLayout) -> Option<(&'a Mode, &'a IdentifierField)> {
    let own: Vec<_> = protocol.patterns_of(frame).map(|(_, pattern)| pattern).collect();
    let is_other = |way: &Way| {
        way.is_to_module() == frame.is_to_module() && frame.travels.iter().all(|travel| travel.mode != way.mode)
    };
    let others = Way::all(&protocol.modes).filter(|(way, _)| is_other(way));
    let mut others = others.filter(|(way, _)| !is_claimed(protocol, frame, *way));
    others.find_map(|(way, other)| {
        let tells = |field: &&IdentifierField| own.iter().all(|pattern| differ(pattern, other, field.mask()));
        Some((&protocol[way.mode], protocol.identifier.fields.iter().find(tells)?))
    })
}

/// Tests whether another message takes every frame of that way.
fn is_claimed(protocol: &Protocol, frame: &FrameLayout, way: Way) -> bool {
    protocol.frames.iter().any(|other| {
        let has_lengths = frame.lengths.iter().all(|length| other.lengths.contains(length));
        other.constants.is_empty() && has_lengths && way.has(other)
    })
}

/// Tests whether two patterns have different constants in a field.
fn differ(one: &AddressPattern, other: &AddressPattern, field: u32) -> bool {
    one.mask & other.mask & field == field && (one.value ^ other.value) & field != 0
}

fn report(message: &Message, mode: &Mode, field: &IdentifierField) -> Diagnostic {
    let text = format!(
        "nothing but its length chooses `{}`, so other frames of the mode `{}` are read as it",
        message.name, mode.name
    );
    let help = format!("name `{}` in its `match`", field.name);
    Diagnostic::warning(&NO_MATCH, message.doc.path.at_key(), text).help(help)
}
