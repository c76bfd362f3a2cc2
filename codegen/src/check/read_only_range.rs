#![doc = include_str!("../../docs/rules/read_only_range.md")]

use crate::model::{Message, Protocol, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    READ_ONLY_RANGE "read_only_range" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let content = protocol.whole(message);
        for (id, signal) in content.signals.entries() {
            let is_own = signal.range_path.ancestors().any(|path| *path == message.doc.path);
            let is_idle = signal.range.is_some() && signal.specials.is_empty();
            if is_idle && is_own && !protocol.is_sent(message, id) {
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
