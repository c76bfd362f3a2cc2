//! Long messages that travel by a transport, as that of J1939 or ISO-TP.
//!
//! An [`Assembler`] puts them together, for many nodes at a time and without allocation. It is given
//! every frame of the bus. A message that one frame has room for is whole with that frame. So a
//! program sees each message as the same struct, whichever way it came. A [`Sender`] makes the
//! frames of a message. [`Outgoing`] is one with its own memory, which keeps the times of J1939.
//!
//! The modules [`tp`](crate::tp) and [`isotp`](crate::isotp) do the same with bytes alone.

mod assembler;
mod group;
pub mod isotp;
mod j1939;
mod outgoing;
mod sender;
mod standard;

use core::fmt::Debug;

use super::LongLayout;
use super::buffer::Memory;
use crate::protocol::{Heading, heading};
use crate::{Bits, Error, Exchange, Frame, Kind, Payload, Protocol};
use standard::Standard;

pub use crate::tp::{Answer, Broken, Cause, Reason, memory};
pub use assembler::{Assembler, Event, Whole};
pub use isotp::{Filled, Isotp};
pub use j1939::{Grouped, J1939};
pub use outgoing::{Next, Outgoing};
pub use sender::Sender;

/// A transport of a protocol. Generated code implements it, and an [`Assembler`] needs it.
pub trait Transport: Copy + Debug + 'static {
    /// The messages of the protocol.
    type Protocol: Protocol;
    /// Memory for the longest message.
    type Memory: Memory;
    /// The standard: [`J1939`] or [`Isotp`].
    type Standard: Standard<Self>;
    /// What its frames send in fields of the identifier, in place of what the message sends.
    const SENDS: &'static [(Bits, u32)] = &[];
    /// How the messages travel that it carries, and what their frames are for.
    const CARRIES: &'static [(&'static Exchange, Kind)];
}

/// A message that travels by a transport, or in one frame if that is enough. Generated code
/// implements it.
pub trait Transferred: LongLayout {
    /// The transport.
    type Transport: Transport;
    /// The numbers of data bytes that it can have, if the spec lists them.
    const SIZES: &'static [usize] = &[];

    /// Tests whether its fields can have some number of data bytes.
    fn has_size(size: usize) -> bool {
        Self::has_size_with(0, size)
    }

    /// Tests whether it can have some number of data bytes if its constants end with the first `head`.
    #[doc(hidden)]
    fn has_size_with(head: usize, size: usize) -> bool {
        if Self::SIZES.is_empty() { super::has_size::<Self>(head, size) } else { Self::SIZES.contains(&size) }
    }

    /// Returns what sends the message: in one frame, or by the transport. `blank` is a frame of the
    /// message: received, or made by [`Filter::frame`](crate::Filter::frame). Its identifier shows
    /// who sends the message, and to whom. The data are written to `buffer`, for which
    /// [`LONGEST`](LongLayout::LONGEST) bytes are enough. Constants of the data are those of `blank`.
    ///
    /// # Errors
    ///
    /// The same as [`encode`](LongLayout::encode). If the controller sends it, it also refuses values
    /// outside their limits. By ISO-TP it refuses a blank frame that is none of the message with values.
    fn sender<'a>(&self, blank: &Frame, buffer: &'a mut [u8]) -> Result<Sender<'a, Self::Transport>, Error> {
        Sender::new(self, blank, None, buffer)
    }

    /// The same as [`sender`](Self::sender), with the scales and the limits of a device model.
    ///
    /// # Errors
    ///
    /// The same as [`sender`](Self::sender).
    fn sender_for<'a>(
        &self,
        model: impl Into<u8>,
        blank: &Frame,
        buffer: &'a mut [u8],
    ) -> Result<Sender<'a, Self::Transport>, Error> {
        Sender::new(self, blank, Some(model.into()), buffer)
    }
}

/// Returns the rules by which the values of a message are written, whose identifier shows who sends it.
fn rules<L: Transferred>(id: u32, model: Option<u8>) -> Payload {
    let payload = Payload::new(L::MESSAGE, [0; 8]).for_model(model);
    if is_to_module::<L::Transport>(id) { payload.keeping_limits() } else { payload }
}

/// Tests whether an identifier goes to a module.
fn is_to_module<T: Transport>(id: u32) -> bool {
    heading::<T::Protocol>(id) == Heading::Module
}

/// Writes a value to a field of an identifier.
fn put(id: u32, bits: Bits, value: u32) -> u32 {
    u32::try_from(bits.put(id.into(), value.into())).unwrap_or(id)
}
