//! An assembler of parts on a protocol written by hand: three nodes, and messages of two or three parts.

use std::vec::Vec;

use super::*;
use crate::long::{Elements, LongPayload, LongSignal};
use crate::plumbing::{Address, Decode, Headed, Heading, Incoming, Pattern, Task, Who};
use crate::{
    Access, AddressType, AnySignal, Bits, Bytes, Data, Error, Exchange, Filter, Kind, Mode, Payload, Problem, Received,
    Signal,
};

const NODE: Bits = Bits::new(3, 0);
const TO_HOST: Bits = Bits::new(4, 4);
const COMMAND: Bits = Bits::new(6, 5);
const ERROR: Bits = Bits::new(7, 7);
const NODE_ADDRESS: AddressType = AddressType::new("node", 1, 3);

const MODE: Mode = Mode {
    name: "single",
    target: Some(&NODE_ADDRESS),
    request: Some(Pattern { constants: &[(TO_HOST, 0)], addresses: &[Address::new(NODE, &NODE_ADDRESS)] }),
    one: Some(Pattern { constants: &[(TO_HOST, 1)], addresses: &[Address::new(NODE, &NODE_ADDRESS)] }),
    each: None,
    coordinator: None,
};

const READ: Access = Access::new("read", &[Some(Who::One)]).request(&Filter::STANDARD).reply(&Filter::STANDARD);
const STATE: Exchange = READ.of("state").id(COMMAND, 1);
const CELLS: Exchange = READ.of("cells").id(COMMAND, 2);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Message {
    Request,
    State(State),
    Part(CellsPart),
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Identifier(u32);

impl IdentifierFields for Identifier {
    const FROM_RAW: fn(u32) -> Self = Self;
    const TO_RAW: fn(Self) -> u32 = |Self(id)| id;

    fn head<H: Headed>(id: u32, frame: H) -> H::Output {
        if TO_HOST.of(id) == 0 { frame.to(Heading::Module) } else { frame.to(Heading::Controller) }
    }
}

impl Protocol for Message {
    type Identifier = Identifier;
    const FRAME: Filter = Filter::STANDARD;
    const NORMAL: Filter = Filter::STANDARD.id(ERROR, 0);
    const MODES: &'static [Mode] = &[MODE];

    fn request(frame: &Incoming) -> Result<Received<Self>, Problem> {
        match frame.id(COMMAND) {
            1 => frame.request(&STATE, Self::Request),
            2 => frame.request(&CELLS, Self::Request),
            _ => frame.unknown(),
        }
    }

    fn reply(frame: &Incoming) -> Result<Received<Self>, Problem> {
        match frame.id(COMMAND) {
            1 => frame.reply(&STATE, Self::State(frame.values())),
            2 => frame.reply(&CELLS, Self::Part(frame.values())),
            _ => frame.unknown(),
        }
    }

    fn run<T: Task>(&self, task: T) -> T::Output {
        match self {
            Self::State(message) => task.run(message),
            Self::Part(message) => task.run(message),
            Self::Request => task.run(&()),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    cells: u8,
}

impl Layout for State {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[];
    const DECODE: Decode<Self> = |data| Self { cells: Place::byte(0).read(data) };

    fn write_to(&self, _: &mut Payload) -> bool {
        true
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct CellsPart {
    part: u8,
    data: Bytes<4>,
}

impl Layout for CellsPart {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[];
    const DECODE: Decode<Self> = |data| Self { part: Cells::NUMBER.read(data), data: Cells::DATA.read(data) };

    fn write_to(&self, _: &mut Payload) -> bool {
        true
    }
}

/// Two bytes, and one to five cells of two bytes in parts of four.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cells {
    cycles: u16,
    voltage: Elements<u16, 5>,
}

impl Cells {
    const CYCLES: LongSignal<u16> = LongSignal::new(0, Signal::new("cycles", Place::bytes(0, 1)).limits(0, 60_000));
    const VOLTAGE: LongSignal<u16> = LongSignal::new(2, Signal::new("voltage", Place::bytes(0, 1))).every(2);
}

impl LongLayout for Cells {
    const MESSAGE: &'static str = "cells";
    const SHORTEST: usize = 2;
    const LONGEST: usize = 12;
    const ELEMENTS: Option<(usize, usize)> = Some((1, 5));
    const BYTES: fn(usize) -> usize = |elements| Self::VOLTAGE.reach(elements).max(2);
    const DECODE: fn(&[u8]) -> Self = |data| Self {
        cycles: Self::CYCLES.read(data, Signal::get),
        voltage: Self::VOLTAGE.read_some(data, Self::VOLTAGE.fitting(data.len()), Signal::get),
    };
    const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error> = |message, payload| {
        Self::CYCLES.write(message.cycles, payload, Signal::put)?;
        Self::VOLTAGE.write_some(&message.voltage, payload, Signal::put)
    };

    /// Model 7 has no cycles, but 0 in their place.
    fn on_model(self, data: &[u8], model: Option<u8>) -> Self {
        if model == Some(7) && data.len() >= Self::SHORTEST { Self { cycles: 0, ..self } } else { self }
    }
}

impl Parted for Cells {
    type Protocol = Message;
    type Part = CellsPart;
    type Memory = [u8; 13];
    const NUMBER: Place = Place::byte(0);
    const DATA: Place = Place::bytes(1, 4);
    const FIRST: Option<u16> = Some(1);

    const SAID: fn(&Message) -> Said = |message| match message {
        Message::Part(_) => Said::Part,
        Message::State(_) => Said::Count(Place::byte(0)),
        Message::Request => Said::Nothing,
    };
}

fn cells(cells: &[u16]) -> Cells {
    Cells { cycles: 258, voltage: Elements::from_slice(cells).expect("one to five") }
}

/// Returns the frames of a node.
fn frames(node: u32, cells: &Cells) -> Vec<Frame> {
    let blank = Frame::new_raw(2 << 5 | 1 << 4 | node, false, [0; 8], 8);
    cells.frames(&blank).expect("it fits").collect()
}

fn state(node: u32, cells: u8) -> Frame {
    Frame::new_raw(1 << 5 | 1 << 4 | node, false, [cells, 0, 0, 0, 0, 0, 0, 0], 8)
}

fn request(node: u32) -> Frame {
    Frame::new_raw(2 << 5 | node, false, [0; 8], 8)
}

/// What became of a message, to compare it: who sent it, its values, and its missing parts.
type Told = (u32, Option<Cells>, Vec<u16>);

fn told(outcome: Outcome<Cells>) -> Told {
    match outcome {
        Outcome::Whole(whole) => (NODE.of(whole.identifier().0), Some(whole.values), Vec::new()),
        Outcome::Incomplete(partial) => (NODE.of(partial.identifier().0), None, partial.missing().collect()),
        Outcome::Full(frame) => (NODE.of(frame.raw_id()), None, Vec::new()),
    }
}

fn fed<const N: usize>(assembler: &mut Assembler<Cells, N>, frames: &[Frame]) -> Vec<Told> {
    frames.iter().flat_map(|frame| assembler.receive(frame, 0)).map(told).collect()
}

#[test]
fn a_message_is_taken_apart_and_put_together() {
    let message = cells(&[10, 20, 30, 40, 50]);
    let parts: Vec<_> = message.parts().expect("it fits").collect();
    // 258 is 0x0102; cells of two bytes follow it.
    let expected = [[1, 2, 0, 10], [0, 20, 0, 30], [0, 40, 0, 50]].map(Bytes::new);
    assert_eq!(parts.iter().map(|part| part.data).collect::<Vec<_>>(), expected);
    assert_eq!(parts.iter().map(|part| part.part).collect::<Vec<_>>(), [1, 2, 3]);
    assert_eq!(fed(&mut Assembler::<_, 1>::new(9), &frames(2, &message)), [(2, Some(message), Vec::new())]);
}

#[test]
fn a_message_has_what_the_device_model_of_the_assembler_has() {
    let message = cells(&[10, 20, 30, 40, 50]);
    let on = |model: u8| fed(&mut Assembler::<_, 1>::new(9).for_model(model), &frames(2, &message));
    assert_eq!(on(7), [(2, Some(Cells { cycles: 0, ..message }), Vec::new())]);
    assert_eq!(on(8), [(2, Some(message), Vec::new())]);
}

#[test]
fn the_number_that_a_node_tells_ends_its_messages() {
    let (short, mut assembler) = (cells(&[10]), Assembler::<_, 3>::new(9));
    assert_eq!(fed(&mut assembler, &frames(2, &short)), []);
    assert_eq!(fed(&mut assembler, &[state(1, 1), state(3, 2)]), []);
    assert_eq!(fed(&mut assembler, &frames(1, &short)), [(1, Some(short), Vec::new())]);
    let Some(Outcome::Whole(counted)) = assembler.receive(&frames(1, &short)[0], 0).next() else { panic!("one part") };
    assert!(counted.is_counted);
    let two = cells(&[10, 20]);
    assert_eq!(fed(&mut assembler, &frames(3, &two)), [(3, Some(two), Vec::new())]);
    // Node 2 has told nothing. All elements are shown that came: those of the one part.
    let Some(Outcome::Whole(last)) = assembler.finish() else { panic!("one message has begun") };
    assert_eq!((last.values, last.is_counted), (short, false));
    assert!(assembler.finish().is_none());
}

#[test]
fn a_repeated_frame_counts_once_and_a_lost_one_is_missing() {
    let mut assembler = Assembler::<_, 1>::new(9);
    let message = cells(&[10, 20, 30, 40, 50]);
    let [one, two, three] = frames(1, &message)[..] else { panic!("three parts") };
    assert_eq!(fed(&mut assembler, &[one, one, two, two, three]), [(1, Some(message), Vec::new())]);
    assert_eq!(fed(&mut assembler, &[one, three]), [(1, None, [2].into())]);
    assert_eq!(fed(&mut assembler, &[three]), [(1, None, [1, 2].into())]);
    // A part that is not greater begins another message.
    assert_eq!(fed(&mut assembler, &[one, two, one]), [(1, Some(cells(&[10, 20, 30])), Vec::new())]);
    // The node tells that there are five cells, so each message that begins anew has lost something.
    assert_eq!(
        fed(&mut assembler, &[state(1, 5), two, one, one, three]),
        [(1, None, [3].into()), (1, None, [2].into())]
    );
}

#[test]
fn a_request_begins_another_message() {
    let mut assembler = Assembler::<_, 2>::new(9);
    let [one, two, three] = frames(1, &cells(&[10, 20, 30, 40, 50]))[..] else { panic!("three parts") };
    let told = fed(&mut assembler, &[state(1, 5), one, request(2), two, request(1), three]);
    assert_eq!(told, [(1, None, [3].into()), (1, None, [1, 2].into())]);
}

#[test]
fn an_incomplete_message_has_what_came() {
    let mut assembler = Assembler::<Cells, 1>::new(9);
    let [one, _, three] = frames(1, &cells(&[10, 20, 30, 40, 50]))[..] else { panic!("three parts") };
    assert!(assembler.receive(&one, 0).next().is_none());
    let Some(Outcome::Incomplete(partial)) = assembler.receive(&three, 0).next() else { panic!("part 2 is missing") };
    assert_eq!(
        [1, 2, 3, 0].map(|number| partial.part(number)),
        [Some(&[1, 2, 0, 10][..]), None, Some(&[0, 40, 0, 50]), None]
    );
    assert_eq!(partial.data(), [1, 2, 0, 10, 0, 0, 0, 0, 0, 40, 0, 50]);
}

#[test]
fn there_is_room_for_as_many_nodes_as_the_caller_says() {
    let mut assembler = Assembler::<_, 1>::new(9);
    let message = cells(&[10, 20, 30, 40, 50]);
    let of_one = frames(1, &message);
    assert!(assembler.receive(&of_one[0], 0).next().is_none());
    assert!(matches!(assembler.receive(&frames(2, &message)[0], 0).next(), Some(Outcome::Full(_))));
    assert_eq!(fed(&mut assembler, &of_one[1..]), [(1, Some(message), Vec::new())]);
}

#[test]
fn a_silent_node_times_out_whatever_the_time_is() {
    let mut assembler = Assembler::<_, 2>::new(100);
    let of = |node| frames(node, &cells(&[10, 20, 30, 40, 50]));
    assert!(assembler.receive(&of(1)[0], u32::MAX - 10).next().is_none());
    assert!(assembler.receive(&of(2)[0], 0).next().is_none());
    assert!(assembler.timed_out(88).is_none());
    assert_eq!(assembler.timed_out(89).map(told), Some((1, Some(cells(&[10])), Vec::new())));
    assert!(assembler.timed_out(89).is_none());
    // A repeated frame shows that the node is there.
    assert!(assembler.receive(&of(2)[0], 90).next().is_none());
    assert!(assembler.timed_out(189).is_none() && assembler.timed_out(190).is_some());
}

#[test]
fn frames_that_are_none_of_the_message_change_nothing() {
    let mut assembler = Assembler::<_, 1>::new(9);
    let [one, two, _] = frames(1, &cells(&[10, 20, 30, 40, 50]))[..] else { panic!("three parts") };
    let other = Frame::new_raw(3 << 5 | 1 << 4 | 1, false, [0; 8], 8);
    let beyond = one.with_data([4, 0, 0, 0, 0, 0, 0, 0] as Data);
    let before = one.with_data([0; 8]);
    let extended = Frame::new_raw(one.raw_id(), true, one.bytes(), 8);
    let error = |frame: Frame| Frame::new_raw(frame.raw_id() | 1 << 7, false, frame.bytes(), 8);
    assert_eq!(fed(&mut assembler, &[one, other, beyond, before, extended, error(state(1, 1)), error(two), two]), []);
    assert_eq!(assembler.finish().map(told), Some((1, Some(cells(&[10, 20, 30])), Vec::new())));
    assert_eq!(CELLS.filter(Kind::Reply).map(|filter| filter.matches(&one)), Some(true));
}

/// Lets a type have the layout of [`Cells`].
macro_rules! like_cells {
    ($name:ident) => {
        impl LongLayout for $name {
            const MESSAGE: &'static str = Cells::MESSAGE;
            const SHORTEST: usize = Cells::SHORTEST;
            const LONGEST: usize = Cells::LONGEST;
            const ELEMENTS: Option<(usize, usize)> = Cells::ELEMENTS;
            const BYTES: fn(usize) -> usize = Cells::BYTES;
            const DECODE: fn(&[u8]) -> Self = |data| Self(Cells::DECODE(data));
            const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error> =
                |own, payload| Cells::ENCODE(&own.0, payload);
        }
    };
}

/// The same as [`Cells`] in fast packets: the frames count their messages, and the first one begins with the length.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Packet(Cells);

like_cells!(Packet);

impl Parted for Packet {
    type Protocol = Message;
    type Part = CellsPart;
    type Memory = [u8; 17];
    const NUMBER: Place = Place::byte(0).bits(4, 0);
    const COUNTER: Option<Place> = Some(Place::byte(0).bits(7, 5));
    const LENGTH: Option<Place> = Some(Place::byte(1));
    const DATA: Place = Place::bytes(1, 4);
    const FIRST: Option<u16> = Some(0);
    const SAID: fn(&Message) -> Said = |message| match message {
        Message::Part(_) => Said::Part,
        Message::State(_) | Message::Request => Said::Nothing,
    };
}

/// Returns a frame of node 1 with these bytes.
fn packet(data: [u8; 5]) -> Frame {
    let [one, two, three, four, five] = data;
    Frame::new_raw(2 << 5 | 1 << 4 | 1, false, [one, two, three, four, five, 0, 0, 0], 8)
}

/// What became of a fast packet: its cells, or the missing parts and the length that is announced.
type Ended = Result<Vec<u16>, (Vec<u16>, Option<usize>)>;

fn ended(assembler: &mut Assembler<Packet, 1>, frames: &[[u8; 5]]) -> Vec<Ended> {
    let outcomes = frames.iter().flat_map(|frame| assembler.receive(&packet(*frame), 0));
    let told = |outcome: Outcome<Packet>| match outcome {
        Outcome::Whole(whole) => Ok(whole.values.0.voltage.to_vec()),
        Outcome::Incomplete(partial) => Err((partial.missing().collect(), partial.announced())),
        Outcome::Full(_) => panic!("there is room for one"),
    };
    outcomes.map(told).collect()
}

#[test]
fn a_fast_packet_begins_with_its_length_and_each_frame_counts_the_messages() {
    let frames = Packet(cells(&[10, 20])).frames(&packet([0; 5])).expect("it fits");
    let bytes = |frames: Frames<Packet>| frames.map(|frame| frame.bytes()).collect::<Vec<_>>();
    // Two bytes for 258 and two cells of two bytes are six.
    assert_eq!(bytes(frames.clone()), [[0, 6, 1, 2, 0, 0, 0, 0], [1, 10, 0, 20, 0, 0, 0, 0]]);
    // Three bits hold 1 of 9.
    assert_eq!(bytes(frames.with_counter(9)), [[0x20, 6, 1, 2, 0, 0, 0, 0], [0x21, 10, 0, 20, 0, 0, 0, 0]]);
    let mut assembler = Assembler::new(9);
    // What fills up the last part is no cell.
    assert_eq!(ended(&mut assembler, &[[0x20, 6, 1, 2, 0], [0x21, 10, 0, 20, 30]]), [Ok([10, 20].into())]);
    assert_eq!(ended(&mut assembler, &[[0x40, 4, 1, 2, 0], [0x41, 10, 0, 0, 0]]), [Ok([10].into())]);
    assert!(assembler.receive(&packet([0x60, 4, 1, 2, 0]), 0).next().is_none());
    let last = assembler.receive(&packet([0x61, 10, 0, 0, 0]), 0).next();
    let Some(Outcome::Whole(whole)) = last else { panic!("both parts came") };
    assert!(whole.is_counted);
}

#[test]
fn parts_with_another_counter_are_never_joined() {
    let mut assembler = Assembler::new(9);
    let lost = [[0x20, 6, 1, 2, 0], [0x41, 10, 0, 20, 0]];
    assert_eq!(ended(&mut assembler, &lost), [Err(([1].into(), Some(6)))]);
    // The second message lacks its first part, so nobody knows how long it is.
    assert_eq!(ended(&mut assembler, &[[0x60, 4, 1, 2, 0]]), [Err(([0].into(), None))]);
    // The same frame again counts once, but not with another counter.
    let again = [[0x60, 4, 1, 2, 0], [0x80, 4, 1, 2, 0], [0x81, 9, 0, 0, 0]];
    assert_eq!(ended(&mut assembler, &again), [Err(([1].into(), Some(4))), Ok([9].into())]);
}

#[test]
fn a_length_that_the_message_never_has_is_told() {
    let mut assembler = Assembler::new(9);
    // It is over with the last frame that is announced.
    assert_eq!(ended(&mut assembler, &[[0x20, 0, 1, 2, 0]]), [Err(([].into(), Some(0)))]);
    assert_eq!(ended(&mut assembler, &[[0x40, 5, 1, 2, 0], [0x41, 10, 0, 20, 0]]), [Err(([].into(), Some(5)))]);
    // There is no room for more than four parts.
    let long = [[0x60, 200, 1, 2, 0], [0x61, 1, 0, 2, 0], [0x62, 3, 0, 4, 0], [0x63, 5, 0, 6, 0], [0x64, 7, 0, 8, 0]];
    assert_eq!(ended(&mut assembler, &long), [Err(([].into(), Some(200)))]);
    assert!(assembler.finish().is_none());
}

/// The same as [`Cells`], but nobody says how many there are: a message ends by silence.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pausing(Cells);

like_cells!(Pausing);

impl Parted for Pausing {
    type Protocol = Message;
    type Part = CellsPart;
    type Memory = [u8; 13];
    const NUMBER: Place = Place::byte(0);
    const DATA: Place = Place::bytes(1, 4);
    const FIRST: Option<u16> = Some(1);
    const SILENCE: Option<u32> = Some(50);
    const SAID: fn(&Message) -> Said = Packet::SAID;
}

#[test]
fn a_message_that_ends_by_silence_is_whole_with_what_it_has() {
    // The document says how long silence is, so the patience does not matter.
    let mut assembler = Assembler::<Pausing, 1>::new(9);
    let [one, two, _] = frames(1, &cells(&[10, 20, 30, 40, 50]))[..] else { panic!("three parts") };
    let said = |outcome: Option<Outcome<Pausing>>| match outcome {
        Some(Outcome::Whole(whole)) => (whole.values.0.voltage.to_vec(), whole.is_counted),
        other => panic!("{other:?}"),
    };
    assert!(assembler.receive(&one, 0).next().is_none());
    assert!(assembler.timed_out(49).is_none());
    assert_eq!(said(assembler.timed_out(50)), ([10].into(), true));
    // A frame shows the silence, too. Its part belongs to another message, which lacks the first one.
    assert!(assembler.receive(&one, 100).next().is_none());
    assert_eq!(said(assembler.receive(&two, 150).next()), ([10].into(), true));
    let Some(Outcome::Incomplete(partial)) = assembler.timed_out(200) else { panic!("part 1 is missing") };
    assert_eq!(partial.missing().collect::<Vec<_>>(), [1]);
    // The same frame after the silence is a message of its own.
    assert!(assembler.receive(&one, 300).next().is_none());
    assert_eq!(said(assembler.receive(&one, 350).next()), ([10].into(), true));
    // A message that begins before the silence does not show where the other one ended. The end of a log does not, either.
    assert!(assembler.receive(&two, 360).next().is_none());
    assert_eq!(said(assembler.receive(&one, 370).next()), ([10, 20, 30].into(), false));
    assert_eq!(said(assembler.finish()), ([10].into(), false));
}

#[test]
fn values_keep_to_limits_on_the_way_to_a_module_only() {
    let cells = Cells { cycles: 60_001, ..cells(&[3300]) };
    let frames = |id| cells.frames(&Frame::new_raw(id, false, [0; 8], 8)).map(|_| ());
    assert!(matches!(frames(0x41), Err(Error::Value(_))));
    assert_eq!(frames(0x51), Ok(()));
}
