#![doc = include_str!("../rules/unreachable.md")]

use super::ambiguous::{Ranges, accepted, patterns};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{AddressPattern, Foreign, IdentifierField, Message, Protocol, SelectorPlace, Shape};

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let frames: Vec<_> = message
            .shapes
            .iter()
            .flat_map(|shape| patterns(protocol, (message, shape)).into_iter().map(move |pattern| (shape, pattern)))
            .collect();
        if frames.is_empty() && message.set.is_none() {
            diagnostics.push(without_mode(message));
        }
        let mut owners = frames.iter().map(|(shape, pattern)| owner(protocol, shape, pattern));
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
    Diagnostic::error("unreachable", message.doc.path.key("access").at_key(), text).help(help)
}

fn claimed(message: &Message, foreign: &Foreign) -> Diagnostic {
    let text = format!("no frame is ever decoded as `{}`: all frames that it could have are foreign", message.name);
    let help = "correct the constants of the message, or let the foreign identifiers leave it some";
    let diagnostic = Diagnostic::error("unreachable", message.doc.path.at_key(), text).help(help);
    diagnostic.other(foreign.doc.path.key("match").at_key(), "this claims them first")
}

/// Finds who claims all frames of a shape that an addressing pattern allows.
fn owner<'a>(protocol: &'a Protocol, shape: &Shape, pattern: &AddressPattern) -> Option<&'a Foreign> {
    let fields = protocol.identifier.fields.iter().enumerate();
    let values: Vec<_> = fields.map(|(index, field)| values(protocol, shape, pattern, (index, field))).collect();
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
    shape: &Shape,
    pattern: &AddressPattern,
    (index, field): (usize, &IdentifierField),
) -> Ranges {
    let is_here = |selector: usize| matches!(protocol.selectors[selector].place, SelectorPlace::Identifier(place) if place == index);
    let chosen = shape.constants.iter().find(|(selector, _)| is_here(*selector));
    let chosen = chosen.and_then(|(_, value)| u32::try_from(*value).ok());
    match field.constant.or(chosen) {
        Some(value) => vec![(value, value)],
        None => accepted(protocol, pattern, index),
    }
}

/// Returns the least and the greatest identifier.
fn whole(protocol: &Protocol, values: &[Ranges]) -> (u32, u32) {
    let fixed = protocol.identifier.value;
    let fields = protocol.identifier.fields.iter().zip(values);
    fields.fold((fixed, fixed), |(low, high), (field, ranges)| {
        let least = ranges.iter().map(|range| range.0).min().unwrap_or(0);
        let greatest = ranges.iter().map(|range| range.1).max().unwrap_or(0);
        (low | least << field.shift, high | greatest << field.shift)
    })
}
