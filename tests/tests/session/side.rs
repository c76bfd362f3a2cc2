//! What both sides have in common: cycles, waits, long messages both ways, and a memory of what came.

use std::collections::VecDeque;

use canspec_protocols::gbt27930::transfers::{Assembler, Whole};
use canspec_protocols::gbt27930::{Frame, LongLayout, Message, TimeoutState, Tp, Transferred};
use canspec_runtime::Exchange;
use canspec_runtime::schedule::Schedule;
use canspec_runtime::transfers::{Next, Outgoing};

use super::bus::hex;

/// Where a side is. Section 8.1 names the phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    Connected,
    Handshake,
    Recognition,
    Configuration,
    Charging,
    Stop,
    End,
    Done,
    Error,
    /// The connector has to be plugged again.
    Failed,
}

/// Section 8.3: how often a side begins anew after a time-out.
const ATTEMPTS: u32 = 3;
/// Section 8.2: the wait for any message without a time of its own.
pub const GENERAL: u32 = 5000;
/// Section 8.3: the wait until the other side is ready.
pub const READY: u32 = 60_000;
/// Section 8.3: the wait for the statistics of the other side.
pub const STATISTICS: u32 = 10_000;
/// How long a side tells of a time-out, before the charger begins anew or the session has failed. For the charger,
/// section 8.3 has 30 s after CEM, and erratum N12 of the spec: for what it waits is unclear. Here it begins sooner, since
/// a vehicle that has sent BEM waits no longer than 30 s for CRM.
pub const LAST_WORDS: u32 = 3000;

/// Messages that are longer than a frame. Section 4.
const LONG: [&str; 6] = ["brm", "bcp", "bcs", "bmv", "bmt", "bsp"];

/// Returns the cycle of a message. Section 8.4.
fn cycle(name: &str) -> u32 {
    match name {
        "bst" | "cst" => 10,
        "bcl" | "ccs" => 50,
        "bcp" | "cts" => 500,
        "bmv" | "bmt" | "bsp" => 10_000,
        _ => 250,
    }
}

/// A message that a side has received.
#[derive(Clone, Debug, PartialEq)]
pub struct Came {
    pub at: u32,
    pub name: &'static str,
    pub data: String,
}

/// What a side keeps.
pub struct Side {
    pub phase: Phase,
    pub phases: Vec<Phase>,
    /// How many attempts have failed.
    pub attempts: u32,
    /// What it has waited for in vain, in the last attempt.
    pub missed: Option<&'static str>,
    pub came: Vec<Came>,
    cycles: Schedule<&'static str, 8>,
    waits: Schedule<&'static str, 8>,
    outgoing: Outgoing<Tp>,
    assembler: Assembler<Tp, 1>,
    answers: VecDeque<Frame>,
}

impl Side {
    pub fn new() -> Self {
        Self {
            phase: Phase::Connected,
            phases: vec![],
            attempts: 0,
            missed: None,
            came: vec![],
            cycles: Schedule::new(),
            waits: Schedule::new(),
            outgoing: Outgoing::new(),
            assembler: Assembler::new(),
            answers: VecDeque::new(),
        }
    }

    /// Begins a phase.
    pub fn go(&mut self, phase: Phase) {
        self.phase = phase;
        self.phases.push(phase);
    }

