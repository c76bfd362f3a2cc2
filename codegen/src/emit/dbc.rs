//! The model as a DBC, the file format in which other tools read messages and signals.

mod file;
mod frames;
mod limits;
mod names;
mod signals;
mod text;
mod tree;

use std::ops::RangeInclusive;

use crate::model::Protocol;

use file::File;

/// A DBC, and what must be known beside it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dbc {
    /// The file, in ASCII.
    pub text: String,
    /// The bits of an identifier that choose the message; the other ones vary.
    pub mask: u32,
    /// How many messages of the protocol there are, and how many frames were made of them.
    pub counts: (usize, usize),
    /// What the protocol says and the file cannot, a sentence each without a full stop.
    pub limits: Vec<String>,
}

/// Emits a DBC: a message for each layout of the identifier, or for each identifier of these nodes.
///
/// Where addresses vary, the messages are told apart by the bits of [`Dbc::mask`].
pub fn dbc(protocol: &Protocol, nodes: Option<RangeInclusive<i64>>) -> Dbc {
    let sent = frames::sent(protocol, nodes.as_ref());
    let mask = frames::mask(protocol, &sent);
    let (frames, lost) = frames::frames(protocol, &sent, mask);
    let mut limits = limits::limits(protocol, mask);
    limits.extend(lost);
    let counts = (protocol.messages.len(), frames.len());
    let file = File { comment: text::header(protocol, mask, &limits), nodes: text::nodes(nodes), frames };
    Dbc { text: file.to_string(), mask, counts, limits }
}
