//! Messages by SAE J1939-21: an announcement, packets with numbers, and the receiver's answers.

use super::group::{Carried, frame, group_of, link};
use super::standard::{Frames, Sessions, Standard};
use super::{Answer, Broken, Event, Memory, Reason, Sender, Transferred, Transport, Whole, rules};
use crate::frame::padded;
use crate::protocol::own_id;
use crate::tp::{self, ALL, CONTROL_GROUP, Control, DATA_GROUP, Link, SIZES};
use crate::{Bits, Data, Error, Frame, Protocol, Received};

/// The transport of SAE J1939-21.
#[derive(Clone, Copy, Debug)]
pub struct J1939;

/// What J1939 needs of a transport. Generated code implements it.
pub trait Grouped: Transport<Standard = J1939> {
    /// The fields of the identifier that are the number of a message, the highest bits first.
    const GROUP: &'static [Bits];
    /// The field with the address of the receiver, which is the last one of `GROUP`.
    const TARGET: Bits;
    /// The field with the address of the sender.
    const SOURCE: Bits;
}

/// How many packets a receiver may allow at once: any number.
const LIMIT: u8 = 0xFF;

impl<T: Grouped> Standard<T> for J1939 {
    type Sessions<M: Memory, const N: usize> = tp::Assembler<M, N>;
    type Transfer<M: Memory> = tp::Transfer<M>;
    type Broken<M: Memory> = Broken<M>;
    type Frames<'a> = Packets<'a>;
    type Answer = Answer;

    fn frames<'a, L: Transferred<Transport = T>>(
        values: &L,
        blank: &Frame,
        model: Option<u8>,
        buffer: &'a mut [u8],
    ) -> Result<Packets<'a>, Error> {
        let id = blank.raw_id();
        let data = &*values.encode_by(rules::<L>(id, model), 0, buffer)?;
        if let Ok(length @ 0..=8) = u8::try_from(data.len()) {
            let extended = T::Protocol::FRAME.is_extended();
            return Ok(Packets::One(Some(Frame::new_raw(id, extended, padded(data), length))));
        }
        let room = Error::Room { message: L::MESSAGE, length: data.len(), room: *SIZES.end() };
        let packets = tp::Sender::new(group_of::<T>(id), data, LIMIT).ok_or(room)?;
        Ok(Packets::Several { packets, is_announced: false })
    }
}

impl<M: Memory> AsRef<[u8]> for tp::Transfer<M> {
    fn as_ref(&self) -> &[u8] {
        self.data()
    }
}

impl<T: Grouped, M: Memory, const N: usize> Sessions<T, M> for tp::Assembler<M, N> {
    const NONE: Self = Self::new();

    fn take(&mut self, received: &Received<T::Protocol>, now: u32) -> Event<T, M> {
        let (id, data) = (received.frame().raw_id(), received.frame().bytes());
        let event = match group_of::<T>(id) {
            CONTROL_GROUP => control::<T, M, N>(self, id, data, now),
            DATA_GROUP => self.packet(link::<T>(id), &data, now),
            _ => return Event { whole: of_frame(received), ..Event::NONE },
        };
        named(event, Some(id))
    }

    fn timed_out(&mut self, now: u32) -> Option<Event<T, M>> {
        Some(named(self.timed_out(now)?, None))
    }
}

/// Takes a control frame. A message that the transport does not carry is not put together.
fn control<T: Grouped, M: Memory, const N: usize>(
    packets: &mut tp::Assembler<M, N>,
    id: u32,
    data: Data,
    now: u32,
) -> tp::Event<M> {
    let link: Link = link::<T>(id);
    match Control::decode(&data) {
        Some((Control::Rts { .. } | Control::Bam { .. }, group)) if Carried::find::<T>(id, group).is_none() => {
            packets.interrupt(link)
        }
        _ => packets.control(link, &data, now),
    }
}

/// Names what a frame of a transport changes. `id` is the identifier of the frame, if one came.
fn named<T: Grouped, M: Memory>(event: tp::Event<M>, id: Option<u32>) -> Event<T, M> {
    let tp::Event { whole, broken, refused, answer } = event;
    let usual = T::Protocol::FRAME.sent_id();
    let answer = answer.map(|(link, data)| frame::<T>(usual, CONTROL_GROUP, link, data));
    let whole = whole.zip(id).and_then(|(transfer, id)| {
        let Carried { exchange, kind, id } = Carried::find::<T>(id, transfer.group)?;
        let blank = Frame::new_raw(id, T::Protocol::FRAME.is_extended(), [0; 8], 0);
        Some(Whole::of_frames((exchange, kind), blank, transfer))
    });
    Event { whole, broken, refused, answer }
}

/// Returns a message that one frame has room for.
fn of_frame<T: Grouped, M: Memory>(received: &Received<T::Protocol>) -> Option<Whole<T, M>> {
    let (exchange, kind) = (received.exchange(), received.kind());
    let mut carried = T::CARRIES.iter().filter(|(known, of_kind)| *of_kind == kind && known.is(exchange));
    carried.next().filter(|_| !received.is_error_reply())?;
    Some(Whole::of_one((exchange, kind), *received.frame()))
}

/// The frames of a message: one, or an announcement and packets.
#[derive(Clone)]
pub enum Packets<'a> {
    /// The frame, until it is sent.
    One(Option<Frame>),
    /// Packets, and whether they are announced.
    Several { packets: tp::Sender<'a>, is_announced: bool },
}

impl<T: Grouped> Frames<T> for Packets<'_> {
    fn next(&mut self, id: u32) -> Option<Frame> {
        let is_to_all = link::<T>(id).target == ALL;
        let (group, data) = match self {
            Self::One(frame) => return frame.take(),
            Self::Several { packets, is_announced } if !*is_announced => {
                *is_announced = true;
                (CONTROL_GROUP, if is_to_all { packets.bam() } else { packets.rts() })
            }
            Self::Several { packets, .. } => (DATA_GROUP, packets.next()?),
        };
        Some(sent::<T>(id, group, data))
    }

    fn receive(&mut self, id: u32, frame: &impl embedded_can::Frame) -> Answer {
        let link_of_message = link::<T>(id);
        let is_answer = |own: &u32| {
            let is_back = link::<T>(*own) == link_of_message.reversed() && link_of_message.target != ALL;
            is_back && group_of::<T>(*own) == CONTROL_GROUP
        };
        let own = own_id::<T::Protocol>(frame).filter(is_answer);
        let own = own.and_then(|id| Frame::copied(id, T::Protocol::FRAME.is_extended(), Some(8), frame));
        match (self, own) {
            (Self::Several { packets, is_announced: true }, Some(frame)) => packets.control(&frame.bytes()),
            _ => Answer::Other,
        }
    }
}

/// Returns a frame of the sender of a message.
fn sent<T: Grouped>(id: u32, group: u32, data: Data) -> Frame {
    frame::<T>(id, group, link::<T>(id), data)
}

impl<T: Grouped> Sender<'_, T> {
    /// Returns the frame that gives the message up, if it travels in packets. A message to all ends
    /// without one.
    pub fn abort(&self, reason: Reason) -> Option<Frame> {
        match &self.frames {
            Packets::Several { packets, .. } if link::<T>(self.id).target != ALL => {
                Some(sent::<T>(self.id, CONTROL_GROUP, packets.abort(reason)))
            }
            Packets::One(_) | Packets::Several { .. } => None,
        }
    }
}
