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
//!         match client.handle(&frame) {
//!             Heard::Answer { ticket, received } => println!("{ticket:?}: {received:?}"),
//!             // Refusals, late and repeated answers, reports, and frames of others.
//!             _ => {}
//!         }
//!     }
//!     loop {
//!         match client.poll(now) {
//!             Step::Send(frame) => send(frame),
//!             Step::Lost(ticket) => println!("{ticket:?}: nobody answers"),
//!             Step::Done(_) => {}
//!             Step::Wait(_) => break,
//!         }
//!     }
//! }
//! ```
//!
//! Every request ends once: as answered, as refused, as lost, or as done if nobody or each module of
//! several answers it.
//!
//! Two requests that one frame could answer are never under way at once. The second one waits until
//! no answer to the first can come. So an answer that comes late is never taken for another one, if
//! the client knows of it in time.
//!
//! Give it every frame that has come before you call `poll`. To the client a frame comes when it is
//! given. While an answer lies unread, `poll` sends its request again or ends it. It can also end the
//! wait for late answers. Then the client takes that answer for one to the next request like it.
//!
//! Time is a number of milliseconds from any start, and may wrap around. Call `poll` at least once
//! in 24 days.

mod entry;
mod hold;
mod pace;
#[cfg(test)]
mod tests;

pub use entry::Ticket;
pub use hold::{Agrees, NotHeld};
pub use pace::Pace;

use core::num::NonZeroU32;

use crate::{Frame, Problem, Protocol, Received, Replies, Request};
use entry::{Entry, State, earlier, has_come};

/// The longest time in milliseconds after which a later time is still told from an earlier one.
const LONGEST: u32 = (1 << 31) - 1;

/// Asks devices, with room for `N` requests. One keeps its room until no answer to it can come any
/// more, and for ever if it is asked again and again.
#[derive(Clone, Copy, Debug)]
pub struct Client<P, const N: usize> {
    pace: Pace,
    model: Option<u8>,
    entries: [Option<Entry<P>>; N],
    /// When the next frame may be sent, unless it may be sent at once.
    free: Option<u32>,
    /// Number of the next ticket.
    next: u32,
}

/// What a program does next.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub enum Step {
    /// It sends this frame now.
    Send(Frame),
    /// A request is lost: it was sent as often as it may be, and no answer came. If it is held, none came
    /// that agrees.
    Lost(Ticket),
    /// A request is done that nobody answers, or that each module of several could answer.
    Done(Ticket),
    /// It waits for a frame, and calls `poll` at this time at the latest, if there is one.
    Wait(Option<u32>),
}

