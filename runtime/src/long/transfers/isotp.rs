//! Messages by ISO 15765-2: each in a single frame, or in a first frame and consecutive ones.

mod ends;
mod head;
mod packets;

use super::standard::{Sessions, Standard};
use super::{Assembler, Event, Sender, Transferred, Transport, Whole, put, rules};
use crate::frame::padded;
use crate::isotp::{self, Packet, Pdu, SINGLE, SIZES};
use crate::reply::has_error;
use crate::{Destination, Error, Exchange, Frame, Kind, Protocol, Received, Request, Route};

pub use crate::isotp::{Answer, Cause, Memory, Separation, memory};
pub use ends::Ends;
use head::{Carried, Head};
use packets::Packets;

/// The transport of ISO 15765-2.
#[derive(Clone, Copy, Debug)]
pub struct Isotp;

/// What ISO-TP needs of a transport. Generated code implements it.
pub trait Filled: Transport<Standard = Isotp> {
    /// The byte that fills frames up to eight bytes. Without one they end with their data.
    const FILL: Option<u8>;
    /// The messages that are its frames.
    const FRAMES: &'static [&'static str];
    /// Those of [`CARRIES`](Transport::CARRIES) that have no values.
    const BARE: &'static [(&'static Exchange, Kind)] = &[];
}

/// A message on its way, or what came of it.
pub type Transfer<M> = isotp::Transfer<M, Ends>;

/// A message that comes to nothing.
pub type Broken<M> = isotp::Broken<M, Ends>;

/// The messages on their way.
type Open<M, const N: usize> = isotp::Assembler<M, N, Ends>;

impl<T: Filled> Standard<T> for Isotp {
    type Sessions<M: Memory, const N: usize> = Open<M, N>;
    type Transfer<M: Memory> = Transfer<M>;
    type Broken<M: Memory> = Broken<M>;
    type Frames<'a> = Packets<'a>;
    type Answer = Answer;

    fn has_values<L: Transferred, M: Memory>(whole: &Whole<T, M>) -> bool {
        let (exchange, kind) = (whole.exchange(), whole.kind());
        let has_size = L::has_size_with(head_of(exchange, kind), whole.data().len());
        has_size && !is_bare::<T>(exchange, kind) && !whole.is_error_reply()
    }

    fn frames<'a, L: Transferred<Transport = T>>(
        values: &L,
        blank: &Frame,
        model: Option<u8>,
        buffer: &'a mut [u8],
    ) -> Result<Packets<'a>, Error> {
        let id = blank.raw_id();
        let carried = Carried::of_blank::<T>(blank).filter(|carried| carried.exchange.message() == L::MESSAGE);
        let carried = carried.filter(|carried| !is_bare::<T>(carried.exchange, carried.kind));
        let carried = carried.ok_or(Error::Identifier { message: L::MESSAGE, id })?;
        let data = values.encode_by(rules::<L>(id, model), carried.head.length(), buffer)?;
        carried.head.write(data);
        let room = Error::Room { message: L::MESSAGE, length: data.len(), room: *SIZES.end() };
        let packets = isotp::Sender::new(data).ok_or(room)?.padded(T::FILL);
        if data.len() <= SINGLE {
            return Ok(Packets::one::<T>(id, data));
        }
        Ok(Packets::Several { packets, ends: carried.ends::<T>(id) })
    }
}

impl<M: Memory> AsRef<[u8]> for Transfer<M> {
    fn as_ref(&self) -> &[u8] {
        self.data()
    }
}

impl<T: Filled, M: Memory, const N: usize> Sessions<T, M> for Open<M, N> {
    const NONE: Self = Self::NEW.padded(T::FILL);

    fn take(&mut self, received: &Received<T::Protocol>, now: u32) -> Event<T, M> {
        let (Some(ends), data) = (Ends::of::<T>(received), embedded_can::Frame::data(received.frame())) else {
            return Event::NONE;
        };
        let model = received.model();
        let carried = |data: &[u8], size| Carried::find::<T>((ends.id(), ends.is_to_module()), data, size, model);
        let event = match Pdu::decode(data) {
            Some(Pdu::Single(data)) => match carried(data, data.len()) {
                Some(_) => self.single(ends, data),
                None => self.restarted(ends),
            },
            Some(Pdu::First { size, data }) => {
                let size = usize::try_from(size).unwrap_or(usize::MAX);
                match carried(data, size) {
                    Some(carried) => self.first(ends.answered_by(carried.answer::<T>(&ends)), size, data, now),
                    None => self.restarted(ends),
                }
            }
            Some(Pdu::Consecutive { number, data }) => self.consecutive(ends, number, data, now),
            Some(Pdu::Flow(flow)) => self.flow(|sender| ends.answers(sender), flow, now),
            None => return Event::NONE,
        };
        named(event, model)
    }

    fn timed_out(&mut self, now: u32) -> Option<Event<T, M>> {
        Some(named(self.timed_out(now)?, None))
    }
}

