//! One program drives simulated power modules of every vendor, while they fail. It finds them, sets them by quantities,
//! hears of their states and alarms, and stops them.
//!
//! Modules and batteries that answer in several frames are asked again as long as a frame is missing.

mod battery;
mod counting;
mod label;
mod modules;

use std::collections::HashMap;
use std::time::Duration;

use canspec_protocols::trio;
use canspec_runtime::client::{Client, Heard, Pace, Step, Ticket};
use canspec_runtime::sim::{Answer, Bench, Device, Event, Faults, Keeper, Random, Rules, Tell};
use canspec_runtime::{Addressed, Frame, Protocol, Quantities, Quantity, Received, Replies, Severity, Time};

const VOLTAGE: Quantity = Quantity::OUTPUT_VOLTAGE;
const CURRENT: Quantity = Quantity::OUTPUT_CURRENT;
const DELIVERING: Quantity = Quantity::DELIVERING;
/// Whether a simulated module has a defect.
const DEFECT: Quantity = Quantity::new("defect");

/// When the modules are switched on, when each gets a defect, and when they are stopped. All in milliseconds.
const START: u32 = 4000;
const BREAK: u32 = 15_000;
const STOP: u32 = 28_000;
/// When the faults end.
const CLEAR: u32 = 35_000;
const END: u32 = 45_000;
/// The time from one round to the next.
const ROUND: u32 = 2500;
/// After this time without a restart, a module does what it is told.
const SETTLED: u32 = 12_000;

type Kept<P> = Keeper<P, 4>;

/// What differs from vendor to vendor.
struct Facts<P: Addressed> {
    /// The addresses of modules, and others at which none is.
    nodes: [u8; 3],
    absent: [u8; 2],
    /// What lets a module deliver, in the order in which it is sent, and what switches it off.
    on: &'static [(Quantity, i32)],
    off: &'static [(Quantity, i32)],
    /// The code of a refusal, and that of a module that starts.
    code: Option<u64>,
    /// How bad a defect is at least, if a module can say it.
    severity: Option<Severity>,
    /// What a module says, what it reports in turn, and the milliseconds from one report to the next.
    tell: Tell<P, 4>,
    reports: fn(u8, &Kept<P>) -> Vec<Frame>,
    interval: u32,
}

/// A module of any vendor.
struct Module<P: Addressed> {
    kept: Kept<P>,
    reports: fn(u8, &Kept<P>) -> Vec<Frame>,
    interval: u32,
    /// Reports that wait to be sent, and when the next ones are due.
    waiting: Vec<Frame>,
    due: u32,
    /// When it started last, and whether it was ever switched on without a voltage.
    started: u32,
    was_bare: bool,
}

impl<P: Quantities + Addressed<Target: PartialEq>> Device<P> for Module<P> {
    fn answer(&mut self, request: &Received<P>, now: u32) -> Answer<P> {
        let answer = self.kept.answer(request, now);
        self.was_bare |= self.kept.value(DELIVERING) == Some(1) && self.kept.value(VOLTAGE).is_none();
        answer
    }

    fn report(&mut self, node: u8, now: u32) -> Option<Frame> {
        if now >= self.due {
            (self.due, self.waiting) = (now + self.interval, (self.reports)(node, &self.kept));
        }
        self.waiting.pop()
    }

    fn silence(&mut self, now: u32) {
        self.kept.silence(now);
    }

    fn wake(&mut self, now: u32) {
        self.kept.wake(now);
    }

    fn power_on(&mut self, now: u32) {
        self.started = now;
        self.kept.power_on(now);
    }
}

/// What the program knows of a module.
#[derive(Default)]
struct Known {
    /// The state that it has reported last, and when.
    state: Option<(u32, i32)>,
    voltage_mv: Option<i32>,
    severity: Option<Severity>,
}

/// The program.
struct Driver<P: Quantities + Addressed> {
    client: Client<P, 64>,
    known: HashMap<u8, Known>,
    /// What each module is to do.
    told: HashMap<u8, Vec<Ticket>>,
}

impl<P: Quantities + Addressed> Driver<P> {
    /// Looks for modules, by what can be read. Others report by themselves.
    fn search(&mut self, nodes: impl Iterator<Item = u8>) {
        for node in nodes {
            let target = P::module(node.into()).expect("an address of a module");
            for request in P::read(&[DELIVERING], target).expect("it is reported, at least") {
                self.client.every(ROUND, request, 0).expect("room");
            }
        }
    }

    /// Takes what a module says, whether it was asked or not.
    fn hear(&mut self, received: &Received<P>, now: u32) {
        let Some(node) = received.node().and_then(|node| u8::try_from(node).ok()) else { return };
        if received.is_to_module() {
            return;
        }
        let is_new = !self.known.contains_key(&node);
        let known = self.known.entry(node).or_default();
        if let Some(state) = received.quantity(DELIVERING) {
            known.state = Some((now, state));
        }
        known.voltage_mv = received.quantity(VOLTAGE).or(known.voltage_mv);
        known.severity = known.severity.max(received.conditions().filter_map(|bit| bit.severity).max());
        if is_new {
            let target = P::module(node.into()).expect("it has spoken");
            for request in P::read(&[VOLTAGE], target).expect("it is reported, at least") {
                self.client.every(ROUND, request, now).expect("room");
            }
        }
    }

