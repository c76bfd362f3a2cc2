#![doc = include_str!("../../docs/rules/ambiguous.md")]

use std::collections::HashSet;

use crate::model::{AddressPattern, FieldId, FrameId, FrameLayout, Id, Message, Protocol, SelectorId};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    AMBIGUOUS "ambiguous" Check ERROR;
}

/// Inclusive raw ranges.
pub type Ranges = Vec<(u32, u32)>;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    if !protocol.recognition.is_whole {
        let text = "the constants of the messages can be combined in too many ways to tell frames apart";
        let help = "let one field choose among the messages, with a constant in each";
        diagnostics.push(Diagnostic::error(&AMBIGUOUS, Path::default().key("messages").at_key(), text).help(help));
        return;
    }
    let mut reported = HashSet::new();
    for (id, one) in protocol.frames.entries() {
        if is_of_wrong_set(protocol, one, diagnostics) {
            continue;
        }
        let Some(other) = first_alike(protocol, id, one, diagnostics) else { continue };
        let pair = places(protocol, one, other);
        if reported.insert(pair.clone()) {
            report(protocol, one, other, &pair, diagnostics);
        }
    }
}

/// Finds the first earlier frame that a frame could be mistaken for.
fn first_alike<'a>(
    protocol: &'a Protocol,
    id: FrameId,
    one: &FrameLayout,
    diagnostics: &Diagnostics,
) -> Option<&'a FrameLayout> {
    let mut first: Option<FrameId> = None;
    let choice = protocol.recognition.course(one.is_to_module()).choice.as_ref()?;
    let _: Option<()> = choice.find_among(&one.constants, &mut |group| {
        group.choice.as_ref()?.find_among(&one.constants, &mut |frames| {
            let before = frames.iter().copied().take_while(|other| *other < first.unwrap_or(id));
            let mut alike = before.filter(|other| {
                let other = &protocol[*other];
                !is_of_wrong_set(protocol, other, diagnostics) && both_fit(protocol, one, other)
            });
            first = alike.next().or(first);
            None
        })
    });
    first.map(|first| &protocol[first])
}

/// Tests whether a frame belongs to a set with an error, because that error can make it ambiguous.
fn is_of_wrong_set(protocol: &Protocol, frame: &FrameLayout, diagnostics: &Diagnostics) -> bool {
    let message = &protocol[frame.message];
    let set = frame.set.map(|set| &protocol[set]).or(message.set.as_ref().map(|_| message));
    set.is_some_and(|set| diagnostics.has_errors_in(&set.doc.path))
}

fn report(
    protocol: &Protocol,
    one: &FrameLayout,
    other: &FrameLayout,
    (place, second): &(Path, Path),
    diagnostics: &mut Diagnostics,
) {
    let name = |frame: &FrameLayout| {
        let set = frame.set.map_or_else(String::new, |set| format!(" in `{}`", protocol[set].name));
        let (message, access) = (&protocol[frame.message].name, &protocol[frame.access].name);
        format!("the {} of `{message}` by `{access}`{set}", frame.kind.name())
    };
    let text = format!("a frame can be {} and {}", name(other), name(one));
    if let Some((open, closed)) = open_one(protocol, one, other).filter(|_| place != second) {
        let (open, closed) = (&protocol[open.message], &protocol[closed.message]);
        let has = if open.constants.is_empty() { "has no `match`" } else { "has fewer constants" };
        let missing = selectors_beyond(closed, open).map(|selector| format!("`{}`", protocol[selector].name));
        let missing = missing.collect::<Vec<_>>().join(" and ");
        let help = format!("name {missing} in the `match` of `{}`, as `{}` does", open.name, closed.name);
        let diagnostic =
            Diagnostic::error(&AMBIGUOUS, open.doc.path.at_key(), format!("{text}: `{}` {has}", open.name));
        return diagnostics.push_first(diagnostic.help(help).other(closed.doc.path.at_key(), "the other one"));
    }
    let help = "give one of the two another constant, addressing modes of its own, or `models` of its own";
    let (at, second) = if place == second {
        let access = |frame: &FrameLayout| place.key("access").index(frame.exchange.place()).at_value();
        (access(one), access(other))
    } else {
        (place.at_key(), second.at_key())
    };
    diagnostics.push(Diagnostic::error(&AMBIGUOUS, at, text).help(help).other(second, "the other one"));
}

