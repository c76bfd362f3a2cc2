//! What a station knows of a module, and what it asks of it.

use super::event::Event;
use super::fit::LONGEST;
use super::known::Said;
use super::settings::SetPoint;
use crate::client::{Client, Duty, Output, Ticket};
use crate::clock::{has_come, has_lasted, later_of};
use crate::{Protocol, Quantities, Quantity, Received, Severity};

/// What a module is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// What becomes of modules that are found.
    AsFound,
    /// It is to deliver.
    Deliver(SetPoint),
    /// It is to be off.
    Stop,
    /// It is read only.
    Watch,
    /// It is another controller's.
    Leave,
}

/// An address, and the module that has it if one was found.
#[derive(Clone, Copy, Debug)]
pub struct Module<P: Protocol> {
    /// Its group, if it has said so, or the program.
    pub group: Option<u8>,
    /// Who has said so.
    pub placed: Placed,
    /// When it answered last. It is none before it does, and after it has not for so long that it may act by itself.
    pub heard: Option<u32>,
    /// What it is to do, as requests.
    pub duty: Duty,
    /// What reads it.
    pub reads: [Read; 3],
    /// What was asked once in its last round. What the driver has not taken until the next one is not sent any more.
    pub once: Option<Ticket>,
    /// When it has said whether it delivers.
    pub said_at: u32,
    /// When it said first that it is off, if it is.
    pub off_since: u32,
    pub voltage_mv: Option<Said<i32>>,
    pub current_ma: Option<Said<i32>>,
    /// What it has said of its state last.
    pub status: Option<Said<Received<P>>>,
    /// When its next round begins. None means at once.
    pub due: Option<u32>,
    /// What it is told.
    pub goal: Goal,
    /// Whether all of that is in effect.
    pub is_met: bool,
    /// The current that has been in effect since it was told to deliver, in mA.
    pub reached_ma: i32,
    /// The step to which its current may rise, and since when.
    pub step: Option<Said<i32>>,
    /// Whether it has left a group that delivers, and was not off since then.
    pub has_left: bool,
    /// Whether the document does not allow what it could do in its last round.
    pub is_impossible: bool,
    /// Whether it delivered when it was found.
    pub was_on: Option<bool>,
    pub conflict: Conflict,
    pub told: Told,
}

/// Who has said which group a module is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placed {
    /// Nobody since it answers.
    Unknown,
    /// It has.
    ByItself,
    /// The program has, which knows better.
    ByProgram,
}

/// What a station wants of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Nothing at all.
    Leave,
    /// To be read, and not to be told anything.
    Read,
    /// To be off.
    Off,
    /// To have an output, and to be on, or to stay on or off as it is.
    Output { point: SetPoint, is_on: bool },
}

/// What reads a module.
#[derive(Clone, Copy, Debug)]
pub struct Read {
    pub ticket: Option<Ticket>,
    /// How often it was sent since it was answered or lost.
    pub sent: u8,
    /// Whether it was.
    pub has_ended: bool,
}

/// Whether the answers to a request contradict each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conflict {
    /// They do not.
    None,
    /// They did, and have not since the last round.
    Past,
    /// They do.
    Now,
}

/// What the program was told of a module, and what it is to be told.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    is_found: bool,
    output: Output,
    severity: Option<Severity>,
    has_conflict: bool,
    pub starting: Once,
    pub woke: Once,
    pub unmet: Once,
}

/// Whether something goes on, and was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Once {
    No,
    Yes,
    Told,
}

impl Once {
    /// Notes that it goes on.
    pub fn begin(&mut self) {
        if *self == Self::No {
            *self = Self::Yes;
        }
    }
}

impl Read {
    const NONE: Self = Self { ticket: None, sent: 0, has_ended: true };

    /// Returns what reads by a request, which was not sent yet.
    pub const fn of(ticket: Ticket) -> Self {
        Self { ticket: Some(ticket), ..Self::NONE }
    }

    /// Tests whether a request reads.
    pub const fn is_on(&self) -> bool {
        self.ticket.is_some()
    }

    /// Notes that it is sent.
    const fn start(&mut self) {
        self.sent = if self.has_ended { 1 } else { self.sent.saturating_add(1) };
        self.has_ended = false;
    }
}

impl<P: Protocol> Module<P> {
    pub const fn new(node: u8) -> Self {
        let told = Told {
            is_found: false,
            output: Output::Unknown,
            severity: None,
            has_conflict: false,
            starting: Once::No,
            woke: Once::No,
            unmet: Once::No,
        };
        Self {
            group: None,
            placed: Placed::Unknown,
            heard: None,
            duty: Duty::new(node),
            reads: [Read::NONE; 3],
            once: None,
            said_at: 0,
            off_since: 0,
            voltage_mv: None,
            current_ma: None,
            status: None,
            due: None,
            goal: Goal::Read,
            is_met: false,
            reached_ma: 0,
            step: None,
            has_left: false,
            is_impossible: false,
            was_on: None,
            conflict: Conflict::None,
            told,
        }
    }

