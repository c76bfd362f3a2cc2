//! A bus of simulated modules with a station.
#![allow(dead_code, reason = "tests and the example use different parts")]

pub mod fleets;

extern crate alloc;

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use canspec_runtime::client::Output;
use canspec_runtime::clock::has_come;
use canspec_runtime::sim::{Answer, Bench, Complaint, Device, Event, Faults, Rules};
use canspec_runtime::station::{Event as Told, Rival, SetPoint, Step};
use canspec_runtime::{Addressed, AfterSilence, Frame, Protocol, Quantities, Quantity, Received};
use canspec_station::{Chargers, chargers, pace};

/// The time from a frame of another controller to its next one, if it sends it once.
pub const ONCE: u32 = u32::MAX / 4;

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
    /// The most by which its output rose at once, in mA.
    pub steepest_ma: i32,
    /// The current that it was told before it started anew. Its output may rise to that once, as nobody knows yet that
    /// it has started.
    pub before_ma: Option<i32>,
    /// When it started last.
    pub started: u32,
    /// What it does after silence, and whether it was on before that.
    pub after_silence: AfterSilence,
    pub was_on: Option<bool>,
    /// Whether it does not do what it is told.
    pub is_stuck: bool,
    /// How often it has started by itself, after silence.
    pub starts: u64,
    pub reports: Option<Reports<P>>,
}

