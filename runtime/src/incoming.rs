//! Frames while they are recognised.

use core::marker::PhantomData;

use crate::address::Rank;
use crate::frame::padded;
use crate::protocol::{Headed, Heading, heading, is_own, own_id};
use crate::{Bits, Data, Exchange, Frame, IdentifierFields, Kind, Layout, Place, Problem, Protocol, Received};

/// A frame of a protocol while it is recognised, and the number of the device model that it should be of.
///
/// Generated code names the message. Each of its answers is complete, so that nothing is copied on the way to the caller.
#[derive(Clone, Copy, Debug)]
pub struct Incoming {
    frame: Frame,
    pub(crate) model: Option<u8>,
    heading: Heading,
    /// The numbers of data bytes, if there are several.
    lengths: &'static [u8],
}

impl Incoming {
    /// Returns a frame that should be of a device model. It goes nowhere yet.
    #[inline(always)]
    pub const fn new(frame: Frame, model: Option<u8>) -> Self {
        Self { frame, model, heading: Heading::Neither, lengths: &[] }
    }

    /// Sets where the frame goes.
    #[must_use]
    #[inline(always)]
    pub const fn to(&self, heading: Heading) -> Self {
        Self { heading, ..*self }
    }

    /// Returns where the frame goes.
    #[inline(always)]
    pub const fn heading(&self) -> Heading {
        self.heading
    }

    /// Returns the identifier as a number.
    #[inline(always)]
    pub(crate) const fn raw_id(&self) -> u32 {
        self.frame.raw_id()
    }

    /// Returns the frame as one of a protocol, to be recognised by where it goes.
    #[inline(always)]
    pub(crate) const fn of<P>(self) -> IncomingOf<P> {
        IncomingOf { frame: self, protocol: PhantomData }
    }

    /// Reads a data frame that has the width, the fixed bits and the length of a protocol's frames.
    ///
    /// Each test ends in its own way. The compiler would make tests that end in the same way one, which takes more
    /// instructions than each alone.
    ///
    /// # Errors
    ///
    /// Says why the frame is none of the protocol.
    #[inline(always)]
    pub(crate) fn read<P: Protocol>(model: Option<u8>, frame: &impl embedded_can::Frame) -> Result<Self, Problem> {
        let bytes = frame.data();
        let Some(id) = own_id::<P>(frame) else {
            let is_classic = frame.is_data_frame() && bytes.len() <= 8;
            return Err(if is_classic { Problem::Identifier } else { Problem::Frame });
        };
        if !frame.is_data_frame() {
            return Err(Problem::Frame);
        }
        let copied = if is_own::<P>(id) { Frame::of_data(id, P::FRAME.is_extended(), P::LENGTH, bytes) } else { None };
        copied.map(|frame| Self::new(frame, model)).ok_or_else(|| refused::<P>(id, bytes))
    }

    /// Returns the value of a field of the identifier.
    #[inline(always)]
    pub const fn id(&self, bits: Bits) -> u32 {
        bits.of(self.frame.raw_id())
    }

    /// Returns the value at a place of the data.
    #[inline(always)]
    pub const fn data(&self, place: Place) -> u64 {
        place.get(&self.frame.bytes())
    }

    /// Returns the values that the frame carries if it is of a message.
    #[inline(always)]
    pub fn values<L: Layout>(&self) -> L {
        L::read(&self.frame, self.model)
    }

    /// Sets the numbers of data bytes that the message can have.
    #[must_use]
    #[inline(always)]
    pub const fn of_lengths(&self, lengths: &'static [u8]) -> Self {
        Self { lengths, ..*self }
    }

    /// Returns the message of a request and of its reply, which carry the same values.
    ///
    /// # Errors
    ///
    /// Refuses another number of data bytes than the message has.
    #[inline(always)]
    pub fn both<P: Protocol>(&self, exchange: &'static Exchange, message: P) -> Result<Received<P>, Problem> {
        self.pair(exchange, message, message)
    }

    /// Returns the message of a request or that of its reply, whichever the frame is.
    ///
    /// # Errors
    ///
    /// Refuses another number of data bytes than the message has.
    #[inline(always)]
    pub fn pair<P: Protocol>(&self, exchange: &'static Exchange, request: P, reply: P) -> Result<Received<P>, Problem> {
        if self.heading == Heading::Module { self.request(exchange, request) } else { self.reply(exchange, reply) }
    }

    /// Returns the message of a request.
    ///
    /// # Errors
    ///
    /// Refuses another number of data bytes than the message has.
    #[inline(always)]
    pub fn request<P: Protocol>(&self, exchange: &'static Exchange, message: P) -> Result<Received<P>, Problem> {
        self.received(exchange, Kind::Request, message)
    }

    /// Returns the message of a reply.
    ///
    /// # Errors
    ///
    /// Refuses another number of data bytes than the message has.
    #[inline(always)]
    pub fn reply<P: Protocol>(&self, exchange: &'static Exchange, message: P) -> Result<Received<P>, Problem> {
        self.received(exchange, Kind::Reply, message)
    }

    /// Returns the message of a report.
    ///
    /// # Errors
    ///
    /// Refuses another number of data bytes than the message has.
    #[inline(always)]
    pub fn report<P: Protocol>(&self, exchange: &'static Exchange, message: P) -> Result<Received<P>, Problem> {
        self.received(exchange, Kind::Report, message)
    }

