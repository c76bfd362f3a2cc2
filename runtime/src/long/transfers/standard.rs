//! What standards of transports have in common. The transport of a protocol names its standard, so what joins and makes
//! frames is known before a program runs.

use core::fmt::Debug;

use super::{Event, Memory, Transferred, Transport, Whole};
use crate::{Error, Frame, Received};

/// A standard of transports.
pub trait Standard<T: Transport>: Copy + Debug + 'static {
    /// The messages on their way.
    type Sessions<M: Memory, const N: usize>: Sessions<T, M>;
    /// A message of several frames, or what came of it.
    type Transfer<M: Memory>: Copy + Debug + AsRef<[u8]>;
    /// A message that comes to nothing.
    type Broken<M: Memory>: Copy + Debug;
    /// The frames of a message that are not sent yet.
    type Frames<'a>: Frames<T>;
    /// What a frame of the receiver changes.
    type Answer: Copy + Debug + PartialEq;

    /// Tests whether what came has values of the message `L`, whose name it has.
    fn has_values<L: Transferred, M: Memory>(whole: &Whole<T, M>) -> bool {
        L::has_size(whole.data().len())
    }

    /// Writes a message, and takes it apart.
    fn frames<'a, L: Transferred<Transport = T>>(
        values: &L,
        blank: &Frame,
        model: Option<u8>,
        buffer: &'a mut [u8],
    ) -> Result<Self::Frames<'a>, Error>;
}

/// The messages on their way, each in memory `M`.
pub trait Sessions<T: Transport, M: Memory>: Copy + Debug {
    /// None.
    const NONE: Self;

    /// Takes a frame of the protocol.
    fn take(&mut self, received: &Received<T::Protocol>, now: u32) -> Event<T, M>;

    /// Gives up a message whose sender has been silent for too long.
    fn timed_out(&mut self, now: u32) -> Option<Event<T, M>>;
}

/// The frames of a message that are not sent yet. `id` is the identifier that it would have as one frame.
pub trait Frames<T: Transport>: Clone {
    /// Returns the next frame that may be sent now.
    fn next(&mut self, id: u32) -> Option<Frame>;

    /// Takes a frame of the bus.
    fn receive(&mut self, id: u32, frame: &impl embedded_can::Frame) -> <T::Standard as Standard<T>>::Answer;
}
