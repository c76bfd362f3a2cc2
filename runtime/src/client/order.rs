//! What is held in an order: a request is sent only after another one was in effect.

use super::entry::{Entry, State};
use super::hold::Hold;
use super::{Agrees, Client, NotHeld, Ticket};
use crate::clock::{has_come, latest_of};
use crate::{Protocol, Request};

/// The request that another one follows.
#[derive(Clone, Copy, Debug)]
pub struct Leader {
    pub ticket: Ticket,
    /// Whether it has not been in effect since the follower was sent.
    pub is_awaited: bool,
    /// Whether the follower is to be sent again, and it before that.
    pub is_wanted: bool,
    /// How often in turn the follower was sent, and nobody answered.
    pub tries: u8,
}

impl Leader {
    /// Returns a leader that has not been in effect yet.
    const fn new(ticket: Ticket) -> Self {
        Self { ticket, is_awaited: true, is_wanted: false, tries: 0 }
    }
}

impl<P: Protocol, const N: usize, const G: usize> Client<P, N, G> {
    /// Holds a request that is sent only after another one was in effect: a switch-on after its set-point.
    ///
    /// Whenever a round of `first` has shown that it is in effect, the request is sent, once. So it is renewed
    /// as often as `first` is, and each time after it. If its own answer does not come, or says something else,
    /// the module may have restarted. Then both are sent again, `first` before it, as often as the pace says.
    /// An answer that comes after its wait is late. The module is never switched on without its set-point if its
    /// restart outlasts the wait of the switch-on for the bus. What follows another request goes before others that
    /// are due, but for hurried ones. It waits anew while a round of what it follows is due, and
    /// after a program has not called `poll` for a while.
    ///
    /// Another request can follow this one, and so on. When a new round of `first` begins, all that follows it
    /// waits anew, and its answers are late. So renew `first` more slowly than all of them can be answered.
    /// What [replaces](Self::hold) `first` leads in its place. If other values replace it again and again, so fast that
    /// no answer counts, it is never in effect. Then what follows it is never sent. It would otherwise switch on by a
    /// value that is not wanted any more. So leave the time of [`between_values`](super::Pace::between_values) between
    /// two values. Then it is sent within that time if the module answers. If `first` is [cancelled](Self::cancel), or
    /// something that is asked ends it, what follows it ends, too, without an event.
    ///
    /// Another value that is held of the same message and access without an order replaces this request. So a
    /// switch-off is sent at once. To hold the same value keeps the order.
    ///
    /// # Errors
    ///
    /// Refuses what [`hold`](Self::hold) refuses, and a `first` that is not held. Also refuses a request that
    /// would replace `first` or anything that `first` follows.
    pub fn hold_after<R>(
        &mut self,
        first: Ticket,
        request: Request<P, R>,
        agrees: Agrees<P>,
        now: u32,
    ) -> Result<Ticket, NotHeld> {
        let now = self.told(now);
        let entry = Entry::new(self.ticket(), request.untyped(), self.pace, now);
        let mut entries = self.entries.iter().flatten();
        let leader = entries.find(|held| held.ticket == first && held.is_held()).ok_or(NotHeld::First)?;
        let mut replaced = self.entries.iter().flatten().filter(|held| held.is_replaced_by(&entry, &self.groups));
        if replaced.any(|held| self.leaders(first).any(|leader| leader == held.ticket)) {
            return Err(NotHeld::First);
        }
        let (period, leader) = (leader.period, Some(Leader::new(first)));
        self.hold_entry(Entry { period, leader, hold: Some(Hold { agrees, tail: None }), ..entry }, now)
    }

    /// Lets those requests be sent that follow one which is in effect.
    pub(super) fn lead(&mut self, first: Ticket) {
        let begun = self.entries.iter().flatten().find(|entry| entry.ticket == first).map(|entry| entry.begun);
        self.entries.iter_mut().flatten().for_each(|entry| entry.led_by(first, begun));
    }

    /// Lets all that follows a request wait until it is in effect anew.
    pub(super) fn hold_back(&mut self, first: Ticket) {
        for place in 0..N {
            let is_behind = |slot: &Option<Entry<P>>| slot.as_ref().is_some_and(|entry| self.is_behind(entry, first));
            if self.entries.get(place).is_some_and(is_behind) {
                self.entries.get_mut(place).into_iter().flatten().for_each(Entry::wait_anew);
            }
        }
    }

    /// Lets what is due wait anew if what it follows is due, too, or has been in effect for long.
    ///
    /// What is due waits for the gap, and for answers to others. So a program has not called `poll` for a while if
    /// nothing was sent for longer than that.
    pub(super) fn doubt_leaders(&mut self, now: u32) {
        let is_idle = self.busy.is_none();
        for place in 0..N {
            let Some(Some(entry)) = self.entries.get(place) else { continue };
            let Some(leader) = entry.leader.filter(|_| entry.due(now).is_some()) else { continue };
            let is_due = self.leaders(leader.ticket).any(|first| self.is_due(first, now));
            if is_due || is_idle {
                let leader = Leader { is_awaited: true, is_wanted: !is_due, ..leader };
                self.entries.get_mut(place).into_iter().flatten().for_each(|entry| entry.leader = Some(leader));
            }
        }
    }

