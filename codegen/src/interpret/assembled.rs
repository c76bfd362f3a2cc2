//! What becomes of the frames of a long message.

use super::{Decoded, Frame};
use crate::model::{AddressTypeId, Protocol};

/// The addresses of the two sides, in the order of their kinds.
pub type Peers = Vec<(AddressTypeId, i64)>;

/// What became of a frame.
#[derive(Clone, Debug)]
pub struct Taken<M> {
    /// Whether the frame carries a part that was kept, or repeats the one before.
    pub is_part: bool,
    /// The messages that ended.
    pub ended: Vec<Assembled<M>>,
}

impl<M> Taken<M> {
    /// What becomes of a frame that changes nothing.
    pub(super) const NOTHING: Self = Self { is_part: false, ended: Vec::new() };
}

/// A long message, or what came of it.
#[derive(Clone, Debug)]
pub struct Assembled<M> {
    /// What the caller remembers of the frames, in order.
    pub marks: Vec<M>,
    /// The last frame.
    pub frame: Frame,
    /// The values. Their signals are those of the long message.
    pub decoded: Decoded,
    /// The joined data, if no part is missing.
    pub data: Option<Vec<u8>>,
    /// Bits that no signal covers, first byte first.
    pub reserved: Vec<u8>,
    /// The name of what tells a message in parts from the next one, and its value.
    pub counter: Option<(String, u64)>,
    /// What is missing, in one sentence without a full stop.
    pub incomplete: Option<String>,
}

/// Returns those addresses that are not sent by everybody.
pub fn module(protocol: &Protocol, peers: &Peers) -> Peers {
    let own = peers.iter().filter(|(kind, _)| protocol[*kind].send.is_none());
    own.copied().collect()
}
