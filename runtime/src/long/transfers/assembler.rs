//! Puts the packets of long messages together, for many nodes at a time.

use core::fmt;
use core::marker::PhantomData;

use super::group::{Carried, frame, group_of, link};
use super::{Broken, Memory, Transferred, Transport};
use crate::tp::{self, CONTROL_GROUP, Control, DATA_GROUP, Link};
use crate::{Data, Exchange, Frame, IdentifierFields, Kind, Protocol, Received};

/// Puts the messages of the transport `T` together, for up to `N` pairs of nodes at a time, each in
/// memory `M`. Without another `M`, there is room for the longest message of the protocol.
#[derive(Clone, Copy)]
pub struct Assembler<T: Transport, const N: usize, M = <T as Transport>::Memory> {
    packets: tp::Assembler<M, N>,
    transport: PhantomData<T>,
}

/// What a frame changes.
#[derive(Clone, Copy, Debug)]
#[must_use = "a message can have ended"]
pub struct Event<T: Transport, M: Memory = <T as Transport>::Memory> {
    /// The message that is whole now.
    pub whole: Option<Whole<T, M>>,
    /// The message that was on its way and comes to nothing.
    pub broken: Option<Broken<M>>,
    /// The message that would begin, but comes to nothing.
    pub refused: Option<Broken<M>>,
    /// What the receiver answers. Only the node sends it whose address it shows as that of its sender.
    pub answer: Option<Frame>,
}

/// A message that came whole, in packets or in one frame.
#[derive(Clone, Copy)]
pub struct Whole<T: Transport, M: Memory = <T as Transport>::Memory> {
    exchange: &'static Exchange,
    kind: Kind,
    /// The frame, or one that only shows its identifier.
    frame: Frame,
    transfer: Option<tp::Transfer<M>>,
    transport: PhantomData<T>,
}

impl<T: Transport, M: Memory> Whole<T, M> {
    /// Returns the values, if it is the message `L` and has as many data bytes as that can have.
    pub fn values<L: Transferred<Transport = T>>(&self) -> Option<L> {
        let (is_message, data) = (self.exchange.message() == L::MESSAGE, self.data());
        if is_message && L::has_size(data.len()) { L::decode(data) } else { None }
    }

    /// Returns the data.
    pub fn data(&self) -> &[u8] {
        match &self.transfer {
            Some(transfer) => transfer.data(),
            None => embedded_can::Frame::data(&self.frame),
        }
    }

    /// Returns the identifier that it has as one frame, or would have. It shows who sends the
    /// message, and to whom.
    pub fn identifier(&self) -> <T::Protocol as Protocol>::Identifier {
        IdentifierFields::FROM_RAW(self.frame.raw_id())
    }

    /// Returns how the message travels, with its name and its access.
    pub const fn exchange(&self) -> &'static Exchange {
        self.exchange
    }

    /// Returns what the message is for.
    pub const fn kind(&self) -> Kind {
        self.kind
    }
}

impl<T: Transport, M: Memory> fmt::Debug for Whole<T, M> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Whole")
            .field("message", &self.exchange.message())
            .field("identifier", &self.identifier())
            .field("data", &self.data())
            .finish_non_exhaustive()
    }
}

impl<T: Transport, M: Memory> Event<T, M> {
    const NONE: Self = Self { whole: None, broken: None, refused: None, answer: None };

    /// Names what a frame of a transport changes. `id` is the identifier of the frame, if one came.
    fn new(event: tp::Event<M>, id: Option<u32>) -> Self {
        let tp::Event { whole, broken, refused, answer } = event;
        let usual = T::Protocol::FRAME.sent_id();
        let answer = answer.map(|(link, data)| frame::<T>(usual, CONTROL_GROUP, link, data));
        let whole = whole.zip(id).and_then(|(transfer, id)| Whole::of_packets(transfer, id));
        Self { whole, broken, refused, answer }
    }
}

impl<T: Transport, M: Memory> Whole<T, M> {
    fn of_packets(transfer: tp::Transfer<M>, id: u32) -> Option<Self> {
        let Carried { exchange, kind, id } = Carried::find::<T>(id, transfer.group)?;
        let frame = Frame::new_raw(id, T::Protocol::FRAME.is_extended(), [0; 8], 0);
        Some(Self { exchange, kind, frame, transfer: Some(transfer), transport: PhantomData })
    }

    /// Returns a message that one frame has room for.
    fn of_frame(received: &Received<T::Protocol>) -> Option<Self> {
        let (exchange, kind) = (received.exchange(), received.kind());
        let mut carried = T::CARRIES.iter().filter(|(known, of_kind)| *of_kind == kind && known.is(exchange));
        carried.next().filter(|_| !received.is_error_reply())?;
        Some(Self { exchange, kind, frame: *received.frame(), transfer: None, transport: PhantomData })
    }
}

impl<T: Transport, const N: usize, M: Memory> Default for Assembler<T, N, M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Transport, const N: usize, M: Memory> Assembler<T, N, M> {
    /// Returns an assembler.
    pub const fn new() -> Self {
        Self { packets: tp::Assembler::new(), transport: PhantomData }
    }

    /// Takes a frame, and returns what it changes. A frame that is none of the protocol, or of
    /// another message, changes nothing. `now` is a number of milliseconds from any start.
    pub fn receive(&mut self, frame: &impl embedded_can::Frame, now: u32) -> Event<T, M> {
        Received::decode(frame).map_or(Event::NONE, |received| self.take(&received, now))
    }

    /// The same as [`receive`](Self::receive), for a frame that is recognised already.
    pub fn take(&mut self, received: &Received<T::Protocol>, now: u32) -> Event<T, M> {
        let (id, data) = (received.frame().raw_id(), received.frame().bytes());
        let event = match group_of::<T>(id) {
            CONTROL_GROUP => self.control(id, data, now),
            DATA_GROUP => self.packets.packet(link::<T>(id), &data, now),
            _ => return Event { whole: Whole::of_frame(received), ..Event::NONE },
        };
        Event::new(event, Some(id))
    }

    /// Gives up a message whose sender has been silent for too long. Call this until it returns
    /// `None`.
    pub fn timed_out(&mut self, now: u32) -> Option<Event<T, M>> {
        Some(Event::new(self.packets.timed_out(now)?, None))
    }

    /// Takes a control frame. A message that the transport does not carry is not put together.
    fn control(&mut self, id: u32, data: Data, now: u32) -> tp::Event<M> {
        let link: Link = link::<T>(id);
        match Control::decode(&data) {
            Some((Control::Rts { .. } | Control::Bam { .. }, group)) if Carried::find::<T>(id, group).is_none() => {
                self.packets.interrupt(link)
            }
            _ => self.packets.control(link, &data, now),
        }
    }
}

impl<T: Transport, const N: usize, M: Memory> fmt::Debug for Assembler<T, N, M> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Assembler").field("packets", &self.packets).finish_non_exhaustive()
    }
}
