//! Made-up charging modules 1 to 9, alone or in groups, with the addresses of the heaters.
//!
//! All have the same messages. What a station uses of them is a matter of the make.

use core::fmt::Debug;
use core::marker::PhantomData;
use core::time::Duration;

use crate::filter::IdFilter;
use crate::plumbing::{Address, Decode, Incoming, Legend, Shown, States, Task, Way, Who, Word};
use crate::tests::heaters::{
    ALL, COMMAND, CONTROLLER, ERROR, FRAME, GROUP, GROUPED, HEATER, Identifier, OTHERS, SINGLE, SOURCE, TARGET, To,
};
use crate::{
    Access, Addressed, AfterSilence, AnySignal, Destination, Error, Exchange, Filter, Kind, Layout, Mode, Payload,
    Place, Problem, Protocol, Quantities, Quantity, ReadPath, Received, Route, SetPath, Signal, StatusBit, Time,
    Timing,
};

/// What a station uses of the messages.
pub trait Make: Copy + Debug + 'static {
    const READS: &'static [ReadPath];
    const SETS: &'static [SetPath];
    const WATCHDOG: Option<Time>;
    const AFTER_SILENCE: AfterSilence;
}

const VOLTAGE: Signal<u16> = Signal::new("voltage", Place::bytes(0, 1)).unit("V").scale(1, 10).limits(500, 10_000);
/// Model 2 has no more than 30 A.
const CURRENT: Signal<u16> = Signal::new("current", Place::bytes(2, 3))
    .unit("A")
    .scale(1, 10)
    .limits(10, 1000)
    .model_limits(&[(2, Some((10, 300)))]);
const NUMBER: Signal<u8> = Signal::new("group", Place::byte(1));
const STATUS: Signal<Status> = Signal::new("status", Place::byte(2));
const FIRST: States = States { place: Place::byte(0), inactive: 0, active: 1 };
const THIRD: States = States { place: Place::byte(2), inactive: 0, active: 1 };

const TELL: Access = Access::new("tell", &[Some(Who::One), Some(Who::Each), None]).request(&FRAME).reply(&FRAME);
const ASK: Access = Access::new("ask", &[Some(Who::One), None, None]).request(&FRAME).reply(&FRAME);
const SAY: Access = Access::new("say", &[None, Some(Who::Each), None]).report(&FRAME);

/// Sets voltage and current.
const OUTPUT: Exchange = TELL.of("output").id(COMMAND, 1).length(4);
/// Switches on and off.
const SWITCH: Exchange = TELL.of("switch").id(COMMAND, 2).length(4);
/// Sets the voltage, and switches on and off.
const BOTH: Exchange = TELL.of("both").id(COMMAND, 3).length(4);
const ONLY_VOLTAGE: Exchange = TELL.of("voltage").id(COMMAND, 4).length(4);
const ONLY_CURRENT: Exchange = TELL.of("current").id(COMMAND, 5).length(4);
/// Sets what no station sets.
const TOTAL: Exchange = TELL.of("total").id(COMMAND, 6).length(4);
/// Whether it is on, its group, and what is wrong.
const STATE: Exchange = ASK.of("state").id(COMMAND, 8).length(4);
/// Its group alone.
const PLACE: Exchange = ASK.of("place").id(COMMAND, 7).length(4);
const MEASURED: Exchange = ASK.of("measured").id(COMMAND, 9).length(4);
/// Another access to what is measured.
const LOOKED_AT: Exchange =
    Access::new("look", &[Some(Who::One), None, None]).request(&FRAME).reply(&FRAME).of("measured").length(4);
/// Switches on and off. Nobody answers it.
const ORDER: Exchange = Access::new("order", &[Some(Who::Nobody), Some(Who::Nobody), None])
    .request(&FRAME)
    .of("order")
    .id(COMMAND, 11)
    .length(4);
const REPORT: Exchange = SAY.of("report").id(COMMAND, 10).length(4);

const fn number(
    quantity: Quantity,
    unit: Option<&'static str>,
    frames: &'static [(Kind, &'static Exchange)],
    signal: &'static dyn crate::ReadNumber,
) -> ReadPath {
    ReadPath::number(quantity, unit, frames, signal)
}

const MEASUREMENTS: &[(Kind, &Exchange)] = &[(Kind::Reply, &MEASURED), (Kind::Report, &REPORT)];
const VOLTAGE_READ: ReadPath = number(Quantity::OUTPUT_VOLTAGE, Some("V"), MEASUREMENTS, &VOLTAGE).asked_by(&MEASURED);
const CURRENT_READ: ReadPath = number(Quantity::OUTPUT_CURRENT, Some("A"), MEASUREMENTS, &CURRENT).asked_by(&MEASURED);
const STATE_READ: ReadPath = ReadPath::switch(Quantity::DELIVERING, &[(Kind::Reply, &STATE)], FIRST).asked_by(&STATE);
const GROUP_READ: ReadPath = number(Quantity::GROUP, None, &[(Kind::Reply, &STATE)], &NUMBER).asked_by(&STATE);