/// Names what a frame of a transport changes.
fn named<T: Filled, M: Memory>(event: isotp::Event<M, Ends>, model: Option<u8>) -> Event<T, M> {
    let isotp::Event { whole, broken, refused, answer } = event;
    let answer = answer.and_then(|(ends, packet)| Some(framed::<T>(ends.answer()?, &packet)));
    let whole = whole.and_then(|transfer| {
        let shown = (transfer.link.id(), transfer.link.is_to_module());
        let Carried { exchange, kind, .. } = Carried::find::<T>(shown, transfer.data(), transfer.size(), model)?;
        let (data, extended) = (transfer.data(), T::Protocol::FRAME.is_extended());
        let beginning = Frame::new_raw(shown.0, extended, padded(data), u8::try_from(data.len().min(8)).unwrap_or(8));
        Some(Whole::of_frames((exchange, kind), beginning, transfer))
    });
    Event { whole, broken, refused, answer }
}

/// Returns how many bytes the constants of a message need.
fn head_of(exchange: &Exchange, kind: Kind) -> usize {
    exchange.filter(kind).map_or(0, |filter| Head::of(&filter).length())
}

/// Tests whether a message carries no values by an exchange.
fn is_bare<T: Filled>(exchange: &Exchange, kind: Kind) -> bool {
    T::BARE.iter().any(|(known, of_kind)| *of_kind == kind && known.is(exchange))
}

/// Returns a frame of the transport, with what `id` shows elsewhere.
fn framed<T: Filled>(id: u32, packet: &Packet) -> Frame {
    let id = T::SENDS.iter().fold(id, |id, (bits, value)| put(id, *bits, *value));
    let (data, length) = (packet.data(), u8::try_from(packet.data().len()).unwrap_or(8));
    Frame::new_raw(id, T::Protocol::FRAME.is_extended(), padded(data), length)
}

impl<T: Filled> Sender<'static, T> {
    /// Returns what sends a message without values. `blank` is made by
    /// [`Filter::frame`](crate::Filter::frame), and shows who sends the message, and to whom. Returns
    /// `None` if no message without values looks so.
    pub fn bare(blank: &Frame) -> Option<Self> {
        let carried = Carried::of_blank::<T>(blank).filter(|known| is_bare::<T>(known.exchange, known.kind))?;
        let (id, mut data) = (blank.raw_id(), [0; 8]);
        carried.head.write(&mut data);
        Some(Self { id, frames: Packets::one::<T>(id, data.get(..carried.head.length())?) })
    }
}

impl<T: Filled> Sender<'_, T> {
    /// Tests whether a flow control is awaited. If none comes in [`PATIENCE`](isotp::PATIENCE), the
    /// message comes to nothing.
    pub const fn is_waiting(&self) -> bool {
        match &self.frames {
            Packets::One(_) => false,
            Packets::Several { packets, .. } => packets.is_waiting(),
        }
    }

    /// Tests whether all data bytes are sent. If not, and no flow control is awaited, the iterator
    /// gives more frames, or the receiver has refused the message.
    pub const fn is_done(&self) -> bool {
        match &self.frames {
            Packets::One(frame) => frame.is_none(),
            Packets::Several { packets, .. } => packets.is_done(),
        }
    }
}

impl<T: Filled, const N: usize, M: Memory> Assembler<T, N, M> {
    /// Asks senders to wait for an answer after a block of frames, unless it is 0, and to leave time
    /// between frames.
    #[must_use]
    pub const fn pacing(self, block: u8, separation: Separation) -> Self {
        Self { sessions: self.sessions.pacing(block, separation) }
    }
}

impl<T: Filled, M: Memory> Whole<T, M> {
    /// Tests whether it goes to the controller and shows an error code, in the identifier or in the
    /// header of its data.
    pub fn is_error_reply(&self) -> bool {
        let (exchange, kind) = (self.exchange(), self.kind());
        let selectors = exchange.filter(kind).map_or(&[][..], |filter| filter.data_selectors());
        !exchange.is_to_module::<T::Protocol>(kind) && has_error::<T::Protocol>(selectors, self.frame())
    }

    /// Tests whether it is such a frame of an exchange that carries no values, as a request to read can
    /// be. It ends with its constants.
    pub fn is_bare(&self, exchange: &Exchange, kind: Kind) -> bool {
        let is_it = self.kind() == kind && self.exchange().is(exchange);
        is_it && is_bare::<T>(exchange, kind) && self.data().len() == head_of(exchange, kind)
    }
}

impl Exchange {
    /// Returns what sends a message without values to a module by its transport. Generated code calls it.
    ///
    /// # Errors
    ///
    /// The same as [`request_to`](Self::request_to).
    #[doc(hidden)]
    pub fn bare_to<T: Destination, S: Filled<Protocol = T::Protocol>>(
        &'static self,
        route: impl Into<Route<T>>,
    ) -> Result<Sender<'static, S>, Error> {
        let blank: Request<T::Protocol, ()> = self.request_to(route, &())?;
        let id = blank.frame().raw_id();
        Sender::bare(blank.frame()).ok_or(Error::Identifier { message: self.message(), id })
    }
}
