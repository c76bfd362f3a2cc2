//! Puts the parts of long messages together, for many nodes at a time.

use core::fmt;

use super::peers::Peers;
use super::{Incomplete, Outcome, Parted, Said, Whole, announced, data, first, has_length, parts_of, size};
use crate::clock::has_lasted;
use crate::long::buffer::Buffer;
use crate::{Frame, Kind, Received};

/// Puts the parts of the message `L` together, from up to `N` nodes at a time.
///
/// Where a message of a node says how many elements arrays have, it remembers the numbers of `N`
/// nodes.
#[derive(Clone, Copy)]
pub struct Assembler<L: Parted, const N: usize> {
    transfers: [Option<Transfer<L>>; N],
    counts: [Option<Count>; N],
    patience: u32,
    model: Option<u8>,
}

/// The parts of one message, up to now.
#[derive(Clone, Copy)]
struct Transfer<L: Parted> {
    peers: Peers,
    buffer: Buffer<L::Memory>,
    /// Whether it is what a node is told: it goes there, or confirms a request with values.
    is_told: bool,
    /// Whether the last frame said that no other follows, or silence did.
    is_ended: bool,
    /// The last frame.
    frame: Frame,
    /// When it came.
    since: u32,
}

/// How many elements a node says that arrays have.
#[derive(Clone, Copy)]
struct Count {
    node: Peers,
    elements: usize,
}

/// A part of a message.
#[derive(Clone, Copy)]
struct Part {
    /// How many parts come before it.
    index: usize,
    /// Its data, as the low bytes of a word.
    word: [u8; 8],
    /// What all parts of its message show.
    counter: u64,
    /// Whether the frame says that no other follows.
    is_last: bool,
}

impl Part {
    fn data<L: Parted>(&self) -> &[u8] {
        self.word.get(8_usize.saturating_sub(size::<L>())..).unwrap_or_default()
    }
}

/// What became of messages by one frame: of the one that its node was sending, and of the one that
/// it belongs to.
#[derive(Clone)]
#[must_use = "these are messages that ended"]
pub struct Outcomes<L: Parted> {
    before: Option<Outcome<L>>,
    own: Option<Outcome<L>>,
}

impl<L: Parted> Outcomes<L> {
    const NONE: Self = Self { before: None, own: None };
}

impl<L: Parted> Iterator for Outcomes<L> {
    type Item = Outcome<L>;

    fn next(&mut self) -> Option<Outcome<L>> {
        self.before.take().or_else(|| self.own.take())
    }
}

impl<L: Parted + fmt::Debug> fmt::Debug for Outcomes<L> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_list().entries(self.before).entries(self.own).finish()
    }
}

impl<L: Parted, const N: usize> Assembler<L, N> {
    /// Returns an assembler. A node times out after `patience` milliseconds of silence.
    pub const fn new(patience: u32) -> Self {
        Self { transfers: [None; N], counts: [None; N], patience, model: None }
    }

    /// Reads frames as those of a device model. Where the number of the first part depends on it,
    /// nothing is put together without one.
    #[must_use]
    pub fn for_model(self, model: impl Into<u8>) -> Self {
        Self { model: Some(model.into()), ..self }
    }

    /// Takes a frame, and returns what became of messages by it. A frame that is none of the
    /// protocol, or says nothing about the message, changes nothing.
    pub fn receive(&mut self, frame: &impl embedded_can::Frame, now: u32) -> Outcomes<L> {
        Received::decode_by(self.model, frame).map_or(Outcomes::NONE, |received| self.take(&received, now))
    }

    /// The same as [`receive`](Self::receive), for a frame that is recognised already, as one of the
    /// assembler's device model.
    pub fn take(&mut self, received: &Received<L::Protocol>, now: u32) -> Outcomes<L> {
        let said = L::SAID(received.content());
        let is_own = received.exchange().message() == L::MESSAGE;
        if said == Said::Nothing && !is_own || received.is_error_reply() {
            return Outcomes::NONE;
        }
        let Some(peers) = Peers::of(received) else { return Outcomes::NONE };
        match (said, self.part(received)) {
            (Said::Part, Some(part)) => self.add(peers, part, received, now),
            (Said::Count(place), _) if place.is_within(received.frame().length()) => {
                let elements = usize::try_from(place.get(&received.frame().bytes())).unwrap_or(usize::MAX);
                self.keep_count(Count { node: peers, elements });
                Outcomes::NONE
            }
            _ if is_own && received.kind() == Kind::Request => {
                let open = self.taken(|open| open.peers.answer(&peers));
                Outcomes { before: open.map(|open| self.ended(&open.at(now), None)), own: None }
            }
            _ => Outcomes::NONE,
        }
    }

