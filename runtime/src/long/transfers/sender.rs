//! The frames that carry a long message.

use core::fmt;
use core::marker::PhantomData;

use super::group::{frame, group_of, link};
use super::{Answer, Reason, Transferred, Transport, rules};
use crate::frame::padded;
use crate::protocol::own_id;
use crate::tp::{self, ALL, CONTROL_GROUP, DATA_GROUP, Link, SIZES};
use crate::{Data, Destination, Error, Exchange, Frame, Protocol, Request, Route};

/// How many packets a receiver may allow at once: any number.
const LIMIT: u8 = 0xFF;

/// Makes the frames of one message. As an iterator it gives those that may be sent now.
///
/// A message to all, or in one frame, may be sent at once. Packets to all have 50 to 200 ms between
/// them. Any other message begins with an announcement. Its packets come when the receiver allows
/// them, in a frame that [`receive`](Self::receive) is given.
#[derive(Clone)]
pub struct Sender<'a, T: Transport> {
    /// The identifier that the message would have as one frame.
    id: u32,
    frames: Frames<'a>,
    transport: PhantomData<T>,
}

#[derive(Clone)]
enum Frames<'a> {
    One(Option<Frame>),
    Packets { packets: tp::Sender<'a>, is_announced: bool },
}

impl<'a, T: Transport> Sender<'a, T> {
    pub(super) fn new<L: Transferred<Transport = T>>(
        values: &L,
        blank: &Frame,
        model: Option<u8>,
        buffer: &'a mut [u8],
    ) -> Result<Self, Error> {
        let id = blank.raw_id();
        let data = values.encode_by(rules::<L>(id, model), buffer)?;
        let frames = if let Ok(length @ 0..=8) = u8::try_from(data.len()) {
            let extended = T::Protocol::FRAME.is_extended();
            Frames::One(Some(Frame::new_raw(id, extended, padded(data), length)))
        } else {
            let room = Error::Room { message: L::MESSAGE, length: data.len(), room: *SIZES.end() };
            let packets = tp::Sender::new(group_of::<T>(id), data, LIMIT).ok_or(room)?;
            Frames::Packets { packets, is_announced: false }
        };
        Ok(Self { id, frames, transport: PhantomData })
    }

    /// Takes a frame. If the receiver allows packets in it, the iterator gives them.
    pub fn receive(&mut self, frame: &impl embedded_can::Frame) -> Answer {
        let is_answer = |id: &u32| group_of::<T>(*id) == CONTROL_GROUP && link::<T>(*id) == self.link().reversed();
        let own = own_id::<T::Protocol>(frame).filter(is_answer);
        let own = own.and_then(|id| Frame::copied(id, T::Protocol::FRAME.is_extended(), Some(8), frame));
        match (&mut self.frames, own) {
            (Frames::Packets { packets, .. }, Some(frame)) => packets.control(&frame.bytes()),
            _ => Answer::Other,
        }
    }

    /// Returns the frame that gives the message up, if it travels in packets. A message to all ends
    /// without one.
    pub fn abort(&self, reason: Reason) -> Option<Frame> {
        match &self.frames {
            Frames::Packets { packets, .. } if self.link().target != ALL => {
                Some(self.frame(CONTROL_GROUP, packets.abort(reason)))
            }
            Frames::One(_) | Frames::Packets { .. } => None,
        }
    }

    /// Returns who sends the message, and to whom.
    fn link(&self) -> Link {
        link::<T>(self.id)
    }

    fn frame(&self, group: u32, data: Data) -> Frame {
        frame::<T>(self.id, group, self.link(), data)
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
        let is_to_all = self.link().target == ALL;
        let (group, data) = match &mut self.frames {
            Frames::One(frame) => return frame.take(),
            Frames::Packets { packets, is_announced } if !*is_announced => {
                *is_announced = true;
                (CONTROL_GROUP, if is_to_all { packets.bam() } else { packets.rts() })
            }
            Frames::Packets { packets, .. } => (DATA_GROUP, packets.next()?),
        };
        Some(self.frame(group, data))
    }
}

impl<T: Transport> fmt::Debug for Sender<'_, T> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Sender").field("link", &self.link()).finish_non_exhaustive()
    }
}
