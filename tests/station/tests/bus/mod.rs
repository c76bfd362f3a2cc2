//! A bus of simulated modules with a station.
#![allow(dead_code, reason = "tests and the example use different parts")]

pub mod fleets;

extern crate alloc;

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::time::Duration;

use canspec_runtime::client::{Output, Pace};
use canspec_runtime::clock::has_come;
use canspec_runtime::sim::{Answer, Bench, Complaint, Device, Event, Faults, Rules};
use canspec_runtime::{Addressed, Frame, Protocol, Quantities, Quantity, Received, Time, Timing};
use canspec_station::{Settings, Station};

/// What a module sends by itself.
#[derive(Clone, Copy)]
pub struct Reports<P: Addressed> {
    /// Builds one of the frames that are due together, from the number of the module and their own from 0 on.
    pub build: fn(u8, u8, &Charger<P>) -> Option<Frame>,
    /// The milliseconds from one time to the next.
    pub interval: u32,
    /// When they are due next, and how many were sent since they were due.
    due: u32,
    sent: u8,
}

impl<P: Addressed> Reports<P> {
    pub fn new(build: fn(u8, u8, &Charger<P>) -> Option<Frame>, interval: u32) -> Self {
        Self { build, interval, due: 0, sent: 0 }
    }
}

/// A module of any protocol: it keeps what is set, and tells it.
#[derive(Clone, Copy)]
pub struct Charger<P: Addressed> {
    /// Its group, by number and by address.
    pub group: (u8, P::Target),
    /// Builds what it says to a request that reads.
    pub tell: fn(&Received<P>, &Charger<P>) -> Option<P>,
    /// What it was set to since it started, in mV and mA.
    pub voltage_mv: Option<i32>,
    pub current_ma: Option<i32>,
    pub is_on: bool,
    /// Whether it was ever switched on without a set-point.
    pub was_bare: bool,
    /// How often it was switched on while it was off.
    pub switched_on: u32,
    /// The most by which its current was raised at once.
    pub steepest_ma: i32,
    /// When it started last.
    pub started: u32,
    pub reports: Option<Reports<P>>,
}

impl<P: Addressed> Charger<P> {
    pub fn new(group: (u8, P::Target), tell: fn(&Received<P>, &Self) -> Option<P>) -> Self {
        let (voltage_mv, current_ma, is_on, was_bare) = (None, None, false, false);
        let (switched_on, steepest_ma, started, reports) = (0, 0, 0, None);
        Self { group, tell, voltage_mv, current_ma, is_on, was_bare, switched_on, steepest_ma, started, reports }
    }

    /// Lets the module send something by itself.
    pub fn reporting(self, reports: Reports<P>) -> Self {
        Self { reports: Some(reports), ..self }
    }

    pub fn volts(&self) -> f32 {
        if self.is_on { thousandths(self.voltage_mv) } else { 0.0 }
    }

    pub fn amperes(&self) -> f32 {
        if self.is_on { thousandths(self.current_ma) } else { 0.0 }
    }
}

#[expect(clippy::cast_precision_loss, reason = "what is set has few digits")]
fn thousandths(value: Option<i32>) -> f32 {
    value.unwrap_or_default() as f32 / 1000.0
}

impl<P: Quantities + Addressed> Device<P> for Charger<P>
where
    P::Target: PartialEq,
{
    fn answer(&mut self, request: &Received<P>, _now: u32) -> Answer<P> {
        let [voltage_mv, current_ma, is_on] =
            [Quantity::OUTPUT_VOLTAGE, Quantity::OUTPUT_CURRENT, Quantity::DELIVERING]
                .map(|quantity| request.setting(quantity));
        if let Some(current_ma) = current_ma {
            self.steepest_ma = self.steepest_ma.max(current_ma - self.current_ma.unwrap_or_default());
        }
        (self.voltage_mv, self.current_ma) = (voltage_mv.or(self.voltage_mv), current_ma.or(self.current_ma));
        if let Some(is_on) = is_on {
            self.switched_on += u32::from(is_on == 1 && !self.is_on);
            self.is_on = is_on == 1;
            self.was_bare |= self.is_on && (self.voltage_mv.is_none() || self.current_ma.is_none());
        }
        if voltage_mv.is_none() && current_ma.is_none() && is_on.is_none() {
            return (self.tell)(request, self).map_or(Answer::Silence, Answer::Values);
        }
        Answer::Values(*request.content())
    }

    fn is_asked(&self, request: &Received<P>) -> bool {
        request.target() == Some(self.group.1)
    }

    fn report(&mut self, node: u8, now: u32) -> Option<Frame> {
        let mut reports = self.reports.filter(|reports| has_come(reports.due, now))?;
        let frame = (reports.build)(node, reports.sent, self);
        (reports.due, reports.sent) = match frame {
            Some(_) => (reports.due, reports.sent + 1),
            None => (now.wrapping_add(reports.interval), 0),
        };
        self.reports = Some(reports);
        frame
    }

    fn silence(&mut self, _now: u32) {
        self.is_on = false;
    }

    fn power_on(&mut self, now: u32) {
        self.started = now;
        (self.voltage_mv, self.current_ma, self.is_on) = (None, None, false);
    }
}

