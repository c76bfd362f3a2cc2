#![doc = include_str!("../rules/read_only_range.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Message, Protocol, SignalId};
use crate::rule::rules;

rules! {
    READ_ONLY_RANGE "read_only_range" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for (id, signal) in message.signals.entries() {
            let is_own = signal.range_path.ancestors().any(|path| *path == message.doc.path);
            let is_idle = signal.range.is_some() && signal.specials.is_empty();
            if is_idle && is_own && !is_sent(protocol, message, id) {
                let text = format!(
                    "`{}.{}` has a range, but no request carries the field, so nothing is refused",
                    message.name, signal.name
                );
                let help =
                    "take the range out; or keep it for the note `out_of_range`, with a reason in an entry of `allow`";
                diagnostics
                    .push_first(Diagnostic::warning(&READ_ONLY_RANGE, signal.range_path.at_value(), text).help(help));
            }
        }
    }
}

fn is_sent(protocol: &Protocol, message: &Message, signal: SignalId) -> bool {
    protocol.frames_of(message).any(|frame| frame.is_to_module() && frame.signals.contains(&signal))
}
