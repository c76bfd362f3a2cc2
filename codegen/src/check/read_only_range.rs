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
                    "`{}.{}` has a range, which limits what is sent, but no request carries the field",
                    message.name, signal.name
                );
                let help =
                    "take the range out, because only values to send have limits, or allow it with a reason in `allow`";
                diagnostics.push(Diagnostic::warning(&READ_ONLY_RANGE, signal.range_path.at_value(), text).help(help));
            }
        }
    }
}

fn is_sent(protocol: &Protocol, message: &Message, signal: SignalId) -> bool {
    protocol.frames_of(message).any(|frame| frame.kind.is_to_module() && frame.signals.contains(&signal))
}
