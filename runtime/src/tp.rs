//! The transport protocol of J1939: messages of 9 to 1,785 bytes in packets of seven.
//!
//! Control frames (TP.CM) and data frames (TP.DT) have eight data bytes. Their identifiers show a
//! source and a target. An [`Assembler`] keeps a session for each pair of them, in memory that the
//! caller sizes. It answers as a receiver does; a listener sends none of its answers. A [`Sender`]
//! makes the frames of one message.
//!
//! Time is a number of milliseconds from any start, and may wrap around.

mod assembler;
mod control;
mod sender;

pub use crate::long::buffer::Memory;
use crate::long::buffer::room;

pub use assembler::{Assembler, Broken, Cause, Event, Transfer};
pub use control::{Control, Reason};
pub use sender::{Answer, Sender};

#[cfg(test)]
mod tests;

/// The least and the greatest number of data bytes of a message.
pub const SIZES: core::ops::RangeInclusive<usize> = 9..=1785;

/// Data bytes in a packet.
const PACKET: usize = 7;

/// The target of a broadcast.
pub const ALL: u8 = 0xFF;

/// The number of the group of control frames.
pub(crate) const CONTROL_GROUP: u32 = 0xEC00;

/// The number of the group of packets.
pub(crate) const DATA_GROUP: u32 = 0xEB00;

/// Who sends a frame, and to whom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Link {
    /// The address of the sender.
    pub source: u8,
    /// The address of the receiver, or [`ALL`].
    pub target: u8,
}

impl Link {
    /// Returns the same two nodes the other way round.
    #[must_use]
    pub const fn reversed(self) -> Self {
        Self { source: self.target, target: self.source }
    }
}

/// Returns how many bytes of memory a session needs for messages of up to `size` data bytes.
pub const fn memory(size: usize) -> usize {
    room(size.div_ceil(PACKET), PACKET)
}

/// Returns how many packets carry a message of `size` bytes, if it is one of those that travel so.
fn packets(size: usize) -> Option<u8> {
    if SIZES.contains(&size) { u8::try_from(size.div_ceil(PACKET)).ok() } else { None }
}
