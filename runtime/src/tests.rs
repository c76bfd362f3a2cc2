//! A made-up protocol: heaters 1 to 9, alone, in groups or all together, and a controller 0xF0 or 0xF1.

use std::string::ToString;

use crate::plumbing::{Address, Decode, Encode, Pattern, Recognised, Task, Who};
use crate::{
    AddressType, AnySignal, Bits, Destination, Entry, Error, Exchange, Failure, Filter, Frame, IdentifierFields, Kind,
    Layout, Meaning, Mode, Number, Place, Problem, Protocol, Reading, Received, Replies, Request, Route, Selector,
    Signal, StatusBit,
};

const FRAME: Filter = Filter::EXTENDED.id_bits(0x0300_0000, 0x0100_0000);
const ERROR: Bits = Bits::new(28, 26);
const COMMAND: Bits = Bits::new(23, 16);
const TARGET: Bits = Bits::new(15, 8);
const SOURCE: Bits = Bits::new(7, 0);

const CONTROLLER: AddressType = AddressType::new("controller", 0xF0, 0xF1).strict().default_number(0xF0);
const HEATER: AddressType = AddressType::new("heater", 1, 9);
const GROUP: AddressType = AddressType::new("group", 0, 15).offset(0x5F).descending();

const OTHERS: &[(u32, u32)] = &[(0x3F, 0x3F), (0x50, 0x5F), (0xF0, 0xF1)];
const TO_CONTROLLER: Address = Address::new(TARGET, &CONTROLLER);
const FROM_CONTROLLER: Address = Address::new(SOURCE, &CONTROLLER);

const fn mode(name: &'static str, target: Option<&'static AddressType>, request: Pattern) -> Mode {
    Mode { name, target, request: Some(request), one: None, each: None, coordinator: None }
}

const FROM_HEATER: Pattern =
    Pattern { constants: &[], addresses: &[TO_CONTROLLER, Address::new(SOURCE, &HEATER).excluding(OTHERS)] };

const SINGLE: Mode = Mode {
    one: Some(FROM_HEATER),
    ..mode(
        "single",
        Some(&HEATER),
        Pattern { constants: &[], addresses: &[Address::new(TARGET, &HEATER).excluding(OTHERS), FROM_CONTROLLER] },
    )
};

