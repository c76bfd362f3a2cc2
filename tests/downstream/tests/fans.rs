//! Frames of the fans, put together by hand: priority 6 is 0x01800000 in the identifier, the command starts at bit 16.

use std::collections::HashSet;

use winch_driver::fan::embedded_can::{ExtendedId, Frame as _};
use winch_driver::fan::parts::{Assembler, Outcome};
use winch_driver::fan::{
    Air, Bytes, Curve, CurvePart, Error, Failure, Frame, History, HistoryPart, Hours, Identifier, Layout, Message,
    Model, Power, Problem, Replies, Request, SetBlades, SetLamp, SetSpeed, Target, Text,
};

/// Raw -1501, raw 25 and raw 1.
const SLOWLY: SetSpeed = SetSpeed { speed_rpm: -750.5, delay_s: 58.0, power: Power::Off };

#[test]
fn a_low_byte_stands_first_and_a_sign_is_kept() {
    assert_eq!(sent(SLOWLY.set(Target::Fan(1))), frame(0x0191_01E1, &[1, 0x23, 0xFA, 25, 1]));
    let received = decoded(&frame(0x0191_01E1, &[1, 0x23, 0xFA, 25, 1]));
    assert_eq!(received.request(), Some(&Message::SetSpeed(SLOWLY)));
}

#[test]
fn an_angle_in_the_midst_of_a_word_leaves_the_other_bits_alone() {
    let request = SetBlades { angle: -0.2 }.set(Target::Fan(1));
    assert_eq!(sent(request), frame(0x0191_01E1, &[2, 0xE0, 0x3F, 0, 0]));
    assert_eq!(<SetBlades as Layout>::RESERVED, [0, 0x0F, 0xC0, 0xFF, 0xFF, 0, 0, 0]);
    let noisy = decoded(&frame(0x0191_01E1, &[2, 0xEF, 0xFF, 0, 0x80]));
    assert_eq!(noisy.request(), Some(&Message::SetBlades(SetBlades { angle: -0.2 })));
    assert_eq!(noisy.reserved(), [0, 0x0F, 0xC0, 0, 0x80, 0, 0, 0]);
}

#[test]
fn a_special_delay_is_told_from_seconds() {
    // Raw 0 means `never`; as seconds it would be 8.
    let delay = |raw| match decoded(&frame(0x0191_01E1, &[1, 0x23, 0xFA, raw, 1])).request() {
        Some(Message::SetSpeed(speed)) => (speed.delay_s, SetSpeed::DELAY.special_of(speed.delay_s)),
        _ => panic!("it sets the speed"),
    };
    assert_eq!([0, 1].map(delay), [(8.0, Some("never")), (10.0, None)]);
    let mut shown = Vec::new();
    decoded(&frame(0x0191_01E1, &[1, 0x23, 0xFA, 0, 1])).visit(|reading| shown.push(reading.to_string()));
    assert_eq!(shown, ["speed -750.5 rpm", "delay never", "power off"]);
}

#[test]
fn power_0_is_on_and_power_1_is_off() {
    let speed = |power| sent(SetSpeed { power, ..SLOWLY }.set(Target::Fan(1)));
    assert_eq!(speed(Power::On), frame(0x0191_01E1, &[1, 0x23, 0xFA, 25, 0]));
    assert_eq!(speed(Power::Off), frame(0x0191_01E1, &[1, 0x23, 0xFA, 25, 1]));
    assert_eq!(speed(Power::Unknown(7)), frame(0x0191_01E1, &[1, 0x23, 0xFA, 25, 7]));
    assert_eq!([Power::On, Power::Off, Power::Unknown(7)].map(Power::name), [Some("on"), Some("off"), None]);
}

#[test]
fn values_with_the_same_number_are_equal_whether_named_or_not() {
    assert_eq!([0, 1, 7].map(Power::Unknown), [Power::On, Power::Off, Power::from_raw(7)]);
    assert_ne!(Power::Unknown(7), Power::Unknown(6));
    let numbers = HashSet::from([Power::On, Power::Unknown(0), Power::Off, Power::Unknown(1), Power::Unknown(7)]);
    assert_eq!(numbers.len(), 3);
}

