//! Refusals in the generated code: another message's reply that answers a request.

use canspec_protocols::megmeet::{self, RealTimeData};
use canspec_runtime::{Failure, Frame, Replies};
use canspec_tests::devices_refusals::{Message, Refusal, RefusalValue, Speed, Target, Temperature};

/// Returns a frame of the pumps.
fn frame(id: u32, data: [u8; 4]) -> Frame {
    let [operation, index, high, low] = data;
    Frame::new_raw(id, false, [operation, index, high, low, 0, 0, 0, 0], 4)
}

#[test]
fn a_refusal_answers_the_request_and_has_no_values() {
    let request = Speed { value_rpm: 3000 }.write(Target::Pump(1)).expect("the limit");
    let refused = frame(0x451, [0x80, 7, 0, 3]);
    let reply = request.reply(&refused).expect("the refusal of pump 1");
    assert_eq!((reply.values, reply.identifier().node), (Err(Failure::Error), 1));
    let selectors: Vec<_> = reply.selectors().map(|(selector, raw)| (selector.name, raw)).collect();
    assert_eq!(selectors, [("operation", 0x80), ("index", 7)]);
    assert!(request.is_reply(&refused));
    let why = Message::decode(&refused).expect("a message of its own");
    assert_eq!(why.reply(), Some(Ok(&Message::Refusal(Refusal { value: RefusalValue::OutOfRange }))));
}

#[test]
fn a_request_that_is_carried_out_has_the_values_of_its_reply() {
    let request = Speed { value_rpm: 3000 }.write(Target::Pump(1)).expect("the limit");
    let reply = request.reply(&frame(0x451, [4, 7, 0x0B, 0xB8])).expect("the reply of pump 1");
    assert_eq!(reply.values, Ok(Speed { value_rpm: 3000 }));
}

#[test]
fn a_refusal_of_another_register_or_pump_is_no_answer() {
    let request = Temperature::read(Target::Pump(2)).expect("a pump");
    assert!(request.is_reply(&frame(0x452, [0x80, 8, 0, 1])));
    for other in [frame(0x452, [0x80, 7, 0, 1]), frame(0x451, [0x80, 8, 0, 1]), frame(0x052, [0x80, 8, 0, 1])] {
        assert!(!request.is_reply(&other) && request.reply(&other).is_none(), "{other:?}");
    }
}

#[test]
fn a_filter_for_refusals_stands_beside_that_for_replies() {
    let request = Speed { value_rpm: 300 }.write(Target::Pump(9)).expect("the limit");
    let refusal = request.refusal().expect("a write can be refused");
    assert_eq!((refusal.id_value(), refusal.data_value()), (0x459, [0x80, 7, 0, 0, 0, 0, 0, 0]));
    assert_eq!(refusal.id_mask(), 0x7FF);
    let broadcast = Speed { value_rpm: 300 }.write(Target::All).expect("the limit");
    assert_eq!((broadcast.replies(), broadcast.refusal()), (Replies::Nobody, None));
    assert!(!broadcast.is_reply(&frame(0x450, [0x80, 7, 0, 3])));
}

#[test]
fn a_refusal_in_place_of_a_frame_of_a_set_is_no_success() {
    let request = RealTimeData::read_all(megmeet::Target::Module(1)).expect("a module");
    let answer = |error: u8| Frame::new_raw(0x1081_407F, true, [error << 4 | 1, 0x83, 0, 0, 0, 0, 0, 0], 8);
    let values = |error| request.reply(&answer(error)).expect("a frame of the set").values;
    assert_eq!([0, 1, 3].map(values), [Ok(()), Err(Failure::Error), Err(Failure::Error)]);
    let reply = request.reply(&answer(3)).expect("a frame of the set");
    let selectors: Vec<_> = reply.selectors().map(|(selector, raw)| (selector.name, raw)).collect();
    assert_eq!(selectors, [("error_type", 3), ("signal", 0x183)]);
}