    /// Lets a module do something from now on.
    fn tell(&mut self, node: u8, values: &[(Quantity, i32)], now: u32) {
        let requests = P::set(values, P::module(node.into()).expect("an address")).expect("the document allows it");
        self.told.remove(&node).into_iter().flatten().for_each(|ticket| self.client.cancel(ticket));
        let mut last = None;
        for request in requests {
            let agrees = |asked: &Received<P>, said: &Received<P>| said.confirms(asked, 100);
            let told = match last {
                _ if request.replies() == Replies::Nobody => self.client.every(ROUND, request, now).expect("room"),
                None => self.client.hold(request, ROUND, agrees, now).expect("room"),
                Some(last) => self.client.hold_after(last, request, agrees, now).expect("room"),
            };
            self.client.hurry(told, now);
            last = Some(told);
            self.told.entry(node).or_default().push(told);
        }
    }

    fn poll(&mut self, now: u32) -> Option<Frame> {
        loop {
            match self.client.poll(now) {
                Step::Send { frame, .. } => return Some(frame),
                Step::Wait(_) => return None,
                Step::Lost(_)
                | Step::Done(_)
                | Step::Missing { .. }
                | Step::Silent(_)
                | Step::Back(_)
                | Step::ClockBack(_) => {}
            }
        }
    }

    /// Returns whether a module delivers, if it has said so in the last rounds.
    fn state(&self, node: u8, now: u32) -> Option<i32> {
        let (heard, state) = self.known.get(&node)?.state?;
        (now - heard < 4 * ROUND).then_some(state)
    }
}

/// Returns the pace of the document, and chooses what it does not state.
fn pace<P: Protocol>() -> Pace {
    let chosen = |time: Option<Time>, milliseconds| time.unwrap_or(Time::of(Duration::from_millis(milliseconds)));
    let timing = P::TIMING
        .with_request_gap(chosen(P::TIMING.request_gap, 30))
        .with_reply_timeout(chosen(P::TIMING.reply_timeout, 100))
        .with_tries(P::TIMING.tries.unwrap_or(3));
    Pace::of(&timing, 100).expect("what the document does not state is chosen")
}

/// Half a minute with three modules that fail by a seed.
fn drive<P: Quantities + Addressed<Target: PartialEq>>(facts: &Facts<P>, seed: u64) {
    let module = |node| {
        let (kept, reports, interval) = (Keeper::new(facts.tell), facts.reports, facts.interval);
        (node, Module { kept, reports, interval, waiting: vec![], due: 0, started: 0, was_bare: false })
    };
    let watchdog = P::TIMING.watchdog.map(|time| u32::try_from(time.shortest.as_millis()).expect("it is short"));
    let rules = Rules { gap: pace::<P>().gap, watchdog, boot: 1500 };
    let mut bench = Bench::<P, Module<P>, 3, 64>::new(facts.nodes.map(module), rules, seed);
    let mut random = Random::new(seed);
    for node in facts.nodes {
        let drawn = Faults::random(&mut random, 12, STOP);
        let (code, refused) = (facts.code.unwrap_or_default(), if facts.code.is_some() { drawn.refused } else { 0 });
        let slowest = 1 + random.below(150);
        *bench.faults(node).expect("a module") = Faults { disguised: 0, code, refused, slowest, ..drawn };
    }
    let mut driver = Driver::<P> { client: Client::new(pace::<P>()), known: HashMap::new(), told: HashMap::new() };
    driver.search(facts.nodes.into_iter().chain(facts.absent));
    for now in 0..END {
        while let Some(event) = bench.poll(now) {
            match event {
                Event::Frame { frame, at } => match driver.client.handle(&frame, at) {
                    Heard::Answer { received, .. } | Heard::Late { received, .. } | Heard::Other(received) => {
                        driver.hear(&received, now);
                    }
                    _ => {}
                },
                Event::Complaint(complaint) => panic!("seed {seed}, at {now} ms: {complaint}"),
            }
        }
        for node in facts.nodes {
            match now {
                START => driver.tell(node, facts.on, now),
                BREAK => bench.device(node).expect("a module").kept.keep(DEFECT, 1),
                STOP => {
                    check_output(&mut bench, &driver, facts, node, seed);
                    driver.tell(node, facts.off, now);
                }
                CLEAR => {
                    let faults = bench.faults(node).expect("a module");
                    *faults = Faults { dies: faults.dies, ..Faults::NONE };
                }
                _ => {}
            }
        }
        while let Some(frame) = driver.poll(now) {
            bench.send(&frame, now);
        }
    }
    for node in facts.nodes {
        let (dies, state) = (bench.faults(node).expect("a module").dies, driver.state(node, END));
        let module = bench.device(node).expect("a module");
        assert!(!module.was_bare, "seed {seed}: module {node} was switched on without its voltage");
        assert!(dies.is_some() || module.kept.value(DELIVERING) != Some(1), "seed {seed}: module {node} is on");
        assert_eq!(state, if dies.is_some() { None } else { Some(0) }, "seed {seed}: module {node}");
        let has_time = |from: u32| !(BREAK..=BREAK + SETTLED).contains(&from);
        if dies.is_none_or(|dies| dies > BREAK + SETTLED) && has_time(module.started) {
            let severity = driver.known.get(&node).and_then(|known| known.severity);
            assert!(severity >= facts.severity, "seed {seed}: module {node} has a defect: {severity:?}");
        }
    }
    assert!(facts.absent.iter().all(|node| !driver.known.contains_key(node)), "seed {seed}: nobody is there");
}

