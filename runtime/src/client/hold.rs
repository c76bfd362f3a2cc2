//! What is held: sent until its echo agrees, and renewed.

use super::entry::{Asked, Entry, State};
use super::group::Groups;
use super::order::Leader;
use super::{Client, Full, NotRepeated, Ticket, has_one_answer, round};
use crate::clock::{earlier, has_come, latest_of};
use crate::{Protocol, Received, Request};

/// Says whether an echo agrees: whether the second frame says what the first one asks for.
pub type Agrees<P> = fn(&Received<P>, &Received<P>) -> bool;

/// Tests whether an echo says exactly what was asked for.
pub fn repeats<P: Protocol + PartialEq>(asked: &Received<P>, said: &Received<P>) -> bool {
    asked.content() == said.content()
}

/// Why a request is not held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum NotHeld {
    /// There is no room for another request.
    Full,
    /// Nobody is known to answer it. So nothing would show whether it is in effect.
    Unconfirmed,
    /// Something else is held of some of the same modules, and of others. Or it is not known which modules
    /// that are, and the targets differ. Cancel that first.
    Torn(Ticket),
    /// What it is to follow is not held, or would be replaced by it. Or what that follows would be.
    First,
    /// The time from one renewal to the next is 0 ms.
    Period,
}

impl core::fmt::Display for NotHeld {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Full => Full.fmt(formatter),
            Self::Period => NotRepeated::Period.fmt(formatter),
            Self::Unconfirmed => formatter.write_str("nobody is known to answer, so nothing shows what is in effect"),
            Self::First => formatter.write_str("what it is to follow is not held, or would be replaced"),
            Self::Torn(_) => formatter.write_str("something else is held of other modules that are partly the same"),
        }
    }
}

impl core::error::Error for NotHeld {}

/// How an entry is held.
#[derive(Clone, Copy, Debug)]
pub struct Hold<P: Protocol> {
    pub agrees: Agrees<P>,
    /// What can still answer what was sent before this round, if anything can.
    pub tail: Option<Tail>,
}

/// Answers that can still come to what was sent before a round, until a time.
#[derive(Clone, Copy, Debug)]
pub enum Tail {
    /// Answers to what it replaced. So no answer counts.
    Replaced(u32),
    /// Answers to itself, since it was sent when none counted. It is not sent again yet.
    Own(u32),
}

impl<P: Protocol, const N: usize, const G: usize> Client<P, N, G> {
    /// Sends a request until its echo agrees, and renews it every `refresh` milliseconds, until it is
    /// [cancelled](Self::cancel) or replaced. `agrees(asked, said)` compares the request with its
    /// reply. No document states how far an echo may differ, so the program says it. [`repeats`] allows no
    /// difference. [`Received::confirms`](crate::Received::confirms) compares quantities.
    ///
    /// Each round ends once. If the echo agrees, it is an [`Answer`](super::Heard::Answer). If it says
    /// something else, it is [`NotInEffect`](super::Heard::NotInEffect), and the request is sent again
    /// as if nobody had answered. After as many tries as the pace has, the round is
    /// [lost](super::Step::Lost). A refusal ends the round, too. The next renewal tries again.
    ///
    /// To hold what is held already sends nothing, keeps its [order](Self::hold_after), and returns the same
    /// ticket. So a program may call this in a loop.
    ///
    /// A request of the same message by the same access is replaced, if the new one goes to all of its
    /// modules. That is true of what is held, and of what was asked with other values. It does not matter who answers, or
    /// which address of the controller asks. The client does not send the old request after that. Its ticket
    /// ends without an event. So a stop that is held passes a switch-on that was asked.
    ///
    /// The new request does not wait for answers to the old one, and takes its place among those that are
    /// due. As long as an answer to the old one can come that could be taken for one to the new one, every
    /// answer is [`Late`](super::Heard::Late). After that the request is sent once more, and its answer
    /// counts. Others wait for answers to both. A request that is replaced faster than that is never known to be in effect. It is lost,
    /// however, if nobody answers.
    ///
    /// To [`ask`](Self::ask) for the same message and access ends what is held of the modules asked. An earlier
    /// request that also addresses other modules survives, and may be sent after the new value. Unless it may be,
    /// [cancel](Self::cancel) it, or [hurry](Self::hurry) the new value.
    ///
    /// A device that restarts forgets what it was told. So hold all that it must do: the set-point, and
    /// that it is on. [`hold_after`](Self::hold_after) sends the second one only after the first is in effect.
    ///
    /// Of several modules, each must agree, so the client must know its [`members`](Self::members). A round
    /// is [`Done`](super::Step::Done), or [`Missing`](super::Step::Missing) some. What is held of a group
    /// replaces what is held of its members, if they are known.
    ///
    /// # Errors
    ///
    /// Refuses a request
    /// - if there is no room for it,
    /// - if `refresh` is 0 ms,
    /// - if nobody is known to answer it,
    /// - if the same message is held of some of the same modules and of others,
    /// - if it is held of another target, and the modules of one of them are not known.
    pub fn hold<R>(
        &mut self,
        request: Request<P, R>,
        refresh: u32,
        agrees: Agrees<P>,
        now: u32,
    ) -> Result<Ticket, NotHeld> {
        let now = self.told(now);
        let entry = Entry::new(self.ticket(), request.untyped(), self.pace, now);
        let period = Some(round(refresh).ok_or(NotHeld::Period)?);
        let hold = Some(Hold { agrees, tail: None });
        self.hold_entry(Entry { period, hold, ..entry }, now)
    }