const fn set(quantity: Quantity, unit: &'static str, by: &'static Exchange, signal: &'static Signal<u16>) -> SetPath {
    SetPath::number(quantity, Some(unit), by, signal).echoed()
}

const TOTAL_SET: SetPath = set(Quantity::OUTPUT_POWER, "W", &TOTAL, &CURRENT);

/// They have groups, and one message for voltage and current. They resume after 10 s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InGroups;

impl Make for InGroups {
    const READS: &'static [ReadPath] = &[GROUP_READ, STATE_READ, VOLTAGE_READ, CURRENT_READ];
    const SETS: &'static [SetPath] = &[
        TOTAL_SET,
        set(Quantity::OUTPUT_VOLTAGE, "V", &OUTPUT, &VOLTAGE),
        set(Quantity::OUTPUT_CURRENT, "A", &OUTPUT, &CURRENT),
        SetPath::switch(Quantity::DELIVERING, &SWITCH, FIRST).echoed(),
    ];
    const WATCHDOG: Option<Time> = Some(Time::between(Duration::from_secs(10), Duration::from_secs(12)));
    const AFTER_SILENCE: AfterSilence = AfterSilence::Resumes;
}

/// One message sets the voltage and switches on and off. The current can be neither set nor read. They have
/// neither groups nor a watchdog, and start by themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtOnce;

impl Make for AtOnce {
    const READS: &'static [ReadPath] =
        &[number(Quantity::OUTPUT_POWER, Some("W"), &[(Kind::Report, &REPORT)], &CURRENT), STATE_READ, VOLTAGE_READ];
    const SETS: &'static [SetPath] = &[
        set(Quantity::OUTPUT_VOLTAGE, "V", &BOTH, &VOLTAGE),
        SetPath::switch(Quantity::DELIVERING, &BOTH, THIRD).echoed(),
        TOTAL_SET,
    ];
    const WATCHDOG: Option<Time> = None;
    const AFTER_SILENCE: AfterSilence = AfterSilence::Starts;
}

/// They have a message for each of voltage, current, on and off, and the group. They go on as they
/// were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart;

impl Make for Apart {
    const READS: &'static [ReadPath] = &[
        number(Quantity::GROUP, None, &[(Kind::Reply, &PLACE)], &NUMBER).asked_by(&PLACE),
        VOLTAGE_READ,
        CURRENT_READ,
        STATE_READ,
    ];
    const SETS: &'static [SetPath] = &[
        set(Quantity::OUTPUT_VOLTAGE, "V", &ONLY_VOLTAGE, &VOLTAGE),
        set(Quantity::OUTPUT_CURRENT, "A", &ONLY_CURRENT, &CURRENT),
        SetPath::switch(Quantity::DELIVERING, &SWITCH, FIRST).echoed(),
    ];
    const WATCHDOG: Option<Time> = InGroups::WATCHDOG;
    const AFTER_SILENCE: AfterSilence = AfterSilence::Keeps;
}

/// They do what they are told, and do not answer that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mute;

impl Make for Mute {
    const READS: &'static [ReadPath] = InGroups::READS;
    const SETS: &'static [SetPath] = &[SetPath::switch(Quantity::DELIVERING, &ORDER, FIRST)];
    const WATCHDOG: Option<Time> = None;
    const AFTER_SILENCE: AfterSilence = AfterSilence::Unknown;
}

/// They say by themselves whether they deliver, and cannot be asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Talkative;

impl Make for Talkative {
    const READS: &'static [ReadPath] =
        &[ReadPath::switch(Quantity::DELIVERING, &[(Kind::Report, &REPORT)], FIRST), VOLTAGE_READ];
    const SETS: &'static [SetPath] = InGroups::SETS;
    const WATCHDOG: Option<Time> = None;
    const AFTER_SILENCE: AfterSilence = AfterSilence::Unknown;
}

/// They are asked for one message by two accesses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twofold;

impl Make for Twofold {
    const READS: &'static [ReadPath] =
        &[ReadPath::switch(Quantity::DELIVERING, MEASUREMENTS, THIRD).asked_by(&LOOKED_AT), VOLTAGE_READ, CURRENT_READ];
    const SETS: &'static [SetPath] = InGroups::SETS;
    const WATCHDOG: Option<Time> = None;
    const AFTER_SILENCE: AfterSilence = AfterSilence::Unknown;
}

/// What is wrong with a module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status(u8);