/// Tests that a module delivers what it is told, and that the program knows it.
fn check_output<P: Quantities + Addressed<Target: PartialEq>>(
    bench: &mut Bench<P, Module<P>, 3, 64>,
    driver: &Driver<P>,
    facts: &Facts<P>,
    node: u8,
    seed: u64,
) {
    let is_dead = bench.faults(node).expect("a module").dies.is_some();
    let module = bench.device(node).expect("a module");
    if is_dead || module.started + SETTLED > STOP {
        return;
    }
    for (quantity, value) in facts.on {
        assert_eq!(module.kept.value(*quantity), Some(*value), "seed {seed}: {quantity:?} of module {node}");
    }
    assert_eq!(driver.state(node, STOP), Some(1), "seed {seed}: module {node}");
    let shown = driver.known.get(&node).and_then(|known| known.voltage_mv);
    let asked = facts.on.iter().find(|(quantity, _)| *quantity == VOLTAGE).map(|(_, value)| *value);
    assert_eq!(shown, asked, "seed {seed}: module {node}");
}

/// Runs twenty seeds.
fn drive_all<P: Quantities + Addressed<Target: PartialEq>>(facts: &Facts<P>) {
    (0..20).for_each(|seed| drive(facts, seed));
}

const OUTPUT: &[(Quantity, i32)] = &[(VOLTAGE, 500_000), (CURRENT, 10_000), (DELIVERING, 1)];
const OFF: &[(Quantity, i32)] = &[(DELIVERING, 0)];

/// What modules have in common that report nothing, and say that a defect is at least an alarm.
const fn silent<P: Addressed>(nodes: [u8; 3], absent: [u8; 2], tell: Tell<P, 4>) -> Facts<P> {
    let (severity, reports, interval) = (Some(Severity::Alarm), no_reports, u32::MAX);
    Facts { nodes, absent, on: OUTPUT, off: OFF, code: None, severity, tell, reports, interval }
}

const fn no_reports<P: Addressed>(_: u8, _: &Kept<P>) -> Vec<Frame> {
    Vec::new()
}

#[test]
fn infy_modules_are_driven() {
    let facts = silent([0, 1, 2], [3, 0x3B], modules::infy_tells);
    drive_all(&Facts { code: Some(4), ..facts });
}

#[test]
fn gcp_modules_are_driven() {
    let facts = silent([0, 1, 2], [3, 0x3B], modules::gcp_tells);
    drive_all(&Facts { code: Some(4), ..facts });
}

#[test]
fn maxwell_modules_are_driven() {
    drive_all(&Facts { code: Some(0xF2), ..silent([3, 4, 5], [6, 7], modules::mxr_tells) });
}

#[test]
fn megmeet_modules_are_driven() {
    // Section 2.2.1: error type 3 while addresses are assigned.
    let code = Some(1);
    let on = &[(VOLTAGE, 53_500), (DELIVERING, 1)];
    drive_all(&Facts { on, code, ..silent([1, 2, 3], [4, 0x7F], modules::megmeet_tells) });
}

#[test]
fn huawei_modules_are_driven() {
    // Section 7.2: status 2 is a parameter error. Section 9.1: about 377 ms. Section 4.3 names no alarm.
    let (code, severity, reports, interval) = (Some(2), None, modules::huawei_reports, 377);
    let on = &[(VOLTAGE, 53_500), (DELIVERING, 1)];
    drive_all(&Facts { on, code, severity, reports, interval, ..silent([1, 2, 3], [4, 0x7F], modules::huawei_tells) });
}

#[test]
fn trio_modules_are_driven_although_they_answer_nothing() {
    let tell = |_: &Received<trio::Message>, _: &Kept<trio::Message>| Answer::Silence;
    let (on, off) = (&[(VOLTAGE, 24_000), (DELIVERING, 1)], &[(VOLTAGE, 24_000), (DELIVERING, 0)]);
    let (reports, interval) = (modules::trio_reports, 200);
    drive_all(&Facts { on, off, reports, interval, ..silent([0xE1, 0xE6, 0xEF], [0xE2, 0xE3], tell) });
}
