#![doc = include_str!("../rules/read_only_range.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Message, Protocol, Signal, SignalId};
use crate::rule::rules;

rules! {
    READ_ONLY_RANGE "read_only_range" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let content = protocol.long_message(message).map_or(message, |(_, long)| &long.content);
        for (id, signal) in content.signals.entries() {
            let is_own = signal.range_path.ancestors().any(|path| *path == message.doc.path);
            let is_idle = signal.range.is_some() && signal.specials.is_empty();
            if is_idle && is_own && !is_sent(protocol, message, id) {
                diagnostics.push_first(idle(content, signal));
            }
        }
    }
}

fn idle(message: &Message, signal: &Signal) -> Diagnostic {
    let text = format!(
        "`{}.{}` has a range, but no request carries the field, so nothing is refused",
        message.name,
        message.field_name(signal)
    );
    let help = "take the range out; or keep it for the note `out_of_range`, with a reason in an entry of `allow`";
    Diagnostic::warning(&READ_ONLY_RANGE, signal.range_path.at_value(), text).help(help)
}

/// Tests whether a signal goes to a module, alone or in the parts of a long message.
fn is_sent(protocol: &Protocol, message: &Message, signal: SignalId) -> bool {
    let mut sent = protocol.layouts_of(message).filter(|frame| frame.is_to_module());
    sent.any(|frame| protocol.part_of(frame).is_some() || frame.signals.contains(&signal))
}