    /// Ends a message whose node has been silent for too long, or whose end is a silence. Call this
    /// until it returns `None`.
    pub fn timed_out(&mut self, now: u32) -> Option<Outcome<L>> {
        let patience = L::SILENCE.unwrap_or(self.patience);
        let open = self.taken(|open| has_lasted(open.since, patience, now))?;
        Some(self.ended(&open.at(now), None))
    }

    /// Ends a message whose parts have begun to come. Call this until it returns `None`.
    pub fn finish(&mut self) -> Option<Outcome<L>> {
        let open = self.taken(|_| true)?;
        Some(self.ended(&open, None))
    }

    /// Takes a message out that has begun.
    fn taken(&mut self, is_meant: impl Fn(&Transfer<L>) -> bool) -> Option<Transfer<L>> {
        self.transfers.iter_mut().find(|slot| slot.as_ref().is_some_and(&is_meant))?.take()
    }

    /// Returns the part that a frame carries, if its number is one of the message's.
    fn part(&self, received: &Received<L::Protocol>) -> Option<Part> {
        let data = received.frame().bytes();
        let index = L::NUMBER.get(&data).checked_sub(first::<L>(self.model)?.into())?;
        let index = usize::try_from(index).ok().filter(|index| *index < parts_of::<L>(L::LONGEST))?;
        let continuation = L::CONTINUATION.filter(|_| L::LENGTH.is_none());
        let is_last = continuation.is_some_and(|continuation| !continuation.is_in(received.frame()));
        let counter = counter::<L>(received.frame());
        Some(Part { index, word: L::DATA.get(&data).to_be_bytes(), counter, is_last })
    }

    /// Adds a part to the message that its node sends, or begins another.
    fn add(&mut self, peers: Peers, part: Part, received: &Received<L::Protocol>, now: u32) -> Outcomes<L> {
        let (frame, exchange) = (received.frame(), received.exchange());
        let is_told = peers.is_to_module() || received.kind() == Kind::Reply && exchange.has_values();
        let open = self.taken(|open| open.peers.are(&peers)).map(|open| open.at(now));
        let (open, before) = match open {
            Some(open) if open.repeats(&part) => {
                let kept = self.keep(Transfer { since: now, ..open });
                return Outcomes { before: None, own: kept };
            }
            Some(open) if open.is_before(&part) => (open, None),
            other => (Transfer::new(peers, frame, now), other.map(|open| self.ended(&open, None))),
        };
        let mut open = Transfer { is_told, is_ended: part.is_last, frame: *frame, since: now, ..open };
        open.buffer.put(part.index, part.data::<L>());
        let count = part.index.saturating_add(1);
        let expected = if part.is_last { Some(count) } else { expected::<L>(&open.buffer, self.count(&open)) };
        let is_end = expected.unwrap_or_else(|| parts_of::<L>(L::LONGEST)) <= count;
        let own = if is_end { Some(self.ended(&open, expected)) } else { self.keep(open) };
        Outcomes { before, own }
    }

    /// Keeps a message that goes on, or says that there is no room.
    fn keep(&mut self, open: Transfer<L>) -> Option<Outcome<L>> {
        match self.transfers.iter_mut().find(|slot| slot.is_none()) {
            Some(slot) => {
                *slot = Some(open);
                None
            }
            None => Some(Outcome::Full(open.frame)),
        }
    }

    /// Remembers how many elements a node says that arrays have.
    fn keep_count(&mut self, count: Count) {
        let is_its = |known: &Option<Count>| known.is_some_and(|known| known.node.are_of_module(&count.node));
        let known = self.counts.iter().position(is_its).or_else(|| self.counts.iter().position(Option::is_none));
        if let Some(slot) = known.and_then(|known| self.counts.get_mut(known)) {
            *slot = Some(count);
        }
    }

