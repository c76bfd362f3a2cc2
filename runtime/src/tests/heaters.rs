//! A made-up protocol: heaters 1 to 9, alone, in groups or all together, and a controller 0xF0 or 0xF1.

use crate::plumbing::{
    Address, Decode, Headed, Heading, IdFilter, Incoming, Particulars, Pattern, Shown, Task, Way, Who,
};
use crate::{
    Access, AddressType, Addressed, AfterSilence, AnySignal, Bits, Destination, Error, Exchange, Filter, Frame,
    IdentifierFields, Layout, Mode, Payload, Place, Problem, Protocol, Received, Request, Route, Selector, Signal,
};

pub const FRAME: Filter = Filter::EXTENDED.id_bits(0x0300_0000, 0x0100_0000);
pub const ERROR: Bits = Bits::new(28, 26);
pub const COMMAND: Bits = Bits::new(23, 16);
pub const TARGET: Bits = Bits::new(15, 8);
pub const SOURCE: Bits = Bits::new(7, 0);

pub const CONTROLLER: AddressType = AddressType::new("controller", 0xF0, 0xF1).strict().default_number(0xF0);
pub const HEATER: AddressType = AddressType::new("heater", 1, 9);
pub const GROUP: AddressType = AddressType::new("group", 0, 15).offset(0x5F).descending();

pub const OTHERS: &[(u32, u32)] = &[(0x3F, 0x3F), (0x50, 0x5F), (0xF0, 0xF1)];
pub const TO_CONTROLLER: Address = Address::new(TARGET, &CONTROLLER);
pub const FROM_CONTROLLER: Address = Address::new(SOURCE, &CONTROLLER);

pub const fn mode(name: &'static str, target: Option<&'static AddressType>, request: Pattern) -> Mode {
    Mode { name, target, request: Some(request), one: None, each: None, coordinator: None }
}

pub const FROM_HEATER: Pattern =
    Pattern { constants: &[], addresses: &[TO_CONTROLLER, Address::new(SOURCE, &HEATER).excluding(OTHERS)] };

pub const SINGLE: Mode = Mode {
    one: Some(FROM_HEATER),
    ..mode(
        "single",
        Some(&HEATER),
        Pattern { constants: &[], addresses: &[Address::new(TARGET, &HEATER).excluding(OTHERS), FROM_CONTROLLER] },
    )
};

pub const GROUPED: Mode = Mode {
    each: Some(FROM_HEATER),
    coordinator: Some(Pattern { constants: &[], addresses: &[TO_CONTROLLER, Address::new(SOURCE, &GROUP)] }),
    ..mode(
        "grouped",
        Some(&GROUP),
        Pattern {
            constants: &[],
            addresses: &[Address::new(TARGET, &GROUP).excluding(&[(0, 0x4F), (0x60, 0xFF)]), FROM_CONTROLLER],
        },
    )
};

pub const ALL: Mode = mode("all", None, Pattern { constants: &[(TARGET, 0x3F)], addresses: &[FROM_CONTROLLER] });

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum To {
    Heater(u8),
    Group(u8),
    All,
}

impl Destination for To {
    type Protocol = Message;

    fn mode(self) -> usize {
        match self {
            Self::Heater(_) => 0,
            Self::Group(_) => 1,
            Self::All => 2,
        }
    }

    fn request(self, sender: Option<i32>) -> Result<IdFilter, Error> {
        let filter = match self {
            Self::Heater(number) => IdFilter::ANY.documented(TARGET, &HEATER, number.into())?,
            Self::Group(number) => IdFilter::ANY.documented(TARGET, &GROUP, number.into())?,
            Self::All => IdFilter::ANY.id(TARGET, 0x3F),
        };
        filter.documented(SOURCE, &CONTROLLER, CONTROLLER.chosen(sender))
    }

    fn replies(self, who: Who, sender: Option<i32>) -> Option<IdFilter> {
        let filter = IdFilter::ANY.address(TARGET, &CONTROLLER, CONTROLLER.chosen(sender));
        match (self, who) {
            (Self::Heater(number), Who::One) => Some(filter.address(SOURCE, &HEATER, number.into())),
            (Self::Group(_), Who::Each) => Some(filter),
            (Self::Group(number), Who::Coordinator) => Some(filter.address(SOURCE, &GROUP, number.into())),
            _ => None,
        }
    }

