#![doc = include_str!("../../docs/rules/no_limit.md")]

use crate::model::{Kind, Message, Protocol, Signal, SignalId, Unit};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    NO_LIMIT "no_limit" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let content = protocol.whole(message);
        // An array is one field.
        let fields = content.signals.entries().filter(|(_, signal)| signal.element.is_none_or(|of| of.index == 0));
        for (id, signal) in fields {
            if signal.on_each().any(is_unlimited) && is_set(protocol, message, id) {
                diagnostics.push(unlimited(content, signal));
            }
        }
    }
}

/// Tests whether nothing limits what can do harm.
fn is_unlimited(signal: &Signal) -> bool {
    signal.unit.is_some_and(Unit::can_harm) && signal.limits().next().is_none()
}

/// Tests whether a request carries a signal, alone or in the parts of a long message.
fn is_set(protocol: &Protocol, message: &Message, signal: SignalId) -> bool {
    let mut requests = protocol.layouts_of(message).filter(|frame| frame.kind == Kind::Request);
    requests.any(|frame| protocol.part_of(frame).is_some() || frame.signals.contains(&signal))
}

fn unlimited(message: &Message, signal: &Signal) -> Diagnostic {
    let text = format!("a request sets `{}.{}` without a limit", message.name, message.field_name(signal));
    let place = signal.types.first().map_or_else(String::new, |name| format!(", or that of its type `{name}`"));
    let help = format!(
        "write its `range`{place}, as the document or the ratings state it; if neither does, `allow` the warning"
    );
    Diagnostic::warning(&NO_LIMIT, signal.doc.path.at_key(), text).help(help)
}
