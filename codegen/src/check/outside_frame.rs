#![doc = include_str!("../rules/outside_frame.md")]

use crate::diagnostic::{At, Diagnostic, Diagnostics};
use crate::model::Protocol;
use crate::rule::rules;
use crate::syntax::tree::Path;

rules! {
    OUTSIDE_FRAME "outside_frame" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            let used = 8 - signal.place.mask().iter().rev().take_while(|byte| **byte == 0).count();
            if used > message.length.into() {
                let text = format!(
                    "`{}.{}` reaches byte {}, but the message has {}",
                    message.name,
                    signal.name,
                    used - 1,
                    bytes(message.length)
                );
                let help = "correct the place, or the `length` of the message";
                let at = place(&signal.doc.path, diagnostics);
                diagnostics.push_first(Diagnostic::error(&OUTSIDE_FRAME, at, text).help(help));
            }
        }
    }
}

/// Names the bytes of a frame, counted from 0 as `bytes` does.
fn bytes(length: u8) -> String {
    match length {
        0 => "no data bytes".to_owned(),
        1 => "byte 0 only".to_owned(),
        _ => format!("bytes 0 to {}", length - 1),
    }
}

/// Returns the place of `bytes`: of the field itself, or of the word around it.
fn place(field: &Path, diagnostics: &Diagnostics) -> At {
    let known = field.ancestors().map(|outer| outer.key("bytes")).find(|path| diagnostics.has(path));
    known.map_or_else(|| field.at_key(), |path| path.at_value())
}