    /// Holds a request, and replaces others by it.
    pub(super) fn hold_entry(&mut self, entry: Entry<P>, now: u32) -> Result<Ticket, NotHeld> {
        if !has_one_answer(&entry.request) && self.groups.answering(&entry.request).is_none() {
            return Err(NotHeld::Unconfirmed);
        }
        if let Some(same) = self.entries.iter_mut().flatten().find(|held| held.holds_the_same(&entry)) {
            same.keep_as(&entry);
            return Ok(same.ticket);
        }
        let groups = self.groups;
        if let Some(held) = self.entries.iter().flatten().find(|held| held.is_torn_by(&entry, &groups)) {
            return Err(NotHeld::Torn(held.ticket));
        }
        let is_replaced =
            |slot: &Option<Entry<P>>| slot.as_ref().is_some_and(|held| held.is_replaced_by(&entry, &groups));
        let mut new = entry;
        for place in 0..N {
            let Some(slot) = self.entries.get_mut(place).filter(|slot| is_replaced(slot)) else { continue };
            let Some(old) = slot.take() else { continue };
            let is_like = groups.is_like(&old, &entry);
            new = new.in_place_of(&old, is_like, now);
            // Late answers that could not be taken for one to the new request are still told from others.
            *slot = Some(old).filter(|_| !is_like).and_then(Entry::cancelled);
            if old.is_held() {
                self.lead_instead(old.ticket, entry.ticket);
            }
        }
        self.add(new).or_else(|Full| {
            let slot = self.entries.iter_mut().find(|slot| is_replaced(slot)).ok_or(NotHeld::Full)?;
            *slot = None;
            self.add(new).map_err(|Full| NotHeld::Full)
        })
    }

    /// Ends what was asked once and could undo a request that is to be sent before it.
    pub(super) fn overtake(&mut self, request: &Entry<P>) {
        let Self { entries, groups, .. } = self;
        let would_undo = |slot: &Option<Entry<P>>| slot.as_ref().is_some_and(|asked| asked.would_undo(request, groups));
        for slot in entries.iter_mut().filter(|slot| would_undo(slot)) {
            *slot = slot.and_then(Entry::cancelled);
        }
    }

    /// Ends what is held that a request would contradict.
    pub(super) fn release(&mut self, request: &Entry<P>) {
        let Self { entries, groups, .. } = self;
        let is_released =
            |slot: &Option<Entry<P>>| slot.as_ref().is_some_and(|held| held.is_contradicted_by(request, groups));
        for slot in entries.iter_mut().filter(|slot| is_released(slot)) {
            *slot = slot.and_then(Entry::cancelled);
        }
        self.end_followers();
    }
}

impl<P: Protocol> Hold<P> {
    /// Tests whether a reply shows that a request is in effect.
    pub fn agrees(&self, request: &Request<P, ()>, received: &Received<P>, model: Option<u8>) -> bool {
        let asked = Received::decode_by(model, request.frame());
        asked.is_ok_and(|asked| (self.agrees)(&asked, received))
    }
}

impl<P: Protocol> Entry<P> {
    /// Tests whether it is held, and not cancelled.
    pub const fn is_held(&self) -> bool {
        self.hold.is_some() && self.period.is_some()
    }

    /// Tests whether this is held, and another one would hold exactly the same.
    fn holds_the_same(&self, other: &Self) -> bool {
        self.is_held() && self.is_of_same_exchange(other) && self.request.frame() == other.request.frame()
    }

    /// Goes on as it is, but is renewed and compared as another one that would hold the same, and led if that is.
    fn keep_as(&mut self, other: &Self) {
        let is_new = |leader: &Leader| self.leader.is_none_or(|known| known.ticket != leader.ticket);
        if let Some(leader) = other.leader.filter(is_new) {
            self.leader = Some(leader);
            self.wait_anew();
        }
        let tail = self.hold.and_then(|hold| hold.tail);
        (self.period, self.pace) = (other.period, other.pace);
        self.hold = other.hold.map(|hold| Hold { tail, ..hold });
    }

    /// Tests whether both carry the same message by the same access.
    fn is_of_same_exchange(&self, other: &Self) -> bool {
        self.request.is_of_same_exchange(&other.request)
    }

    /// Tests whether both carry the same data.
    fn says_the_same(&self, other: &Self) -> bool {
        self.request.frame().bytes() == other.request.frame().bytes()
    }

