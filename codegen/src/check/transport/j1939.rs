//! What J1939 asks of its messages: an announcement shows only the number of a group.

use std::collections::HashMap;

use crate::model::{FrameLayout, Groups, LongMessage, Protocol, Side};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::resolve::rules;

/// The messages of a transport, by what an announcement shows: who sends it, and the number of the group. Each has the
/// first one, with its place among them.
#[derive(Default)]
pub struct Announced<'a> {
    count: usize,
    first: HashMap<(Side, u32), (usize, &'a LongMessage)>,
}

/// Tests a message, and those of the same transport before it, which are announced so.
pub fn check<'a>(
    protocol: &Protocol,
    groups: &Groups,
    long: &'a LongMessage,
    earlier: &mut Announced<'a>,
    diagnostics: &mut Diagnostics,
) {
    if long.frames.iter().any(|frame| frame.payload().next().is_some()) {
        diagnostics.push(chosen_by_data(long));
    }
    let shown: Vec<_> = long.frames.iter().map(|frame| shown(protocol, groups, frame)).collect();
    let alike = shown.iter().filter_map(|shown| earlier.first.get(shown)).min_by_key(|(place, _)| *place);
    if is_nameless(groups, long) {
        diagnostics.push(nameless(long));
    } else if let Some((_, other)) = alike {
        diagnostics.push(self::alike(long, other));
    }
    for shown in shown {
        earlier.first.entry(shown).or_insert((earlier.count, long));
    }
    earlier.count += 1;
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

/// Returns what an announcement shows of a frame.
fn shown(protocol: &Protocol, groups: &Groups, frame: &FrameLayout) -> (Side, u32) {
    let id = frame.identifier().fold(protocol.identifier.value, |id, (field, value)| protocol[field].put(id, value));
    (frame.sender, groups.group_of(protocol, id))
}
