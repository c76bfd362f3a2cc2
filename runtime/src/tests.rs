//! Requests, replies and what they say, of a made-up protocol.

pub mod heaters;
pub mod random;

use std::string::ToString;

use heaters::{FRAME, HEAT, Heat, Identifier, Message, To, decode, frame, mode_of};

use crate::plumbing::{Decode, Particulars, Sent};
use crate::{
    Access, AddressType, AnySignal, Bits, Entry, Error, Exchange, Failure, Frame, Kind, Layout, Meaning, Number,
    Payload, Problem, Reading, Reason, Received, Replies, Request, Route, Signal, StatusBit,
};

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
fn a_frame_shows_whom_its_request_addresses_and_which_module_sends_or_is_asked() {
    let shown = |id, data| {
        let received = decode(&frame(id, data)).expect("a known frame");
        let route = received.route();
        (received.target(), route.and_then(|route| route.sender()), received.node())
    };
    let (set, echo) = ([1, 0, 0, 0], [2, 0, 0, 0]);
    assert_eq!(shown(0x0107_03F1, set), (Some(To::Heater(3)), Some(0xF1), Some(3)));
    assert_eq!(shown(0x0107_0AF0, set), (Some(To::Heater(10)), Some(0xF0), Some(10)), "not documented");
    assert_eq!(shown(0x0107_3FF0, set), (Some(To::All), None, None));
    assert_eq!(shown(0x0107_F003, echo), (None, None, Some(3)), "a reply of each does not show the group");
    assert_eq!(shown(0x0108_F05D, [0; 4]), (Some(To::Group(2)), Some(0xF0), None));
    assert_eq!(shown(0x0108_03F0, [0; 4]), (None, None, None), "`read` has no such mode");
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
    assert_eq!((reply.identifier(), reply.values), (Identifier(0x0107_F003), Ok(Heat { power_w: 1000.0 })));
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
    assert_eq!(HEAT.set(To::All).expect("a legal request").replies(), Replies::Nobody);
}

#[test]
fn a_recognised_frame_is_a_line_with_its_direction_its_module_and_its_data() {
    let line = |id, data| decode(&frame(id, data)).expect("a known frame").to_string();
    assert_eq!(line(0x0107_03F1, [1, 0, 0, 0x96]), "set heat to 3: 01000096");
    assert_eq!(line(0x0107_F003, [2, 0xF0, 0, 0x64]), "set heat of 3: 02F00064");
    // One for a whole group, and the reply of the module that answers for it.
    assert_eq!(line(0x0107_3FF0, [1, 0, 0, 0x96]), "set heat to 01073FF0: 01000096");
    assert_eq!(line(0x0108_F05D, [0; 4]), "read heat of 0108F05D: 00000000");
}