/// What a received frame is to a client.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub enum Heard<P: Protocol> {
    /// It answers a request.
    Answer {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It answers a request that is [held](Client::hold), and says something else. The request waits on.
    NotInEffect {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It refuses a request: it shows an error code, or is the message that says why.
    Refusal {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It refuses a request with another number of bytes than the message has, as an error reply may.
    ShortRefusal(Ticket),
    /// It would answer a request if it had the right length. The request waits on.
    Broken(Ticket),
    /// It answers a request that was lost, or could answer what was held before.
    Late {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It answers a request that has an answer already, as the further parts of a message in `parts`
    /// do. Give them to the assembler, too. A module of a group that answers after [`Step::Done`] is
    /// also here.
    Twice {
        /// The request.
        ticket: Ticket,
        /// The frame.
        received: Received<P>,
    },
    /// It answers nothing that was asked: a report, a reply to somebody else, or a request.
    Other(Received<P>),
    /// It is not recognised.
    Unrecognised(Problem),
}

/// There is no room for another request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

impl core::fmt::Display for Full {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.write_str("there is no room for another request")
    }
}

impl core::error::Error for Full {}

impl<P: Protocol, const N: usize> Client<P, N> {
    /// Returns a client that has asked nothing yet.
    pub const fn new(pace: Pace) -> Self {
        Self { pace, model: None, entries: [None; N], free: None, next: 0 }
    }

    /// Reads frames as those of a device model if messages look the same.
    #[must_use]
    pub fn for_model(self, model: impl Into<u8>) -> Self {
        Self { model: Some(model.into()), ..self }
    }

    /// Asks once.
    ///
    /// # Errors
    ///
    /// Refuses a request if there is no room for it.
    pub fn ask<R>(&mut self, request: Request<P, R>, now: u32) -> Result<Ticket, Full> {
        self.ask_at(self.pace, request, now)
    }

    /// Asks once, at a pace of its own.
    ///
    /// # Errors
    ///
    /// Refuses a request if there is no room for it.
    pub fn ask_at<R>(&mut self, pace: Pace, request: Request<P, R>, now: u32) -> Result<Ticket, Full> {
        self.add(Entry::new(self.ticket(), request.untyped(), pace, now))
    }

    /// Asks again and again, until it is [cancelled](Self::cancel). Each round ends like a request. A
    /// round that comes too late is left out. The period is at least 1 ms. One of more than 24 days
    /// counts as 2^31 - 1 ms, which is somewhat more than that.
    ///
    /// # Errors
    ///
    /// Refuses a request if there is no room for it.
    pub fn every<R>(&mut self, period: u32, request: Request<P, R>, now: u32) -> Result<Ticket, Full> {
        let mut entry = Entry::new(self.ticket(), request.untyped(), self.pace, now);
        entry.period = NonZeroU32::new(period.clamp(1, LONGEST));
        self.add(entry)
    }

    /// Sends a request before all others that are due, if it is due: a stop, for instance. The gap between
    /// requests stays.
    pub fn hurry(&mut self, ticket: Ticket, now: u32) {
        let due = self.entries.iter_mut().flatten().find(|entry| entry.ticket == ticket && entry.due(now).is_some());
        if let Some(entry) = due {
            entry.state = State::Due { from: now.wrapping_sub(LONGEST / 2) };
        }
    }

    /// Asks no more. An answer that still comes is late.
    pub fn cancel(&mut self, ticket: Ticket) {
        let entries = self.entries.iter_mut();
        for slot in entries.filter(|slot| slot.is_some_and(|entry| entry.ticket == ticket)) {
            *slot = slot.filter(Entry::is_under_way).map(Entry::cancelled);
        }
    }

    /// Says what to do next.
    pub fn poll(&mut self, now: u32) -> Step {
        self.free = self.free.filter(|free| !has_come(*free, now));
        for slot in &mut self.entries {
            *slot = slot.and_then(|entry| entry.rested(now));
        }
        let ended = self.entries.iter_mut().flatten().find_map(|entry| entry.ended(now));
        ended.or_else(|| self.send(now)).unwrap_or_else(|| Step::Wait(self.deadline(now)))
    }

    /// Says what a received frame is.
    pub fn handle(&mut self, frame: &impl embedded_can::Frame) -> Heard<P> {
        let mut entries = self.entries.iter_mut().flatten();
        let awaiting = |entry: &&mut Entry<P>| entry.awaits() && entry.request.refuses(frame).is_some();
        let received = match Received::decode_by(self.model, frame) {
            Ok(received) => received,
            Err(Problem::Length) => {
                let short = entries.find(awaiting).map(|entry| entry.answered_short(frame));
                return short.unwrap_or(Heard::Unrecognised(Problem::Length));
            }
            Err(problem) => return Heard::Unrecognised(problem),
        };
        if let Some(entry) = entries.find(awaiting) {
            return entry.answered(received, entry.request.refuses(frame) == Some(true), self.model);
        }
        let past = self.entries.iter().flatten().find_map(|entry| entry.too_late(frame, received));
        past.unwrap_or(Heard::Other(received))
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

    /// Sends the request that has waited longest, if the bus is free.
    fn send(&mut self, now: u32) -> Option<Step> {
        if self.free.is_some() {
            return None;
        }
        let ready = self.entries.iter().enumerate().filter_map(|(place, slot)| Some((place, slot.as_ref()?.due(now)?)));
        let ready = ready.filter(|(place, _)| !self.is_blocked(*place, now));
        let (place, _) = ready.reduce(|one, other| if earlier(other.1, one.1, now) { other } else { one })?;
        let entry = self.entries.get_mut(place)?.as_mut()?;
        entry.start(now);
        self.free = Some(now.wrapping_add(entry.pace.gap)).filter(|free| !has_come(*free, now));
        Some(Step::Send(*entry.request.frame()))
    }

    /// Tests whether an answer to another request could be taken for one to this.
    fn is_blocked(&self, place: usize, now: u32) -> bool {
        let Some(own) = self.entries.get(place).and_then(Option::as_ref) else { return true };
        let others = self.entries.iter().flatten().filter(|other| other.ticket != own.ticket);
        others.filter(|other| other.is_open(now)).any(|other| own.request.is_like(&other.request))
    }

    /// Returns the next time at which something is to do.
    fn deadline(&self, now: u32) -> Option<u32> {
        let free = self.free.unwrap_or(now);
        let times = self.entries.iter().flatten().map(|entry| match entry.state {
            State::Due { from } if earlier(from, free, now) => free,
            State::Due { .. } | State::Waiting { .. } | State::Resting { .. } => entry.until(),
        });
        // What is due and not sent waits for another entry.
        let times = times.filter(|time| !has_come(*time, now));
        times.reduce(|one, other| if earlier(other, one, now) { other } else { one })
    }
}

/// Tests whether one module, or one for all, answers a request.
fn has_one_answer<P: Protocol>(request: &Request<P, ()>) -> bool {
    matches!(request.replies(), Replies::One(_) | Replies::Coordinator(_))
}
