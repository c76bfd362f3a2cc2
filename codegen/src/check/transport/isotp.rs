//! What ISO-TP asks of its messages: the first six bytes show which one it is, and one node answers its first frame.

use crate::check::ambiguous::agree;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{FrameLayout, LongMessage, Protocol, Signal, Travel, Who};
use crate::resolve::rules;

/// Data bytes that a first frame has, and that a single frame has.
const FIRST: usize = 6;
const SINGLE: usize = 7;

/// Tests a message, and those of the same transport before it.
pub fn check(protocol: &Protocol, long: &LongMessage, earlier: &[&LongMessage], diagnostics: &mut Diagnostics) {
    if let Some(flaw) = long.frames.iter().find_map(|layout| flaw(protocol, long, layout)) {
        diagnostics.push(flaw);
    }
    if let Some(other) = earlier.iter().find(|other| are_alike(long, other)) {
        diagnostics.push(alike(long, other));
    }
}

/// Finds what is wrong with one of the ways in which a message is sent.
fn flaw(protocol: &Protocol, long: &LongMessage, layout: &FrameLayout) -> Option<Diagnostic> {
    let (extent, name, kind) = (long.extent(layout), &long.content.name, layout.kind.name());
    let path = &long.content.doc.path;
    let error = |at, text: String, help: &str| Some(Diagnostic::error(&rules::TRANSPORT, at, text).help(help));
    if extent.longest() == 0 {
        let text = format!("a {kind} of `{name}` has no data byte, and ISO-TP carries at least one");
        return error(path.at_key(), text, "name a field of the header in `match` or the access, or write `fields`");
    }
    if layout.head() > FIRST {
        let text = format!("the header of `{name}` has {} bytes, and the first frame shows {FIRST}", layout.head());
        return error(
            path.key("via").at_key(),
            text,
            "make fields of the message of what does not tell messages apart",
        );
    }
    if let Some(length) = extent.lengths().iter().find(|length| usize::from(**length) < layout.head()) {
        let text = format!("a {kind} of `{name}` has no room for its header in the length {length}");
        return error(path.key("length").at_key(), text, "count the bytes of the header in `length`, too");
    }
    if let Some((_, signal)) = extent.signals().find(|(_, signal)| is_covered(signal, layout)) {
        let text = format!("`{}` stands where the header or a constant of `{name}` does", signal.name);
        return error(signal.doc.path.at_key(), text, "fields count from byte 0 of the whole message; move the field");
    }
    let to_many = |travel: &&Travel| matches!(travel.who, Who::Each | Who::Coordinator);
    let travel = layout.travels.iter().find(to_many).filter(|_| layout.is_to_module() && extent.longest() > SINGLE)?;
    let mode = &protocol[travel.mode].name;
    let text = format!(
        "a {kind} of `{name}` has up to {} bytes, and goes to several nodes in the mode `{mode}`",
        extent.longest()
    );
    error(path.at_key(), text, "a message to several nodes has at most 7 bytes; leave the mode out in `answers`")
}

/// Tests whether a signal has bits of the header.
fn is_covered(signal: &Signal, layout: &FrameLayout) -> bool {
    let header = layout.covered.to_be_bytes();
    let own = header.into_iter().skip(signal.window.into()).zip(signal.masks());
    own.into_iter().any(|(header, mask)| header & mask != 0)
}

fn alike(long: &LongMessage, other: &LongMessage) -> Diagnostic {
    let text = format!("data can be of both `{}` and `{}`", other.content.name, long.content.name);
    let problem = Diagnostic::error(&rules::TRANSPORT, long.content.doc.path.at_key(), text);
    problem
        .other(other.content.doc.path.at_key(), "the other one")
        .help("let a constant in the first six bytes differ, in `match`, the access or a field")
}

/// Tests whether the same data can be of either message.
fn are_alike(one: &LongMessage, other: &LongMessage) -> bool {
    one.frames.iter().any(|frame| other.frames.iter().any(|known| fit_both(frame, known)))
}

fn fit_both(one: &FrameLayout, other: &FrameLayout) -> bool {
    let differs = one.identifier().any(|known| {
        let mut others = other.identifier();
        others.any(|(field, value)| field == known.0 && value != known.1)
    });
    one.sender == other.sender && !differs && agree(one, other)
}
