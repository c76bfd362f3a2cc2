#![doc = include_str!("../../docs/rules/no_quantity.md")]

use std::collections::HashSet;

use crate::model::{Message, Protocol, Signal, Unit};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    NO_QUANTITY "no_quantity" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    if protocol.quantities.is_empty() {
        return;
    }
    let named = named(protocol);
    for message in &protocol.messages {
        let content = protocol.whole(message);
        let sent = content.signals.entries().filter(|(id, _)| protocol.is_sent(message, *id));
        let open = sent.filter(|(_, signal)| is_of_output(signal) && !named.contains(&signal.doc.path));
        open.for_each(|(_, signal)| diagnostics.push_first(nameless(content, signal)));
    }
}

/// Returns the places of the fields that belong to a quantity.
fn named(protocol: &Protocol) -> HashSet<&Path> {
    let setters = protocol.quantities.iter().flat_map(|known| protocol.setters(known));
    setters.map(|(_, signal)| &signal.doc.path).collect()
}

/// Tests whether a signal has a unit in which an output is set, alone or on a device model.
fn is_of_output(signal: &Signal) -> bool {
    signal.on_each().filter_map(|own| own.unit).any(Unit::can_harm)
}

fn nameless(message: &Message, signal: &Signal) -> Diagnostic {
    let field = format!("{}.{}", message.name, message.field_name(signal));
    let text = format!("a request sets `{field}`, which belongs to no quantity");
    let help = format!("add `{field}` to `also` of the quantity that it sets; if it sets none, `allow` the warning");
    Diagnostic::warning(&NO_QUANTITY, signal.doc.path.at_key(), text).help(help)
}
