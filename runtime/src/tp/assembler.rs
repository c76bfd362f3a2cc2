//! Puts packets together, for several pairs of nodes at a time.

use super::control::{Control, Reason};
use super::{ALL, Link, Memory, PACKET, packets};
use crate::Data;
use crate::clock::has_lasted;
use crate::long::buffer::Buffer;

/// How long a receiver waits for the next packet, in milliseconds: T1 of the standard.
const NEXT: u32 = 750;

/// How long a receiver waits for the first packet after it has allowed some: T2 of the standard.
const FIRST: u32 = 1250;

/// How often a receiver asks again for packets that are lost.
const REPETITIONS: u8 = 2;

/// Puts the packets of up to `N` pairs of nodes together, each in memory `M`, such as
/// `[u8; memory(1785)]`.
#[derive(Clone, Copy, Debug)]
pub struct Assembler<M, const N: usize> {
    sessions: [Option<Session<M>>; N],
}

/// A message on its way.
#[derive(Clone, Copy, Debug)]
struct Session<M> {
    transfer: Transfer<M>,
    packets: u8,
    limit: u8,
    /// The last packet that the receiver has allowed.
    allowed: u8,
    /// How often the receiver has asked again for packets.
    repetitions: u8,
    since: u32,
    patience: u32,
}

/// A message, or what came of it.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<M> {
    /// Who sends it, and to whom.
    pub link: Link,
    /// Number of its parameter group.
    pub group: u32,
    size: usize,
    buffer: Buffer<M>,
}

/// What a frame changes.
#[derive(Clone, Copy, Debug)]
#[must_use = "a message can have ended"]
pub struct Event<M> {
    /// The message that is whole now.
    pub whole: Option<Transfer<M>>,
    /// The message that was on its way and comes to nothing.
    pub broken: Option<Broken<M>>,
    /// The message that would begin, but comes to nothing.
    pub refused: Option<Broken<M>>,
    /// What the receiver answers, as a control frame from the message's target to its source.
    pub answer: Option<(Link, Data)>,
}

/// A message that comes to nothing.
#[derive(Clone, Copy, Debug)]
pub struct Broken<M> {
    /// What came of it.
    pub transfer: Transfer<M>,
    /// Why.
    pub cause: Cause,
}

/// Why a message comes to nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// One of both has given up.
    Aborted(Reason),
    /// The sender has begun another message.
    Restarted,
    /// The sender was silent for too long.
    Silent,
    /// The size is none that travels so, or needs another number of packets.
    Size,
    /// A packet has a number that the message does not have.
    Number(u8),
    /// A packet came again, with other data.
    Changed(u8),
    /// Packets are missing: of a broadcast at its end, of another message where the receiver has
    /// acknowledged it, or has asked twice for them.
    Lost,
    /// There is no room for it.
    Full,
}

impl<M: Memory> Transfer<M> {
    fn new(link: Link, group: u32, size: u16) -> Self {
        Self { link, group, size: size.into(), buffer: Buffer::new(PACKET) }
    }

    /// Returns the data, without what fills the last packet up. Those of missing packets are 0.
    pub fn data(&self) -> &[u8] {
        let data = self.buffer.data();
        data.get(..self.size).unwrap_or(data)
    }

    /// Returns the numbers of the packets that did not come, which count from 1.
    pub fn missing(&self) -> impl Iterator<Item = u8> {
        let count = packets(self.size).unwrap_or_default();
        self.buffer.missing(count.into()).filter_map(|index| u8::try_from(index.checked_add(1)?).ok())
    }
}

impl<M: Memory> Event<M> {
    pub(crate) const NONE: Self = Self { whole: None, broken: None, refused: None, answer: None };

    fn broken(transfer: Transfer<M>, cause: Cause) -> Self {
        Self { broken: Some(Broken { transfer, cause }), ..Self::NONE }
    }

    /// Adds an answer, which nobody gives to a broadcast.
    fn answered(self, link: Link, control: Control, group: u32) -> Self {
        let answer = (link.target != ALL).then(|| (link.reversed(), control.encode(group)));
        Self { answer, ..self }
    }
}

impl<M: Memory, const N: usize> Default for Assembler<M, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<M: Memory, const N: usize> Assembler<M, N> {
    /// Returns an assembler without sessions.
    pub const fn new() -> Self {
        Self { sessions: [None; N] }
    }

    /// Takes the data of a control frame.
    pub fn control(&mut self, link: Link, data: &Data, now: u32) -> Event<M> {
        let Some((control, group)) = Control::decode(data) else { return Event::NONE };
        match control {
            Control::Rts { size, packets, limit } if link.target != ALL => {
                self.begin(Transfer::new(link, group, size), (packets, limit), now)
            }
            Control::Bam { size, packets } if link.target == ALL => {
                self.begin(Transfer::new(link, group, size), (packets, ALL), now)
            }
            Control::Cts { .. } => self.allow(link.reversed(), group, now),
            Control::EndOfMsgAck { .. } => self.give_up(link.reversed(), group, Cause::Lost),
            Control::Abort(reason) => {
                let event = self.give_up(link, group, Cause::Aborted(reason));
                if event.broken.is_some() {
                    event
                } else {
                    self.give_up(link.reversed(), group, Cause::Aborted(reason))
                }
            }
            Control::Rts { .. } | Control::Bam { .. } => Event::NONE,
        }
    }

    /// Takes the data of a packet. One without a session changes nothing.
    pub fn packet(&mut self, link: Link, data: &Data, now: u32) -> Event<M> {
        let Some(session) = self.take(link, None) else { return Event::NONE };
        match session.add(*data, now) {
            Ok((session, event)) => {
                self.keep(session);
                event
            }
            Err(event) => event,
        }
    }

