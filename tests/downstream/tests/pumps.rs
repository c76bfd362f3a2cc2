//! What the manual of the pumps says, and what this crate does with it.

use winch_driver::pump::{Frame, Kind, Message, Model, Motion, SetSpeed, Target};
use winch_driver::pumps::{answer, flow, model, report, turn, urgent};

#[test]
fn a_model_takes_its_own_speeds_only() {
    let small = model("P30").expect("it is a model of the spec");
    assert_eq!(turn(small, 3, 3000).expect("the model runs so fast").frame(), &frame(0x443, [0x0B, 0xB8, 0, 0]));
    let error = turn(small, 3, 4200).expect_err("it is too fast");
    assert_eq!(error.to_string(), "`speed` of `set_speed` is 4200 rpm, but its limits are 300 and 3000 rpm");
    assert!(turn(Model::P60, 3, 4200).is_ok());
    assert_eq!(model("P90"), None);
}

#[test]
fn without_a_model_the_hull_of_what_both_models_take_counts() {
    // The P30 takes 300 to 3000 rpm, the P60 300 to 4500.
    let takes = |speed_rpm| SetSpeed { speed_rpm }.set(Target::Pump(3)).is_ok();
    assert_eq!([299, 300, 4500, 4501].map(takes), [false, true, true, false]);
}

#[test]
fn a_simulated_pump_answers_what_it_is_asked() {
    let request = turn(Model::P30, 3, 3000).expect("the model runs so fast");
    assert_eq!(answer(3, request.frame()), Some(frame(0x483, [0x0B, 0xB8, 0, 0])), "it is printed");
    assert_eq!(answer(4, request.frame()), None);
}

#[test]
fn a_report_is_read_and_built() {
    let printed = frame(0x503, [0x0B, 0xA4, 0x03, 0xE7]);
    assert_eq!(flow(Model::P30, &printed), Some(99.9));
    assert_eq!(report(3, Motion { speed_rpm: 2980, flow: 99.9 }), Some(printed));
}

#[test]
fn a_frame_of_any_kind_says_what_it_is() {
    let received = Message::decode(&frame(0x503, [0x0B, 0xA4, 0x03, 0xE7])).expect("it is printed");
    assert_eq!((received.kind(), received.identifier().pump), (Kind::Report, 3));
    let mut shown = Vec::new();
    received.visit(|reading| shown.push(reading.to_string()));
    assert_eq!(shown, ["speed 2980 rpm", "flow 99.9"]);
    assert_eq!((received.request(), received.reply()), (None, None));
    assert_eq!(received.content(), &Message::Motion(Motion { speed_rpm: 2980, flow: 99.9 }));
}

#[test]
fn a_frame_shows_which_pump_it_is_about() {
    let echo = Message::decode(&frame(0x083, [0x0B, 0xB8, 0, 0])).expect("it is printed");
    assert_eq!((echo.target(), echo.node()), (Some(Target::Pump(3)), Some(3)));
    let report = Message::decode(&frame(0x503, [0x0B, 0xA4, 0x03, 0xE7])).expect("it is printed");
    assert_eq!((report.target(), report.node()), (None, Some(3)));
}

#[test]
fn a_filter_of_the_hardware_lets_the_answers_pass() {
    let request = turn(Model::P30, 3, 3000).expect("the model runs so fast");
    let replies = request.replies().filter().expect("one pump answers");
    assert_eq!((replies.id_mask(), replies.id_value()), (0x1FF, 0x083));
    let reports = Motion::REPORT.filter(Kind::Report).expect("it is reported");
    assert_eq!((reports.id_mask(), reports.id_value()), (0x1C0, 0x100));
}

#[test]
fn another_priority_is_still_answered() {
    let request = turn(Model::P30, 3, 3000).expect("the model runs so fast");
    assert_eq!(urgent(&request), Some(frame(0x043, [0x0B, 0xB8, 0, 0])));
    assert!(request.is_reply(&frame(0x083, [0x0B, 0xB8, 0, 0])));
}

fn frame(id: u32, [first, second, third, fourth]: [u8; 4]) -> Frame {
    Frame::new_raw(id, false, [first, second, third, fourth, 0, 0, 0, 0], 4)
}