    /// Tests whether a request is to be sent now.
    pub(crate) fn is_due(&self, ticket: Ticket, now: u32) -> bool {
        self.entries.iter().flatten().any(|entry| entry.ticket == ticket && entry.due(now).is_some())
    }

    /// Renews soon what others follow that are to be sent again.
    pub(super) fn renew_leaders(&mut self, now: u32) {
        for place in 0..N {
            let Some(Some(Entry { leader: Some(leader), .. })) = self.entries.get_mut(place) else { continue };
            if core::mem::take(&mut leader.is_wanted) {
                let first = leader.ticket;
                let head = self.leaders(first).last();
                let mut entries = self.entries.iter_mut().flatten();
                entries.find(|entry| Some(entry.ticket) == head).into_iter().for_each(|entry| entry.renew_soon(now));
            }
        }
    }

    /// Returns a ticket, that of what leads it, and so on.
    fn leaders(&self, first: Ticket) -> impl Iterator<Item = Ticket> {
        let of = |ticket: &Ticket| self.entries.iter().flatten().find(|entry| entry.ticket == *ticket);
        core::iter::successors(Some(first), move |ticket| Some(of(ticket)?.leader?.ticket)).take(N)
    }

    /// Tests whether a request follows another one, perhaps by way of others.
    fn is_behind(&self, entry: &Entry<P>, first: Ticket) -> bool {
        entry.leader.is_some_and(|leader| self.leaders(leader.ticket).any(|leader| leader == first))
    }

    /// Lets what follows a request follow another one instead.
    pub(super) fn lead_instead(&mut self, old: Ticket, new: Ticket) {
        for follower in self.entries.iter_mut().flatten().filter(|entry| entry.follows(old)) {
            follower.leader = Some(Leader::new(new));
        }
        self.hold_back(new);
    }

    /// Ends what follows a request that is not held any more.
    pub(super) fn end_followers(&mut self) {
        while let Some(place) = self.entries.iter().position(|slot| self.is_left(slot.as_ref())) {
            let Some(slot) = self.entries.get_mut(place) else { return };
            *slot = slot.and_then(Entry::cancelled);
        }
    }

    /// Tests whether a request is held after another one that is not held any more.
    fn is_left(&self, entry: Option<&Entry<P>>) -> bool {
        let leader = entry.filter(|entry| entry.is_held()).and_then(|entry| entry.leader);
        let leads = |held: &Entry<P>, first: Ticket| held.ticket == first && held.is_held();
        leader.is_some_and(|leader| !self.entries.iter().flatten().any(|held| leads(held, leader.ticket)))
    }
}

impl<P: Protocol> Entry<P> {
    /// Tests whether it is sent after another request.
    fn follows(&self, first: Ticket) -> bool {
        self.leader.is_some_and(|leader| leader.ticket == first)
    }

    /// Tests whether it is not to be sent before another request is in effect.
    pub fn is_held_back(&self) -> bool {
        self.leader.is_some_and(|leader| leader.is_awaited)
    }

    /// Is to be sent if it follows a request that is in effect. That was sent at a time.
    pub fn led_by(&mut self, first: Ticket, sent: Option<u32>) {
        if self.follows(first) {
            self.be_led(sent);
        }
    }

    fn be_led(&mut self, sent: Option<u32>) {
        self.leader = self.leader.map(|leader| Leader { is_awaited: false, ..leader });
        if let (State::Due { .. }, Some(from)) = (self.state, latest_of(sent, self.deaf())) {
            self.state = State::Due { from };
        }
    }

    /// Waits until what it follows is in effect anew. An answer that still comes is late.
    pub fn wait_anew(&mut self) {
        self.wait_for_leader();
        if self.sent.is_some() && !self.is_resting() {
            self.rest(true);
        }
    }

    /// Begins its next round when no answer to this one can come any more.
    fn renew_soon(&mut self, now: u32) {
        match (self.state, self.period) {
            (State::Resting { until, .. }, Some(period)) => self.round = until.wrapping_sub(period.get()),
            (State::Due { from }, _) if self.tries == 0 && !has_come(from, now) => {
                (self.state, self.round) = (State::Due { from: now }, now);
            }
            (State::Due { .. } | State::Waiting { .. } | State::Resting { .. }, _) => {}
        }
    }

    /// Notes that nobody has answered. Lets what it follows be sent again before it, if it may be sent again.
    pub const fn wants_leader(&mut self) -> bool {
        let Some(leader) = &mut self.leader else { return false };
        let tries = leader.tries.saturating_add(1);
        leader.is_wanted = tries < self.pace.tries;
        leader.tries = if leader.is_wanted { tries } else { 0 };
        leader.is_wanted
    }

    /// Waits until what it follows is in effect anew, which is to be soon.
    pub fn want_leader(&mut self) {
        let Some(leader) = &mut self.leader else { return };
        leader.is_wanted |= !leader.is_awaited || matches!(self.state, State::Due { .. });
        leader.is_awaited = true;
    }

    /// Notes that it is not sent again before what it follows is in effect anew.
    pub fn wait_for_leader(&mut self) {
        self.leader = self.leader.map(|leader| Leader { is_awaited: true, ..leader });
    }
}