    fn shown(way: &Way) -> Option<Route<Self>> {
        let byte = |number: i32| u8::try_from(number).ok();
        Some(match way.place() {
            (0, None) => Route::new(Self::Heater(byte(way.number(TARGET, &HEATER))?), way.number(SOURCE, &CONTROLLER)),
            (1, None) => Route::new(Self::Group(byte(way.number(TARGET, &GROUP))?), way.number(SOURCE, &CONTROLLER)),
            (1, Some(Who::Coordinator)) => {
                Route::new(Self::Group(byte(way.number(SOURCE, &GROUP))?), way.number(TARGET, &CONTROLLER))
            }
            (2, None) => Self::All.into(),
            _ => return None,
        })
    }
}

impl Addressed for Message {
    type Target = To;
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identifier(pub u32);

impl IdentifierFields for Identifier {
    const FROM_RAW: fn(u32) -> Self = Self;
    const TO_RAW: fn(Self) -> u32 = |identifier| identifier.0;

    fn is_foreign(id: u32) -> bool {
        id == 0x0100_0000
    }

    fn head<H: Headed>(id: u32, frame: H) -> H::Output {
        match (TARGET.of(id) >= 0xF0, SOURCE.of(id) >= 0xF0) {
            (false, true) => frame.to(Heading::Module),
            (true, false) => frame.to(Heading::Controller),
            (true, true) | (false, false) => frame.to(Heading::Neither),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heat {
    pub power_w: f64,
}

pub const FUNCTION: Selector = Selector::new("function", Place::byte(0));
pub const RESULT: Selector = Selector::new("result", Place::byte(1)).normal(0xF0);

impl Heat {
    pub const POWER: Signal<u16, f64> =
        Signal::new("power", Place::bytes(2, 3)).unit("W").scale(10, 1).limits(0.0, 2000.0);
    pub const SET: Exchange = Access::new("set", &[Some(Who::One), Some(Who::Each), Some(Who::Nobody)])
        .with_values()
        .request(&FRAME.selectors(&[FUNCTION]).data(FUNCTION.place, 1))
        .reply(&FRAME.selectors(&[FUNCTION, RESULT]).data(FUNCTION.place, 2).accepting())
        .of("heat")
        .id(COMMAND, 7)
        .length(4)
        .with(&Particulars::NOTHING.refusal(&FRAME.id(COMMAND, 9).selectors(&[FUNCTION]).data(FUNCTION.place, 1)));
    pub const READ: Exchange = Access::new("read", &[None, Some(Who::Coordinator), None])
        .request(&FRAME)
        .reply(&FRAME)
        .of("heat")
        .id(COMMAND, 8)
        .length(4);
    pub const ASK: Exchange = Access::new("ask", &[Some(Who::One), Some(Who::Each), None])
        .request(&FRAME)
        .reply(&FRAME)
        .of("heat")
        .id(COMMAND, 0x0C)
        .length(4);
    pub const REPORT: Exchange =
        Access::new("report", &[None; 3]).report(&FRAME).of("heat").id(COMMAND, 0x0B).length(4);
    pub const REPORT_1: Exchange = Self::REPORT.with(&Particulars::NOTHING.models(&[1]));
    pub const REPORT_2: Exchange = Access::new("report of model 2", &[None; 3])
        .report(&FRAME)
        .of("heat")
        .length(4)
        .with(&Particulars::NOTHING.models(&[2]));
    pub const PROBE: Exchange = Access::new("probe", &[None; 3]).of("heat").length(2);

    pub fn set(self, route: impl Into<Route<To>>) -> Result<Request<Message, Self>, Error> {
        Self::SET.request_to(route, &self)
    }

    pub fn ask(route: impl Into<Route<To>>) -> Result<Request<Message, Self>, Error> {
        Self::ASK.request_to(route, &())
    }
}

impl Layout for Heat {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[&Self::POWER];
    const DECODE: Decode<Self> = |data| Self { power_w: Self::POWER.decode(data) };

    fn write_to(&self, payload: &mut Payload) -> bool {
        payload.encode(&Self::POWER, self.power_w)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Message {
    Heat(Heat),
    ReadHeat,
}

impl Protocol for Message {
    type Identifier = Identifier;
    const FRAME: Filter = FRAME;
    const NORMAL: Filter = FRAME.id(ERROR, 0);
    const STARTING: Option<u64> = Some(7);
    const AFTER_SILENCE: AfterSilence = AfterSilence::Resumes;
    const DATA_SELECTORS: bool = true;
    const REFUSALS: bool = true;
    const MODES: &'static [Mode] = &[SINGLE, GROUPED, ALL];

    fn request(frame: &Incoming) -> Result<Received<Self>, Problem> {
        match (frame.id(COMMAND), frame.data(FUNCTION.place)) {
            (0x07, 0x01) => frame.request(&Heat::SET, Self::Heat(frame.values())),
            (0x08, _) => frame.request(&Heat::READ, Self::ReadHeat),
            (0x0C, _) => frame.request(&Heat::ASK, Self::ReadHeat),
            (0x0A, _) => frame.best([
                frame.request(&Heat::READ, Self::ReadHeat),
                frame.request(&Heat::SET, Self::Heat(frame.values())),
                frame.request(&Heat::PROBE, Self::ReadHeat),
            ]),
            _ => frame.unknown(),
        }
    }

    fn reply(frame: &Incoming) -> Result<Received<Self>, Problem> {
        match (frame.id(COMMAND), frame.data(FUNCTION.place)) {
            (0x07, 0x02) => frame.reply(&Heat::SET, Self::Heat(frame.values())),
            (0x08, _) => frame.reply(&Heat::READ, Self::Heat(frame.values())),
            (0x0C, _) => frame.reply(&Heat::ASK, Self::Heat(frame.values())),
            (0x0A, _) => frame.best([
                frame.report(&Heat::REPORT_1, Self::Heat(frame.values())),
                frame.report(&Heat::REPORT_2, Self::Heat(frame.values())),
            ]),
            (0x0B, _) => frame.report(&Heat::REPORT, Self::Heat(frame.values())),
            _ => frame.unknown(),
        }
    }

    fn request_lengths(frame: &Incoming) -> &'static [u8] {
        if matches!(frame.id(COMMAND), 0x07 | 0x08 | 0x0C) { &[4] } else { &[] }
    }

    fn reply_lengths(frame: &Incoming) -> &'static [u8] {
        if frame.id(COMMAND) == 0x0B { &[4] } else { Self::request_lengths(frame) }
    }

    fn way(shown: &Shown) -> Option<Way> {
        let source = Address::new(SOURCE, &CONTROLLER);
        Way::best([
            shown.request(0).address(&Address::new(TARGET, &HEATER).excluding(OTHERS)).address(&source),
            shown
                .request(1)
                .address(&Address::new(TARGET, &GROUP).excluding(&[(0, 0x4F), (0x60, 0xFF)]))
                .address(&source),
            shown.reply(1, Who::Each).address(&Address::new(SOURCE, &HEATER)),
            shown.reply(1, Who::Coordinator).address(&Address::new(SOURCE, &GROUP)),
            shown.request(2).id(TARGET, 0x3F).address(&source),
        ])
    }

    fn node(way: &Way) -> Option<i32> {
        Some(match way.place() {
            (0, None) => way.number(TARGET, &HEATER),
            (1, Some(Who::Each)) => way.number(SOURCE, &HEATER),
            _ => return None,
        })
    }

    fn run<T: Task>(&self, task: T) -> T::Output {
        match self {
            Self::Heat(message) => task.run(message),
            Self::ReadHeat => task.run(&()),
        }
    }
}

pub const HEAT: Heat = Heat { power_w: 1500.0 };

pub fn frame(id: u32, data: [u8; 4]) -> Frame {
    let [a, b, c, d] = data;
    Frame::new_raw(id, true, [a, b, c, d, 0, 0, 0, 0], 4)
}

pub fn decode(frame: &Frame) -> Result<Received<Message>, Problem> {
    Received::decode(frame)
}

pub fn mode_of(id: u32, data: [u8; 4]) -> Option<(&'static str, bool, bool)> {
    let addressing = decode(&frame(id, data)).expect("a known frame").addressing()?;
    Some((addressing.mode().name, addressing.is_offered(), addressing.is_documented()))
}
