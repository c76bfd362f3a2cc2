#![doc = include_str!("../../docs/rules/shared_address.md")]

use std::collections::HashSet;

use crate::model::{Address, AddressPattern, FieldId, FrameLayout, Mode, ModeId, Protocol};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    SHARED_ADDRESS "shared_address" Check WARNING;
}

/// A mode, and what the identifier of its requests shows.
type Asked<'a> = (ModeId, &'a AddressPattern);

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let mut known = HashSet::new();
    // The standard of a transport says where its frames go.
    let is_own = |frame: &&FrameLayout| frame.is_to_module() && protocol.transport_frame(frame.message).is_none();
    for frame in protocol.frames.iter().filter(is_own) {
        let modes: Vec<Asked> = protocol.patterns_of(frame).collect();
        if !known.insert(modes.iter().map(|(mode, _)| *mode).collect::<Vec<_>>()) {
            continue;
        }
        for (place, one) in modes.iter().enumerate() {
            if let Some(found) = modes[place + 1..].iter().find_map(|other| shared(protocol, frame, *one, *other)) {
                diagnostics.push(found);
            }
        }
    }
}

/// Finds an identifier that a request shows in both modes.
fn shared(protocol: &Protocol, frame: &FrameLayout, one: Asked, other: Asked) -> Option<Diagnostic> {
    let mut identifier = 0;
    for (id, field) in protocol.identifier.fields.entries() {
        let [numbers, others] = [one, other].map(|(_, pattern)| sent(protocol, frame, pattern, id));
        identifier = field.put(identifier, lowest_shared(&numbers, &others)?);
    }
    Some(report(protocol, identifier, [one, other].map(|(mode, _)| &protocol[mode])))
}

/// Returns the values of a field that the document names for a request, as inclusive ranges.
fn sent(protocol: &Protocol, frame: &FrameLayout, pattern: &AddressPattern, field: FieldId) -> Vec<(u32, u32)> {
    let value = protocol[field].get(protocol.base_identifier(frame, pattern));
    let address = pattern.addresses.iter().find(|address| address.field == field);
    address.map_or_else(|| vec![(value, value)], |address| protocol[address.address_type].raw_ranges())
}

/// Returns the lowest number that lies in a range of both lists.
fn lowest_shared(ranges: &[(u32, u32)], others: &[(u32, u32)]) -> Option<u32> {
    let pairs = ranges.iter().flat_map(|range| others.iter().map(move |other| (range, other)));
    let shared = pairs.map(|(range, other)| (range.0.max(other.0), range.1.min(other.1)));
    shared.filter(|(first, last)| first <= last).map(|(first, _)| first).min()
}

fn report(protocol: &Protocol, identifier: u32, [one, other]: [&Mode; 2]) -> Diagnostic {
    let at = |mode: &Mode| mode.doc.path.key("request").at_key();
    let open = [(one, other), (other, one)].into_iter().find_map(|(mode, other)| Some((mode, other, open(mode)?)));
    let Some((mode, second, address)) = open else {
        let text = format!("a request in the mode `{}` is also one in the mode `{}`", one.name, other.name);
        let help = "give one of the two another constant, or leave it out of `answers`";
        return Diagnostic::warning(&SHARED_ADDRESS, at(other), text).help(help).other(at(one), "the other mode");
    };
    let known = &protocol[address.address_type];
    let (name, number) = (&known.name, known.number(protocol[address.field].get(identifier)));
    let text = format!("a request to `{name}` {number} is also one in the mode `{}`", second.name);
    let key = if known.names.is_empty() { "range" } else { "values" };
    let help = format!("if no `{name}` has the address {number}, take it out of the {key} of `{name}`");
    let diagnostic = Diagnostic::warning(&SHARED_ADDRESS, at(second), text).help(help);
    let diagnostic = diagnostic.other(at(mode), format!("here `{name}` is addressed"));
    diagnostic.other(known.doc.path.key(key).at_value(), format!("the {key}"))
}

/// Returns the address that requests of a mode leave to the caller.
fn open(mode: &Mode) -> Option<&Address> {
    mode.request.as_ref()?.addresses.iter().find(|address| Some(address.address_type) == mode.target)
}