#[test]
fn an_error_reply_is_a_reply_without_values() {
    let request = HEAT.set(To::Heater(3)).expect("a legal request");
    for error in [frame(0x0907_F003, [2, 0xF0, 0, 0]), frame(0x0107_F003, [2, 0xF2, 0, 0])] {
        let reply = request.reply(&error).expect("the reply of heater 3");
        assert_eq!((reply.identifier().0, reply.values), (error.raw_id(), Err(Failure::Error)));
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
        assert_eq!((reply.identifier(), reply.values), (Identifier(0x0109_F003), Err(Failure::Error)));
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
#[derive(Clone, Copy)]
struct Strange {
    id: u32,
    data: [u8; 12],
    length: usize,
    is_remote: bool,
    is_data: bool,
}

impl Strange {
    /// Returns a frame with its identifier.
    fn shown(&self) -> Frame {
        Frame::new_raw(self.id, self.id > 0x7FF, [0; 8], 4)
    }
}

impl embedded_can::Frame for Strange {
    fn new(_: impl Into<embedded_can::Id>, _: &[u8]) -> Option<Self> {
        None
    }

    fn new_remote(_: impl Into<embedded_can::Id>, _: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        embedded_can::Frame::is_extended(&self.shown())
    }

    fn is_remote_frame(&self) -> bool {
        self.is_remote
    }

    fn is_data_frame(&self) -> bool {
        self.is_data
    }

    fn id(&self) -> embedded_can::Id {
        self.shown().id()
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
    let strange = |length| Strange { id: 0x0107_F003, data, length, is_remote: false, is_data: true };
    let values = |strange| request.reply(&strange).map(|reply| reply.values);
    assert_eq!(values(strange(4)), Some(Ok(Heat { power_w: 0.0 })));
    assert_eq!(values(strange(8)), Some(Err(Failure::Length)));
    let remote = Strange { is_remote: true, is_data: false, ..strange(4) };
    let error = Strange { is_data: false, ..strange(4) };
    let filter = request.replies().filter().expect("one heater replies");
    assert!(filter.matches(&strange(4)) && !filter.matches(&remote) && !filter.matches(&error));
    let short = [strange(9), remote, error].map(|strange| Strange { id: 0x107, ..strange });
    for strange in [strange(9), strange(12), remote, error].into_iter().chain(short) {
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
    assert_eq!(problem(Frame::new_raw(0x0100_0000, true, [0; 8], 8)), Problem::Foreign);
    assert_eq!(problem(Frame::new_raw(0x1307_03F0, true, [1; 8], 8)), Problem::Identifier);
    assert_eq!(problem(frame(0x0107_03F0, [9, 0, 0, 0])), Problem::UnknownMessage);
}

#[test]
fn each_direction_has_messages_and_lengths_of_its_own() {
    let problem = |id| decode(&Frame::new_raw(id, true, [0; 8], 3)).map(|received| received.kind()).expect_err("short");
    assert_eq!(problem(0x010B_F003), Problem::Length);
    assert_eq!(problem(0x010B_03F0), Problem::UnknownMessage);
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
fn a_message_sends_fields_and_spare_bits_of_its_own_and_accepts_any() {
    const PRIORITY: Bits = Bits::new(28, 26);
    const ALL: Access = Access::new("set", &[None; 3]).request(&FRAME).reply(&FRAME).report(&FRAME);
    const SENT: Sent = Sent::NOTHING.id(PRIORITY, 4).request([0xFF; 8]).reply([0x0F; 8]).report([0xF0; 8]);
    const URGENT: Sent = Sent::NOTHING.id(PRIORITY, 4);
    let every = ALL.of("boost");
    let own = every.with(const { &Particulars::NOTHING.sending(&SENT) });
    let urgent = every.with(const { &Particulars::NOTHING.sending(&URGENT) });
    let plain = |kind| urgent.filter(kind).map(|filter| filter.frame(8).bytes());
    assert_eq!([Kind::Request, Kind::Reply, Kind::Report].map(plain), [Some([0; 8]); 3]);
    let blank = |kind| own.filter(kind).expect("all kinds are there").frame(2);
    assert_eq!([Kind::Request, Kind::Reply, Kind::Report].map(|kind| blank(kind).raw_id()), [0x1100_0000; 3]);
    assert_eq!([Kind::Request, Kind::Reply, Kind::Report].map(|kind| blank(kind).bytes()[0]), [0xFF, 0x0F, 0xF0]);
    let masks = [own, every].map(|exchange| exchange.filter(Kind::Request).map(|filter| filter.id_mask()));
    assert_eq!(masks[0], masks[1]);
}

#[test]
fn a_longer_frame_than_the_received_one_has_spare_bits_as_they_are_sent() {
    const SENT: Sent = Sent::NOTHING.request([1; 8]).reply([2; 8]).report([4; 8]);
    static EVERY: Exchange =
        Access::new("set", &[None; 3]).of("heat").length(4).with(&Particulars::NOTHING.sending(&SENT));
    let built = |exchange: &'static Exchange, kind| {
        let short = Frame::new_raw(0x0107_F003, true, [0x80, 0, 0, 0, 0, 0, 0, 0], 1);
        let received = Received::new(Message::Heat(Heat { power_w: 0.0 }), exchange, kind, short, None);
        received.encode().map(|frame| frame.bytes())
    };
    assert_eq!(built(&EVERY, Kind::Reply), Ok([0x80, 2, 0, 0, 0, 0, 0, 0]));
    assert_eq!(built(&EVERY, Kind::Report), Ok([0x80, 4, 0, 0, 0, 0, 0, 0]));
    assert_eq!(built(&Heat::SET, Kind::Reply), Ok([0x80, 0, 0, 0, 0, 0, 0, 0]));
    assert_eq!(EVERY.ones::<Message>(Kind::Request), [1; 8]);
}

#[test]
fn a_message_of_some_device_models_is_refused_for_the_others() {
    const BOOST: Exchange =
        Access::new("set", &[None; 3]).of("boost").length(4).with(&Particulars::NOTHING.models(&[1, 4]));
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

        fn write_to(&self, payload: &mut Payload) -> bool {
            payload.put(&BOOST, self.0)
        }
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
fn another_identifier_is_that_of_the_frame_too() {
    let received = decode(&frame(0x0107_F003, [2, 0xF0, 0x00, 0x96])).expect("a known frame");
    let failed = received.with_identifier(Identifier(0x1107_F004));
    assert_eq!((failed.identifier(), failed.frame().raw_id()), (Identifier(0x1107_F004), 0x1107_F004));
    assert_eq!((received.is_error_reply(), failed.is_error_reply()), (false, true));
    assert_eq!(failed.frame().bytes(), received.frame().bytes());
}

#[test]
fn a_frame_takes_other_values_but_not_another_message() {
    let received = decode(&frame(0x0107_F003, [2, 0xF0, 0x00, 0x96])).expect("a known frame");
    let other = received.with_content(Message::Heat(Heat { power_w: 1000.0 })).encode().expect("a legal reply");
    assert_eq!(other.to_string(), "0107F003#02F00064");
    assert!(matches!(received.with_content(Message::ReadHeat).encode(), Err(Error::Identifier { .. })));
}

#[test]
fn a_request_built_anew_keeps_to_limits_and_a_reply_does_not() {
    let hot = Message::Heat(Heat { power_w: 2010.0 });
    let request = decode(&frame(0x0107_03F0, [1, 0, 0x00, 0x96])).expect("a known frame");
    let refused = request.with_content(hot).encode().map_err(|error| error.reason());
    assert!(matches!(refused, Err(Some(Reason::Limits { .. }))));
    let reply = decode(&frame(0x0107_F003, [2, 0xF0, 0x00, 0x96])).expect("a known frame");
    // 2010 W are 201 steps of 10 W.
    assert_eq!(reply.with_content(hot).encode().expect("a legal reply").to_string(), "0107F003#02F000C9");
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

#[test]
fn a_frame_knows_the_device_model_for_which_it_was_recognised() {
    let request = frame(0x0107_03F0, [1, 0, 0, 150]);
    for model in 0..=u8::MAX {
        assert_eq!(Received::<Message>::decode_for(model, &request).map(|received| received.model()), Ok(Some(model)));
    }
    assert_eq!(Received::<Message>::decode(&request).map(|received| received.model()), Ok(None));
}
