//! A client without input and output: it says what to send and when, and what a frame answers.
//!
//! The program owns the bus and the clock. It gives every frame that it receives to
//! [`handle`](Client::handle), and then calls [`poll`](Client::poll) until there is nothing left to do:
//!
//! ```
//! use canspec_runtime::client::{Client, Heard, Step};
//! use canspec_runtime::{Frame, Protocol};
//!
//! fn turn<P: Protocol>(
//!     client: &mut Client<P, 16>,
//!     now: u32,
//!     send: impl Fn(Frame),
//!     received: impl IntoIterator<Item = Frame>,
//! ) {
//!     for frame in received {
//!         match client.handle(&frame, now) {
//!             Heard::Answer { ticket, received } => println!("{ticket:?}: {received:?}"),
//!             // Refusals, late and repeated answers, reports, and frames of others.
//!             _ => {}
//!         }
//!     }
//!     loop {
//!         match client.poll(now) {
//!             Step::Send { frame, .. } => send(frame),
//!             Step::Lost(ticket) => println!("{ticket:?}: nobody answers"),
//!             // Requests that nobody answers, or each of several, and how modules are.
//!             Step::Done(_) | Step::Missing { .. } | Step::Silent(_) | Step::Back(_) | Step::ClockBack(_) => {}
//!             Step::Wait(_) => break,
//!         }
//!     }
//! }
//! ```
//!
//! Every request ends once: as answered, as refused, as lost, or as done if nobody or each module of
//! several answers it. If it is asked [again and again](Client::every), each round ends so.
//! What a device must go on doing is [held](Client::hold). What the program itself cancels, replaces or
//! passes ends without an event.
//!
//! Two requests that one frame could answer are never under way at once. The second one waits until
//! no answer to the first can come. So an answer that comes late is never taken for another one, if
//! the client knows of it in time.
//!
//! Give it every frame that has come before you call `poll`. To the client a frame comes when it is
//! given. While an answer lies unread, `poll` sends its request again or ends it. It can also end the
//! wait for late answers. Then the client takes that answer for one to the next request like it.
//!
//! Time is a number of milliseconds from any [start](crate::clock), and may wrap around. Call `poll` at least once
//! in 24 days. If the clock goes back, no time counts as passed, and [`Step::ClockBack`] says so. A program that then
//! sleeps until a time that it was told before sleeps too long. So sleep for the time that is left, and not until a time.

mod bus;
mod duty;
mod entry;
mod error;
mod group;
mod health;
mod hear;
mod heard;
mod hold;
mod nodes;
mod order;
mod pace;
mod quiet;
mod step;
#[cfg(test)]
mod tests;

pub use bus::Bus;
pub use duty::{Duty, Output};
pub use entry::Ticket;
pub use error::{Full, NotRepeated};
pub use group::NoMembers;
pub use heard::Heard;
pub use hold::{Agrees, NotHeld, repeats};
pub use nodes::Nodes;
pub use pace::Pace;
pub use step::Step;

use core::num::NonZeroU32;

use crate::clock::{LONGEST, Steady, has_come};
use crate::{Protocol, Replies, Request};
use bus::Sending;
use entry::{Entry, Urgency};
use group::Groups;
use health::Health;
use quiet::Quiet;

/// Asks devices, with room for `N` requests, and for `G` groups whose members it knows.
///
/// A request keeps its room until no answer to it can come any more, and for ever if it is asked again
/// and again.
///
/// A client takes 168 bytes. Each request takes 124 on a processor of 32 bits, and 136 on one of 64 bits.
/// Each group takes 120.
#[derive(Clone, Copy, Debug)]
pub struct Client<P: Protocol, const N: usize, const G: usize = 0> {
    pace: Pace,
    model: Option<u8>,
    entries: [Option<Entry<P>>; N],
    groups: Groups<G>,
    health: Health,
    clock: Steady,
    bus: Bus,
    /// When the next frame may be sent, if it must wait.
    free: Option<u32>,
    /// When the gap after the last frame ends. Long after that it is forgotten.
    busy: Option<u32>,
    /// What was sent last, until the next poll.
    last: Option<Sending>,
    /// How long there is nothing to do, if that is known and nothing happens.
    quiet: Option<Quiet>,
    /// Number of the next ticket.
    next: u32,
}

