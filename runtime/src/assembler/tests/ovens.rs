//! A made-up protocol: ovens 1 to 15 answer with sets of six members, or of two.

use crate::plumbing::{Address, Continuation, Decode, Headed, Heading, Incoming, Pattern, Task, Who};
use crate::{
    Access, AddressType, AnySignal, Bits, Exchange, Filter, Frame, FrameSet, IdentifierFields, Layout, Mode, Payload,
    Place, Problem, Protocol, Received, Selector, Signal,
};

const DIRECTION: Bits = Bits::new(10, 10);
const COMMAND: Bits = Bits::new(9, 5);
const NODE: Bits = Bits::new(4, 1);
const MORE: Bits = Bits::new(0, 0);
const SIGNAL: Selector = Selector::new("signal", Place::byte(0));
const RESULT: Selector = Selector::new("result", Place::byte(1)).normal(0);

const OVEN: AddressType = AddressType::new("oven", 1, 9);

const SINGLE: Mode = Mode {
    name: "single",
    target: Some(&OVEN),
    request: Some(Pattern { constants: &[(DIRECTION, 0)], addresses: &[Address::new(NODE, &OVEN)] }),
    one: Some(Pattern { constants: &[(DIRECTION, 1)], addresses: &[Address::new(NODE, &OVEN).excluding(&[(0, 0)])] }),
    each: None,
    coordinator: None,
};

const ANSWERS: &[Option<Who>] = &[Some(Who::One)];

const SCAN: Access = Access::new("scan", ANSWERS).request(&Filter::STANDARD).reply(&Filter::STANDARD);
const SCAN_ALL: Access = of_members("scan").member_of("all");
const SCAN_PAIR: Access = of_members("scan").member_of("pair");
const READ: Access = of_members("read");

const fn of_members(name: &'static str) -> Access {
    const SHOWN: Filter = Filter::STANDARD.selectors(&[SIGNAL, RESULT]);
    Access::new(name, ANSWERS).request(&SHOWN).reply(const { &SHOWN.accepting() })
}

/// Returns how a member travels, alone or as part of a set.
const fn member(access: &'static Access, name: &'static str, command: u32, signal: u64) -> Exchange {
    access.of(name).id(COMMAND, command).data(SIGNAL.place, signal).length(4)
}

const fn whole(name: &'static str, command: u32) -> Exchange {
    SCAN.of(name).id(COMMAND, command).length(4)
}

static ALL: Exchange = whole("all", 5);
static PAIR: Exchange = whole("pair", 6);

static OF_ALL: [Exchange; 6] = [
    member(&SCAN_ALL, "a", 5, 1),
    member(&SCAN_ALL, "b", 5, 2),
    member(&SCAN_ALL, "c", 5, 3),
    member(&SCAN_ALL, "d", 5, 4),
    member(&SCAN_ALL, "e", 5, 5),
    member(&SCAN_ALL, "f", 5, 6),
];

static OF_PAIR: [Exchange; 2] = [member(&SCAN_PAIR, "a", 6, 1), member(&SCAN_PAIR, "b", 6, 2)];

static ALONE: [Exchange; 6] = [
    member(&READ, "a", 7, 1),
    member(&READ, "b", 7, 2),
    member(&READ, "c", 7, 3),
    member(&READ, "d", 7, 4),
    member(&READ, "e", 7, 5),
    member(&READ, "f", 7, 6),
];

/// A member by its place among the six, and what it says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    position: usize,
    value: u16,
}

const VALUE: Signal<u16> = Signal::new("value", Place::bytes(2, 3));

impl Layout for Value {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[&VALUE];
    const DECODE: Decode<Self> = |data| Self { position: usize::from(data[0]).wrapping_sub(1), value: VALUE.get(data) };

    fn write_to(&self, payload: &mut Payload) -> bool {
        payload.put(&VALUE, self.value)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identifier(u32);

impl IdentifierFields for Identifier {
    const FROM_RAW: fn(u32) -> Self = Self;
    const TO_RAW: fn(Self) -> u32 = |identifier| identifier.0;

    fn head<H: Headed>(id: u32, frame: H) -> H::Output {
        if DIRECTION.of(id) == 0 { frame.to(Heading::Module) } else { frame.to(Heading::Controller) }
    }
}

impl Protocol for Value {
    type Identifier = Identifier;
    const FRAME: Filter = Filter::STANDARD;
    const NORMAL: Filter = Filter::STANDARD;
    const MODES: &'static [Mode] = &[SINGLE];
    const DATA_SELECTORS: bool = true;

    fn request(frame: &Incoming) -> Result<Received<Self>, Problem> {
        found(frame).map_or_else(|| frame.unknown(), |exchange| frame.request(exchange, frame.values()))
    }

    fn reply(frame: &Incoming) -> Result<Received<Self>, Problem> {
        found(frame).map_or_else(|| frame.unknown(), |exchange| frame.reply(exchange, frame.values()))
    }

    fn request_lengths(_: &Incoming) -> &'static [u8] {
        &[4]
    }

    fn reply_lengths(_: &Incoming) -> &'static [u8] {
        &[4, 8]
    }

    fn run<T: Task>(&self, task: T) -> T::Output {
        task.run(self)
    }
}

/// Finds how a frame travels; device model 1 takes the six as members of no set.
fn found(frame: &Incoming) -> Option<&'static Exchange> {
    let known: &[Exchange] = match (frame.id(COMMAND), frame.model) {
        (5, None) => &OF_ALL,
        (6, None) => &OF_PAIR,
        (5 | 7, _) => &ALONE,
        _ => return None,
    };
    known.get(usize::try_from(frame.data(Place::byte(0))).ok()?.wrapping_sub(1))
}

/// The six values of an oven.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct All(pub [Option<u16>; 6]);

impl FrameSet for All {
    type Protocol = Value;
    const EXCHANGE: &'static Exchange = &ALL;
    const NODE: &'static AddressType = &OVEN;
    const CONTINUATION: Continuation = Continuation::identifier(MORE, 1);
    const MEMBERS: &'static [&'static str] = &["a", "b", "c", "d", "e", "f"];

    fn position(message: &Value) -> Option<usize> {
        Some(message.position).filter(|position| *position < 6)
    }

    fn put(&mut self, message: &Value) -> bool {
        self.0[message.position].replace(message.value) == Some(message.value)
    }
}

/// The two values of a smaller set, whose byte 3 says whether more follow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pair(pub [Option<u16>; 2]);

impl FrameSet for Pair {
    type Protocol = Value;
    const EXCHANGE: &'static Exchange = &PAIR;
    const NODE: &'static AddressType = &OVEN;
    const CONTINUATION: Continuation = Continuation::data(Place::byte(3), 0xAA);
    const MEMBERS: &'static [&'static str] = &["a", "b"];

    fn position(message: &Value) -> Option<usize> {
        Some(message.position)
    }

    fn put(&mut self, message: &Value) -> bool {
        self.0[message.position].replace(message.value) == Some(message.value)
    }
}

/// Returns the reply of an oven by a command; signals are counted from 1.
pub fn reply(command: u32, node: u32, more: bool, signal: u8, value: u16) -> Frame {
    let [high, low] = value.to_be_bytes();
    let id = 0x400 | command << 5 | node << 1 | u32::from(more);
    Frame::new_raw(id, false, [signal, 0, high, low, 0, 0, 0, 0], 4)
}