#[test]
fn half_a_step_is_rounded_away_from_zero() {
    let speed = |speed_rpm| sent(SetSpeed { speed_rpm, ..SLOWLY }.set(Target::Fan(1)));
    assert_eq!(speed(750.25), frame(0x0191_01E1, &[1, 0xDD, 0x05, 25, 1]));
    assert_eq!(speed(-750.25), frame(0x0191_01E1, &[1, 0x23, 0xFA, 25, 1]));
}

#[test]
fn both_ends_of_a_range_are_legal_and_what_lies_beyond_is_refused() {
    let speed = |speed_rpm| SetSpeed { speed_rpm, ..SLOWLY }.set(Target::Fan(1)).is_ok();
    assert_eq!([-1500.5, 1500.5].map(speed), [true; 2]);
    assert_eq!([-1500.6, 1500.6, f64::NAN].map(speed), [false; 3]);
}

#[test]
fn a_special_value_is_legal_outside_the_range() {
    let delay = |delay_s| SetSpeed { delay_s, ..SLOWLY }.set(Target::Fan(1));
    assert_eq!(SetSpeed::DELAY_NEVER.to_bits(), 8.0_f64.to_bits());
    assert_eq!(sent(delay(SetSpeed::DELAY_NEVER)), frame(0x0191_01E1, &[1, 0x23, 0xFA, 0, 1]));
    assert!(delay(8.5).is_err());
}

#[test]
fn a_model_has_limits_and_messages_of_its_own() {
    let speed = |speed_rpm, model| SetSpeed { speed_rpm, ..SLOWLY }.within(model).is_ok();
    assert!(speed(900.5, Model::F200) && !speed(901.0, Model::F200));
    assert!(speed(901.0, Model::F400) && !speed(1501.0, Model::F400));
    let blades = SetBlades { angle: 1.0 };
    assert!(blades.within(Model::F400).is_ok() && blades.within(Model::F200).is_err());
}

#[test]
fn a_fan_has_an_address_from_1_to_64() {
    let air = |fan| Air::read(Target::Fan(fan));
    assert_eq!(sent(air(0x40)), frame(0x0192_40E1, &[1, 0, 0, 0, 0, 0, 0, 0]));
    assert!(air(0).is_err() && air(0x41).is_err());
}

#[test]
fn the_host_is_e1_unless_the_caller_is_another() {
    let air = |host| Air::read(Target::Fan(2).sent_by(host));
    assert_eq!(sent(air(0xE3)), frame(0x0192_02E3, &[1, 0, 0, 0, 0, 0, 0, 0]));
    assert!(air(0xDF).is_err() && air(0xE4).is_err());
}

#[test]
fn each_fan_of_a_group_answers() {
    let request = SLOWLY.set(Target::Group(6)).expect("there are groups 0 to 7");
    assert_eq!(*request.frame(), frame(0x0191_99E1, &[1, 0x23, 0xFA, 25, 1]));
    assert!(matches!(request.replies(), Replies::Each(_)));
    assert!(request.is_reply(&frame(0x0191_E140, &[1, 0, 0, 0, 0])));
    assert!(!request.is_reply(&frame(0x0191_E040, &[1, 0, 0, 0, 0])));
    assert!(!request.is_reply(&frame(0x0191_E140, &[2, 0, 0, 0, 0])));
    assert!(SLOWLY.set(Target::Group(8)).is_err());
}

