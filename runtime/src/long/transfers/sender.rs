//! The frames that carry a long message.

use core::fmt;

use super::standard::{Frames, Standard};
use super::{Transferred, Transport};
use crate::{Destination, Error, Exchange, Frame, Request, Route};

/// Makes the frames of one message. As an iterator it gives those that may be sent now.
///
/// A message in one frame may be sent at once, and by J1939 one to all. Packets to all have 50 to
/// 200 ms between them. Any other message begins with one frame. Others come when the receiver
/// allows them, in a frame that [`receive`](Self::receive) is given.
#[derive(Clone)]
pub struct Sender<'a, T: Transport> {
    /// The identifier that the message would have as one frame.
    pub(super) id: u32,
    pub(super) frames: <T::Standard as Standard<T>>::Frames<'a>,
}

impl<'a, T: Transport> Sender<'a, T> {
    pub(super) fn new<L: Transferred<Transport = T>>(
        values: &L,
        blank: &Frame,
        model: Option<u8>,
        buffer: &'a mut [u8],
    ) -> Result<Self, Error> {
        Ok(Self { id: blank.raw_id(), frames: T::Standard::frames(values, blank, model, buffer)? })
    }

    /// Takes a frame. If the receiver allows others in it, the iterator gives them.
    pub fn receive(&mut self, frame: &impl embedded_can::Frame) -> <T::Standard as Standard<T>>::Answer {
        self.frames.receive(self.id, frame)
    }
}

impl Exchange {
    /// Returns what sends `message` to a module by its transport, or in one frame. Generated code calls it.
    ///
    /// # Errors
    ///
    /// The same as [`request_to`](Self::request_to). It also refuses a buffer with too few bytes.
    #[doc(hidden)]
    pub fn transfer_to<'a, T: Destination, L: Transferred<Transport: Transport<Protocol = T::Protocol>>>(
        &'static self,
        route: impl Into<Route<T>>,
        message: &L,
        buffer: &'a mut [u8],
    ) -> Result<Sender<'a, L::Transport>, Error> {
        let blank: Request<T::Protocol, ()> = self.request_to(route, &())?;
        message.sender(blank.frame(), buffer)
    }
}

impl<T: Transport> Iterator for Sender<'_, T> {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        self.frames.next(self.id)
    }
}

impl<T: Transport> fmt::Debug for Sender<'_, T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Sender").field("id", &self.id).finish_non_exhaustive()
    }
}
