//! Modules of MEGMEET, which number themselves. The program counts them as section 4 says, and anew when one is added.

use canspec_protocols::megmeet::{
    Alarms, AssignAddresses, Assignment, CharacteristicWord, Efficiency, ExtendedAlarms, Frame, HardwareAddress,
    InherentInformation, InputType, Message, ModuleStatus, OutputType, Phases, Supply, Target, Versions,
};
use canspec_runtime::client::{Client, Heard, Pace, Step, Ticket};
use canspec_runtime::sim::{Answer, Bench, Device, Event, Faults, Rules};
use canspec_runtime::{Protocol as _, Received};

/// How long modules assign their addresses.
const ASSIGNMENT: u32 = 3000;
/// How long the program then asks nothing.
const PAUSE: u32 = 1000;
/// When a module is added, and when all ends.
const ADDED: u32 = 20_000;
const END: u32 = 40_000;

/// A module.
struct Module {
    assigns_until: u32,
    /// How often it was asked meanwhile.
    disturbed: u32,
}

impl Device<Message> for Module {
    fn answer(&mut self, request: &Received<Message>, now: u32) -> Answer<Message> {
        if *request.content() == Message::AssignAddresses(ASSIGN) {
            self.assigns_until = now + ASSIGNMENT;
            return Answer::Silence;
        }
        if now < self.assigns_until {
            self.disturbed += 1;
            return Answer::Starting;
        }
        let slave = request.node().and_then(|node| u8::try_from(node).ok()).expect("one module is asked");
        match request.content() {
            Message::ReadAllCharacteristicWord => Answer::Values(Message::CharacteristicWord(CHARACTERISTIC_WORD)),
            Message::ReadAllVersions => Answer::Values(Message::Versions(VERSIONS)),
            Message::ReadAllHardwareAddress => {
                Answer::Values(Message::HardwareAddress(HardwareAddress { group: 1, slave }))
            }
            Message::ReadModuleStatus => Answer::Values(Message::ModuleStatus(ModuleStatus {
                extended: ExtendedAlarms::default(),
                alarms: Alarms::default(),
            })),
            _ => Answer::Silence,
        }
    }
}

const ASSIGN: AssignAddresses = AssignAddresses { value: Assignment::Assign };
const VERSIONS: Versions = Versions { hardware: 0x100, dcdc: 0x202, pfc: 0x203 };
const CHARACTERISTIC_WORD: CharacteristicWord = CharacteristicWord {
    supply: Supply::Single,
    phases: Phases::SinglePhase,
    input_type: InputType::AcAndOther,
    rated_current_a: 50.0,
    output_type: OutputType::V48,
    efficiency: Efficiency::From90To91,
    minor_version: 1,
    generation: 7,
};

/// What the program is about.
enum Stage {
    /// Modules assign their addresses, perhaps until this time.
    Assignment(u32),
    /// It asks the module after the last one that is there and the missing ones behind that.
    Count { asked: Vec<Ticket>, has_answered: bool, last: u8, missing: u8 },
    /// It knows how many modules are there.
    Counted(u8),
}

/// The program.
struct Counter {
    client: Client<Message, 16>,
    stage: Stage,
    polled: Vec<Ticket>,
}

impl Counter {
    fn new(pace: Pace) -> Self {
        let mut client = Client::new(pace);
        client.ask(ASSIGN.set(Target::Broadcast).expect("all modules"), 0).expect("room");
        Self { client, stage: Stage::Assignment(PAUSE), polled: Vec::new() }
    }

    fn handle(&mut self, frame: &Frame, now: u32) {
        match self.client.handle(frame, now) {
            Heard::Starting { .. } => self.pause(now),
            Heard::Answer { ticket, .. } | Heard::Refusal { ticket, .. } => self.ended(ticket, true, now),
            _ => {}
        }
    }