#[test]
fn a_reply_says_what_the_fan_measures_or_shows_an_error() {
    let request = Air::read(Target::Fan(1)).expect("fan 1 is documented");
    let reply = |id, data: &[u8]| request.reply(&frame(id, data)).map(|reply| reply.values);
    let air = Air { temperature_c: 15.0, humidity_percent: 50.0 };
    assert_eq!(reply(0x0192_E101, &[1, 0x6E, 0, 0, 0x42, 0x48, 0, 0]), Some(Ok(air)));
    assert_eq!(reply(0x0592_E101, &[1, 0x6E, 0, 0, 0x42, 0x48, 0, 0]), Some(Err(Failure::Error)));
    assert_eq!(reply(0x0192_E101, &[1, 0x6E, 0, 0, 0x42]), Some(Err(Failure::Length)));
    assert_eq!(reply(0x0192_E102, &[1, 0x6E, 0, 0, 0x42, 0x48, 0, 0]), None);
}

#[test]
fn a_request_of_a_message_in_parts_gets_its_parts() {
    let request = History::read(Target::Fan(1)).expect("fan 1 is documented");
    assert_eq!(*request.frame(), frame(0x0196_01E1, &[0; 8]));
    let reply = request.reply(&frame(0x0196_E101, &[2, 8, 0, 0xFA, 0xFF, 0xFD, 0xFF, 0]));
    let part = HistoryPart { part: 2, speed_rpm: [4.0, -3.0, -1.5] };
    assert_eq!(reply.map(|reply| reply.values), Some(Ok(part)));
}

#[test]
fn the_elements_of_all_parts_are_one_list() {
    let mut assembler = Assembler::<History, 1>::new(100);
    assert!(assembler.receive(&frame(0x0196_E101, &[1, 2, 0, 4, 0, 6, 0, 0]), 0).next().is_none());
    let ended = assembler.receive(&frame(0x0196_E101, &[2, 8, 0, 0xFA, 0xFF, 0xFD, 0xFF, 0]), 1).next();
    let Some(Outcome::Whole(whole)) = ended else { panic!("both parts came") };
    assert_eq!(whole.values, History { speed_rpm: [1.0, 2.0, 3.0, 4.0, -3.0, -1.5] });
}

#[test]
fn of_a_part_that_goes_to_a_fan_nothing_but_the_counter_can_be_changed() {
    let curve = Curve { speed_rpm: [1.0, 2.0, 3.0, 4.0] };
    let frames = curve.set(Target::Fan(1)).expect("speeds within their limits");
    let [first, second] = <[Frame; 2]>::try_from(frames.collect::<Vec<_>>()).expect("two parts");
    assert_eq!(first, frame(0x0197_01E1, &[0, 2, 0, 4, 0, 6, 0, 0]));
    assert_eq!(second, frame(0x0197_01E1, &[1, 8, 0, 0, 0, 0, 0, 0]));
    let received = decoded(&second);
    let Message::CurvePart(part) = *received.content() else { panic!("it carries a part") };
    let built = |part| received.with_content(Message::CurvePart(part)).encode();
    assert_eq!(built(CurvePart { counter: 7, ..part }), Ok(frame(0x0197_01E1, &[0xE1, 8, 0, 0, 0, 0, 0, 0])));
    let refused = |part| match built(part) {
        Err(Error::Value(refused)) => refused.signal(),
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(CurvePart { part: 2, ..part }), "part");
    assert_eq!(refused(CurvePart { data: Bytes::new([9, 0, 0, 0, 0, 0]), ..part }), "data");
}

/// Raw 25 and raw -3.
fn hours(limit_h: Option<f64>, stops: Option<u8>, load_percent: Option<i8>) -> Hours {
    Hours { limit_h, label: Text::new("A").expect("one letter"), stops, load_percent }
}

#[test]
fn a_frame_ends_before_what_is_not_there_and_its_spare_bits_are_ones() {
    let set = |hours: Hours| hours.set(Target::Fan(1));
    let whole = hours(Some(12.5), Some(7), Some(-3));
    assert_eq!(sent(set(whole)), frame(0x00D3_01E1, &[1, 25, 0x41, 0x20, 0xF7, 0xFD]));
    assert_eq!(sent(set(hours(None, Some(7), None))), frame(0x00D3_01E1, &[1, 0xFF, 0x41, 0x20, 0xF7]));
    assert_eq!(sent(set(hours(None, None, None))), frame(0x00D3_01E1, &[1, 0xFF, 0x41, 0x20]));
    let missing = set(hours(None, None, Some(0))).map(|_| ()).expect_err("there is a value behind it");
    assert_eq!(missing.to_string(), "`stops` of `hours` is left out, but the frame is long enough for it");
}