impl<P: Protocol, const N: usize, const G: usize> Client<P, N, G> {
    /// Returns a client that has asked nothing yet.
    pub const fn new(pace: Pace) -> Self {
        let (entries, groups) = ([None; N], Groups([None; G]));
        let (health, clock, bus) = (Health::NEW, Steady::NEW, Bus::On);
        let (free, busy, last, quiet) = (None, None, None, None);
        Self { pace, model: None, entries, groups, health, clock, bus, free, busy, last, quiet, next: 0 }
    }

    /// Reads frames as those of a device model if messages look the same.
    #[must_use]
    pub fn for_model(self, model: impl Into<u8>) -> Self {
        Self { model: Some(model.into()), ..self }
    }

    /// Asks once.
    ///
    /// The request ends what is [held](Self::hold) of the same message by the same access, if it goes to
    /// one of its modules. It may not be known whether it does. What says the same goes on. The ticket of what
    /// is ended has no event. So no renewal undoes a stop of all modules. Reading never ends a held setting.
    ///
    /// The request waits until no answer to an earlier one can be taken for one to it. To hold the new value
    /// instead is faster.
    ///
    /// # Errors
    ///
    /// Refuses a request if there is no room for it. Then nothing ends.
    pub fn ask<R>(&mut self, request: Request<P, R>, now: u32) -> Result<Ticket, Full> {
        self.ask_at(self.pace, request, now)
    }

    /// Asks once, at a pace of its own. It ends what [`ask`](Self::ask) would end.
    ///
    /// # Errors
    ///
    /// Refuses a request if there is no room for it. Then nothing ends.
    pub fn ask_at<R>(&mut self, pace: Pace, request: Request<P, R>, now: u32) -> Result<Ticket, Full> {
        let now = self.told(now);
        self.add_instead(Entry::new(self.ticket(), request.untyped(), pace, now))
    }

    /// Asks again and again, until it is [cancelled](Self::cancel). Each round ends like a request. A
    /// round that comes too late is left out. A period of more than 24 days counts as 2^31 - 1 ms, which is
    /// somewhat more than that. It ends what [`ask`](Self::ask) would end.
    ///
    /// # Errors
    ///
    /// Refuses a request if there is no room for it, and a period of 0 ms. Then nothing ends.
    pub fn every<R>(&mut self, period: u32, request: Request<P, R>, now: u32) -> Result<Ticket, NotRepeated> {
        self.repeat(period, false, request, now)
    }

    /// Asks a module if it has heard nothing for a period, until it is [cancelled](Self::cancel). So a
    /// module whose watchdog runs out in silence is never left alone. A third of that time leaves room for
    /// lost frames.
    ///
    /// An answer to another request is what shows that the module has heard something. The period then
    /// starts anew when that request was sent. If the request goes to more than one module, it is sent in
    /// each period.
    ///
    /// A round that has waited for a gap goes before all others but hurried ones. So it is at most two gaps
    /// late, and one more for each other module whose round is due. What is held in an
    /// [order](Self::hold_after) goes before others in the same way. It is later while its last round is sent
    /// again. It is also later while an answer to another request could be taken for one to it.
    ///
    /// It ends what [`ask`](Self::ask) would end.
    ///
    /// # Errors
    ///
    /// Refuses a request if there is no room for it, and a period of 0 ms. Then nothing ends.
    pub fn keep_alive<R>(&mut self, request: Request<P, R>, period: u32, now: u32) -> Result<Ticket, NotRepeated> {
        self.repeat(period, true, request, now)
    }

    /// Lets time pass until the program tells something, after which there may be something to do.
    fn told(&mut self, now: u32) -> u32 {
        self.quiet = None;
        self.clock.pass(now)
    }

