//! Finds messages whose examples cannot be read as these messages. If there are several, their
//! `match` is probably wrong.

use indexmap::IndexMap;

use super::unreadable::Slip;
use crate::interpret::{Frame, Problem, Unrecognised, decode};
use crate::model::{Example, MessageId, Protocol};
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::tree::Path;
use crate::resolve::rules;

/// Largest number of examples that are shown beside a message.
const SHOWN: usize = 3;

/// Finds the messages with at least two examples that cannot be read, and none that can. A frame of another length says
/// by itself what is wrong.
pub fn find(protocol: &Protocol) -> IndexMap<MessageId, Vec<&Example>> {
    let mut unread: IndexMap<_, Vec<_>> = IndexMap::new();
    let mut read = Vec::new();
    for example in protocol.examples.iter().filter(|example| example.fails.is_none()) {
        let Some(message) = example.message else { continue };
        match decode(protocol, example.model, &Frame::of(protocol, example)) {
            Ok(decoded) if decoded.message == message => read.push(message),
            Err(Unrecognised { problem: Problem::Length, .. }) => {}
            _ => unread.entry(message).or_default().push(example),
        }
    }
    unread.retain(|message, frames| frames.len() > 1 && !read.contains(message));
    unread
}

/// Says that no example is read as the message.
pub fn report(protocol: &Protocol, message: MessageId, examples: &[&Example]) -> Diagnostic {
    let message = &protocol[message];
    let text = format!("none of the {} examples of `{name}` is read as `{name}`", examples.len(), name = message.name);
    let help = "correct `match` or another constant of the message, or the examples";
    let diagnostic = Diagnostic::error(&rules::EXAMPLE, At::Key(message.doc.path.key("match")), text).help(help);
    let slip = examples.first().and_then(|example| Slip::find(protocol, example));
    let diagnostic = match slip {
        Some(slip) => slip.mark(diagnostic),
        None => diagnostic,
    };
    let others = examples.iter().take(SHOWN);
    others.fold(diagnostic, |known, example| known.other(place(example).at_value(), "this frame, for instance"))
}

/// Returns the place of the frame of an example.
pub fn place(example: &Example) -> Path {
    example.doc.path.key(example.kind.name())
}