    fn poll(&mut self, now: u32) -> Option<Frame> {
        if matches!(self.stage, Stage::Assignment(until) if until <= now) {
            self.ask(0, 0, now);
        }
        loop {
            match self.client.poll(now) {
                Step::Send { frame, .. } => return Some(frame),
                Step::Lost(ticket) => self.ended(ticket, false, now),
                Step::Wait(_) => return None,
                _ => {}
            }
        }
    }

    /// Asks nothing more for a while.
    fn pause(&mut self, now: u32) {
        let stage = std::mem::replace(&mut self.stage, Stage::Assignment(now + PAUSE));
        let asked = if let Stage::Count { asked, .. } = stage { asked } else { Vec::new() };
        asked.into_iter().chain(self.polled.drain(..)).for_each(|ticket| self.client.cancel(ticket));
    }

    /// Asks the next module, after the last one that is there and some that are missing.
    fn ask(&mut self, last: u8, missing: u8, now: u32) {
        let requests = InherentInformation::read_all(Target::Module(last + missing + 1)).expect("an address");
        let asked = requests.map(|request| self.client.ask(request, now).expect("room")).into();
        self.stage = Stage::Count { asked, has_answered: false, last, missing };
    }

    /// Goes on with the next module when all that one was asked for has ended. Two that do not answer are the end.
    fn ended(&mut self, ticket: Ticket, is_answer: bool, now: u32) {
        let Stage::Count { asked, has_answered, last, missing } = &mut self.stage else { return };
        asked.retain(|other| *other != ticket);
        *has_answered |= is_answer;
        match (asked.is_empty(), *has_answered, *missing, *last) {
            (false, ..) => {}
            (true, true, missing, last) => self.ask(last + missing + 1, 0, now),
            (true, false, 0, last) => self.ask(last, 1, now),
            (true, false, _, last) => {
                self.stage = Stage::Counted(last);
                let read = |node| ModuleStatus::read(Target::Module(node)).expect("an address");
                self.polled = (1..=last).map(|node| self.client.every(2000, read(node), now).expect("room")).collect();
            }
        }
    }
}

/// Counts three modules, and then four.
fn count(seed: u64) {
    let nodes = [1, 2, 3, 4];
    let timing = Message::TIMING.of("inherent_information");
    let pace = Pace::of(&timing, 120).expect("section 4 states the times");
    let rules = Rules { gap: pace.gap, boot: 500, ..Rules::default() };
    let modules = nodes.map(|node| (node, Module { assigns_until: 0, disturbed: 0 }));
    let mut bench = Bench::<Message, Module, 4, 64>::new(modules, rules, seed);
    for node in nodes {
        *bench.faults(node).expect("a module") =
            Faults { deaf: 10, lost: 10, twice: 10, broken: 5, refused: 5, code: 7, slowest: 150, ..Faults::NONE };
    }
    bench.faults(4).expect("a module").dies = Some(0);
    let mut counter = Counter::new(pace);
    for now in 0..END {
        if now == ADDED {
            assert!(matches!(counter.stage, Stage::Counted(3)), "seed {seed}");
            bench.restart(4, now);
            for node in nodes {
                bench.device(node).expect("a module").assigns_until = now + ASSIGNMENT;
            }
        }
        while let Some(event) = bench.poll(now) {
            let Event::Frame { frame, .. } = event else { panic!("seed {seed}: {event:?}") };
            counter.handle(&frame, now);
        }
        while let Some(frame) = counter.poll(now) {
            bench.send(&frame, now);
        }
    }
    assert!(matches!(counter.stage, Stage::Counted(4)), "seed {seed}");
    let disturbed: u32 = nodes.iter().map(|node| bench.device(*node).expect("a module").disturbed).sum();
    assert!((2..=30).contains(&disturbed), "seed {seed}: modules that assign addresses were asked {disturbed} times");
}

#[test]
fn modules_that_number_themselves_are_counted_and_left_in_peace_meanwhile() {
    (0..20).for_each(count);
}
