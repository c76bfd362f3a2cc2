//! A request of a client, from the first time that it is sent until no answer can come any more.

use core::num::NonZeroU32;

use super::group::Group;
use super::hold::{Hold, Tail};
use super::order::Leader;
use super::{Heard, Nodes, Pace, Step, has_one_answer};
use crate::clock::{earlier, has_come, is_later, later_of, latest_of};
use crate::frame::classic;
use crate::reply::error_code;
use crate::{Protocol, Received, Replies, Request};

/// Names a request of a client.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ticket(pub(super) u32);

/// A request in the table.
#[derive(Clone, Copy, Debug)]
pub struct Entry<P: Protocol> {
    pub ticket: Ticket,
    pub request: Request<P, ()>,
    pub asked: Asked,
    pub pace: Pace,
    /// The time from one round to the next, if it is asked again and again.
    pub period: Option<NonZeroU32>,
    /// Whether it only keeps a module alive: a round is put off if the module has heard something else.
    pub is_spare: bool,
    pub urgency: Urgency,
    /// How it is held, if it is.
    pub hold: Option<Hold<P>>,
    /// The request after which it is sent, if there is one.
    pub leader: Option<Leader>,
    pub state: State,
    /// When this round was due.
    pub round: u32,
    /// When it, or what it replaced, was first sent of those times that `unheard` counts, or its tries.
    pub begun: u32,
    /// When it was sent in this round, if an answer to that can come.
    pub sent: Option<Sent>,
    /// How many of its tries this round has had.
    pub tries: u8,
    /// Whether the request was answered in this round.
    pub has_answer: bool,
    /// How often it, and what it replaced, was sent since this round began or a module answered.
    pub unheard: u8,
    /// Whether the module that it goes to has sent anything since `begun`.
    pub is_heard: bool,
}

/// When a request was sent.
#[derive(Clone, Copy, Debug)]
pub struct Sent {
    /// The first time.
    pub first: u32,
    /// Until when an answer can come.
    pub closes: u32,
}

/// A request that was answered, refused, or is not in effect.
#[derive(Clone, Copy, Debug)]
pub struct Answered {
    /// When it was first sent.
    pub begun: u32,
    /// Its ticket, if an answer has ended its round.
    pub ended: Option<Ticket>,
}

/// Whom an entry asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// A module.
    One(u8),
    /// Several modules, or one without a number below 256.
    Several,
    /// A group that has other members since then. So others can still answer.
    Strangers,
}

/// Whether an entry is sent before all others that are due.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Urgency {
    /// It waits for its turn.
    Usual,
    /// It is sent first.
    Hurried,
}

/// What an entry waits for.
#[derive(Clone, Copy, Debug)]
pub enum State {
    /// It is to be sent.
    Due {
        /// Not before this time.
        from: u32,
    },
    /// It waits for an answer.
    Waiting {
        /// When that has taken too long.
        until: u32,
    },
    /// It has ended, and answers can still come.
    Resting {
        /// When none can come any more.
        until: u32,
        /// Whether it was lost or cancelled.
        is_lost: bool,
    },
}

impl<P: Protocol> Entry<P> {
    pub fn new(ticket: Ticket, request: Request<P, ()>, pace: Pace, now: u32) -> Self {
        Self {
            ticket,
            request,
            asked: request.module().and_then(|number| u8::try_from(number).ok()).map_or(Asked::Several, Asked::One),
            pace,
            period: None,
            is_spare: false,
            urgency: Urgency::Usual,
            hold: None,
            leader: None,
            state: State::Due { from: now },
            round: now,
            begun: now,
            sent: None,
            tries: 0,
            has_answer: false,
            unheard: 0,
            is_heard: false,
        }
    }

    /// Returns the module that it goes to, if it is one.
    pub const fn node(&self) -> Option<u8> {
        if let Asked::One(node) = self.asked { Some(node) } else { None }
    }

    /// Returns since when the request is to be sent, if it is.
    pub fn due(&self, now: u32) -> Option<u32> {
        match self.state {
            State::Due { from } => Some(from).filter(|from| has_come(*from, now) && !self.is_held_back()),
            State::Waiting { .. } | State::Resting { .. } => None,
        }
    }