impl Word for Status {
    type Raw = u8;
    const LEGEND: Legend<u8> = Legend::Bits(&[
        StatusBit::fault(0, "broken", "Broken"),
        StatusBit::alarm(1, "hot", "Too hot"),
        StatusBit::new(2, "cold", "Cold"),
    ]);
    const FROM_RAW: fn(u8) -> Self = Self;
    const RAW: fn(Self) -> u8 = |status| status.0;
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct State;

impl Layout for State {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[&STATUS];
    const DECODE: Decode<Self> = |_| Self;

    fn write_to(&self, _: &mut Payload) -> bool {
        true
    }
}

/// A message of a make, which tells the state or something else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Message<K> {
    is_state: bool,
    make: PhantomData<K>,
}

impl<K: Make> Message<K> {
    const OTHER: Self = Self { is_state: false, make: PhantomData };
    const STATE: Self = Self { is_state: true, make: PhantomData };

    fn told(frame: &Incoming) -> Option<&'static Exchange> {
        Some(match frame.id(COMMAND) {
            1 => &OUTPUT,
            2 => &SWITCH,
            3 => &BOTH,
            4 => &ONLY_VOLTAGE,
            5 => &ONLY_CURRENT,
            6 => &TOTAL,
            7 => &PLACE,
            9 => &MEASURED,
            _ => return None,
        })
    }
}

impl<K: Make> Protocol for Message<K> {
    type Identifier = Identifier;
    const FRAME: Filter = FRAME;
    const NORMAL: Filter = FRAME.id(ERROR, 0);
    const STARTING: Option<u64> = Some(7);
    const MODES: &'static [Mode] = &[SINGLE, GROUPED, ALL];
    const TIMING: Timing = Timing { watchdog: K::WATCHDOG, ..Timing::NONE };
    const AFTER_SILENCE: AfterSilence = K::AFTER_SILENCE;

    fn request(frame: &Incoming) -> Result<Received<Self>, Problem> {
        match (Self::told(frame), frame.id(COMMAND)) {
            (Some(told), _) => frame.request(told, Self::OTHER),
            (None, 8) => frame.request(&STATE, Self::OTHER),
            _ => frame.unknown(),
        }
    }

    fn reply(frame: &Incoming) -> Result<Received<Self>, Problem> {
        match (Self::told(frame), frame.id(COMMAND)) {
            (Some(told), _) => frame.reply(told, Self::OTHER),
            (None, 8) => frame.reply(&STATE, Self::STATE),
            (None, 10) => frame.report(&REPORT, Self::OTHER),
            _ => frame.unknown(),
        }
    }

    fn request_lengths(frame: &Incoming) -> &'static [u8] {
        if matches!(frame.id(COMMAND), 1..=10) { &[4] } else { &[] }
    }

    fn reply_lengths(frame: &Incoming) -> &'static [u8] {
        Self::request_lengths(frame)
    }

    fn way(shown: &Shown) -> Option<Way> {
        let source = Address::new(SOURCE, &CONTROLLER);
        Way::best([
            shown.request(0).address(&Address::new(TARGET, &HEATER).excluding(OTHERS)).address(&source),
            shown.reply(0, Who::One).address(&Address::new(SOURCE, &HEATER).excluding(OTHERS)),
            shown
                .request(1)
                .address(&Address::new(TARGET, &GROUP).excluding(&[(0, 0x4F), (0x60, 0xFF)]))
                .address(&source),
            shown.reply(1, Who::Each).address(&Address::new(SOURCE, &HEATER).excluding(OTHERS)),
        ])
    }

    fn node(way: &Way) -> Option<i32> {
        Some(match way.place() {
            (0, None) => way.number(TARGET, &HEATER),
            (0, Some(Who::One)) | (1, Some(Who::Each)) => way.number(SOURCE, &HEATER),
            _ => return None,
        })
    }

    fn run<T: Task>(&self, task: T) -> T::Output {
        if self.is_state { task.run(&State) } else { task.run(&()) }
    }
}

impl<K: Make> Quantities for Message<K> {
    const READS: &'static [ReadPath] = K::READS;
    const SETS: &'static [SetPath] = K::SETS;
}

impl<K: Make> Addressed for Message<K> {
    type Target = At<K>;

    fn module(number: i32) -> Option<At<K>> {
        u8::try_from(number).ok().filter(|number| *number < 100).map(|number| At(To::Heater(number), PhantomData))
    }
}

/// A module or a group of a make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At<K>(To, PhantomData<K>);

/// Returns what addresses a group.
pub const fn group<K>(number: u8) -> At<K> {
    At(To::Group(number), PhantomData)
}

impl<K: Make> Destination for At<K> {
    type Protocol = Message<K>;

    fn mode(self) -> usize {
        self.0.mode()
    }

    fn request(self, sender: Option<i32>) -> Result<IdFilter, Error> {
        self.0.request(sender)
    }

    fn replies(self, who: Who, sender: Option<i32>) -> Option<IdFilter> {
        self.0.replies(who, sender)
    }

    fn shown(_: &Way) -> Option<Route<Self>> {
        None
    }
}