/// A station, and the bus with its `N` modules.
pub struct Bus<P: Quantities + Addressed, const N: usize, const G: usize> {
    pub station: Station<P, 16, G, 64>,
    pub bench: Bench<P, Charger<P>, N, 64>,
    pub now: u32,
    /// What the station has sent, and how many frames it has heard.
    pub sent: Vec<(u32, Frame)>,
    pub heard: u64,
}

impl<P: Quantities + Addressed, const N: usize, const G: usize> Bus<P, N, G>
where
    P::Target: PartialEq,
{
    pub fn new(groups: [(u8, P::Target); G], modules: [(u8, Charger<P>); N], seed: u64) -> Self {
        let settings = Settings { pace: pace::<P>(), round: ROUND, rise_ma: RISE_MA };
        Self {
            station: Station::new(settings, core::array::from_fn(|node| u8::try_from(node).expect("below 16")), groups),
            bench: Bench::new(modules, rules::<P>(), seed),
            now: 0,
            sent: Vec::new(),
            heard: 0,
        }
    }

    /// Lets time pass. The station must keep to the rules, and no module may be worse off than it says.
    pub fn run(&mut self, until: u32) {
        while self.now < until {
            self.turn().unwrap_or_else(|complaint| panic!("at {} ms: {complaint}", self.now));
            self.now += 1;
        }
    }

    /// Lets the station read and send what it has to, and fails if it breaks a rule.
    pub fn turn(&mut self) -> Result<(), String> {
        while let Some(event) = self.bench.poll(self.now) {
            match event {
                Event::Frame { frame, .. } => {
                    self.heard += 1;
                    self.station.handle(&frame, self.now);
                }
                // What it has not found yet, it cannot feed.
                Event::Complaint(Complaint::Unfed { node }) if self.state(node).is_none() => {}
                Event::Complaint(complaint) => return Err(complaint.to_string()),
            }
        }
        while let Some(frame) = self.station.poll(self.now) {
            self.sent.push((self.now, frame));
            self.bench.send(&frame, self.now);
        }
        Ok(())
    }

    /// Returns what the station says of a module, if it has found it.
    pub fn state(&self, node: u8) -> Option<Output> {
        self.station.modules().find(|module| module.node == node).map(|module| module.duty.output())
    }

    pub fn device(&mut self, node: u8) -> &mut Charger<P> {
        self.bench.device(node).expect("a module of the bus")
    }

    pub fn faults(&mut self, node: u8) -> &mut Faults {
        self.bench.faults(node).expect("a module of the bus")
    }
}

/// The time from one round to the next.
pub const ROUND: u32 = 3000;

/// How far the current rises in a round.
pub const RISE_MA: i32 = 4000;

/// Returns the times of the document, and chooses those that it does not state.
fn timing<P: Protocol>() -> Timing {
    let Timing { request_gap, reply_timeout, tries, .. } = P::TIMING;
    let chosen = |time: Option<Time>, milliseconds| time.unwrap_or(Time::of(Duration::from_millis(milliseconds)));
    P::TIMING
        .with_request_gap(chosen(request_gap, 20))
        .with_reply_timeout(chosen(reply_timeout, 100))
        .with_tries(tries.unwrap_or(3))
}

/// Returns the pace of the document, and chooses what it does not state.
pub fn pace<P: Protocol>() -> Pace {
    Pace::of(&timing::<P>(), 100).expect("what the document does not state is chosen")
}

/// Returns what the devices of the document expect.
pub fn rules<P: Protocol>() -> Rules {
    let watchdog = P::TIMING.watchdog.map(|time| u32::try_from(time.shortest.as_millis()).expect("it is short"));
    Rules { gap: pace::<P>().gap, watchdog, boot: 1500 }
}