    /// Returns its address, as the document counts.
    pub const fn node(&self) -> u8 {
        self.duty.node()
    }

    /// Tests whether it hears what goes to a group. One whose group is not known can be in any.
    pub fn hears(&self, group: u8) -> bool {
        self.group.map_or(self.placed != Placed::ByProgram, |own| own == group)
    }

    /// Returns what is known of its output.
    pub fn output(&self, valid: u32, now: u32) -> Output {
        let is_known = self.heard.is_some() && self.conflict == Conflict::None;
        let said = Said { value: self.duty.output(), at: self.said_at };
        said.fresh(valid, now).filter(|_| is_known).unwrap_or(Output::Unknown)
    }

    /// Tests whether a request reads it.
    pub fn is_read_by(&mut self, ticket: Ticket) -> Option<&mut Read> {
        self.reads.iter_mut().find(|read| read.ticket == Some(ticket))
    }

    /// Notes that a request is sent, if it reads it.
    pub fn sent(&mut self, ticket: Ticket) {
        self.is_read_by(ticket).into_iter().for_each(Read::start);
    }

    /// Notes that a request was not sent after all, if it reads it.
    pub fn not_sent(&mut self, ticket: Ticket) {
        if let Some(read) = self.is_read_by(ticket) {
            read.sent = read.sent.saturating_sub(1);
        }
    }

    /// Notes that nobody has answered a request.
    pub fn lost(&mut self, ticket: Ticket) {
        self.is_read_by(ticket).into_iter().for_each(|read| read.has_ended = true);
    }

    /// Notes that it has answered something. If it had not for long, its round begins at once.
    pub fn answers(&mut self, at: u32) {
        if self.heard.is_none() {
            // What was answered did not read it.
            (self.reads, self.due) = ([Read::NONE; 3], None);
            if self.placed == Placed::ByItself {
                self.placed = Placed::Unknown;
            }
        }
        self.heard = Some(self.heard.map_or(at, |heard| later_of(heard, at)));
    }

    /// Ends all that is asked of it.
    pub fn end<const N: usize, const G: usize>(&mut self, client: &mut Client<P, N, G>) {
        let reads = self.reads.iter_mut().map(|read| &mut read.ticket);
        reads.filter_map(Option::take).for_each(|ticket| client.cancel(ticket));
        self.duty.end(client);
        self.goal = Goal::Read;
    }

    /// Ends what is asked of it, as it may act by itself. It is not read until it answers.
    pub fn lose<const N: usize, const G: usize>(&mut self, client: &mut Client<P, N, G>) {
        self.end(client);
        (self.heard, self.was_on, self.due) = (None, None, None);
        self.rise_anew();
        self.conflict = Conflict::None;
    }

    /// Ends what it is told, and lets it be told anew.
    pub fn tell_anew<const N: usize, const G: usize>(&mut self, client: &mut Client<P, N, G>) {
        self.duty.end(client);
        (self.goal, self.due) = (Goal::Read, None);
    }

    /// Knows only that it is there, since it starts.
    pub fn forget(&mut self) {
        self.duty.forget();
        self.begin_anew();
        (self.voltage_mv, self.current_ma, self.status) = (None, None, None);
    }

    /// Notes that it does not deliver. Its current is to rise from zero, so what it was told is too much.
    fn begin_anew(&mut self) {
        self.due = self.due.filter(|_| self.reached_ma == 0);
        self.rise_anew();
    }

    /// Lets its current rise from zero.
    pub fn rise_anew(&mut self) {
        (self.reached_ma, self.step) = (0, None);
    }

    /// Returns the current to which it may rise, in mA: by a step in each round.
    pub fn step(&mut self, rise_ma: i32, round: u32, now: u32) -> i32 {
        let step = self.step.filter(|step| !has_lasted(step.at, round, now));
        let step = step.unwrap_or(Said { value: self.reached_ma.saturating_add(rise_ma), at: now });
        self.step = Some(step);
        step.value.min(self.reached_ma.saturating_add(rise_ma))
    }

    /// Forgets values that are so old that their age could not be told any more.
    pub fn expire(&mut self, now: u32) {
        let is_old = |at: u32| has_lasted(at, LONGEST, now);
        self.voltage_mv = self.voltage_mv.filter(|said| !is_old(said.at));
        self.current_ma = self.current_ma.filter(|said| !is_old(said.at));
        self.status = self.status.filter(|said| !is_old(said.at));
        if is_old(self.said_at) {
            // It stays old.
            self.said_at = now.wrapping_sub(LONGEST);
        }
        self.off_since = if is_old(self.off_since) { now.wrapping_sub(LONGEST) } else { self.off_since };
        self.step = self.step.filter(|step| !is_old(step.at));
    }