impl<P: Addressed> Charger<P> {
    pub fn new(group: (u8, P::Target), tell: fn(&Received<P>, &Self) -> Option<P>) -> Self {
        Self {
            group,
            tell,
            voltage_mv: None,
            current_ma: None,
            is_on: false,
            was_bare: false,
            switched_on: 0,
            steepest_ma: 0,
            before_ma: None,
            started: 0,
            after_silence: P::AFTER_SILENCE,
            was_on: None,
            is_stuck: false,
            starts: 0,
            reports: None,
        }
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

    /// Returns the current of its output, in mA. It delivers as much as it may.
    pub fn delivered_ma(&self) -> i32 {
        self.current_ma.filter(|_| self.is_on).unwrap_or_default()
    }

    /// Notes that its output has risen from a current.
    fn note_rise(&mut self, from_ma: i32) {
        if self.delivered_ma() > from_ma {
            let from_ma = from_ma.max(self.before_ma.take().unwrap_or_default());
            self.steepest_ma = self.steepest_ma.max(self.delivered_ma() - from_ma);
        }
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
        let from_ma = self.delivered_ma();
        (self.voltage_mv, self.current_ma) = (voltage_mv.or(self.voltage_mv), current_ma.or(self.current_ma));
        if let Some(is_on) = is_on.filter(|_| !self.is_stuck) {
            self.switched_on += u32::from(is_on == 1 && !self.is_on);
            self.is_on = is_on == 1;
            let has_current =
                self.current_ma.is_some() || !P::SETS.iter().any(|path| path.quantity == Quantity::OUTPUT_CURRENT);
            self.was_bare |= self.is_on && !(self.voltage_mv.is_some() && has_current);
        }
        self.note_rise(from_ma);
        if voltage_mv.is_none() && current_ma.is_none() && is_on.is_none() {
            return (self.tell)(request, self).map_or(Answer::Silence, Answer::Values);
        }
        Answer::Values(*request.content())
    }

    fn is_asked(&self, request: &Received<P>) -> bool {
        request.target() == Some(self.group.1)
    }

    fn wake(&mut self, _now: u32) {
        self.is_on = self.was_on.take().unwrap_or(self.is_on);
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
        match self.after_silence {
            // What the document does not say could be the worst.
            AfterSilence::Resumes | AfterSilence::Unknown => {
                (self.was_on, self.is_on) = (Some(self.is_on), false);
            }
            AfterSilence::Off => self.is_on = false,
            AfterSilence::Starts => {
                self.starts += u64::from(!self.is_on);
                self.is_on = true;
            }
            AfterSilence::Keeps => {}
        }
    }

    fn power_on(&mut self, now: u32) {
        self.started = now;
        self.before_ma = self.current_ma.or(self.before_ma);
        (self.voltage_mv, self.current_ma, self.is_on, self.was_on) = (None, None, false, None);
    }
}

/// A station, and the bus with its `N` modules.
pub struct Bus<P: Quantities + Addressed, const N: usize, const G: usize> {
    pub station: Chargers<P, G>,
    pub bench: Bench<P, Charger<P>, N, 64>,
    /// The time of the bus, and how far the program's clock is ahead.
    pub now: u32,
    pub ahead: u32,
    /// Whether the driver takes no frame, and gives none.
    pub is_down: bool,
    /// Whether the program stands still while the driver keeps frames, with the times at which they came.
    pub is_stalled: bool,
    pub kept: Vec<(Frame, u32)>,
    /// Until when modules may not be fed, since the bus was away.
    pub excused: u32,
    /// What the station has sent, and how many frames it has heard.
    pub sent: Vec<(u32, Frame)>,
    pub heard: u64,
    /// What it has told.
    pub events: Vec<(u32, Told)>,
}

impl<P: Quantities + Addressed, const N: usize, const G: usize> Bus<P, N, G>
where
    P::Target: PartialEq,
{
    pub fn new(groups: [(u8, P::Target); G], modules: [(u8, Charger<P>); N], seed: u64) -> Self {
        let station = chargers(groups.map(|(number, target)| (number, Some(target)))).expect("it fits the document");
        Self::of(station, modules, seed)
    }

    /// Returns a bus with a station.
    pub fn of(station: Chargers<P, G>, modules: [(u8, Charger<P>); N], seed: u64) -> Self {
        Self {
            station,
            bench: Bench::new(modules, rules::<P>(), seed),
            now: 0,
            ahead: 0,
            is_down: false,
            is_stalled: false,
            kept: Vec::new(),
            excused: 0,
            sent: Vec::new(),
            heard: 0,
            events: Vec::new(),
        }
    }

    /// Lets time pass. The station must keep to the rules, and no module may be worse off than it says.
    pub fn run(&mut self, until: u32) {
        while self.now < until {
            self.turn().unwrap_or_else(|complaint| panic!("at {} ms: {complaint}", self.now));
            self.now += 1;
        }
    }

    /// Lets time pass, in which modules may not be fed.
    pub fn run_unfed(&mut self, until: u32) {
        self.excused = until;
        self.run(until);
    }

    /// Lets a group deliver from now on, and time pass.
    pub fn deliver(&mut self, group: u8, point: SetPoint, until: u32) {
        self.station.deliver(group, point, self.clock()).expect("the document allows it");
        self.run(until);
    }

    /// Stops a group, and lets time pass.
    pub fn stop(&mut self, group: u8, until: u32) {
        self.station.stop(group, self.clock()).expect("the group is known");
        self.run(until);
    }

    /// Lets the station read and send what it has to, and fails if it breaks a rule.
    pub fn turn(&mut self) -> Result<(), String> {
        self.receive()?;
        self.act();
        Ok(())
    }

    /// Lets the driver keep what comes, and fails if the station has broken a rule.
    pub fn receive(&mut self) -> Result<(), String> {
        while let Some(event) = self.bench.poll(self.now) {
            match event {
                Event::Frame { .. } if self.is_down => {}
                Event::Frame { frame, at } => self.kept.push((frame, at.wrapping_add(self.ahead))),
                // What it has not found yet, it cannot feed.
                Event::Complaint(Complaint::Unfed { node }) if self.state(node).is_none() => {}
                Event::Complaint(Complaint::Unfed { .. }) if self.now < self.excused => {}
                Event::Complaint(complaint) => return Err(complaint.to_string()),
            }
        }
        Ok(())
    }

    /// Lets the station read and send what it has to, unless the program stands still.
    pub fn act(&mut self) {
        if self.is_stalled {
            return;
        }
        for (frame, at) in self.kept.drain(..) {
            self.heard += 1;
            self.station.handle(&frame, at);
        }
        loop {
            match self.station.poll(self.clock()) {
                Step::Send { ticket, .. } if self.is_down => self.station.not_sent(ticket, self.clock()),
                Step::Send { frame, .. } => {
                    self.sent.push((self.now, frame));
                    self.bench.send(&frame, self.now);
                }
                Step::Event(event) => self.events.push((self.now, event)),
                Step::Wait(_) => return,
            }
        }
    }

    /// Returns the time of the program's clock.
    pub fn clock(&self) -> u32 {
        self.now.wrapping_add(self.ahead)
    }

    /// Returns what the station says of a module, if it has found it.
    pub fn state(&self, node: u8) -> Option<Output> {
        self.station.modules().any(|known| known == node).then(|| self.station.output(node, self.clock()))
    }

    /// Returns what other controllers have set.
    pub fn rivals(&self) -> Vec<Rival> {
        let rival = |(_, told): &(u32, Told)| if let Told::Rival(rival) = told { Some(*rival) } else { None };
        self.events.iter().filter_map(rival).collect()
    }

    pub fn device(&mut self, node: u8) -> &mut Charger<P> {
        self.bench.device(node).expect("a module of the bus")
    }

    pub fn faults(&mut self, node: u8) -> &mut Faults {
        self.bench.faults(node).expect("a module of the bus")
    }
}

/// Returns what the devices of the document expect.
pub fn rules<P: Protocol>() -> Rules {
    let watchdog = P::TIMING.watchdog.map(|time| u32::try_from(time.shortest.as_millis()).expect("it is short"));
    Rules { gap: pace::<P>().gap, watchdog, boot: 1500 }
}
