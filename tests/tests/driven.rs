//! One program drives simulated power modules of every vendor, while they fail. It finds them, sets them by quantities,
//! hears of their states and alarms, and stops them.

use std::collections::HashMap;
use std::time::Duration;

use canspec_protocols::{gcp, infy, megmeet, mxr, trio};
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
    starting_up: Option<u64>,
    /// What a module says, and what it reports in turn, every 200 ms.
    tell: Tell<P, 4>,
    reports: fn(u8, &Kept<P>) -> Vec<Frame>,
}

/// A module of any vendor.
struct Module<P: Addressed> {
    kept: Kept<P>,
    reports: fn(u8, &Kept<P>) -> Vec<Frame>,
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
            (self.due, self.waiting) = (now + 200, (self.reports)(node, &self.kept));
        }
        self.waiting.pop()
    }

    fn silence(&mut self, now: u32) {
        self.kept.silence(now);
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
                Step::Lost(_) | Step::Done(_) | Step::Missing { .. } | Step::Silent(_) | Step::Back(_) => {}
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
        let (kept, reports) = (Keeper::new(facts.tell), facts.reports);
        (node, Module { kept, reports, waiting: vec![], due: 0, started: 0, was_bare: false })
    };
    let watchdog = P::TIMING.watchdog.map(|time| u32::try_from(time.shortest.as_millis()).expect("it is short"));
    let rules = Rules { gap: pace::<P>().gap, watchdog, boot: 1500, starting_up: facts.starting_up };
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
                Event::Frame(frame) => match driver.client.handle(&frame) {
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
            assert!(severity >= Some(Severity::Alarm), "seed {seed}: module {node} has an alarm: {severity:?}");
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

/// Returns the voltage or the current that a module delivers.
fn delivered<P: Quantities + Addressed<Target: PartialEq>>(module: &Kept<P>, quantity: Quantity) -> f64 {
    let value = module.value(quantity).filter(|_| is_on(module));
    f64::from(value.unwrap_or_default()) / 1000.0
}

fn is_on<P: Quantities + Addressed<Target: PartialEq>>(module: &Kept<P>) -> bool {
    module.value(DELIVERING) == Some(1)
}

/// Chooses among the values of a status word: of a module that is off, and of one with a defect.
fn shown<P: Quantities + Addressed<Target: PartialEq>, W: Default + std::ops::BitOr<Output = W>>(
    module: &Kept<P>,
    off: W,
    defect: W,
) -> W {
    let off = if is_on(module) { W::default() } else { off };
    if module.value(DEFECT) == Some(1) { off | defect } else { off }
}

const fn no_reports<P: Addressed>(_: u8, _: &Kept<P>) -> Vec<Frame> {
    Vec::new()
}

/// How modules of INFY and of GCP answer, whose messages are alike.
macro_rules! tells {
    ($tells:ident $protocol:ident) => {
        #[expect(clippy::cast_possible_truncation, reason = "what is set has few digits")]
        fn $tells(
            request: &Received<$protocol::Message>,
            module: &Kept<$protocol::Message>,
        ) -> Answer<$protocol::Message> {
            use $protocol::{Message, ModuleOutput, ModuleStatus, Status0, Status1, Status2};
            let [voltage_v, current_a] = [VOLTAGE, CURRENT].map(|quantity| delivered(module, quantity) as f32);
            match request.content() {
                Message::ReadModuleOutput => {
                    Answer::Values(Message::ModuleOutput(ModuleOutput { voltage_v, current_a }))
                }
                Message::ReadModuleStatus => Answer::Values(Message::ModuleStatus(ModuleStatus {
                    group: 0,
                    temperature_c: 30,
                    status_2: Status2::default(),
                    status_1: shown(module, Status1::DC_OFF, Status1::default()),
                    status_0: shown(module, Status0::default(), Status0::OUTPUT_SHORT_CIRCUIT),
                })),
                _ => Answer::Silence,
            }
        }
    };
}

tells!(infy_tells infy);
tells!(gcp_tells gcp);

#[expect(clippy::cast_possible_truncation, reason = "what is set has few digits")]
fn mxr_tells(request: &Received<mxr::Message>, module: &Kept<mxr::Message>) -> Answer<mxr::Message> {
    use mxr::{Alarms, Message, ModuleStatus, OutputVoltage};
    match request.content() {
        Message::ReadOutputVoltage => {
            Answer::Values(Message::OutputVoltage(OutputVoltage { value_v: delivered(module, VOLTAGE) as f32 }))
        }
        Message::ReadModuleStatus => Answer::Values(Message::ModuleStatus(ModuleStatus {
            value: shown(module, Alarms::DCDC_OFF, Alarms::FAULT),
        })),
        _ => Answer::Silence,
    }
}

fn megmeet_tells(request: &Received<megmeet::Message>, module: &Kept<megmeet::Message>) -> Answer<megmeet::Message> {
    use megmeet::{Alarms, ExtendedAlarms, Message, ModuleStatus, OutputVoltage};
    match request.content() {
        Message::ReadOutputVoltage => {
            Answer::Values(Message::OutputVoltage(OutputVoltage { value_v: delivered(module, VOLTAGE) }))
        }
        Message::ReadModuleStatus => Answer::Values(Message::ModuleStatus(ModuleStatus {
            extended: ExtendedAlarms::default(),
            alarms: shown(module, Alarms::SHUT_DOWN, Alarms::MODULE_FAILURE),
        })),
        _ => Answer::Silence,
    }
}

/// What a module of TRIO sends by itself.
fn trio_reports(node: u8, module: &Kept<trio::Message>) -> Vec<Frame> {
    use trio::{ControlMode, Identifier, Kind, Message, Operation, OutputValues, ReferenceValues, Status};
    let reference = ReferenceValues {
        mode: ControlMode::Remote,
        operation: if is_on(module) { Operation::On } else { Operation::Off },
        nominal_voltage_v: 24.0,
        maximum_voltage_v: 29.8,
        minimum_voltage_v: 23.5,
    };
    let output = OutputValues {
        voltage_v: delivered(module, VOLTAGE),
        current_a: 0.0,
        power_w: 0.0,
        status: shown(module, Status::default(), Status::HARDWARE_FAULT),
    };
    let blanks = [ReferenceValues::REPORT, OutputValues::REPORT].map(|exchange| {
        let filter = exchange.filter(Kind::Report).expect("it is reported");
        filter.id(Identifier::TARGET, 0xF3).id(Identifier::SOURCE, node.into()).frame(8)
    });
    let contents = [Message::ReferenceValues(reference), Message::OutputValues(output)];
    let build = |(blank, content): (&Frame, Message)| Message::decode(blank).ok()?.with_content(content).encode().ok();
    blanks.iter().zip(contents).filter_map(build).collect()
}

/// Runs twenty seeds.
fn drive_all<P: Quantities + Addressed<Target: PartialEq>>(facts: &Facts<P>) {
    (0..20).for_each(|seed| drive(facts, seed));
}

const OUTPUT: &[(Quantity, i32)] = &[(VOLTAGE, 500_000), (CURRENT, 10_000), (DELIVERING, 1)];
const OFF: &[(Quantity, i32)] = &[(DELIVERING, 0)];

#[test]
fn infy_modules_are_driven() {
    let (code, starting_up) = (Some(4), Some(7));
    let (nodes, absent) = ([0, 1, 2], [3, 0x3B]);
    drive_all(&Facts { nodes, absent, on: OUTPUT, off: OFF, code, starting_up, tell: infy_tells, reports: no_reports });
}

#[test]
fn gcp_modules_are_driven() {
    let (code, starting_up) = (Some(4), Some(7));
    let (nodes, absent) = ([0, 1, 2], [3, 0x3B]);
    drive_all(&Facts { nodes, absent, on: OUTPUT, off: OFF, code, starting_up, tell: gcp_tells, reports: no_reports });
}

#[test]
fn maxwell_modules_are_driven() {
    let (nodes, absent, code) = ([3, 4, 5], [6, 7], Some(0xF2));
    let (tell, reports, starting_up) = (mxr_tells, no_reports, None);
    drive_all(&Facts { nodes, absent, on: OUTPUT, off: OFF, code, starting_up, tell, reports });
}

#[test]
fn megmeet_modules_are_driven() {
    // Section 2.2.1: error type 3 while addresses are assigned.
    let (nodes, absent, code, starting_up) = ([1, 2, 3], [4, 0x7F], Some(1), Some(3));
    let on = &[(VOLTAGE, 53_500), (DELIVERING, 1)];
    drive_all(&Facts { nodes, absent, on, off: OFF, code, starting_up, tell: megmeet_tells, reports: no_reports });
}

#[test]
fn trio_modules_are_driven_although_they_answer_nothing() {
    let (nodes, absent, code, starting_up) = ([0xE1, 0xE6, 0xEF], [0xE2, 0xE3], None, None);
    let (on, off) = (&[(VOLTAGE, 24_000), (DELIVERING, 1)], &[(VOLTAGE, 24_000), (DELIVERING, 0)]);
    let tell = |_: &Received<trio::Message>, _: &Kept<trio::Message>| Answer::Silence;
    drive_all(&Facts { nodes, absent, on, off, code, starting_up, tell, reports: trio_reports });
}