    /// Returns how many elements the arrays of a message have, if its node has said it. What the node is told may
    /// change that number.
    fn count(&self, open: &Transfer<L>) -> Option<usize> {
        let mut own = self.counts.iter().flatten().filter(|_| !open.is_told);
        let known = own.find(|known| known.node.are_of_module(&open.peers));
        known.map(|known| known.elements)
    }

    /// Returns what became of a message. `expected` is the number of its parts, if the frames say it.
    fn ended(&self, open: &Transfer<L>, expected: Option<usize>) -> Outcome<L> {
        let Transfer { buffer, frame, .. } = *open;
        let (count, is_to_module) = (self.count(open), open.peers.is_to_module());
        let expected = expected.or_else(|| self::expected::<L>(&buffer, count)).unwrap_or(buffer.end());
        let (data, announced) = (data::<L>(&buffer), announced::<L>(&buffer));
        let data = data.get(..announced.unwrap_or_else(|| bytes_with::<L>(count))).unwrap_or(data);
        let is_right = announced.is_none_or(has_length::<L>);
        let values = if is_right && buffer.missing(expected).next().is_none() { L::decode(data) } else { None };
        let values = values.map(|values| values.on_model(data, self.model));
        match values {
            Some(values) => {
                let is_told = count.is_some() || announced.is_some() || open.is_ended;
                let is_counted = L::ELEMENTS.is_none() || is_told;
                Outcome::Whole(Whole { values, is_counted, frame, is_to_module })
            }
            None => Outcome::Incomplete(Incomplete {
                buffer,
                first: first::<L>(self.model).unwrap_or_default(),
                expected,
                frame,
                is_to_module,
            }),
        }
    }
}

impl<L: Parted> Transfer<L> {
    fn new(peers: Peers, frame: &Frame, now: u32) -> Self {
        Self { peers, buffer: Buffer::new(size::<L>()), is_told: false, is_ended: false, frame: *frame, since: now }
    }

    /// Returns what it is at a time: silence may have ended it.
    fn at(self, now: u32) -> Self {
        Self { is_ended: L::SILENCE.is_some_and(|silence| has_lasted(self.since, silence, now)), ..self }
    }

    /// Tests whether a part is the last one once more.
    fn repeats(&self, part: &Part) -> bool {
        let is_index = self.buffer.end() == part.index.saturating_add(1) && self.is_open_to(part);
        is_index && self.buffer.get(part.index) == Some(part.data::<L>())
    }

    /// Tests whether a part can follow those that came.
    fn is_before(&self, part: &Part) -> bool {
        self.buffer.end() <= part.index && self.is_open_to(part)
    }

    /// Tests whether a part can be one of the message.
    fn is_open_to(&self, part: &Part) -> bool {
        !self.is_ended && counter::<L>(&self.frame) == part.counter
    }
}

impl<L: Parted, const N: usize> fmt::Debug for Assembler<L, N> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let nodes = self.transfers.iter().flatten().count();
        formatter.debug_struct("Assembler").field("message", &L::MESSAGE).field("nodes", &nodes).finish_non_exhaustive()
    }
}

/// Returns the number of parts, if it is known.
fn expected<L: Parted>(buffer: &Buffer<L::Memory>, count: Option<usize>) -> Option<usize> {
    let is_known = L::ELEMENTS.is_none() || count.is_some();
    let announced = announced::<L>(buffer).map(|length| parts_of::<L>(length).min(parts_of::<L>(L::LONGEST)));
    announced.or_else(|| is_known.then(|| parts_of::<L>(bytes_with::<L>(count))))
}

/// Returns what all parts of a message show, 0 if there is no such number.
fn counter<L: Parted>(frame: &Frame) -> u64 {
    L::COUNTER.map_or(0, |place| place.get(&frame.bytes()))
}

/// Returns the number of data bytes if arrays that vary in length have some number of elements, or all.
fn bytes_with<L: Parted>(count: Option<usize>) -> usize {
    match (L::ELEMENTS, count) {
        (Some((_, most)), Some(count)) => L::BYTES(count.min(most)),
        _ => L::LONGEST,
    }
}
