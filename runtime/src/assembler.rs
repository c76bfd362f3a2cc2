//! Puts the frames of sets together, for many nodes at a time.
//!
//! The caller tells an [`Assembler`] which nodes were asked, and gives it every frame of the bus.
//! For each frame of its set, the assembler returns what the frame changes. It never mixes frames
//! of two nodes: the node is the address that the reply shows.
//!
//! Time is a number of milliseconds from any start, and may wrap around. Call
//! [`timed_out`](Assembler::timed_out) at least once in 24 days, or it may miss a silent node.

use core::fmt;

use embedded_can::Frame as _;

use crate::clock::{has_come, has_lasted};
use crate::frame::classic;
use crate::set::FrameSet;
use crate::{Frame, Kind, Problem, Received};

#[cfg(test)]
mod tests;

/// Collects the frames of the set `S` from up to `N` nodes at a time.
#[derive(Clone, Copy, Debug)]
pub struct Assembler<S, const N: usize> {
    nodes: [Option<Node<S>>; N],
    patience: u32,
    model: Option<u8>,
    is_listening: bool,
}

/// What one node has sent.
#[derive(Clone, Copy, Debug)]
struct Node<S> {
    number: i32,
    /// When it was asked, or sent its last frame.
    since: u32,
    /// The greatest position of any member so far.
    furthest: usize,
    /// Members with values, one bit each.
    came: u64,
    /// Members that were answered with an error, one bit each.
    failed: u64,
    set: S,
}

/// What a frame of the set changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress<S> {
    /// More frames will follow.
    Pending {
        /// Number of the node.
        node: i32,
        /// What this frame is.
        arrival: Arrival,
        /// Members that have not come yet.
        missing: Members,
    },
    /// This was the last frame, and every member has values. The node is forgotten.
    Complete {
        /// Number of the node.
        node: i32,
        /// What this frame is.
        arrival: Arrival,
        /// The values.
        set: S,
    },
    /// This was the last frame, but a member is missing. The node is forgotten.
    Incomplete {
        /// What this frame is.
        arrival: Arrival,
        /// What came.
        partial: Partial<S>,
    },
    /// The node was not asked, or has already sent its last frame. Nothing is kept.
    Unasked {
        /// Number of the node.
        node: i32,
    },
    /// The assembler listens to every node, but has no room for this one. Nothing is kept.
    Full {
        /// Number of the node.
        node: i32,
    },
}

/// What a frame of a set is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// The first member, or one after all that came. Members in between may be late or lost.
    InOrder,
    /// A member that should have come earlier.
    OutOfOrder,
    /// A member again, with the same values.
    Repeated,
    /// A member again, with other values. These count from now on.
    Changed,
    /// An error reply in place of a member's values. Values that came before stay.
    Failed,
    /// No member of the set. Its values are ignored, but it can end the set.
    Unlisted,
}

/// What came of a set that is not complete.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Partial<S> {
    /// Number of the node.
    pub node: i32,
    /// The values that came.
    pub set: S,
    /// Members that did not come.
    pub missing: Members,
    /// Members that were answered with an error.
    pub failed: Members,
}

/// Some members of a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Members {
    names: &'static [&'static str],
    bits: u64,
}

impl Members {
    /// Tests whether there are none.
    pub const fn is_empty(&self) -> bool {
        self.bits == 0
    }

    /// Returns their names in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        let Self { names, bits } = *self;
        names.iter().enumerate().filter(move |(position, _)| bits & bit(*position) != 0).map(|(_, name)| *name)
    }
}

/// The assembler has no room for another node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

impl fmt::Display for Full {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the assembler has no room for another node")
    }
}

impl core::error::Error for Full {}

/// What a frame of a set says.
#[derive(Clone, Copy)]
enum Said<P> {
    Values(usize, P),
    Error(usize),
    Unlisted,
}

impl<S: FrameSet, const N: usize> Assembler<S, N> {
    /// Returns an assembler for nodes that were [asked](Self::ask). A node times out after
    /// `patience` milliseconds of silence.
    pub const fn new(patience: u32) -> Self {
        Self { nodes: [None; N], patience, model: None, is_listening: false }
    }

    /// Returns an assembler for every node that sends a frame of the set.
    ///
    /// A frame that is repeated after the last one begins another set, which will time out.
    pub const fn listening(patience: u32) -> Self {
        Self { is_listening: true, ..Self::new(patience) }
    }

    /// Reads frames as those of a device model if messages look the same.
    #[must_use]
    pub fn for_model(self, model: impl Into<u8>) -> Self {
        Self { model: Some(model.into()), ..self }
    }

    /// Waits for a whole set from a node, whatever the node has sent before.
    ///
    /// Frames have no number, so late frames of an earlier request count as new ones.
    ///
    /// # Errors
    ///
    /// Refuses a node if there is no room for it.
    pub fn ask(&mut self, node: impl Into<i32>, now: u32) -> Result<(), Full> {
        let number = node.into();
        let slot = self.slot(number).ok_or(Full)?;
        *slot = Some(Node::new(number, now));
        Ok(())
    }

    /// Forgets a node.
    pub fn forget(&mut self, node: impl Into<i32>) {
        let number = node.into();
        let known = self.nodes.iter_mut().find(|slot| slot.as_ref().is_some_and(|known| known.number == number));
        if let Some(slot) = known {
            *slot = None;
        }
    }

    /// Returns what a node has sent so far, if the assembler waits for it.
    pub fn partial(&self, node: impl Into<i32>) -> Option<Partial<S>> {
        let number = node.into();
        self.nodes.iter().flatten().find(|known| known.number == number).map(Node::partial)
    }

