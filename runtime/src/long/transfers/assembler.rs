//! Puts long messages together, for many nodes at a time.

use core::fmt;
use core::marker::PhantomData;

use super::standard::{Sessions, Standard};
use super::{Memory, Transferred, Transport};
use crate::{Exchange, Frame, IdentifierFields, Kind, Protocol, Received};

/// Puts the messages of the transport `T` together, for up to `N` pairs of nodes at a time, each in
/// memory `M`. Without another `M`, there is room for the longest message of the protocol.
#[derive(Clone, Copy)]
pub struct Assembler<T: Transport, const N: usize, M: Memory = <T as Transport>::Memory> {
    pub(super) sessions: <T::Standard as Standard<T>>::Sessions<M, N>,
}

/// What a frame changes.
#[derive(Clone, Copy, Debug)]
#[must_use = "a message can have ended"]
pub struct Event<T: Transport, M: Memory = <T as Transport>::Memory> {
    /// The message that is whole now.
    pub whole: Option<Whole<T, M>>,
    /// The message that was on its way and comes to nothing.
    pub broken: Option<<T::Standard as Standard<T>>::Broken<M>>,
    /// The message that would begin, but comes to nothing.
    pub refused: Option<<T::Standard as Standard<T>>::Broken<M>>,
    /// What the receiver answers. Only the node sends it whose address it shows as that of its sender.
    pub answer: Option<Frame>,
}

/// A message that came whole, in several frames or in one.
#[derive(Clone, Copy)]
pub struct Whole<T: Transport, M: Memory = <T as Transport>::Memory> {
    exchange: &'static Exchange,
    kind: Kind,
    /// The frame, or one that only shows its identifier.
    frame: Frame,
    transfer: Option<<T::Standard as Standard<T>>::Transfer<M>>,
    /// The number of the device model as whose the last frame is recognised, if one was chosen.
    model: Option<u8>,
    transport: PhantomData<T>,
}

impl<T: Transport, M: Memory> Whole<T, M> {
    /// Returns a message that several frames carried. `frame` shows its identifier.
    pub(super) const fn of_frames(
        (exchange, kind): (&'static Exchange, Kind),
        frame: Frame,
        transfer: <T::Standard as Standard<T>>::Transfer<M>,
    ) -> Self {
        Self { exchange, kind, frame, transfer: Some(transfer), model: None, transport: PhantomData }
    }

    /// Returns a message that one frame has room for.
    pub(super) const fn of_one((exchange, kind): (&'static Exchange, Kind), frame: Frame) -> Self {
        Self { exchange, kind, frame, transfer: None, model: None, transport: PhantomData }
    }

    /// Returns the values, if it is the message `L` and has as many data bytes as that can have. A kind
    /// of frame without values has none, and neither has an error reply. Optional values are left out that the device
    /// model of its last frame does not have, unless bits show them.
    pub fn values<L: Transferred<Transport = T>>(&self) -> Option<L> {
        let is_message = self.exchange.message() == L::MESSAGE;
        let values = if is_message && T::Standard::has_values::<L, M>(self) { L::decode(self.data()) } else { None };
        values.map(|values| values.on_model(self.data(), self.model))
    }

    /// Returns the frame, or one that shows the identifier.
    pub(super) const fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Returns the data.
    pub fn data(&self) -> &[u8] {
        match &self.transfer {
            Some(transfer) => transfer.as_ref(),
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
    /// Nothing.
    pub(super) const NONE: Self = Self { whole: None, broken: None, refused: None, answer: None };
}

impl<T: Transport, const N: usize, M: Memory> Default for Assembler<T, N, M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Transport, const N: usize, M: Memory> Assembler<T, N, M> {
    /// Returns an assembler.
    pub const fn new() -> Self {
        Self { sessions: Sessions::NONE }
    }

    /// Takes a frame, and returns what it changes. A frame that is none of the protocol, or of
    /// another message, changes nothing. `now` is a number of milliseconds from any start.
    pub fn receive(&mut self, frame: &impl embedded_can::Frame, now: u32) -> Event<T, M> {
        Received::decode(frame).map_or(Event::NONE, |received| self.take(&received, now))
    }

    /// The same as [`receive`](Self::receive), for a frame that is recognised already.
    pub fn take(&mut self, received: &Received<T::Protocol>, now: u32) -> Event<T, M> {
        let event = self.sessions.take(received, now);
        Event { whole: event.whole.map(|whole| Whole { model: received.model(), ..whole }), ..event }
    }

    /// Gives up a message whose sender has been silent for too long. Call this until it returns
    /// `None`.
    pub fn timed_out(&mut self, now: u32) -> Option<Event<T, M>> {
        self.sessions.timed_out(now)
    }
}

impl<T: Transport, const N: usize, M: Memory> fmt::Debug for Assembler<T, N, M> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Assembler").field("sessions", &self.sessions).finish_non_exhaustive()
    }
}