    fn repeat<R>(
        &mut self,
        period: u32,
        is_spare: bool,
        request: Request<P, R>,
        now: u32,
    ) -> Result<Ticket, NotRepeated> {
        let now = self.told(now);
        let period = Some(round(period).ok_or(NotRepeated::Period)?);
        let entry = Entry::new(self.ticket(), request.untyped(), self.pace, now);
        self.add_instead(Entry { period, is_spare, ..entry }).map_err(|Full| NotRepeated::Full)
    }

    /// Returns for how many more requests there is room.
    pub fn room(&self) -> usize {
        self.entries.iter().filter(|slot| slot.is_none()).count()
    }

    /// Returns the module that a request goes to, if it is one.
    pub(crate) fn node(&self, ticket: Ticket) -> Option<u8> {
        self.entries.iter().flatten().find(|entry| entry.ticket == ticket)?.node()
    }

    /// Tests whether a request is [held](Self::hold).
    pub(crate) fn holds(&self, ticket: Ticket) -> bool {
        self.entries.iter().flatten().any(|entry| entry.ticket == ticket && entry.is_held())
    }

    /// Returns how many requests are [held](Self::hold) that go to a module.
    pub(crate) fn held_by(&self, node: u8) -> usize {
        self.entries.iter().flatten().filter(|entry| entry.node() == Some(node) && entry.is_held()).count()
    }

    /// Returns the modules that are silent.
    #[must_use]
    pub const fn silent(&self) -> &Nodes {
        &self.health.silent
    }

    /// Sends a request before all others that are due, if it is due: a stop, for instance. It counts for one
    /// sending. It keeps the gap between requests. It also waits until no answer to another request could be
    /// taken for one to it, but not for answers to what it replaced. Of a group whose members are known, it
    /// waits until the round of another request to that group has ended, also if it is held. With a dead
    /// member, that takes all tries of the round.
    ///
    /// What was asked once by the same message and access, and says something else, ends without an event. That
    /// is so if it could go to one of the same modules. It ends also if it was sent and could be sent again.
    /// Otherwise a switch-on would come after the stop. So a stop of one module ends what was asked of its
    /// group. A hurried switch-on would end a stop that waits, so hurry only stops. [Cancel](Self::cancel)
    /// what is asked [again and again](Self::every) and would undo a stop.
    pub fn hurry(&mut self, ticket: Ticket, now: u32) {
        let now = self.told(now);
        let mut entries = self.entries.iter_mut().flatten();
        if let Some(entry) = entries.find(|entry| entry.ticket == ticket && entry.due(now).is_some()) {
            entry.urgency = Urgency::Hurried;
            let request = *entry;
            self.overtake(&request);
        }
    }

    /// Asks no more, and ends what [follows](Self::hold_after) it. An answer that still comes is late.
    pub fn cancel(&mut self, ticket: Ticket) {
        self.quiet = None;
        let entries = self.entries.iter_mut();
        for slot in entries.filter(|slot| slot.as_ref().is_some_and(|entry| entry.ticket == ticket)) {
            *slot = slot.and_then(Entry::cancelled);
        }
        self.end_followers();
    }

    /// Says what to do next.
    pub fn poll(&mut self, now: u32) -> Step {
        let now = self.clock.pass(now);
        self.last = None;
        if let Some(back) = self.clock.went_back() {
            return Step::ClockBack(back);
        }
        if self.quiet.is_none_or(|quiet| quiet.is_over(now)) {
            if let Some(step) = self.act(now) {
                return step;
            }
            self.quiet = Some(self.quiet_from(now));
        }
        let deadline = self.quiet.and_then(|quiet| quiet.deadline);
        Step::Wait(deadline.map(|time| self.clock.of_program(time)))
    }

    /// Says what to do now, if there is anything.
    fn act(&mut self, now: u32) -> Option<Step> {
        self.free = self.free.filter(|free| !has_come(*free, now));
        self.busy = self.busy.filter(|_| self.idle_from().is_some_and(|from| !has_come(from, now)));
        let ended = self.pass(now);
        if let Some(Step::Done(ticket)) = ended {
            self.lead(ticket);
        }
        let ended = ended.or_else(|| self.health.news());
        ended.or_else(|| self.send(now))
    }