/// Returns two frames in another order, if the message of the first lacks constants of the second,
/// and not the other way round.
fn open_one<'a>(
    protocol: &Protocol,
    one: &'a FrameLayout,
    other: &'a FrameLayout,
) -> Option<(&'a FrameLayout, &'a FrameLayout)> {
    let lacks = |one: &FrameLayout, other: &FrameLayout| {
        selectors_beyond(&protocol[other.message], &protocol[one.message]).next().is_some()
    };
    match (lacks(one, other), lacks(other, one)) {
        (true, false) => Some((one, other)),
        (false, true) => Some((other, one)),
        _ => None,
    }
}

/// Lists the selectors that have a constant in every frame of the first message, and not of the
/// second.
fn selectors_beyond<'a>(first: &'a Message, second: &'a Message) -> impl Iterator<Item = SelectorId> + 'a {
    let has = |known: &SelectorId| second.constants.iter().any(|constant| constant.selector == *known);
    first.constants.iter().map(|constant| constant.selector).filter(move |known| !has(known))
}

/// Returns the places of the sets of two frames. If they have no sets or the same one, it returns
/// those of their messages.
fn places(protocol: &Protocol, one: &FrameLayout, other: &FrameLayout) -> (Path, Path) {
    let own = |frame: &FrameLayout| protocol[frame.message].doc.path.clone();
    let whole = |frame: &FrameLayout| protocol[frame.set.unwrap_or(frame.message)].doc.path.clone();
    let (first, second) = (whole(one), whole(other));
    if first == second { (own(one), own(other)) } else { (first, second) }
}

/// Tests whether models, lengths, constants and addresses allow a frame that is both.
fn both_fit(protocol: &Protocol, one: &FrameLayout, other: &FrameLayout) -> bool {
    !protocol[one.message].is_apart_from(&protocol[other.message]) && are_alike(protocol, one, other)
}

/// Tests whether lengths, constants and addresses allow a frame that is both.
pub fn are_alike(protocol: &Protocol, one: &FrameLayout, other: &FrameLayout) -> bool {
    agree(one, other)
        && one.lengths.iter().any(|length| other.lengths.contains(length))
        && protocol
            .patterns_of(one)
            .any(|(_, pattern)| protocol.patterns_of(other).any(|(_, opposite)| intersect(protocol, pattern, opposite)))
}

/// Tests whether the constants of two frames want the same of each data bit, whatever the fields are called.
pub fn agree(one: &FrameLayout, other: &FrameLayout) -> bool {
    let ((mask, value), (others, wanted)) = (fixed(one), fixed(other));
    mask & others & (value ^ wanted) == 0
}

/// Returns the data bits that the constants of a frame fix, and what they are there.
pub fn fixed(frame: &FrameLayout) -> (u64, u64) {
    let constants = frame.constants.iter().filter_map(|constant| Some((constant.in_payload()?.0, constant)));
    constants.fold((0, 0), |(mask, bits), (place, constant)| {
        let [mut counting, mut data] = [[0; 8]; 2];
        place.put(&mut counting, place.max() & !constant.open);
        place.put(&mut data, constant.value);
        (mask | u64::from_be_bytes(counting), bits | u64::from_be_bytes(data))
    })
}

/// Tests whether one identifier fits both patterns.
fn intersect(protocol: &Protocol, one: &AddressPattern, other: &AddressPattern) -> bool {
    protocol.identifier.fields.ids().all(|field| {
        let (ranges, others) = (accepted(protocol, one, field), accepted(protocol, other, field));
        ranges.iter().any(|(first, last)| others.iter().any(|(start, end)| first <= end && start <= last))
    })
}

/// Returns the raw values of a field that a pattern accepts, tolerated ones included.
pub fn accepted(protocol: &Protocol, pattern: &AddressPattern, field: FieldId) -> Ranges {
    let known = &protocol[field];
    let greatest = known.mask() >> known.shift;
    if pattern.mask & known.mask() != 0 {
        let value = known.get(pattern.value);
        return vec![(value, value)];
    }
    let Some(address) = pattern.addresses.iter().find(|address| address.field == field) else {
        return vec![(0, greatest)];
    };
    let address_type = &protocol[address.address_type];
    let documented = address_type.raw_ranges();
    if address_type.strict { documented } else { without(greatest, &address.excluded, documented) }
}

/// Returns the values up to `greatest` that are not excluded, and the documented ones.
fn without(greatest: u32, excluded: &[(u32, u32)], documented: Ranges) -> Ranges {
    let mut ranges = documented;
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
