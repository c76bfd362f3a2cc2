//! Frames of a battery whose identifier is one number, put together by hand.

use winch_driver::battery::embedded_can::{Frame as _, StandardId};
use winch_driver::battery::{Cycles, Frame, Inverter, Kind, Limits, Message, Problem, Received, Target, Wanted};

fn frame(id: u16, data: &[u8]) -> Frame {
    Frame::new(StandardId::new(id).expect("11 bits"), data).expect("at most 8 bytes")
}

fn decoded(frame: &Frame) -> Received {
    Message::decode(frame).expect("a frame of the battery")
}

const WANTED: [u8; 8] = [150, 0, 0, 0, 0, 0, 0, 0];
const LIMITS: [u8; 8] = [0xF4, 0x01, 0, 0, 0, 0, 0, 0];

#[test]
fn the_number_of_a_frame_says_whether_it_is_a_request_or_a_report() {
    assert_eq!(decoded(&frame(0x305, &WANTED)).request(), Some(&Message::Wanted(Wanted { current_a: 150 })));
    assert_eq!(decoded(&frame(0x351, &LIMITS)).report(), Some(&Message::Limits(Limits { voltage_v: 50.0 })));
}

#[test]
fn a_report_of_the_controller_keeps_to_limits_and_gets_no_reply() {
    let told = Inverter { power_w: -2 }.tell(Target::Bus).expect("a power within the limits");
    assert_eq!(*told.frame(), frame(0x306, &[0xFE, 0xFF, 0, 0, 0, 0, 0, 0]));
    assert!(told.replies().filter().is_none());
    assert!(Inverter { power_w: 5001 }.tell(Target::Bus).is_err());

    let received = decoded(told.frame());
    assert_eq!(received.report(), Some(&Message::Inverter(Inverter { power_w: -2 })));
    assert_eq!((received.kind(), received.is_to_module()), (Kind::Report, true));
    assert_eq!(received.addressing().map(|addressing| addressing.mode().name), Some("bus"));
    assert_eq!(received.encode(), Ok(*told.frame()));
    assert!(received.with_content(Message::Inverter(Inverter { power_w: 5001 })).encode().is_err());
    assert!(!decoded(&frame(0x351, &LIMITS)).is_to_module());
}

#[test]
fn a_byte_tells_a_request_from_its_reply_under_one_number() {
    let asked = Cycles::query(Target::Bus).expect("a documented request");
    assert_eq!(*asked.frame(), frame(0x600, &[3, 0, 0, 0, 0, 0, 0, 0]));
    assert_eq!(decoded(asked.frame()).request(), Some(&Message::QueryCycles));
    let answer = frame(0x600, &[0x43, 100, 0, 0, 0, 0, 0, 0]);
    assert_eq!(decoded(&answer).reply(), Some(Ok(&Message::Cycles(Cycles { count: 100 }))));
    assert!(asked.is_reply(&answer) && !asked.is_reply(asked.frame()));
}

#[test]
fn a_number_of_no_message_and_a_wrong_length_are_told_apart() {
    let problem = |id, data: &[u8]| Message::decode(&frame(id, data)).expect_err("a frame of nothing");
    assert_eq!(problem(0x352, &LIMITS), Problem::UnknownMessage);
    assert_eq!(problem(0x351, &LIMITS[..7]), Problem::Length);
    assert_eq!(problem(0x600, &LIMITS), Problem::UnknownMessage);
}
