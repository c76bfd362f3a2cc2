//! Tests that the announcement of a transport shows which message comes.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{FrameLayout, LongMessage, Protocol, Transport};
use crate::resolve::rules;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let carried: Vec<_> = protocol.long_messages.iter().filter(|long| long.transport().is_some()).collect();
    for (index, long) in carried.iter().enumerate() {
        if long.frames.iter().any(|frame| frame.payload().next().is_some()) {
            diagnostics.push(chosen_by_data(long));
        }
        if long.transport().is_some_and(|transport| is_nameless(&protocol[transport], long)) {
            diagnostics.push(nameless(long));
            continue;
        }
        let earlier = carried[..index].iter().filter(|other| other.transport() == long.transport());
        if let Some(other) = earlier.into_iter().find(|other| are_alike(protocol, long, other)) {
            diagnostics.push(alike(long, other));
        }
    }
}

fn chosen_by_data(long: &LongMessage) -> Diagnostic {
    let text = format!("data bytes choose `{}`, but a transport announces only its group", long.content.name);
    let help = "let `match` and the access name fields of the identifier alone";
    Diagnostic::error(&rules::TRANSPORT, long.content.doc.path.key("via").at_value(), text).help(help)
}

fn nameless(long: &LongMessage) -> Diagnostic {
    let text = format!("nothing chooses the group of `{}`", long.content.name);
    let help = "name fields of `group` in its `match`, such as the format";
    Diagnostic::error(&rules::TRANSPORT, long.content.doc.path.key("match").at_key(), text).help(help)
}

/// Tests whether a message shows no field of its group.
fn is_nameless(transport: &Transport, long: &LongMessage) -> bool {
    let names = |frame: &FrameLayout| frame.identifier().any(|(field, _)| transport.group.contains(&field));
    !long.frames.iter().all(names)
}

fn alike(long: &LongMessage, other: &LongMessage) -> Diagnostic {
    let text = format!("`{}` and `{}` have the same group", other.content.name, long.content.name);
    let problem = Diagnostic::error(&rules::TRANSPORT, long.content.doc.path.at_key(), text);
    problem
        .other(other.content.doc.path.at_key(), "the other one")
        .help("let their `match` differ in a field of `group`")
}

/// Tests whether an announcement can be of either message.
fn are_alike(protocol: &Protocol, one: &LongMessage, other: &LongMessage) -> bool {
    let Some(transport) = one.transport().map(|id| &protocol[id]) else { return false };
    let group = |frame: &FrameLayout| {
        let id =
            frame.identifier().fold(protocol.identifier.value, |id, (field, value)| protocol[field].put(id, value));
        (frame.sender, transport.group_of(protocol, id))
    };
    one.frames.iter().any(|frame| other.frames.iter().any(|known| group(frame) == group(known)))
}