    /// Lets time pass. Begins rounds, and ends a request, and says how.
    fn pass(&mut self, now: u32) -> Option<Step> {
        let Self { entries, groups, health, .. } = self;
        let (mut ended, mut is_led) = (None, false);
        for slot in entries {
            slot.take_if(|entry| !entry.goes_on(now));
            is_led |= slot.as_ref().is_some_and(|entry| entry.leader.is_some());
            let Some(entry) = slot.as_mut().filter(|entry| ended.is_none() && entry.awaits()) else { continue };
            let group = groups.asked_by(entry).map(|group| &*group);
            ended = entry.ended(now, group);
            if let Some(Step::Lost(_) | Step::Missing { .. }) = ended {
                health.lost(&entry.silent(group));
            }
        }
        // When the bus is on again, all that follows another request waits anew.
        if is_led && self.bus == Bus::On {
            self.doubt_leaders(now);
            self.renew_leaders(now);
        }
        ended
    }

    const fn ticket(&self) -> Ticket {
        Ticket(self.next)
    }

    fn add(&mut self, entry: Entry<P>) -> Result<Ticket, Full> {
        let slot = self.entries.iter_mut().find(|slot| slot.is_none()).ok_or(Full)?;
        *slot = Some(entry);
        self.next = self.next.wrapping_add(1);
        Ok(entry.ticket)
    }

    /// Adds a request, and ends what is held that it contradicts.
    fn add_instead(&mut self, entry: Entry<P>) -> Result<Ticket, Full> {
        let ticket = self.add(entry)?;
        self.release(&entry);
        Ok(ticket)
    }

    /// Sends the request that is to be sent first, if the bus is free.
    fn send(&mut self, now: u32) -> Option<Step> {
        if self.free.is_some() || self.bus == Bus::Off {
            return None;
        }
        let mut first: Option<(usize, &Entry<P>)> = None;
        for (place, slot) in self.entries.iter().enumerate() {
            let Some(entry) = slot.as_ref().filter(|entry| entry.due(now).is_some()) else { continue };
            let is_first = first.is_none_or(|(_, first)| entry.is_before(first, now));
            if is_first && !self.is_blocked(entry, now) {
                first = Some((place, entry));
            }
        }
        let (place, _) = first?;
        let entry = self.entries.get_mut(place)?.as_mut()?;
        let (ticket, frame) = (entry.ticket, *entry.request.frame());
        self.last = Some(Sending { ticket, from: entry.until(), sent: entry.sent, busy: self.busy });
        entry.start(now, self.groups.answering(&entry.request));
        self.busy = Some(now.wrapping_add(entry.pace.gap));
        self.free = self.busy.filter(|busy| !has_come(*busy, now));
        if entry.tries == 1 {
            self.hold_back(ticket);
        }
        Some(Step::Send { ticket, frame })
    }

    /// Tests whether another request, under way or to go first, has answers that could be taken for those to this.
    ///
    /// Otherwise the one that has waited longest might never be sent.
    fn is_blocked(&self, own: &Entry<P>, now: u32) -> bool {
        let mut others = self.entries.iter().flatten().filter(|other| other.ticket != own.ticket);
        others.any(|other| {
            let is_first = other.is_to_go_before(own, now);
            let is_awaited = || other.listens() && self.groups.is_asked_by(other);
            (is_first || other.is_open(now)) && self.groups.is_like(own, other)
                || (is_first || is_awaited()) && self.groups.is_shared(own, other)
        })
    }
}

/// Returns the time from one round to the next.
fn round(period: u32) -> Option<NonZeroU32> {
    NonZeroU32::new(period.min(LONGEST))
}

/// Tests whether one module, or one for all, answers a request.
fn has_one_answer<P: Protocol>(request: &Request<P, ()>) -> bool {
    matches!(request.replies(), Replies::One(_) | Replies::Coordinator(_))
}