#[test]
fn the_spare_bits_of_a_reply_are_ones_too() {
    let asked = hours(None, None, None).set(Target::Fan(1)).expect("it can be set");
    let answer = decoded(asked.frame()).answer(1, Message::Hours(hours(Some(12.5), Some(7), Some(-3))));
    assert_eq!(answer, Ok(frame(0x00D3_E101, &[1, 25, 0x41, 0x20, 0xF7, 0xFD])));
}

#[test]
fn what_only_one_fan_is_told_is_refused_for_a_group() {
    let lamp = SetLamp { lamp: Power::Off };
    assert_eq!(sent(lamp.set(Target::Fan(1))), frame(0x0195_01E1, &[1, 1]));
    let refused = lamp.set(Target::Group(1)).map(|_| ()).expect_err("a group has no such message");
    assert_eq!(refused, Error::Mode { message: "set_lamp", access: "set", mode: Some("group") });
}

#[test]
fn a_frame_of_any_of_its_lengths_comes_back_as_it_was() {
    for (data, expected) in [
        (&[1, 25, 0x41, 0x20][..], hours(Some(12.5), None, None)),
        (&[1, 0xFF, 0x41, 0x20, 0xF7], hours(None, Some(7), None)),
        (&[1, 0xFF, 0x41, 0x20, 0x07, 0x7F], hours(None, Some(7), None)),
        (&[1, 0xFE, 0x41, 0x20, 0xF7, 0xFF], hours(Some(127.0), Some(7), Some(-1))),
    ] {
        let received = decoded(&frame(0x0193_E101, data));
        assert_eq!(received.reply(), Some(Ok(&Message::Hours(expected))));
        assert_eq!(received.encode(), Ok(frame(0x0193_E101, data)));
    }
    assert!(Message::decode(&frame(0x0193_E101, &[1, 25, 0x41])).is_err());
    assert!(Message::decode(&frame(0x0193_E101, &[1, 25, 0x41, 0x20, 0xF7, 0xFD, 0])).is_err());
}

#[test]
fn an_identifier_is_split_into_its_fields() {
    let identifier = Identifier { error: 1, priority: 6, command: 0x12, target: 0xE1, source: 1 };
    assert_eq!(decoded(&frame(0x0592_E101, &[1, 0, 0, 0, 0, 0, 0, 0])).identifier(), identifier);
}

#[test]
fn what_is_no_frame_of_a_fan_is_named() {
    let problem = |id, data: &[u8]| Message::decode(&frame(id, data)).map(|_| ());
    assert_eq!(problem(0x01FF_FF00, &[]), Err(Problem::Foreign));
    assert_eq!(problem(0x0191_01DF, &[1, 0, 0, 0, 0]), Err(Problem::Identifier));
    assert_eq!(problem(0x0194_01E1, &[1, 0, 0, 0, 0]), Err(Problem::UnknownMessage));
    assert_eq!(problem(0x0191_01E1, &[3, 0, 0, 0, 0]), Err(Problem::UnknownMessage));
    assert_eq!(problem(0x0191_01E1, &[1, 0, 0, 0]), Err(Problem::Length));
    assert_eq!(problem(0x0191_01E1, &[1, 0, 0, 0, 0, 0]), Err(Problem::Length));
}

fn sent<R>(request: Result<Request<R>, Error>) -> Frame {
    *request.expect("the document allows it").frame()
}

fn decoded(frame: &Frame) -> winch_driver::fan::Received {
    Message::decode(frame).expect("a frame of a fan")
}

fn frame(id: u32, data: &[u8]) -> Frame {
    Frame::new(ExtendedId::new(id).expect("it has 29 bits"), data).expect("it has 8 bytes at most")
}