    /// Forgets a node that has been silent for too long, and returns what it sent. Call this until
    /// it returns `None`.
    pub fn timed_out(&mut self, now: u32) -> Option<Partial<S>> {
        let patience = self.patience;
        let is_silent = |node: &Node<S>| has_lasted(node.since, patience, now);
        let slot = self.nodes.iter_mut().find(|slot| slot.as_ref().is_some_and(is_silent))?;
        slot.take().map(|node| node.partial())
    }

    /// Takes a frame. `None` means that the frame does not belong to this set, is a request, or is
    /// damaged.
    ///
    /// Only [`timed_out`](Self::timed_out) ends the wait. Until it is called, a late frame still
    /// counts.
    pub fn receive(&mut self, frame: &impl embedded_can::Frame, now: u32) -> Option<Progress<S>> {
        let frame = classic(frame)?;
        let said = self.said(&frame)?;
        let number = node::<S>(frame.raw_id())?;
        let is_listening = self.is_listening;
        let slot = match self.slot(number) {
            Some(slot) if slot.is_some() || is_listening => slot,
            None if is_listening => return Some(Progress::Full { node: number }),
            _ => return Some(Progress::Unasked { node: number }),
        };
        let node = slot.get_or_insert_with(|| Node::new(number, now));
        let progress = node.progress(said, S::CONTINUATION.is_in(&frame), now);
        if !matches!(progress, Progress::Pending { .. }) {
            *slot = None;
        }
        Some(progress)
    }

    /// Returns the slot of a node, or a free one.
    fn slot(&mut self, number: i32) -> Option<&mut Option<Node<S>>> {
        let is_its = |slot: &Option<Node<S>>| slot.as_ref().is_some_and(|known| known.number == number);
        let found = self.nodes.iter().position(is_its).or_else(|| self.nodes.iter().position(Option::is_none));
        self.nodes.get_mut(found?)
    }

    /// Returns what a frame says if it belongs to this set.
    fn said(&self, frame: &Frame) -> Option<Said<S::Protocol>> {
        match Received::<S::Protocol>::decode_by(self.model, frame) {
            Ok(received) if is_of::<S>(&received) => {
                let position = S::position(received.content())?;
                let values = || Said::Values(position, *received.content());
                Some(if received.is_error_reply() { Said::Error(position) } else { values() })
            }
            Err(Problem::UnknownMessage) => is_unlisted::<S>(frame).then_some(Said::Unlisted),
            _ => None,
        }
    }
}

/// Tests whether a frame carries a member of the set.
fn is_of<S: FrameSet>(received: &Received<S::Protocol>) -> bool {
    received.kind() == Kind::Reply && received.exchange().set() == Some(S::EXCHANGE.message())
}

/// Tests whether a frame without a message shows what every frame of the set shows.
fn is_unlisted<S: FrameSet>(frame: &Frame) -> bool {
    let shows = S::EXCHANGE.filter(Kind::Reply).is_some_and(|filter| filter.matches(frame));
    shows && frame.dlc() == usize::from(S::EXCHANGE.data_length())
}

/// Returns the number of the node that sends a reply.
fn node<S: FrameSet>(id: u32) -> Option<i32> {
    S::EXCHANGE.addressing::<S::Protocol>(Kind::Reply, id)?.number(S::NODE, id)
}

impl<S: FrameSet> Node<S> {
    fn new(number: i32, now: u32) -> Self {
        Self { number, since: now, furthest: 0, came: 0, failed: 0, set: S::default() }
    }

    /// Takes what a frame says. `more` tells whether other frames follow.
    fn progress(&mut self, said: Said<S::Protocol>, more: bool, now: u32) -> Progress<S> {
        let arrival = self.arrival(said);
        if has_come(self.since, now) {
            self.since = now;
        }
        let partial = self.partial();
        let Partial { node, set, missing, failed } = partial;
        if more {
            Progress::Pending { node, arrival, missing }
        } else if missing.is_empty() && failed.is_empty() {
            Progress::Complete { node, arrival, set }
        } else {
            Progress::Incomplete { arrival, partial }
        }
    }

    fn arrival(&mut self, said: Said<S::Protocol>) -> Arrival {
        let (position, values) = match said {
            Said::Values(position, values) => (position, Some(values)),
            Said::Error(position) => (position, None),
            Said::Unlisted => return Arrival::Unlisted,
        };
        let is_in_order = position >= self.furthest;
        self.furthest = self.furthest.max(position);
        let Some(values) = values else {
            self.failed |= bit(position);
            return Arrival::Failed;
        };
        let is_repeated = self.came & bit(position) != 0;
        self.came |= bit(position);
        match (is_repeated, self.set.put(&values)) {
            (true, true) => Arrival::Repeated,
            (true, false) => Arrival::Changed,
            (false, _) if is_in_order => Arrival::InOrder,
            (false, _) => Arrival::OutOfOrder,
        }
    }

    fn partial(&self) -> Partial<S> {
        let all = (0..S::MEMBERS.len()).fold(0, |all, position| all | bit(position));
        let members = |bits| Members { names: S::MEMBERS, bits };
        let missing = members(all & !(self.came | self.failed));
        let failed = members(self.failed & !self.came);
        Partial { node: self.number, set: self.set, missing, failed }
    }
}

/// Returns the bit of a member.
fn bit(position: usize) -> u64 {
    u32::try_from(position).ok().and_then(|position| 1_u64.checked_shl(position)).unwrap_or(0)
}