    /// Tests whether both are due, and this is to be sent first.
    ///
    /// First comes what is hurried. Then comes what keeps a module alive and has waited for a gap, or follows
    /// another request. Then comes what has waited longest.
    #[inline]
    pub fn is_before(&self, other: &Self, now: u32) -> bool {
        let Some((own, others)) = self.due(now).zip(other.due(now)) else { return false };
        let [rank, other_rank] =
            [self, other].map(|entry| (entry.urgency, entry.leader.is_some() || entry.is_overdue(now)));
        rank > other_rank || rank == other_rank && earlier(own, others, now)
    }

    /// Tests whether it keeps a module alive, and has waited for the time from one request to the next.
    fn is_overdue(&self, now: u32) -> bool {
        self.overdue_from().is_some_and(|from| has_come(from, now))
    }

    /// Returns from when on it goes before others since it keeps a module alive, if it waits to be sent.
    fn overdue_from(&self) -> Option<u32> {
        let State::Due { from } = self.state else { return None };
        self.is_spare.then(|| from.wrapping_add(self.pace.gap))
    }

    /// Tests whether this is to be sent before another one, which waits for its first answer that counts.
    pub fn is_to_go_before(&self, other: &Self, now: u32) -> bool {
        !other.listens() && self.is_before(other, now)
    }

    /// Tests whether a frame that answers it belongs to it, also if it does not count.
    pub const fn awaits(&self) -> bool {
        self.is_under_way() && !self.is_resting()
    }

    /// Tests whether an answer counts.
    pub fn listens(&self) -> bool {
        self.sent.is_some() && self.deaf().is_none() && !self.is_resting()
    }

    /// Tests whether a frame that was received then can answer what was sent in this round.
    pub fn was_sent_by(&self, received_at: u32) -> bool {
        // What waits to be sent again may have been passed by another request since no answer could come.
        let is_open = |closes| !matches!(self.state, State::Due { .. }) || has_come(received_at, closes);
        self.sent.is_some_and(|sent| has_come(sent.first, received_at) && is_open(sent.closes))
    }

    /// Returns how surely an answer is for it, the least number first, or `None` if the frame that was received then
    /// cannot answer it. First comes what was sent, then what waits to be sent, then what has ended. Last comes what
    /// strangers can answer.
    pub fn claim(&self, received_at: u32) -> Option<u8> {
        let was_sent = self.was_sent_by(received_at);
        Some(match self.state {
            _ if !was_sent && self.tail_until().is_none() => return None,
            _ if self.asked == Asked::Strangers => 3,
            State::Resting { .. } => 2,
            State::Due { .. } | State::Waiting { .. } => u8::from(!was_sent),
        })
    }

    /// Tests whether its round has ended.
    pub const fn is_resting(&self) -> bool {
        matches!(self.state, State::Resting { .. })
    }

    /// Tests whether an answer to what was sent, or to what was held before, can come in this round.
    pub const fn is_under_way(&self) -> bool {
        self.sent.is_some() || matches!(self.hold, Some(Hold { tail: Some(_), .. }))
    }

    /// Tests whether an answer can come.
    pub fn is_open(&self, now: u32) -> bool {
        match self.state {
            State::Due { .. } => self.open_until().is_some_and(|until| !has_come(until, now)),
            State::Waiting { .. } => true,
            State::Resting { until, .. } => !has_come(until, now),
        }
    }

    /// Returns until when an answer to what was sent, or to what it replaced, can come.
    pub fn open_until(&self) -> Option<u32> {
        let own = match self.state {
            State::Resting { until, .. } => Some(until),
            State::Due { .. } | State::Waiting { .. } => self.sent.map(|sent| sent.closes),
        };
        latest_of(own, self.tail_until())
    }

    /// Notes that the request is sent.
    pub fn start(&mut self, now: u32, group: Option<&mut Group>) {
        if self.tries == 0 && self.unheard == 0 && self.leader.is_none_or(|leader| leader.tries == 0) {
            (self.begun, self.is_heard) = (now, false);
        }
        if let Some(group) = group {
            group.ask(self.ticket, self.tries == 0, now);
        }
        self.wait_for_leader();
        self.tries = self.tries.saturating_add(1);
        self.unheard = self.unheard.saturating_add(1);
        let is_answered = self.request.replies() != Replies::Nobody;
        let [wait, late] = if is_answered { [self.pace.wait, self.pace.late] } else { [0, 0] };
        let until = now.wrapping_add(wait);
        let closes = until.wrapping_add(late);
        let open = self.sent.filter(|sent| !has_come(sent.closes, now));
        let again = |sent: Sent| Sent { closes: later_of(sent.closes, closes), ..sent };
        self.sent = Some(open.map_or(Sent { first: now, closes }, again));
        self.state = State::Waiting { until: self.deaf().map_or(until, |deaf| later_of(until, deaf)) };
    }

