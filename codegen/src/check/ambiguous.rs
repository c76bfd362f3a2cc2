#![doc = include_str!("../rules/ambiguous.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{AddressPattern, Kind, Message, Protocol, Shape, Who};
use crate::syntax::tree::Path;

/// Inclusive raw ranges.
pub type Ranges = Vec<(u32, u32)>;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let all = protocol.messages.iter().flat_map(|message| message.shapes.iter().map(move |shape| (message, shape)));
    let frames: Vec<_> = all.filter(|frame| !is_of_wrong_set(protocol, *frame, diagnostics)).collect();
    let mut reported: Vec<(Path, Path)> = Vec::new();
    for (index, one) in frames.iter().enumerate() {
        let Some(other) = frames[..index].iter().find(|other| both_fit(protocol, *one, **other)) else { continue };
        let pair = places(protocol, *one, *other);
        if !reported.contains(&pair) {
            report(protocol, *one, *other, &pair, diagnostics);
            reported.push(pair);
        }
    }
}

/// Tests whether a frame belongs to a set that has an error of its own, which can be why it is ambiguous.
fn is_of_wrong_set(protocol: &Protocol, (message, shape): (&Message, &Shape), diagnostics: &Diagnostics) -> bool {
    let set = message.accesses[shape.access].set.map(|set| &protocol.messages[set]);
    let set = set.or(message.set.as_ref().map(|_| message));
    set.is_some_and(|set| diagnostics.has_errors_in(&set.doc.path))
}

fn report(
    protocol: &Protocol,
    one: (&Message, &Shape),
    other: (&Message, &Shape),
    (place, second): &(Path, Path),
    diagnostics: &mut Diagnostics,
) {
    let name = |(message, shape): (&Message, &Shape)| {
        let access = &message.accesses[shape.access];
        let set = access.set.map_or_else(String::new, |set| format!(" in `{}`", protocol.messages[set].name));
        let access = &protocol.accesses[access.access].name;
        format!("the {} of `{}` by `{access}`{set}", shape.kind.name(), message.name)
    };
    let text = format!("a frame can be {} and {}", name(other), name(one));
    let help = "give one of the two another constant, addressing modes of its own, or `models` of its own";
    let (at, second) = if place == second {
        let access = |shape: &Shape| place.key("access").index(shape.access).at_value();
        (access(one.1), access(other.1))
    } else {
        (place.at_key(), second.at_key())
    };
    diagnostics.push(Diagnostic::error("ambiguous", at, text).help(help).other(second, "the other one"));
}

/// Returns the places of the sets that two frames are part of; where they are part of one, or of none, those of their messages.
fn places(protocol: &Protocol, one: (&Message, &Shape), other: (&Message, &Shape)) -> (Path, Path) {
    let whole = |(message, shape): (&Message, &Shape)| {
        let set = message.accesses[shape.access].set;
        set.map_or(message, |set| &protocol.messages[set]).doc.path.clone()
    };
    let (first, second) = (whole(one), whole(other));
    if first == second { (one.0.doc.path.clone(), other.0.doc.path.clone()) } else { (first, second) }
}

fn both_fit(protocol: &Protocol, one: (&Message, &Shape), other: (&Message, &Shape)) -> bool {
    let same_direction = (one.1.kind == Kind::Request) == (other.1.kind == Kind::Request);
    same_direction
        && !one.0.is_apart_from(other.0)
        && one.0.length == other.0.length
        && agree(one.1, other.1)
        && patterns(protocol, one)
            .iter()
            .any(|pattern| patterns(protocol, other).iter().any(|opposite| intersect(protocol, pattern, opposite)))
}

/// Tests whether no selector has two values.
fn agree(one: &Shape, other: &Shape) -> bool {
    let differs = |(selector, value): &(usize, u64)| {
        other.constants.iter().any(|(known, opposite)| known == selector && opposite != value)
    };
    !one.constants.iter().any(differs)
}

/// Returns the addressing patterns that the document allows for a frame.
pub fn patterns<'a>(protocol: &'a Protocol, (message, shape): (&Message, &Shape)) -> Vec<&'a AddressPattern> {
    let answers = &message.accesses[shape.access].answers;
    let allowed = protocol.modes.iter().zip(answers).filter_map(|(mode, who)| Some((mode, (*who)?)));
    allowed
        .filter_map(|(mode, who): (_, Who)| match shape.kind {
            Kind::Request => mode.request.as_ref(),
            Kind::Reply | Kind::Report => mode.reply(who),
        })
        .collect()
}

/// Tests whether one identifier fits both patterns.
fn intersect(protocol: &Protocol, one: &AddressPattern, other: &AddressPattern) -> bool {
    (0..protocol.identifier.fields.len()).all(|field| {
        let (ranges, others) = (accepted(protocol, one, field), accepted(protocol, other, field));
        ranges.iter().any(|(first, last)| others.iter().any(|(start, end)| first <= end && start <= last))
    })
}

/// Returns the raw values of a field that a pattern accepts, tolerated ones included.
pub fn accepted(protocol: &Protocol, pattern: &AddressPattern, field: usize) -> Ranges {
    let known = &protocol.identifier.fields[field];
    let greatest = known.mask() >> known.shift;
    if pattern.mask & known.mask() != 0 {
        let value = known.get(pattern.value);
        return vec![(value, value)];
    }
    let Some(address) = pattern.addresses.iter().find(|address| address.field == field) else {
        return vec![(0, greatest)];
    };
    let address_type = &protocol.address_types[address.address_type];
    let documented = address_type.raw_range();
    if address_type.strict { vec![documented] } else { without(greatest, &address.excluded, documented) }
}

/// Returns the values up to `greatest` that are not excluded, and the documented ones.
fn without(greatest: u32, excluded: &[(u32, u32)], documented: (u32, u32)) -> Ranges {
    let mut ranges = vec![documented];
    let mut next = 0;
    for (first, last) in excluded {
        if *first > next {
            ranges.push((next, first - 1));
        }
        next = next.max(last.saturating_add(1));
    }
    if next <= greatest {
        ranges.push((next, greatest));
    }
    ranges
}
