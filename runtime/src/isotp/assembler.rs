//! Puts frames together, for several pairs of identifiers at a time.

use super::pdu::{CONSECUTIVE, FIRST, Flow, Packet, Pdu, Separation};
use super::{Link, Memory, PADDING, PATIENCE, SIZES};
use crate::clock::has_lasted;
use crate::long::buffer::Buffer;

/// Puts the messages of up to `N` pairs of identifiers together, each in memory `M`, such as
/// `[u8; memory(4095)]`. `L` is what tells pairs apart.
#[derive(Clone, Copy, Debug)]
pub struct Assembler<M, const N: usize, L = Link> {
    sessions: [Option<Session<M, L>>; N],
    block: u8,
    separation: Separation,
    padding: Option<u8>,
}

/// A message on its way.
#[derive(Clone, Copy, Debug)]
struct Session<M, L> {
    transfer: Transfer<M, L>,
    since: u32,
}

/// A message, or what came of it.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<M, L = Link> {
    /// Who sends it, and to whom.
    pub link: L,
    size: usize,
    /// Bytes of the first chunk that are not data: a first frame has fewer than the others.
    head: usize,
    buffer: Buffer<M>,
}

/// What a frame changes.
#[derive(Clone, Copy, Debug)]
#[must_use = "a message can have ended"]
pub struct Event<M, L = Link> {
    /// The message that is whole now.
    pub whole: Option<Transfer<M, L>>,
    /// The message that was on its way and comes to nothing.
    pub broken: Option<Broken<M, L>>,
    /// The message that would begin, but comes to nothing.
    pub refused: Option<Broken<M, L>>,
    /// What the receiver answers, from the message's target to its source.
    pub answer: Option<(L, Packet)>,
}

/// A message that comes to nothing.
#[derive(Clone, Copy, Debug)]
pub struct Broken<M, L = Link> {
    /// What came of it.
    pub transfer: Transfer<M, L>,
    /// Why.
    pub cause: Cause,
}

/// Why a message comes to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The sender has begun another message.
    Restarted,
    /// The sender was silent for too long.
    Silent,
    /// A frame has this number in place of the next one: a frame is lost, late or came again.
    Number(u8),
    /// The receiver has said that it has no room for it.
    Overflow,
    /// There is no room for it.
    Full,
}

impl<M: Memory, L: Copy> Transfer<M, L> {
    /// Returns a message with the data of its only frame, or of its first one, if there is room for them.
    fn new(link: L, size: usize, head: usize, data: &[u8]) -> (Self, bool) {
        let mut transfer = Self { link, size, head, buffer: Buffer::new(CONSECUTIVE) };
        let has_room = super::memory(size) <= M::BLANK.as_ref().len() && transfer.add(head, data);
        (transfer, has_room)
    }

    /// Returns the number of data bytes that the message has.
    pub const fn size(&self) -> usize {
        self.size
    }

    /// Returns the data bytes that came, without what fills the last frame up.
    pub fn data(&self) -> &[u8] {
        let data = self.buffer.data().get(self.head..).unwrap_or_default();
        data.get(..self.size).unwrap_or(data)
    }

    fn missing(&self) -> usize {
        self.size.saturating_sub(self.data().len())
    }

    /// Returns how many frames came.
    fn frames(&self) -> usize {
        self.buffer.end()
    }

    /// Adds the data of a frame behind the others, if there is room for them.
    fn add(&mut self, head: usize, data: &[u8]) -> bool {
        let mut chunk = [0; CONSECUTIVE];
        chunk.iter_mut().skip(head).zip(data).for_each(|(place, byte)| *place = *byte);
        self.buffer.put(self.frames(), &chunk)
    }
}

impl<M: Memory, L: Copy> Event<M, L> {
    pub(crate) const NONE: Self = Self { whole: None, broken: None, refused: None, answer: None };

    fn broken(transfer: Transfer<M, L>, cause: Cause) -> Self {
        Self { broken: Some(Broken { transfer, cause }), ..Self::NONE }
    }

    fn refused(self, transfer: Transfer<M, L>) -> Self {
        Self { refused: Some(Broken { transfer, cause: Cause::Full }), ..self }
    }
}

impl<M: Memory, const N: usize> Default for Assembler<M, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<M: Memory, const N: usize> Assembler<M, N> {
    /// Returns an assembler without sessions. It lets all frames of a message come at once, and
    /// [`PADDING`] fills its answers up.
    pub const fn new() -> Self {
        Self::NEW
    }

    /// Takes the data bytes of a frame. One that the standard tells receivers to ignore changes nothing.
    pub fn receive(&mut self, link: Link, data: &[u8], now: u32) -> Event<M> {
        let event = match Pdu::decode(data) {
            Some(Pdu::Single(data)) => self.single(link, data),
            Some(Pdu::First { size, data }) => self.first(link, usize::try_from(size).unwrap_or(usize::MAX), data, now),
            Some(Pdu::Consecutive { number, data }) => self.consecutive(link, number, data, now),
            Some(Pdu::Flow(flow)) => self.flow(|known| *known == link.reversed(), flow, now),
            None => Event::NONE,
        };
        Event { answer: event.answer.map(|(link, packet)| (link.reversed(), packet)), ..event }
    }
}

