//! The model as a DBC, the file format in which other tools read messages and signals.

mod file;
mod frames;
mod losses;
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
    pub losses: Vec<String>,
    /// The frames that the file lacks.
    pub dropped: Vec<Dropped>,
}

/// A frame of a message that the file lacks, since nothing in it would tell it from another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dropped {
    /// What is missing where, and why, without a full stop.
    pub text: String,
    /// Whether their identifiers differ, if only in bits that vary.
    pub has_own_identifier: bool,
}

/// Emits a DBC: a message for each layout of the identifier, or for each identifier of these nodes.
///
/// Where addresses vary, the messages are told apart by the bits of [`Dbc::mask`].
pub fn dbc(protocol: &Protocol, nodes: Option<RangeInclusive<i64>>) -> Dbc {
    let sent = frames::sent(protocol, nodes.as_ref());
    let mask = frames::mask(protocol, &sent);
    let (frames, dropped) = frames::frames(protocol, &sent, mask);
    let mut losses = losses::losses(protocol, mask);
    losses.extend(dropped.iter().map(|dropped| dropped.text.clone()));
    let counts = (protocol.messages.len(), frames.len());
    let file = File { comment: text::header(protocol, mask, &losses), nodes: text::nodes(nodes), frames };
    Dbc { text: file.to_string(), mask, counts, losses, dropped }
}