    /// Tests whether another one asks all modules of this one.
    fn is_covered_by<const G: usize>(&self, other: &Self, groups: &Groups<G>) -> bool {
        let is_same_target = self.request.frame().raw_id() == other.request.frame().raw_id();
        let [own, others] = [self, other].map(|entry| groups.reach(entry));
        let is_part = own.zip(others).is_some_and(|(own, others)| own.both(&others) == own);
        is_same_target || is_part || self.modules(other).is_some_and(|[own, other]| own == other)
    }

    /// Tests whether it is known that another one asks none of the modules of this one.
    fn is_apart_from<const G: usize>(&self, other: &Self, groups: &Groups<G>) -> bool {
        let [own, others] = [self, other].map(|entry| groups.reach(entry));
        let is_apart = own.zip(others).is_some_and(|(own, others)| own.both(&others).is_empty());
        is_apart || self.modules(other).is_some_and(|[own, other]| own != other)
    }

    /// Returns the numbers of the modules that both go to, if each goes to one.
    fn modules(&self, other: &Self) -> Option<[i32; 2]> {
        Some([self.request.module()?, other.request.module()?])
    }

    /// Tests whether another one, which is to be held, replaces this one.
    pub fn is_replaced_by<const G: usize>(&self, other: &Self, groups: &Groups<G>) -> bool {
        let is_other = self.hold.is_some() || !self.says_the_same(other);
        is_other && self.is_of_same_exchange(other) && self.is_covered_by(other, groups)
    }

    /// Tests whether this is asked once, and could tell a module of another one something else.
    fn would_undo<const G: usize>(&self, other: &Self, groups: &Groups<G>) -> bool {
        self.period.is_none() && self.differs_from(other, groups)
    }

    /// Tests whether this is held, and another one could tell one of its modules something else.
    fn is_contradicted_by<const G: usize>(&self, other: &Self, groups: &Groups<G>) -> bool {
        self.is_held() && self.differs_from(other, groups)
    }

    /// Tests whether both could tell one module something else by the same message and access.
    fn differs_from<const G: usize>(&self, other: &Self, groups: &Groups<G>) -> bool {
        let is_other = !self.says_the_same(other) && self.is_of_same_exchange(other);
        is_other && !self.is_apart_from(other, groups)
    }

    /// Tests whether another one would contradict this one, but perhaps not for all of its modules.
    fn is_torn_by<const G: usize>(&self, other: &Self, groups: &Groups<G>) -> bool {
        self.is_contradicted_by(other, groups) && !self.is_covered_by(other, groups)
    }

    /// Takes over from what was asked or held before: its place among those that wait, and how often nobody answered
    /// it. What can still answer it also comes over, if that could be taken for an answer to this.
    fn in_place_of(mut self, old: &Self, is_like: bool, now: u32) -> Self {
        if let Some(from) = old.due(now).filter(|from| earlier(*from, self.until(), now)) {
            self.state = State::Due { from };
        }
        if matches!(old.state, State::Due { .. }) {
            self.urgency = self.urgency.max(old.urgency);
        }
        if old.node() == self.node() {
            (self.begun, self.unheard, self.is_heard) = (old.begun, old.unheard, old.is_heard);
        }
        let open = old.open_until().filter(|until| is_like && !has_come(*until, now));
        self.set_tail(latest_of(self.deaf(), open).map(Tail::Replaced));
        if (old.asked, self.asked) == (Asked::Strangers, Asked::Several) && open.is_some() {
            self.asked = Asked::Strangers;
        }
        self
    }

    /// Returns until when an answer to what it replaced can come, or counts as one to it.
    pub const fn deaf(&self) -> Option<u32> {
        if let Some(Hold { tail: Some(Tail::Replaced(until)), .. }) = self.hold { Some(until) } else { None }
    }

    /// Returns until when an answer to what was sent before this round can come.
    pub fn tail_until(&self) -> Option<u32> {
        let (Tail::Replaced(until) | Tail::Own(until)) = self.hold.as_ref()?.tail?;
        Some(until)
    }

    /// Notes what can still answer what was sent before this round.
    pub const fn set_tail(&mut self, tail: Option<Tail>) {
        if let Some(hold) = &mut self.hold {
            hold.tail = tail;
        }
    }

    /// Begins to listen when no answer to what it replaced can come any more. The request is due again.
    pub fn listen(&mut self, now: u32) -> bool {
        let is_deaf = self.deaf().is_some();
        if is_deaf {
            self.begin(now, now);
        }
        is_deaf
    }

    /// Returns from when on nobody answers, if the request was sent often enough, with other values each time.
    pub fn unheard_from(&self) -> Option<u32> {
        let is_unheard = self.awaits() && self.deaf().is_some() && self.unheard >= self.pace.tries.max(1);
        is_unheard.then_some(self.begun.wrapping_add(self.pace.wait))
    }
}
