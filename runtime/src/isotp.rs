//! The transport protocol of ISO 15765-2 (ISO-TP) on classic CAN: messages of 1 to 4,095 bytes.
//!
//! A message of up to seven bytes is a single frame. A longer one begins with a first frame. The
//! receiver answers with a flow control, and consecutive frames follow. All frames of one direction
//! have one identifier. An [`Assembler`] keeps a session for each pair of identifiers, in memory
//! that the caller sizes. It answers as a receiver does; a listener sends none of its answers.
//! A [`Sender`] makes the frames of one message.
//!
//! Addresses stand in the identifier alone ("normal addressing").
//!
//! Time is a number of milliseconds from any start, and may wrap around.
//!
//! # Examples
//!
//! An engine sends the number of a vehicle to a tester:
//!
//! ```
//! use canspec_runtime::embedded_can::{Id, StandardId};
//! use canspec_runtime::isotp::{Assembler, Link, Sender, memory};
//!
//! # fn exchange() -> Option<()> {
//! let id = |id| StandardId::new(id).map(Id::Standard);
//! let link = Link { source: id(0x7E8)?, target: id(0x7E0)? };
//! let mut assembler = Assembler::<[u8; memory(64)], 1>::new();
//! let mut sender = Sender::new(b"\x49\x02\x011D4GP00R55B123456")?;
//!
//! let first = sender.next()?;
//! assert_eq!(first.data(), b"\x10\x14\x49\x02\x011D4");
//! let (back, flow_control) = assembler.receive(link, first.data(), 0).answer?;
//! assert_eq!(back, link.reversed());
//! sender.control(flow_control.data());
//!
//! let mut whole = None;
//! for packet in sender {
//!     whole = assembler.receive(link, packet.data(), 1).whole;
//! }
//! assert_eq!(whole?.data(), b"\x49\x02\x011D4GP00R55B123456");
//! # Some(())
//! # }
//! # exchange().expect("it comes over");
//! ```

mod assembler;
mod pdu;
mod sender;

use embedded_can::Id;
pub(crate) use pdu::SINGLE;
use pdu::{CONSECUTIVE, FIRST, LONGEST};

pub use crate::long::buffer::Memory;
use crate::long::buffer::room;

pub use assembler::{Assembler, Broken, Cause, Event, Transfer};
pub use pdu::{Flow, Packet, Pdu, Separation};
pub use sender::{Answer, Sender};

#[cfg(test)]
mod tests;

/// The least and the greatest number of data bytes of a message.
pub const SIZES: core::ops::RangeInclusive<usize> = 1..=LONGEST;

/// How long a sender waits for a flow control, and a receiver for a consecutive frame, in
/// milliseconds: `N_Bs` and `N_Cr` of the standard.
pub const PATIENCE: u32 = 1000;

/// The byte that fills frames up to eight bytes, as the standard recommends.
pub const PADDING: u8 = 0xCC;

/// Who sends a message, and to whom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Link {
    /// The identifier of the sender's frames.
    pub source: Id,
    /// The identifier of the receiver's frames.
    pub target: Id,
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
    // A first frame has one byte less than the others. A message of seven bytes is a single frame.
    let bytes = if size > SINGLE { size.saturating_add(CONSECUTIVE - FIRST) } else { SINGLE };
    room(bytes.div_ceil(CONSECUTIVE), CONSECUTIVE)
}