const GROUPED: Mode = Mode {
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

const ALL: Mode = mode("all", None, Pattern { constants: &[(TARGET, 0x3F)], addresses: &[FROM_CONTROLLER] });

#[derive(Clone, Copy)]
enum To {
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

    fn number(self) -> Option<i32> {
        match self {
            Self::Heater(number) | Self::Group(number) => Some(number.into()),
            Self::All => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Identifier(u32);

impl IdentifierFields for Identifier {
    const FROM_RAW: fn(u32) -> Self = Self;
    const TO_RAW: fn(Self) -> u32 = |identifier| identifier.0;

    fn is_foreign(id: u32) -> bool {
        id == 0x0100_0000
    }

    fn is_to_module(id: u32) -> bool {
        SOURCE.of(id) >= 0xF0 && TARGET.of(id) < 0xF0
    }

    fn is_to_controller(id: u32) -> bool {
        TARGET.of(id) >= 0xF0 && SOURCE.of(id) < 0xF0
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Heat {
    power_w: f64,
}

const FUNCTION: Selector = Selector::new("function", Place::byte(0));
const RESULT: Selector = Selector::new("result", Place::byte(1)).normal(0xF0);

impl Heat {
    const POWER: Signal<u16, f64> = Signal::new("power", Place::bytes(2, 3)).unit("W").scale(10, 1).limits(0.0, 2000.0);
    const SET: Exchange = Exchange::new("set", &[Some(Who::One), Some(Who::Each), Some(Who::Nobody)])
        .with_values()
        .request(FRAME.selectors(&[FUNCTION]).data(FUNCTION.place, 1))
        .reply(FRAME.selectors(&[FUNCTION, RESULT]).data(FUNCTION.place, 2))
        .of("heat", FRAME.id(COMMAND, 7))
        .length(4)
        .refusal(&FRAME.id(COMMAND, 9).selectors(&[FUNCTION]).data(FUNCTION.place, 1));
    const READ: Exchange = Exchange::new("read", &[None, Some(Who::Coordinator), None])
        .request(FRAME)
        .reply(FRAME)
        .of("heat", FRAME.id(COMMAND, 8))
        .length(4);
    const REPORT: Exchange =
        Exchange::new("report", &[None; 3]).report(FRAME).of("heat", FRAME.id(COMMAND, 0x0B)).length(4);
    const PROBE: Exchange = Exchange::new("probe", &[None; 3]).of("heat", FRAME).length(2);

    fn set(self, route: impl Into<Route<To>>) -> Result<Request<Message, Self>, Error> {
        Self::SET.request_to(route, &self)
    }
}

impl Layout for Heat {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[&Self::POWER];
    const DECODE: Decode<Self> = |data| Self { power_w: Self::POWER.decode(data) };
    const ENCODE: Encode<Self> = |message, payload| Self::POWER.encode(message.power_w, payload);
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Message {
    Heat(Heat),
    ReadHeat,
}

impl Protocol for Message {
    type Identifier = Identifier;
    const FRAME: Filter = FRAME;
    const NORMAL: Filter = FRAME.id(ERROR, 0);
    const MODES: &'static [Mode] = &[SINGLE, GROUPED, ALL];

    fn request(frame: &Frame, model: Option<u8>) -> Option<Recognised<Self>> {
        let data = &frame.bytes();
        Some(match (COMMAND.of(frame.raw_id()), FUNCTION.place.get(data)) {
            (0x07, 0x01) => Recognised::request(&Heat::SET, Self::Heat(Layout::decode(data))),
            (0x08, _) => Recognised::request(&Heat::READ, Self::ReadHeat),
            (0x0A, _) => Recognised::request(&Heat::READ, Self::ReadHeat)
                .or(Recognised::request(&Heat::SET, Self::Heat(Layout::decode(data))), frame, model)
                .or(Recognised::request(&Heat::PROBE, Self::ReadHeat), frame, model),
            _ => return None,
        })
    }

    fn reply(frame: &Frame, _: Option<u8>) -> Option<Recognised<Self>> {
        let data = &frame.bytes();
        Some(match (COMMAND.of(frame.raw_id()), FUNCTION.place.get(data)) {
            (0x07, 0x02) => Recognised::reply(&Heat::SET, Self::Heat(Layout::decode(data))),
            (0x08, _) => Recognised::reply(&Heat::READ, Self::Heat(Layout::decode(data))),
            (0x0B, _) => Recognised::report(&Heat::REPORT, Self::Heat(Layout::decode(data))),
            _ => return None,
        })
    }

    fn request_lengths(id: u32) -> &'static [u8] {
        if matches!(COMMAND.of(id), 0x07 | 0x08) { &[4] } else { &[] }
    }

    fn reply_lengths(id: u32) -> &'static [u8] {
        Self::request_lengths(id)
    }

    fn run<T: Task>(&self, task: T) -> T::Output {
        match self {
            Self::Heat(message) => task.run(message),
            Self::ReadHeat => task.run(&()),
        }
    }
}

const HEAT: Heat = Heat { power_w: 1500.0 };

fn frame(id: u32, data: [u8; 4]) -> Frame {
    let [a, b, c, d] = data;
    Frame::new_raw(id, true, [a, b, c, d, 0, 0, 0, 0], 4)
}

fn decode(frame: &Frame) -> Result<Received<Message>, Problem> {
    Received::decode(frame)
}

fn mode_of(id: u32, data: [u8; 4]) -> Option<(&'static str, bool, bool)> {
    let addressing = decode(&frame(id, data)).expect("a known frame").addressing()?;
    Some((addressing.mode().name, addressing.is_offered(), addressing.is_documented()))
}

/// A request that waits for its reply, whatever that carries.
#[derive(Clone, Copy, Debug)]
struct Pending<P, R> {
    request: Request<P, R>,
    sent_at: u32,
}

impl<P, R> Pending<P, R> {
    fn frame(&self) -> (u32, Frame, bool) {
        (self.sent_at, *self.request.frame(), self.request.replies().filter().is_some())
    }
}

#[test]
fn a_request_is_kept_and_read_without_bounds_on_its_reply() {
    /// What no reply carries.
    struct Nothing;
    let request: Request<Message, Nothing> = Heat::READ.request_to(To::Group(2), &()).expect("a legal request");
    let pending = Pending { request, sent_at: 7 };
    assert_eq!(pending.frame(), (7, *request.frame(), true));
    assert!(!request.is_reply(request.frame()));
    assert!(std::format!("{request:?}").starts_with("Request { frame: "));
}

#[test]
fn a_request_shows_addresses_constants_and_values() {
    let request = |route: Route<To>| HEAT.set(route).expect("a legal request").frame().to_string();
    assert_eq!(request(To::Heater(3).into()), "010703F0#01000096");
    assert_eq!(request(Route::new(To::Heater(3), 0xF1)), "010703F1#01000096");
    assert_eq!(request(To::Group(2).into()), "01075DF0#01000096");
    assert_eq!(request(To::All.into()), "01073FF0#01000096");
}

#[test]
fn a_request_refuses_addresses_modes_and_values_that_are_not_documented() {
    let refusal = |result: Result<Request<Message, Heat>, Error>| result.expect_err("a refusal").to_string();
    assert_eq!(refusal(HEAT.set(To::Heater(10))), "`heater` is 0x0A, but its limits are 0x01..=0x09");
    assert_eq!(refusal(HEAT.set(Route::new(To::All, 0xF2))), "`controller` is 0xF2, but its limits are 0xF0..=0xF1");
    let read = Heat::READ.request_to(To::All, &());
    assert_eq!(refusal(read), "`heat` has no `read` with the addressing mode `all`");
    let hot = Heat { power_w: 2000.1 }.set(To::All);
    assert_eq!(refusal(hot), "`power` of `heat` is 2000.1 W, but its limits are 0 and 2000 W");
}

#[test]
fn replies_come_from_whom_the_request_addressed() {
    let request = HEAT.set(To::Heater(3)).expect("a legal request");
    assert!(matches!(request.replies(), Replies::One(filter) if filter.id_mask() == 0x03FF_FFFF));
    let reply = request.reply(&frame(0x0107_F003, [2, 0xF0, 0, 0x64])).expect("the reply of heater 3");
    assert_eq!((reply.identifier, reply.values), (Identifier(0x0107_F003), Ok(Heat { power_w: 1000.0 })));
    for other in [0x0107_F004, 0x0107_F103, 0x0108_F003, 0x0107_03F0] {
        assert!(!request.is_reply(&frame(other, [2, 0xF0, 0, 0x64])), "{other:X}");
    }
    assert!(!request.is_reply(&frame(0x0107_F003, [1, 0xF0, 0, 0x64])));
}

#[test]
fn each_heater_of_a_group_may_answer_and_nobody_answers_all() {
    let request = HEAT.set(To::Group(2)).expect("a legal request");
    assert!(matches!(request.replies(), Replies::Each(filter) if filter.id_mask() == 0x03FF_FF00));
    assert!(request.is_reply(&frame(0x0107_F009, [2, 0xF0, 0, 0])));
    let coordinator: Request<Message, Heat> = Heat::READ.request_to(To::Group(2), &()).expect("a legal request");
    assert!(matches!(coordinator.replies(), Replies::Coordinator(filter) if filter.id_value() == 0x0108_F05D));
    assert_eq!(HEAT.set(To::All).expect("a legal request").replies(), &Replies::Nobody);
}

#[test]
fn an_error_reply_is_a_reply_without_values() {
    let request = HEAT.set(To::Heater(3)).expect("a legal request");
    for error in [frame(0x0907_F003, [2, 0xF0, 0, 0]), frame(0x0107_F003, [2, 0xF2, 0, 0])] {
        let reply = request.reply(&error).expect("the reply of heater 3");
        assert_eq!((reply.identifier.0, reply.values), (error.raw_id(), Err(Failure::Error)));
        let received = decode(&error).expect("a known frame");
        assert!(received.is_error_reply() && received.reply() == Some(Err(Failure::Error)));
        assert_eq!(received.content(), &Message::Heat(Heat { power_w: 0.0 }));
    }
    let refused = request.reply(&frame(0x0107_F003, [2, 0xF2, 0, 0])).expect("the reply of heater 3");
    let codes: std::vec::Vec<_> = refused.selectors().map(|(selector, raw)| (selector.name, raw)).collect();
    assert_eq!(codes, [("function", 2), ("result", 0xF2)]);
}

#[test]
fn a_refusal_is_a_reply_without_values_whatever_its_length() {
    let request = HEAT.set(To::Heater(3)).expect("a legal request");
    for length in [1, 4, 8] {
        let refused = Frame::new_raw(0x0109_F003, true, [1, 0, 0, 5, 0, 0, 0, 0], length);
        let reply = request.reply(&refused).expect("the refusal of heater 3");
        assert_eq!((reply.identifier, reply.values), (Identifier(0x0109_F003), Err(Failure::Error)));
        assert!(reply.selectors().map(|(selector, raw)| (selector.name, raw)).eq([("function", 1)]));
        assert!(request.is_reply(&refused));
    }
    for other in [frame(0x0109_F004, [1; 4]), frame(0x0109_F003, [2; 4]), frame(0x0109_03F0, [1; 4])] {
        assert!(request.reply(&other).is_none() && !request.is_reply(&other), "{other}");
    }
    assert_eq!(HEAT.set(To::All).expect("a legal request").refusal(), None);
}

#[test]
fn a_reply_of_another_length_has_no_values_but_may_have_an_error_code() {
    let request: Request<Message, Heat> = Heat::READ.request_to(To::Group(2), &()).expect("a legal request");
    let values =
        |id, length| request.reply(&Frame::new_raw(id, true, [0; 8], length)).expect("the coordinator's reply").values;
    assert_eq!(values(0x0108_F05D, 4), Ok(Heat { power_w: 0.0 }));
    assert_eq!(values(0x0108_F05D, 3), Err(Failure::Length));
    assert_eq!(values(0x0108_F05D, 5), Err(Failure::Length));
    assert_eq!(values(0x0908_F05D, 0), Err(Failure::Error));
    let request = HEAT.set(To::Heater(3)).expect("a legal request");
    let short =
        |data, length| request.reply(&Frame::new_raw(0x0107_F003, true, data, length)).map(|reply| reply.values);
    assert_eq!(short([2, 0, 0, 0, 0, 0, 0, 0], 1), Some(Err(Failure::Length)));
    assert_eq!(short([2, 0xF2, 0, 0, 0, 0, 0, 0], 2), Some(Err(Failure::Error)));
    assert_eq!(short([0; 8], 0), None);
}

#[test]
fn a_frame_of_a_controller_is_no_reply_of_a_group() {
    let request = HEAT.set(To::Group(2)).expect("a legal request");
    assert!(request.replies().filter().is_some_and(|filter| filter.matches(&frame(0x0107_F0F1, [2, 0xF0, 0, 0]))));
    assert!(!request.is_reply(&frame(0x0107_F0F1, [2, 0xF0, 0, 0])));
}

/// A frame that is no classic data frame.
struct Strange {
    data: [u8; 12],
    length: usize,
    is_remote: bool,
    is_data: bool,
}

impl embedded_can::Frame for Strange {
    fn new(_: impl Into<embedded_can::Id>, _: &[u8]) -> Option<Self> {
        None
    }

    fn new_remote(_: impl Into<embedded_can::Id>, _: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        true
    }

    fn is_remote_frame(&self) -> bool {
        self.is_remote
    }

    fn is_data_frame(&self) -> bool {
        self.is_data
    }

    fn id(&self) -> embedded_can::Id {
        frame(0x0107_F003, [0; 4]).id()
    }

    fn dlc(&self) -> usize {
        4
    }

    fn data(&self) -> &[u8] {
        self.data.get(..self.length).expect("at most 12 bytes")
    }
}

#[test]
fn what_is_no_classic_data_frame_is_no_reply() {
    let request = HEAT.set(To::Heater(3)).expect("a legal request");
    let data = [2, 0xF0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let strange = |length| Strange { data, length, is_remote: false, is_data: true };
    let values = |strange| request.reply(&strange).map(|reply| reply.values);
    assert_eq!(values(strange(4)), Some(Ok(Heat { power_w: 0.0 })));
    assert_eq!(values(strange(8)), Some(Err(Failure::Length)));
    let remote = Strange { is_remote: true, is_data: false, ..strange(4) };
    let error = Strange { is_data: false, ..strange(4) };
    let filter = request.replies().filter().expect("one heater replies");
    assert!(filter.matches(&strange(4)) && !filter.matches(&remote) && !filter.matches(&error));
    for strange in [strange(12), remote, error] {
        assert_eq!(Received::<Message>::decode(&strange).map(|_| ()), Err(Problem::Frame));
        assert_eq!(values(strange), None);
    }
}

#[test]
fn a_message_is_only_taken_for_the_kind_of_frame_that_it_came_in() {
    let request = decode(&frame(0x0107_03F0, [1, 0, 0x00, 0x96])).expect("a known frame");
    assert_eq!(request.request(), Some(&Message::Heat(HEAT)));
    assert_eq!((request.reply(), request.report()), (None, None));
    let reply = decode(&frame(0x0107_F003, [2, 0xF0, 0x00, 0x96])).expect("a known frame");
    assert_eq!(reply.reply(), Some(Ok(&Message::Heat(HEAT))));
    assert_eq!((reply.request(), reply.report()), (None, None));
    let report = decode(&frame(0x010B_F003, [0, 0, 0x00, 0x96])).expect("a known frame");
    assert_eq!(report.report(), Some(&Message::Heat(HEAT)));
    assert_eq!((report.request(), report.reply()), (None, None));
    let broken = decode(&frame(0x090B_F003, [0, 0, 0x00, 0x96])).expect("a known frame");
    assert!(broken.report().is_none() && broken.is_error_reply());
}

#[test]
fn problems_are_tested_in_order() {
    let problem = |frame: Frame| decode(&frame).map(|received| received.kind()).expect_err("a problem");
    assert_eq!(problem(Frame::new_raw(0x0100_0000, true, [0; 8], 1)), Problem::Foreign);
    assert_eq!(problem(Frame::new_raw(0x107, false, [0; 8], 4)), Problem::Identifier);
    assert_eq!(problem(frame(0x0307_03F0, [1, 0, 0, 0])), Problem::Identifier);
    assert_eq!(problem(frame(0x0107_F0F0, [1, 0, 0, 0])), Problem::Identifier);
    assert_eq!(problem(Frame::new_raw(0x0109_03F0, true, [0; 8], 1)), Problem::UnknownMessage);
    assert_eq!(problem(Frame::new_raw(0x0107_03F0, true, [9; 8], 3)), Problem::Length);
    assert_eq!(problem(frame(0x0107_03F0, [9, 0, 0, 0])), Problem::UnknownMessage);
}

#[test]
fn of_several_messages_the_length_and_then_the_addresses_choose_and_the_first_wins_a_tie() {
    let access = |id, length| {
        let received = decode(&Frame::new_raw(id, true, [0; 8], length)).expect("a known frame");
        received.exchange().access()
    };
    assert_eq!(access(0x010A_03F0, 4), "set");
    assert_eq!(access(0x010A_5DF0, 4), "read");
    assert_eq!(access(0x010A_03F0, 2), "probe");
}

#[test]
fn a_sender_is_the_usual_one_or_else_the_first_one() {
    let host = AddressType::new("host", 0xE0, 0xE3);
    assert_eq!([host, host.default_number(0xE2)].map(|host| host.sent_number()), [0xE0, 0xE2]);
}

#[test]
fn a_message_of_some_device_models_is_refused_for_the_others() {
    const BOOST: Exchange = Exchange::new("set", &[None; 3]).of("boost", FRAME).length(4).models(&[1, 4]);
    let refused = Err(Error::Model { message: "boost" });
    assert_eq!([0, 1, 2, 4].map(|model: u8| BOOST.within(model, &HEAT)), [refused, Ok(()), refused, Ok(())]);
    assert_eq!(Heat::SET.within(2_u8, &HEAT), Ok(()));
}

#[test]
fn a_request_to_a_device_model_keeps_to_the_limits_of_that_model_alone() {
    struct Boost(u16);

    impl Layout for Boost {
        const SIGNALS: &'static [&'static dyn AnySignal] = &[&BOOST];
        const DECODE: Decode<Self> = |data| Self(BOOST.get(data));
        const ENCODE: Encode<Self> = |boost, payload| BOOST.put(boost.0, payload);
    }

    const BOOST: Signal<u16, f64> = Heat::POWER.limits(0.0, 500.0).model_limits(&[(1, Some((0.0, 300.0))), (2, None)]);
    let takes = |model: u8, raw| {
        let request: Result<Request<Message, ()>, Error> = Heat::SET.request_within(model, To::All, &Boost(raw));
        request.is_ok()
    };
    assert!(takes(1, 30) && !takes(1, 31) && takes(2, 200) && takes(3, 50) && !takes(3, 51));
    let general: Result<Request<Message, ()>, Error> = Heat::SET.request_to(To::All, &Boost(51));
    assert!(general.is_err());
}

#[test]
fn the_addressing_mode_is_the_one_that_fits_best() {
    assert_eq!(mode_of(0x0107_03F0, [1, 0, 0, 0]), Some(("single", true, true)));
    assert_eq!(mode_of(0x0107_30F0, [1, 0, 0, 0]), Some(("single", true, false)));
    assert_eq!(mode_of(0x0107_3FF0, [1, 0, 0, 0]), Some(("all", true, true)));
    assert_eq!(mode_of(0x0107_5DF0, [1, 0, 0, 0]), Some(("grouped", true, true)));
    assert_eq!(mode_of(0x0108_3FF0, [0; 4]), Some(("all", false, true)));
    assert_eq!(mode_of(0x0107_F25D, [2, 0xF0, 0, 0]), None);
}

#[test]
fn a_frame_is_taken_apart_and_built_anew() {
    let received = decode(&frame(0x0107_F003, [2, 0xF0, 0x00, 0x96])).expect("a known frame");
    assert_eq!((received.kind(), received.content()), (Kind::Reply, &Message::Heat(HEAT)));
    let selectors: std::vec::Vec<_> = received.selectors().map(|(selector, raw)| (selector.name, raw)).collect();
    assert_eq!(selectors, [("function", 2), ("result", 0xF0)]);
    assert_eq!(received.reserved(), [0; 8]);
    assert_eq!(received.encode(), Ok(*received.frame()));
    let request = decode(&frame(0x0107_03F0, [1, 0x80, 0x00, 0x96])).expect("a known frame");
    assert_eq!(request.reserved(), [0, 0x80, 0, 0, 0, 0, 0, 0]);
    assert_eq!(request.encode(), Ok(*request.frame()));
}

#[test]
fn a_message_is_not_built_under_the_identifier_of_another() {
    let received = decode(&frame(0x0107_03F0, [1, 0, 0x00, 0x96])).expect("a known frame");
    for (id, expected) in [(0x0108_03F0, "0x10803F0"), (0x0107_F003, "0x107F003"), (0x0100_0000, "0x1000000")] {
        let text = received.with_identifier(Identifier(id)).encode().expect_err("a refusal").to_string();
        assert_eq!(text, std::format!("the identifier {expected} is none of `heat`"));
    }
    let text = received.with_identifier(Identifier(0x0107_30F0)).encode().expect_err("a refusal").to_string();
    assert_eq!(text, "`heater` is 0x30, but its limits are 0x01..=0x09");
}

#[test]
fn a_frame_takes_other_values_but_not_another_message() {
    let received = decode(&frame(0x0107_F003, [2, 0xF0, 0x00, 0x96])).expect("a known frame");
    let other = received.with_content(Message::Heat(Heat { power_w: 1000.0 })).encode().expect("a legal reply");
    assert_eq!(other.to_string(), "0107F003#02F00064");
    assert!(matches!(received.with_content(Message::ReadHeat).encode(), Err(Error::Identifier { .. })));
}

#[test]
fn what_a_frame_says_can_be_written_without_knowing_the_message() {
    const KNOWN: &[StatusBit] = &[StatusBit::fault(0, "fan_fault", "Fan"), StatusBit::new(7, "cold", "Cold")];
    let reading = |unit, meaning| {
        Reading { name: "x", unit, raw: Number::Unsigned(0), meaning, is_of_error_reply: false }.to_string()
    };
    assert_eq!(reading(Some("V"), Meaning::Number(Number::Float(52.5))), "x 52.5 V");
    assert_eq!(reading(Some("s"), Meaning::Name("never")), "x never");
    assert_eq!(reading(None, Meaning::Status(0b1000_0011, KNOWN)), "x {fan_fault, cold, 0x2}");
    assert_eq!(reading(None, Meaning::Status(0, KNOWN)), "x {}");
    assert_eq!(reading(None, Meaning::None), "x ?");
}

#[test]
fn the_values_of_an_error_reply_are_no_measurements() {
    let shown = |id, data| {
        let mut texts = std::vec::Vec::new();
        let received = decode(&frame(id, data)).expect("a known frame");
        received.visit(|reading| texts.push((reading.is_of_error_reply, reading.to_string())));
        texts
    };
    let power = |is_of_error_reply, text: &str| [(is_of_error_reply, text.to_string())];
    assert_eq!(shown(0x0107_F003, [2, 0xF0, 0, 0x96]), power(false, "power 1500 W"));
    // The result in the data, then the error code in the identifiers of a reply and of a report.
    for (id, data) in [(0x0107_F003, [2, 0xF2, 0, 0]), (0x0907_F003, [2, 0xF0, 0, 0]), (0x090B_F003, [0; 4])] {
        assert_eq!(shown(id, data), power(true, "power ? (error reply)"), "{id:X}");
    }
    // A request is no error reply, whatever its identifier shows.
    assert_eq!(shown(0x0907_03F0, [1, 0, 0, 0x96]), power(false, "power 1500 W"));
}

#[test]
fn an_entry_of_the_list_builds_only_requests_that_carry_nothing() {
    const ENTRY: Entry<Message> = Entry::new("Heat", &[], &[&Heat::POWER], &[&Heat::SET, &Heat::READ, &Heat::REPORT]);
    let request = ENTRY.request("read", To::Group(2)).expect("it can be read").expect("a group can be asked");
    assert_eq!((ENTRY.name(), *request.frame()), ("heat", Frame::new_raw(0x0108_5DF0, true, [0; 8], 4)));
    assert!(ENTRY.request("read", To::Heater(1)).is_some_and(|request| request.is_err()));
    assert!(["set", "report", "erase"].iter().all(|access| ENTRY.request(access, To::Group(2)).is_none()));
}