    /// Ends a wait that has taken too long, or for which nobody is missing. Says how it ends. Sends the
    /// request again if it may.
    pub fn ended(&mut self, now: u32, group: Option<&Group>) -> Option<Step> {
        if self.unheard_from().is_some_and(|from| has_come(from, now)) {
            self.unheard = 0;
            return Some(Step::Lost(self.ticket));
        }
        let is_complete = group.is_some_and(|group| group.missing.is_empty()) && self.listens();
        let is_over = matches!(self.state, State::Waiting { until } if has_come(until, now));
        if !(is_over || is_complete) {
            return None;
        }
        self.urgency = Urgency::Usual;
        if self.listen(now) {
            return None;
        }
        let is_done = is_complete || self.request.replies() == Replies::Nobody || group.is_none() && self.is_answered();
        if !is_done && self.leader.is_none() && self.tries < self.pace.tries {
            self.state = State::Due { from: now };
            return None;
        }
        self.rest(!is_done);
        if !is_done && self.wants_leader() {
            return None;
        }
        let ticket = self.ticket;
        Some(match group {
            _ if is_done => Step::Done(ticket),
            Some(group) => Step::Missing { ticket, nodes: group.missing },
            None => Step::Lost(ticket),
        })
    }

    /// Tests whether one of several modules has answered, and nobody knows how many there are.
    const fn is_answered(&self) -> bool {
        self.has_answer && self.hold.is_none()
    }

    /// Returns the modules that have sent nothing, after the round was lost.
    pub fn silent(&self, group: Option<&Group>) -> Nodes {
        let own = || self.node().filter(|_| !self.is_heard).into_iter().collect();
        group.map_or_else(own, Group::silent)
    }

    /// Takes a frame for the answer, if it counts as one.
    pub fn answered(
        &mut self,
        received: Received<P>,
        is_refusal: bool,
        model: Option<u8>,
        received_at: u32,
        group: Option<&mut Group>,
    ) -> Heard<P> {
        let ticket = self.ticket;
        if has_come(self.begun, received_at) {
            self.unheard = 0;
        }
        if !self.listens() || !self.was_sent_by(received_at) {
            return Heard::Late { ticket, received };
        }
        let is_starting = is_refusal && received.is_starting();
        let agrees = |hold: Hold<P>| !is_refusal && hold.agrees(&self.request, &received, model);
        let is_good = !is_starting && self.hold.is_none_or(agrees);
        let is_group_known = group.is_some();
        if let Some(group) = group {
            let sender = self.request.sender(received.frame());
            if sender.is_some_and(|node| !group.answered(node, is_good)) {
                return Heard::Twice { ticket, received };
            }
        }
        if is_starting {
            return Heard::Starting { ticket, received };
        }
        if !is_good && !is_refusal {
            return Heard::NotInEffect { ticket, received };
        }
        self.count(is_group_known);
        if is_refusal { Heard::Refusal { ticket, received } } else { Heard::Answer { ticket, received } }
    }

    /// Takes a frame of a wrong length for the answer if it refuses the request.
    pub fn answered_short(
        &mut self,
        frame: &impl embedded_can::Frame,
        received_at: u32,
        is_group_known: bool,
    ) -> Heard<P> {
        let is_open = self.listens() && self.was_sent_by(received_at);
        if !is_open || self.request.refuses(frame) != Some(true) || self.is_told_to_wait(frame) {
            return Heard::Broken(self.ticket);
        }
        self.unheard = 0;
        self.count(is_group_known);
        Heard::ShortRefusal(self.ticket)
    }

    /// Tests whether an answer of any length says that the module starts.
    fn is_told_to_wait(&self, frame: &impl embedded_can::Frame) -> bool {
        let code = || error_code::<P>(self.request.replies().filter()?.data_selectors(), &classic(frame)?);
        P::STARTING.is_some() && code() == P::STARTING
    }

    /// Notes an answer that counts. The round ends if there is only one. It is not sent again if one of nobody
    /// knows how many is enough.
    fn count(&mut self, is_group_known: bool) {
        self.has_answer = true;
        if has_one_answer(&self.request) {
            self.rest(false);
        } else if let (State::Due { from }, false) = (self.state, is_group_known) {
            self.state = State::Waiting { until: from };
        }
    }