/// Pairs of identifiers, however they are told apart. Here an answer stands beside the link of its message.
impl<M: Memory, const N: usize, L: Copy + PartialEq> Assembler<M, N, L> {
    /// An assembler without sessions.
    pub(crate) const NEW: Self =
        Self { sessions: [None; N], block: 0, separation: Separation(0), padding: Some(PADDING) };

    /// Asks senders to wait for an answer after a block of frames, unless it is 0, and to leave time
    /// between frames.
    #[must_use]
    pub const fn pacing(self, block: u8, separation: Separation) -> Self {
        Self { block, separation, ..self }
    }

    /// Fills answers up to eight bytes with another byte, or not at all.
    #[must_use]
    pub const fn padded(self, padding: Option<u8>) -> Self {
        Self { padding, ..self }
    }

    /// Gives up a message whose sender has been silent for too long. Call this until it returns
    /// `None`. A frame that comes too late gives its message up, too.
    pub fn timed_out(&mut self, now: u32) -> Option<Event<M, L>> {
        let is_silent = |session: &Session<M, L>| has_lasted(session.since, PATIENCE, now);
        let slot = self.sessions.iter_mut().find(|slot| slot.as_ref().is_some_and(is_silent))?;
        Some(Event::broken(slot.take()?.transfer, Cause::Silent))
    }

    pub(crate) fn single(&mut self, link: L, data: &[u8]) -> Event<M, L> {
        let event = self.restarted(link);
        let (transfer, has_room) = Transfer::new(link, data.len(), 0, data);
        if has_room { Event { whole: Some(transfer), ..event } } else { event.refused(transfer) }
    }

    pub(crate) fn first(&mut self, link: L, size: usize, data: &[u8], now: u32) -> Event<M, L> {
        let event = self.restarted(link);
        let (transfer, has_room) = Transfer::new(link, size, CONSECUTIVE - FIRST, data);
        let is_free = self.sessions.iter().any(Option::is_none);
        if !has_room || !is_free || !SIZES.contains(&size) {
            return self.answering(event.refused(transfer), link, Flow::Overflow);
        }
        self.keep(Session { transfer, since: now });
        self.allowing(event, link)
    }

    pub(crate) fn consecutive(&mut self, link: L, number: u8, data: &[u8], now: u32) -> Event<M, L> {
        let Some(Session { mut transfer, since }) = self.take(link) else { return Event::NONE };
        if has_lasted(since, PATIENCE, now) {
            return Event::broken(transfer, Cause::Silent);
        }
        if transfer.frames() & 0xF != number.into() {
            return Event::broken(transfer, Cause::Number(number));
        }
        if data.len() < transfer.missing().min(CONSECUTIVE) {
            self.keep(Session { transfer, since });
            return Event::NONE;
        }
        // The first frame has made sure that there is room.
        _ = transfer.add(0, data);
        if transfer.missing() == 0 {
            return Event { whole: Some(transfer), ..Event::NONE };
        }
        let link = transfer.link;
        self.keep(Session { transfer, since: now });
        let in_block = transfer.frames().saturating_sub(1).checked_rem(self.block.into());
        if in_block == Some(0) { self.allowing(Event::NONE, link) } else { Event::NONE }
    }

    /// Takes what the receiver of a message answers, if somebody listens to both.
    pub(crate) fn flow(&mut self, is_meant: impl Fn(&L) -> bool, flow: Flow, now: u32) -> Event<M, L> {
        let Some(session) = self.take_any(is_meant) else { return Event::NONE };
        if flow == Flow::Overflow {
            return Event::broken(session.transfer, Cause::Overflow);
        }
        if has_lasted(session.since, PATIENCE, now) {
            return Event::broken(session.transfer, Cause::Silent);
        }
        self.keep(Session { since: now, ..session });
        Event::NONE
    }

    /// Ends the message that a sender has begun before.
    pub(crate) fn restarted(&mut self, link: L) -> Event<M, L> {
        self.take(link).map_or(Event::NONE, |session| Event::broken(session.transfer, Cause::Restarted))
    }

    fn allowing(&self, event: Event<M, L>, link: L) -> Event<M, L> {
        self.answering(event, link, Flow::Continue { block: self.block, separation: self.separation })
    }

    fn answering(&self, event: Event<M, L>, link: L, flow: Flow) -> Event<M, L> {
        Event { answer: Some((link, flow.encode(self.padding))), ..event }
    }

    /// Takes the session of a pair of identifiers out.
    fn take(&mut self, link: L) -> Option<Session<M, L>> {
        self.take_any(|known| *known == link)
    }

    fn take_any(&mut self, is_meant: impl Fn(&L) -> bool) -> Option<Session<M, L>> {
        let is_meant = |session: &Session<M, L>| is_meant(&session.transfer.link);
        self.sessions.iter_mut().find(|slot| slot.as_ref().is_some_and(is_meant))?.take()
    }

    fn keep(&mut self, session: Session<M, L>) {
        if let Some(slot) = self.sessions.iter_mut().find(|slot| slot.is_none()) {
            *slot = Some(session);
        }
    }
}
