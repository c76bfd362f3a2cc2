#![doc = include_str!("../rules/no_example.md")]

use crate::diagnostic::{At, Diagnostic, Diagnostics};
use crate::model::{Message, Protocol};

/// Tests that of a hundred messages at least so many have an example.
pub fn check(protocol: &Protocol, percent: u8, diagnostics: &mut Diagnostics) {
    let without: Vec<_> =
        protocol.messages.iter().enumerate().filter(|(index, _)| !has_example(protocol, *index)).collect();
    for (_, message) in &without {
        diagnostics.push(nothing_shows(message));
    }
    let (all, shown) = (protocol.messages.len(), protocol.messages.len() - without.len());
    if shown * 100 < all * usize::from(percent) {
        let text = format!("an example is there for {shown} of {all} messages, fewer than {percent} %");
        let help = "add frames of the document to `examples` of a message, or your own with `origin: ours`";
        diagnostics.push(Diagnostic::error("no_example", At::File, text).help(help));
    }
}

fn has_example(protocol: &Protocol, message: usize) -> bool {
    protocol.examples.iter().any(|example| example.message == Some(message) && example.fails.is_none())
}

fn nothing_shows(message: &Message) -> Diagnostic {
    let text = format!("the message `{}` has no example", message.name);
    Diagnostic::warning("no_example", message.doc.path.at_key(), text).help("add a frame of it to `examples`")
}