    /// Returns what has happened that the program was not told.
    pub fn news(&mut self, valid: u32, now: u32) -> Option<Event> {
        let node = self.node();
        let output = self.output(valid, now);
        let (is_found, has_conflict) = (self.heard.is_some(), self.conflict != Conflict::None);
        let told = &mut self.told;
        if told.is_found != is_found {
            told.is_found = is_found;
            return Some(if is_found { Event::Found { node } } else { Event::Lost { node } });
        }
        let events = [
            (&mut told.starting, Event::Starting { node }),
            (&mut told.woke, Event::Woke { node }),
            (&mut told.unmet, Event::Unmet { node }),
        ];
        for (happens, event) in events {
            if *happens == Once::Yes {
                *happens = Once::Told;
                return Some(event);
            }
        }
        if told.has_conflict != has_conflict {
            told.has_conflict = has_conflict;
            if has_conflict {
                return Some(Event::Conflict { node });
            }
        }
        if told.output != output {
            told.output = output;
            return Some(Event::Output { node, output });
        }
        let severity = self.status.and_then(|status| severity(&status.value));
        (self.status.is_some() && self.told.severity != severity).then(|| {
            self.told.severity = severity;
            Event::Alarm { node, severity }
        })
    }
}

impl<P: Quantities> Module<P> {
    /// Takes an answer to a request. Returns whether it delivers although it has confirmed that it is to be off.
    pub fn answered(&mut self, ticket: Ticket, received: &Received<P>, at: u32) -> bool {
        self.is_read_by(ticket).into_iter().for_each(|read| read.has_ended = true);
        let (was_met, was_off) = (self.is_met, self.duty.output() == Output::Off);
        self.told.starting = Once::No;
        if self.duty.answered(ticket, received) {
            self.is_met = true;
            if let Goal::Output { point, .. } = self.goal {
                self.told.unmet = Once::No;
                self.reached_ma = point.current_ma.unwrap_or(self.reached_ma);
            }
        }
        if self.duty.output() == Output::Off {
            self.has_left = false;
            self.off_since = if was_off { self.off_since } else { at };
        }
        let is_on = received.quantity(Quantity::DELIVERING);
        if let Some(is_on) = is_on {
            self.status = Some(Said { value: *received, at });
            self.said_at = at;
            self.was_on = self.was_on.or(Some(is_on != 0));
            if is_on == 0 {
                self.begin_anew();
            }
            self.conflict = match self.conflict {
                Conflict::Now => Conflict::Past,
                Conflict::Past | Conflict::None => Conflict::None,
            };
        }
        self.measured(received, at);
        if self.duty.output() == Output::Off && !self.is_impossible {
            self.told.unmet = Once::No;
        }
        let resists = was_met && self.goal == Goal::Off && is_on == Some(1);
        match resists {
            true if was_off => self.told.woke = Once::Yes,
            true => self.told.unmet.begin(),
            false => {}
        }
        resists
    }

    /// Takes measured values.
    pub fn measured(&mut self, received: &Received<P>, at: u32) {
        for (known, quantity) in
            [(&mut self.voltage_mv, Quantity::OUTPUT_VOLTAGE), (&mut self.current_ma, Quantity::OUTPUT_CURRENT)]
        {
            let is_newer = known.is_none_or(|known| has_come(known.at, at));
            let value = received.quantity(quantity).filter(|_| is_newer);
            *known = value.map(|value| Said { value, at }).or(*known);
        }
    }

    /// Takes a second answer to a request. If it was sent once, and something else is said, somebody else says it.
    pub fn answered_twice(&mut self, ticket: Ticket, received: &Received<P>) {
        let is_single = self.is_read_by(ticket).is_some_and(|read| read.sent == 1 && read.has_ended);
        let status = self.status.map(|status| status.value);
        let is_on = status.and_then(|status| status.quantity(Quantity::DELIVERING));
        let value = |said: Option<Said<i32>>| said.map(|said| said.value);
        let known = [
            (is_on, Quantity::DELIVERING),
            (value(self.voltage_mv), Quantity::OUTPUT_VOLTAGE),
            (value(self.current_ma), Quantity::OUTPUT_CURRENT),
        ];
        let is_other = |(known, quantity): (Option<i32>, Quantity)| {
            known.zip(received.quantity(quantity)).is_some_and(|(known, said)| known != said)
        };
        if is_single && known.into_iter().any(is_other) {
            self.conflict = Conflict::Now;
        }
    }
}

/// Returns the worst of what a module reports, if it reports anything with a severity.
pub fn severity<P: Protocol>(status: &Received<P>) -> Option<Severity> {
    status.conditions().filter_map(|bit| bit.severity).max()
}