    /// Sends messages in their cycles, if it does not yet.
    pub fn repeat(&mut self, names: &[&'static str], now: u32) {
        for name in names {
            if !self.cycles.has(name) {
                self.cycles.every(name, cycle(name), now).expect("room for eight messages");
            }
        }
    }

    /// Sends messages no more.
    pub fn stop(&mut self, names: &[&'static str]) {
        for name in names {
            self.cycles.cancel(name);
        }
    }

    /// Waits for something from now on.
    pub fn wait(&mut self, name: &'static str, longest: u32, now: u32) {
        self.waits.once(name, longest, now).expect("room for eight waits");
    }

    /// Waits for something from now on, unless it does already.
    pub fn wait_first(&mut self, name: &'static str, longest: u32, now: u32) {
        if !self.waits.has(name) {
            self.wait(name, longest, now);
        }
    }

    /// Waits no more for some of it.
    pub fn has(&mut self, names: &[&'static str]) {
        for name in names {
            self.waits.cancel(name);
        }
    }

    /// Tests whether it waits for something.
    pub fn lacks(&self, name: &'static str) -> bool {
        self.waits.has(name)
    }

    /// Tests whether the last attempt has failed.
    pub const fn is_last(&self) -> bool {
        self.attempts > ATTEMPTS
    }

    /// Neither sends nor waits.
    pub fn rest(&mut self) {
        self.cycles.clear();
        self.waits.clear();
        self.outgoing.cancel();
    }

    /// Tells the other side that an attempt has failed, from now on.
    pub fn fail(&mut self, missed: Option<&'static str>, last_words: &'static str, now: u32) {
        self.rest();
        self.go(Phase::Error);
        self.attempts += 1;
        self.missed = missed;
        self.repeat(&[last_words], now);
    }

    /// Says whether it has waited in vain for one of these.
    pub fn missed(&self, names: &[&str]) -> TimeoutState {
        let is_missed = self.missed.is_some_and(|missed| names.contains(&missed));
        if is_missed { TimeoutState::Timeout } else { TimeoutState::Normal }
    }

    /// Begins to send a long message.
    pub fn begin<L: Transferred<Transport = Tp> + LongLayout>(&mut self, exchange: &Exchange, values: &L, now: u32) {
        let blank = exchange.blank_report::<Message>(0xF4).expect("the vehicle reports it");
        self.outgoing.begin(values, &blank, now).expect("it has room");
    }

    fn note(&mut self, name: &'static str, data: &[u8], now: u32) {
        self.came.push(Came { at: now, name, data: hex(data) });
    }
}

/// A vehicle or a charger.
pub trait Station {
    fn side(&mut self) -> &mut Side;

    /// Takes a message in one frame.
    fn hear(&mut self, message: &Message, now: u32);

    /// Takes a message of several frames.
    fn hear_long(&mut self, _whole: &Whole<Tp>, _now: u32) {}

    /// Returns a message in one frame, or begins a long one.
    fn send(&mut self, name: &'static str, now: u32) -> Option<Frame>;

    /// A wait has ended in vain.
    fn time_out(&mut self, wait: &'static str, now: u32);

    /// Takes a frame of the other side.
    fn handle(&mut self, frame: &Frame, now: u32) {
        let side = self.side();
        let _ = side.outgoing.receive(frame, now);
        let event = side.assembler.receive(frame, now);
        side.answers.extend(event.answer);
        if let Some(whole) = event.whole {
            side.note(whole.exchange().message(), whole.data(), now);
            self.hear_long(&whole, now);
        } else if let Ok(received) = Message::decode(frame) {
            side.note(received.exchange().message(), embedded_can::Frame::data(frame), now);
            self.hear(received.content(), now);
        }
    }

    /// Returns the next frame that it sends now.
    fn poll(&mut self, now: u32) -> Option<Frame> {
        loop {
            let side = self.side();
            while let Some(event) = side.assembler.timed_out(now) {
                side.answers.extend(event.answer);
            }
            if let Some(wait) = side.waits.due(now, |_| true) {
                self.time_out(wait, now);
                continue;
            }
            if let Some(frame) = side.answers.pop_front() {
                return Some(frame);
            }
            if let Next::Send(frame) | Next::Lost(frame) = side.outgoing.poll(now) {
                return Some(frame);
            }
            let is_busy = side.outgoing.is_busy();
            let name = side.cycles.due(now, |name| !is_busy || !LONG.contains(&name))?;
            if let Some(frame) = self.send(name, now) {
                return Some(frame);
            }
        }
    }
}
