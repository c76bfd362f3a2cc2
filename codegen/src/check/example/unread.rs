//! Finds messages whose examples cannot be read as these messages. If there are several, their
//! `match` is probably wrong.

use indexmap::IndexMap;

use crate::diagnostic::{At, Diagnostic};
use crate::interpret::{Frame, decode};
use crate::model::{Example, Message, MessageId, Protocol};
use crate::resolve::rules;
use crate::syntax::tree::Path;

/// Largest number of examples that are shown beside a message.
const SHOWN: usize = 3;

/// Finds the messages with at least two examples that cannot be read, and none that can. It returns
/// the places of their frames.
pub fn find(protocol: &Protocol) -> IndexMap<MessageId, Vec<Path>> {
    let mut unread: IndexMap<_, Vec<_>> = IndexMap::new();
    let mut read = Vec::new();
    for example in protocol.examples.iter().filter(|example| example.fails.is_none()) {
        let Some(message) = example.message else { continue };
        match decode(protocol, example.model, &Frame::of(protocol, example)) {
            Ok(decoded) if decoded.message == message => read.push(message),
            _ => unread.entry(message).or_default().push(place(example)),
        }
    }
    unread.retain(|message, frames| frames.len() > 1 && !read.contains(message));
    unread
}

/// Says that no example is read as the message.
pub fn report(message: &Message, frames: &[Path]) -> Diagnostic {
    let text = format!("none of the {} examples of `{name}` is read as `{name}`", frames.len(), name = message.name);
    let help = "correct `match` or another constant of the message, or the examples";
    let diagnostic = Diagnostic::error(&rules::EXAMPLE, At::Key(message.doc.path.key("match")), text).help(help);
    let others = frames.iter().take(SHOWN);
    others.fold(diagnostic, |diagnostic, frame| diagnostic.other(frame.at_value(), "this frame, for instance"))
}

fn place(example: &Example) -> Path {
    example.doc.path.key(example.kind.name())
}
