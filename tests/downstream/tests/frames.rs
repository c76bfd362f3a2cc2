//! The frames that the manual of the winches prints.

use std::cell::Cell;
use std::collections::VecDeque;

use canspec_runtime::client::{Client, Heard, Pace, Step, repeats};
use winch_driver::winch::embedded_can::nb::Can;
use winch_driver::winch::embedded_can::{self, ExtendedId, Frame as _};
use winch_driver::winch::{Brake, Frame, Message, Run, SetBrake, State, Status, Target};
use winch_driver::{ask, pull, rope_m};

#[test]
fn a_request_is_the_printed_frame() {
    let request = pull(0x12, 600).expect("both are in range");
    assert_eq!(*request.frame(), frame(0x0B20_1201, [0x02, 0x58, 0x19, 0x00]));
    let request = SetBrake { brake: Brake::Engaged }.set(Target::All).expect("all winches have a brake");
    assert_eq!(*request.frame(), frame(0x0B22_FF01, [1, 0, 0, 0]));
}

#[test]
fn a_reply_has_the_printed_values() {
    let reply = frame(0x0B21_0112, [0x04, 0xD2, 0x41, 0x81]);
    assert_eq!(rope_m(&reply), Some(12.34));
    let request = Status::read(Target::Winch(0x12)).expect("the winch is in range");
    let status = request.reply(&reply).expect("it answers the request").values.expect("it has its values");
    assert_eq!((status.rope_m, status.temperature_c), (12.34, 25.0));
    assert!(status.state.contains(State::OVERLOAD | State::BRAKED));
    assert!(!status.state.contains(State::SLACK_ROPE));
    assert!(status.state.intersects(State::OVERLOAD | State::SLACK_ROPE));
    assert!(!status.state.intersects(State::SLACK_ROPE));
    let names = status.state.set_bits().map(|bit| bit.name);
    assert!(names.eq(["braked", "overload"]));
}

/// A bus that hands out frames, and keeps what is sent.
struct Bus {
    sent: Vec<Frame>,
    waiting: VecDeque<Frame>,
}

impl Can for Bus {
    type Frame = Frame;
    type Error = embedded_can::ErrorKind;

    fn transmit(&mut self, frame: &Frame) -> nb::Result<Option<Frame>, Self::Error> {
        self.sent.push(*frame);
        Ok(None)
    }

    fn receive(&mut self) -> nb::Result<Frame, Self::Error> {
        self.waiting.pop_front().ok_or(nb::Error::WouldBlock)
    }
}

/// Returns a clock that is late when it was asked more often than this.
fn patience(times: u32) -> impl Fn() -> bool {
    let asked = Cell::new(0);
    move || asked.replace(asked.get() + 1) >= times
}

#[test]
fn the_frame_that_answers_is_taken_out_of_others() {
    let answer = frame(0x0B21_0112, [0x04, 0xD2, 0x41, 0x81]);
    let bus = || Bus { sent: vec![], waiting: [frame(0x0B21_0113, [0; 4]), answer].into() };
    let request = Status::read(Target::Winch(0x12)).expect("the winch is in range");
    let mut can = bus();
    let reply = ask(&mut can, &request, patience(2)).expect("the second frame answers");
    assert_eq!(reply.values.map(|status| status.rope_m), Ok(12.34));
    assert_eq!(can.sent, [*request.frame()]);
    assert!(ask(&mut bus(), &request, patience(1)).is_none());
}

#[test]
fn a_client_asks_and_knows_the_answer() {
    let request = Status::read(Target::Winch(0x12)).expect("the winch is in range");
    let mut client: Client<Message, 8> = Client::new(Pace { gap: 20, wait: 100, tries: 3, late: 100 });
    let asked = client.ask(request, 0).expect("there is room for eight requests");
    assert_eq!(client.poll(0), Step::Send { ticket: asked, frame: *request.frame() });
    assert_eq!(client.poll(0), Step::Wait(Some(100)));
    let heard = client.handle(&frame(0x0B21_0112, [0x04, 0xD2, 0x41, 0x81]), 30);
    assert!(matches!(heard, Heard::Answer { ticket, .. } if ticket == asked));
}

#[test]
fn a_client_holds_a_speed_until_the_winch_has_it() {
    let mut client: Client<Message, 8> = Client::new(Pace { gap: 20, wait: 100, tries: 3, late: 100 });
    let pull = |speed_rpm| Run { speed_rpm, ramp_s: 2.5 }.set(Target::Winch(0x12)).expect("it is slow enough");
    let old = client.hold(pull(600), 1000, repeats, 0).expect("there is room, and the winch answers");
    assert_eq!(client.poll(0), Step::Send { ticket: old, frame: *pull(600).frame() });
    let stop = client.hold(pull(0), 1000, repeats, 5).expect("it takes the room of the old speed");
    assert_eq!(client.poll(20), Step::Send { ticket: stop, frame: *pull(0).frame() });
    // This may be the answer to the old speed. So the client asks once more when none can come.
    let echo = frame(0x0B20_0112, [0x00, 0x00, 0x19, 0x00]);
    assert!(matches!(client.handle(&echo, 60), Heard::Late { ticket, .. } if ticket == stop));
    assert_eq!(client.poll(200), Step::Send { ticket: stop, frame: *pull(0).frame() });
    assert!(matches!(client.handle(&echo, 230), Heard::Answer { ticket, .. } if ticket == stop));
}

#[test]
fn a_frame_of_the_bus_is_recognised() {
    let received = Message::decode(&frame(0x0B20_0112, [0xFD, 0xA8, 0x19, 0x00])).expect("it is printed");
    assert_eq!(received.reply(), Some(Ok(&Message::Run(Run { speed_rpm: -600, ramp_s: 2.5 }))));
    assert_eq!(received.encode(), Ok(*received.frame()));
    assert!(Message::decode(&frame(0x0B55_0112, [0; 4])).is_err());
}

#[test]
fn what_the_manual_forbids_is_refused() {
    let error = pull(0x12, 1501).expect_err("it is too fast");
    assert_eq!(error.to_string(), "`speed` of `run` is 1501 rpm, but its limits are -1500 and 1500 rpm");
    assert!(pull(0x20, 600).is_err());
}

fn frame(id: u32, data: [u8; 4]) -> Frame {
    Frame::new(ExtendedId::new(id).expect("it has 29 bits"), &data).expect("it has 4 bytes")
}
