//! The frames that carry a message.

use super::super::standard::Frames;
use super::{Answer, Ends, Filled, framed};
use crate::{Frame, Received, isotp};

/// The frames of a message: a single one, or a first and consecutive ones.
#[derive(Clone)]
pub enum Packets<'a> {
    /// The frame, until it is sent.
    One(Option<Frame>),
    /// The frames, and who sends them.
    Several { packets: isotp::Sender<'a>, ends: Ends },
}

impl Packets<'_> {
    /// Returns the only frame of a message.
    pub fn one<T: Filled>(id: u32, data: &[u8]) -> Self {
        let packet = isotp::Sender::new(data).and_then(|packets| packets.padded(T::FILL).next());
        Self::One(packet.map(|packet| framed::<T>(id, &packet)))
    }
}

impl<T: Filled> Frames<T> for Packets<'_> {
    fn next(&mut self, id: u32) -> Option<Frame> {
        match self {
            Self::One(frame) => frame.take(),
            Self::Several { packets, .. } => Some(framed::<T>(id, &packets.next()?)),
        }
    }

    fn receive(&mut self, _: u32, frame: &impl embedded_can::Frame) -> Answer {
        let Self::Several { packets, ends } = self else { return Answer::Other };
        let received = Received::<T::Protocol>::decode(frame).ok();
        let is_answer = received.and_then(|received| Ends::of::<T>(&received)).is_some_and(|own| own.answers(ends));
        if is_answer { packets.control(frame.data()) } else { Answer::Other }
    }
}