    /// Notes that its module has sent something, which perhaps shows what that has heard.
    pub fn has_heard(&mut self, received_at: u32, answered: Option<Answered>) {
        self.is_heard |= has_come(self.begun, received_at);
        if let Some(answered) = answered {
            self.put_off(answered.begun);
        }
    }

    /// Puts a spare round off, since the module has heard what was sent at a time.
    fn put_off(&mut self, sent: u32) {
        let Some(period) = self.period.filter(|_| self.is_spare) else { return };
        let due = sent.wrapping_add(period.get());
        match self.state {
            State::Due { from } if self.tries == 0 => {
                if is_later(due, from) {
                    (self.state, self.round) = (State::Due { from: due }, due);
                }
            }
            State::Due { .. } | State::Waiting { .. } | State::Resting { .. } => {
                if is_later(sent, self.round) {
                    self.round = sent;
                }
            }
        }
    }

    /// Says of a frame that answers a request which has ended.
    pub fn too_late(&self, received: Received<P>, received_at: u32) -> Option<Heard<P>> {
        let State::Resting { is_lost, .. } = self.state else { return None };
        let ticket = self.ticket;
        Some(if is_lost || !self.was_sent_by(received_at) {
            Heard::Late { ticket, received }
        } else {
            Heard::Twice { ticket, received }
        })
    }

    /// Returns the entry after it was cancelled, as long as an answer can come.
    pub fn cancelled(mut self) -> Option<Self> {
        if !self.is_under_way() {
            return None;
        }
        self.period = None;
        if !self.is_resting() {
            self.rest(true);
        }
        Some(self)
    }

    /// Begins the next round after a rest, and returns whether there is one. What is due forgets what was sent before
    /// when no answer to that can come any more.
    #[inline]
    pub fn goes_on(&mut self, now: u32) -> bool {
        match self.state {
            State::Resting { until, .. } if has_come(until, now) => {
                let Some(period) = self.period else { return false };
                if self.leader.is_some() {
                    self.begin(until, now);
                } else {
                    let rounds = now.wrapping_sub(self.round) / period;
                    self.round = self.round.wrapping_add(period.get().wrapping_mul(rounds.max(1)));
                    self.begin(self.round, now);
                }
            }
            State::Due { from } => self.forget(from, now),
            State::Waiting { .. } | State::Resting { .. } => {}
        }
        true
    }

    /// Forgets what was sent before if no answer to that can come any more. Then it listens, and is due since a time.
    fn forget(&mut self, from: u32, now: u32) {
        let Some(until) = self.tail_until().filter(|until| has_come(*until, now)) else { return };
        if self.deaf() == Some(until) {
            self.begin(from, now);
        } else {
            self.set_tail(None);
            self.know_members();
        }
    }

    /// Begins a round, and listens. What can still answer what was sent before is not forgotten.
    pub fn begin(&mut self, from: u32, now: u32) {
        let open = self.open_until().filter(|until| !has_come(*until, now));
        self.set_tail(open.map(Tail::Own));
        (self.state, self.sent, self.tries, self.has_answer) = (State::Due { from }, None, 0, false);
        self.know_members();
    }

    /// Notes that no stranger can answer if nobody can any more.
    fn know_members(&mut self) {
        if !self.is_under_way() && self.asked == Asked::Strangers {
            self.asked = Asked::Several;
        }
    }

    /// Returns from when on what waits to be sent is not answered any more, although it was sent before.
    fn closes(&self) -> Option<u32> {
        let is_due = matches!(self.state, State::Due { .. });
        self.sent.filter(|_| is_due).map(|sent| sent.closes)
    }

    /// Returns the times at which answers to it can come no more, or it goes before others.
    pub fn times(&self) -> [Option<u32>; 4] {
        [self.tail_until(), self.closes(), self.unheard_from(), self.overdue_from()]
    }

    /// Returns when the wait for the last frame is over, or what comes after it.
    pub const fn until(&self) -> u32 {
        match self.state {
            State::Due { from: time } | State::Waiting { until: time } | State::Resting { until: time, .. } => time,
        }
    }

    /// Ends the round, until no answer can come any more.
    pub fn rest(&mut self, is_lost: bool) {
        let until = self.open_until().unwrap_or_else(|| self.until());
        (self.state, self.unheard, self.urgency) = (State::Resting { until, is_lost }, 0, Urgency::Usual);
        self.wait_for_leader();
        if let (Some(leader), false) = (&mut self.leader, is_lost) {
            leader.tries = 0;
        }
    }
}
