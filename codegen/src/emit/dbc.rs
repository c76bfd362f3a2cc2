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
    /// The bits of an identifier that choose the message. The other bits vary.
    pub mask: u32,
    /// The number of messages in the protocol, and the number of frames made from them.
    pub counts: (usize, usize),
    /// What the protocol says and the file cannot, each a sentence without a full stop.
    pub losses: Vec<String>,
    /// The frames that the file lacks.
    pub dropped: Vec<Dropped>,
}

/// A frame that the file lacks, because nothing would tell it from another frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dropped {
    /// What is missing, where and why, without a full stop.
    pub text: String,
    /// Whether the identifiers of the two frames differ, even if only in bits that vary.
    pub has_own_identifier: bool,
}

/// Emits a DBC. It has a message for each layout of the identifier, or for each identifier of these
/// nodes.
///
/// If addresses vary, the bits of [`Dbc::mask`] tell the messages apart.
pub fn dbc(protocol: &Protocol, nodes: Option<RangeInclusive<i64>>) -> Dbc {
    let sent = frames::sent(protocol, nodes.as_ref());
    let mask = frames::mask(protocol, &sent);
    let (frames, dropped) = frames::frames(protocol, &sent, mask);
    let mut losses = losses::losses(protocol, mask);
    losses.extend(dropped.iter().map(|dropped| dropped.text.clone()));
    let counts = (protocol.messages.len(), frames.len());
    let file =
        File { comment: text::header(protocol, mask, &losses), nodes: text::nodes(&protocol.sides, nodes), frames };
    Dbc { text: file.to_string(), mask, counts, losses, dropped }
}