    /// Gives up a message whose sender has been silent for too long. Call this until it returns
    /// `None`.
    pub fn timed_out(&mut self, now: u32) -> Option<Event<M>> {
        let is_silent = |session: &Session<M>| has_lasted(session.since, session.patience, now);
        let slot = self.sessions.iter_mut().find(|slot| slot.as_ref().is_some_and(is_silent))?;
        Some(slot.take()?.given_up(Cause::Silent, Reason::TIMEOUT))
    }

    /// Ends a message whose sender begins another one.
    pub(crate) fn interrupt(&mut self, link: Link) -> Event<M> {
        self.take(link, None).map_or(Event::NONE, |before| Event::broken(before.transfer, Cause::Restarted))
    }

    /// Begins a message. One that its sender has begun before comes to nothing.
    fn begin(&mut self, transfer: Transfer<M>, (count, limit): (u8, u8), now: u32) -> Event<M> {
        let (link, group) = (transfer.link, transfer.group);
        let event = self.interrupt(link);
        let refused = |cause, reason| {
            let refused = Some(Broken { transfer, cause });
            Event { refused, ..event }.answered(link, Control::Abort(reason), group)
        };
        if packets(transfer.size) != Some(count) {
            return refused(Cause::Size, Reason::OTHER);
        }
        let is_free = self.sessions.iter().any(Option::is_none);
        if !is_free || super::memory(transfer.size) > M::BLANK.as_ref().len() {
            return refused(Cause::Full, Reason::RESOURCES);
        }
        let session =
            Session { transfer, packets: count, limit, allowed: 0, repetitions: 0, since: now, patience: FIRST };
        let (session, cts) = session.asking();
        self.keep(session);
        event.answered(link, cts, group)
    }

    /// Waits for packets that a receiver allows.
    fn allow(&mut self, link: Link, group: u32, now: u32) -> Event<M> {
        if let Some(session) = self.take(link, Some(group)) {
            self.keep(Session { since: now, patience: FIRST, ..session });
        }
        Event::NONE
    }

    fn give_up(&mut self, link: Link, group: u32, cause: Cause) -> Event<M> {
        self.take(link, Some(group)).map_or(Event::NONE, |session| Event::broken(session.transfer, cause))
    }

    /// Takes the session of two nodes out, if it is of a group.
    fn take(&mut self, link: Link, group: Option<u32>) -> Option<Session<M>> {
        let is_meant = |session: &Session<M>| {
            session.transfer.link == link && group.is_none_or(|group| group == session.transfer.group)
        };
        self.sessions.iter_mut().find(|slot| slot.as_ref().is_some_and(is_meant))?.take()
    }

    fn keep(&mut self, session: Session<M>) {
        if let Some(slot) = self.sessions.iter_mut().find(|slot| slot.is_none()) {
            *slot = Some(session);
        }
    }
}

impl<M: Memory> Session<M> {
    /// Asks for the packets that come next: the first that is missing, and those behind it.
    fn asking(self) -> (Self, Control) {
        let next = self.transfer.missing().next().unwrap_or(1);
        let left = self.packets.saturating_sub(next).saturating_add(1);
        let packets = left.min(self.limit.max(1));
        (Self { allowed: next.saturating_sub(1).saturating_add(packets), ..self }, Control::Cts { packets, next })
    }

    /// Takes a packet. Returns the session if it goes on, and what becomes of the message.
    fn add(mut self, [number, chunk @ ..]: Data, now: u32) -> Result<(Self, Event<M>), Event<M>> {
        if let Some(cause) = self.put(number, &chunk) {
            return Err(self.given_up(cause, Reason::OTHER));
        }
        (self.since, self.patience) = (now, NEXT);
        match self.transfer.missing().next() {
            None => Err(self.whole()),
            Some(missing) if number == self.packets || number == self.allowed => self.go_on(missing < number),
            Some(_) => Ok((self, Event::NONE)),
        }
    }

    /// Keeps a packet, or says why the message comes to nothing.
    fn put(&mut self, number: u8, chunk: &[u8]) -> Option<Cause> {
        let index = number.checked_sub(1).filter(|index| *index < self.packets).map(usize::from);
        let Some(index) = index else { return Some(Cause::Number(number)) };
        match self.transfer.buffer.get(index) {
            Some(known) => (known != chunk).then_some(Cause::Changed(number)),
            None => (!self.transfer.buffer.put(index, chunk)).then_some(Cause::Full),
        }
    }

    /// Asks for more where the sender has sent all that it may. `is_lost` says that something of it is missing.
    fn go_on(mut self, is_lost: bool) -> Result<(Self, Event<M>), Event<M>> {
        let Transfer { link, group, .. } = self.transfer;
        self.repetitions = self.repetitions.saturating_add(is_lost.into());
        if link.target == ALL || self.repetitions > REPETITIONS {
            return Err(self.given_up(Cause::Lost, Reason::REPETITIONS));
        }
        let (session, cts) = self.asking();
        Ok((Self { patience: FIRST, ..session }, Event::NONE.answered(link, cts, group)))
    }

    fn whole(self) -> Event<M> {
        let Transfer { link, group, size, .. } = self.transfer;
        let size = u16::try_from(size).unwrap_or(u16::MAX);
        let event = Event { whole: Some(self.transfer), ..Event::NONE };
        event.answered(link, Control::EndOfMsgAck { size, packets: self.packets }, group)
    }

    fn given_up(self, cause: Cause, reason: Reason) -> Event<M> {
        let Transfer { link, group, .. } = self.transfer;
        Event::broken(self.transfer, cause).answered(link, Control::Abort(reason), group)
    }
}
