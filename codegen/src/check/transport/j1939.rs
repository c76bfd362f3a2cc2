//! What J1939 asks of its messages: an announcement shows only the number of a group.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{FrameLayout, Groups, LongMessage, Protocol};
use crate::resolve::rules;

/// Tests a message, and those of the same transport before it.
pub fn check(
    protocol: &Protocol,
    groups: &Groups,
    long: &LongMessage,
    earlier: &[&LongMessage],
    diagnostics: &mut Diagnostics,
) {
    if long.frames.iter().any(|frame| frame.payload().next().is_some()) {
        diagnostics.push(chosen_by_data(long));
    }
    if is_nameless(groups, long) {
        diagnostics.push(nameless(long));
    } else if let Some(other) = earlier.iter().find(|other| are_alike(protocol, groups, long, other)) {
        diagnostics.push(alike(long, other));
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
fn is_nameless(groups: &Groups, long: &LongMessage) -> bool {
    let names = |frame: &FrameLayout| frame.identifier().any(|(field, _)| groups.group.contains(&field));
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
fn are_alike(protocol: &Protocol, groups: &Groups, one: &LongMessage, other: &LongMessage) -> bool {
    let group = |frame: &FrameLayout| {
        let id =
            frame.identifier().fold(protocol.identifier.value, |id, (field, value)| protocol[field].put(id, value));
        (frame.sender, groups.group_of(protocol, id))
    };
    one.frames.iter().any(|frame| other.frames.iter().any(|known| group(frame) == group(known)))
}
