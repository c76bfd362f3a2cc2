#![doc = include_str!("../../docs/rules/no_example.md")]

use crate::model::{Message, MessageId, Protocol};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    NO_EXAMPLE "no_example" Check EITHER;
}

/// Tests that at least `percent` of a hundred messages have an example.
pub fn check(protocol: &Protocol, percent: u8, diagnostics: &mut Diagnostics) {
    let without: Vec<_> = protocol.messages.entries().filter(|(id, _)| !has_example(protocol, *id)).collect();
    for (_, message) in &without {
        diagnostics.push(nothing_shows(protocol, message));
    }
    let (all, shown) = (protocol.messages.len(), protocol.messages.len() - without.len());
    if shown * 100 < all * usize::from(percent) {
        let have = if shown == 1 { "has" } else { "have" };
        let text = format!("{shown} of {all} messages {have} an example, {percent} % are asked for");
        let help = "add frames of the document to `examples` of a message, or your own with `origin: ours`";
        diagnostics.push(Diagnostic::error(&NO_EXAMPLE, At::File, text).help(help));
    }
}

fn has_example(protocol: &Protocol, message: MessageId) -> bool {
    let is_long = || protocol.long_examples.iter().any(|example| protocol[example.long].message == message);
    protocol.examples.iter().any(|example| example.message == Some(message) && example.fails.is_none()) || is_long()
}

fn nothing_shows(protocol: &Protocol, message: &Message) -> Diagnostic {
    let failing = protocol.examples.iter().find(|example| {
        example.message.is_some_and(|index| protocol.messages[index].name == message.name) && example.fails.is_some()
    });
    let which = if failing.is_some() { " that holds" } else { "" };
    let text = format!("the message `{}` has no example{which}", message.name);
    let warning = Diagnostic::warning(&NO_EXAMPLE, message.doc.path.at_key(), text);
    let warning = warning.help("add a frame of it to `examples`");
    match failing {
        Some(example) => warning.other(example.doc.path.key("fails").at_value(), "one that must fail does not count"),
        None => warning,
    }
}