    #[inline(always)]
    fn received<P: Protocol>(
        &self,
        exchange: &'static Exchange,
        kind: Kind,
        message: P,
    ) -> Result<Received<P>, Problem> {
        if P::LENGTH.is_none() && !self.frame.has_length(exchange.data_length().into(), self.lengths) {
            return self.unknown();
        }
        Ok(Received::new(message, exchange, kind, self.frame, self.model))
    }

    /// Returns the message that fits the frame best: first by length, then by device model, then by addresses.
    ///
    /// # Errors
    ///
    /// Refuses another number of data bytes than the messages have.
    pub fn best<P: Protocol, const N: usize>(
        &self,
        messages: [Result<Received<P>, Problem>; N],
    ) -> Result<Received<P>, Problem> {
        let fitting = messages.into_iter().filter_map(Result::ok);
        let best = fitting.reduce(|best, next| if self.rank(&next) > self.rank(&best) { next } else { best });
        best.map_or_else(|| self.unknown(), Ok)
    }

    fn rank<P: Protocol>(&self, received: &Received<P>) -> (bool, Option<Rank>) {
        (received.exchange().is_of(self.model), received.addressing().map(|addressing| addressing.rank()))
    }

    /// Says why no message is the frame's.
    ///
    /// # Errors
    ///
    /// Always.
    #[inline(always)]
    pub fn unknown<P: Protocol>(&self) -> Result<Received<P>, Problem> {
        Err(if P::LENGTH.is_some() {
            self.unless_foreign::<P>(Problem::UnknownMessage)
        } else {
            unrecognised::<P>(self.raw_id(), self.frame.byte_count(), self.frame.bytes())
        })
    }

    #[inline(always)]
    fn unless_foreign<P: Protocol>(&self, problem: Problem) -> Problem {
        if P::Identifier::is_foreign(self.raw_id()) { Problem::Foreign } else { problem }
    }
}

/// A frame of a protocol, to be recognised by where it goes.
pub struct IncomingOf<P> {
    frame: Incoming,
    protocol: PhantomData<P>,
}

impl<P: Protocol> Headed for IncomingOf<P> {
    type Output = Result<Received<P>, Problem>;

    #[inline(always)]
    fn to(self, heading: Heading) -> Self::Output {
        if heading == Heading::Neither {
            return Err(self.frame.unless_foreign::<P>(Problem::Identifier));
        }
        P::recognise(&self.frame.to(heading))
    }
}

/// Says why a data frame is none of the protocol, or has a wrong length.
///
/// If all frames have the same length, that takes few instructions. They stand where they are needed, since a call
/// would make decoders save registers.
#[inline(always)]
fn refused<P: Protocol>(id: u32, bytes: &[u8]) -> Problem {
    let Some(length) = u8::try_from(bytes.len()).ok().filter(|length| *length <= 8) else { return Problem::Frame };
    let data = if P::DATA_SELECTORS { padded(bytes) } else { Data::default() };
    if P::LENGTH.is_some() { problem::<P>(id, length, data) } else { unrecognised::<P>(id, length, data) }
}

/// The same as [`problem`], as one function for many messages.
#[cold]
#[inline(never)]
fn unrecognised<P: Protocol>(id: u32, length: u8, data: Data) -> Problem {
    problem::<P>(id, length, data)
}

/// Says why a data frame is not recognised whose identifier has the right width.
///
/// It takes the parts of the frame, or there would have to be a frame in memory.
#[inline(always)]
fn problem<P: Protocol>(id: u32, length: u8, data: Data) -> Problem {
    if P::Identifier::is_foreign(id) {
        return Problem::Foreign;
    }
    let heading = heading::<P>(id);
    if heading == Heading::Neither {
        return Problem::Identifier;
    }
    let incoming = Incoming::new(Frame::new_raw(id, P::FRAME.is_extended(), data, length), None);
    let lengths = P::lengths(&incoming.to(heading));
    if lengths.is_empty() || lengths.contains(&length) { Problem::UnknownMessage } else { Problem::Length }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::heaters::{Heat, Message};

    fn kind_and_message(heading: Heading) -> Result<(Kind, Message), Problem> {
        let incoming = Incoming::new(Frame::new_raw(0x0108_01F0, true, [0; 8], 4), None).to(heading);
        let heat = Message::Heat(Heat { power_w: 20.0 });
        let received = incoming.pair(&Heat::READ, Message::ReadHeat, heat);
        received.map(|received| (received.kind(), *received.content()))
    }

    #[test]
    fn of_a_pair_the_way_of_the_frame_chooses() {
        assert_eq!(kind_and_message(Heading::Module), Ok((Kind::Request, Message::ReadHeat)));
        let heat = Message::Heat(Heat { power_w: 20.0 });
        assert_eq!(kind_and_message(Heading::Controller), Ok((Kind::Reply, heat)));
    }

    #[test]
    fn both_ways_can_carry_the_same_message() {
        let incoming = Incoming::new(Frame::new_raw(0x0107_01F0, true, [0; 8], 4), None);
        for (heading, kind) in [(Heading::Module, Kind::Request), (Heading::Controller, Kind::Reply)] {
            let received = incoming.to(heading).both(&Heat::SET, Message::ReadHeat);
            let found = received.map(|received| (received.kind(), *received.content()));
            assert_eq!(found, Ok((kind, Message::ReadHeat)));
        }
    }
}
