#![doc = include_str!("../rules/outside_frame.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Protocol;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            let used = 8 - signal.place.mask().iter().rev().take_while(|byte| **byte == 0).count();
            if used > message.length.into() {
                let text = format!(
                    "`{}.{}` reaches byte {}, but the message has {} data bytes",
                    message.name,
                    signal.name,
                    used - 1,
                    message.length
                );
                let help = "correct the place, or the `length` of the message";
                let at = signal.doc.path.key("bytes").at_value();
                diagnostics.push(Diagnostic::error("outside_frame", at, text).help(help));
            }
        }
    }
}
