//! What the interface of the ovens says, and what this crate does with it.

use winch_driver::oven::assembler::{Arrival, Assembler, Progress};
use winch_driver::oven::{Frame, Identity, Kind, Measured, Message, Power, Serial, Target, Temperature};
use winch_driver::ovens::{Ovens, who_is};

#[test]
fn an_oven_is_asked_once_and_answers_with_a_frame_a_member() {
    let mut ovens = Ovens::default();
    let request = ovens.ask(3, 0).expect("there is an oven 3").expect("there is room");
    assert_eq!(request, frame(0x086, [0, 0, 0, 0]));
    assert_eq!(ovens.temperature_c(&frame(0x487, [1, 0xA0, 0x09, 0x07]), 10), None);
    assert_eq!(ovens.temperature_c(&frame(0x489, [1, 0, 0, 0]), 10), None);
    assert_eq!(ovens.temperature_c(&frame(0x486, [2, 0xA0, 0x05, 0xDC]), 20), Some((3, 231.1)));
    assert_eq!(ovens.silent(1000), None);
}

#[test]
fn an_oven_that_falls_silent_is_named() {
    let mut ovens = Ovens::default();
    assert!(ovens.ask(3, 0).is_ok_and(|asked| asked.is_ok()));
    assert_eq!(ovens.temperature_c(&frame(0x487, [1, 0xA0, 0x09, 0x07]), 10), None);
    assert_eq!((ovens.silent(109), ovens.silent(110), ovens.silent(110)), (None, Some((3, 1)), None));
}

#[test]
fn a_request_of_several_frames_says_in_all_but_the_last_that_more_follow() {
    assert_eq!(who_is(3), Ok([frame(0x0A7, [3, 0, 0, 0]), frame(0x0A6, [1, 0, 0, 0])]));
    assert!(who_is(16).is_err());
    let requests = Identity::scan(Target::Oven(3)).expect("there is an oven 3");
    let answered = requests.map(|request| request.is_reply(&frame(0x4A7, [3, 0xA0, 0x12, 0x34])));
    assert_eq!(answered, [true, false]);
}

#[test]
fn a_member_says_of_which_set_it_came() {
    let set = |id| Message::decode(&frame(id, [1, 0xA0, 0x09, 0x07])).expect("it is printed").exchange().set();
    assert_eq!([set(0x487), set(0x4A7), set(0x447)], [Some("measured"), Some("identity"), None]);
    let request = Measured::scan(Target::Oven(3)).expect("there is an oven 3");
    let filter = request.replies().filter().expect("one oven answers");
    assert_eq!((filter.id_mask(), filter.id_value()), (0x7FE, 0x486));
    assert!(Measured::SCAN.filter(Kind::Report).is_none());
}

#[test]
fn a_blank_reply_says_that_there_is_no_error() {
    let blank = |kind| Temperature::READ.filter(kind).map(|filter| filter.frame(4));
    assert_eq!(blank(Kind::Request), Some(frame(0x040, [1, 0, 0, 0])));
    assert_eq!(blank(Kind::Reply), Some(frame(0x040, [1, 0xA0, 0, 0])));
    let asked = Temperature::read(Target::Oven(3)).expect("there is an oven 3");
    assert!(asked.is_reply(&frame(0x446, [1, 0xA0, 0, 0])) && asked.is_reply(&frame(0x446, [1, 9, 0, 0])));
}

#[test]
fn both_sets_have_their_members_in_order() {
    let mut measured = Assembler::<Measured, 1>::listening(100);
    let last = measured.receive(&frame(0x486, [2, 0xA0, 0x05, 0xDC]), 0);
    let Some(Progress::Incomplete { partial, arrival: Arrival::InOrder }) = last else { panic!("{last:?}") };
    assert_eq!(partial.set, Measured { temperature: None, power: Some(Power { value_w: 1500 }) });
    assert!(partial.missing.names().eq(["temperature"]));
    let mut identity = Assembler::<Identity, 1>::listening(100);
    assert_eq!(identity.receive(&frame(0x486, [2, 0xA0, 0x05, 0xDC]), 0), None);
    identity.receive(&frame(0x4A7, [1, 0xA0, 0x09, 0x07]), 0);
    let last = identity.receive(&frame(0x4A6, [3, 0xA0, 0x12, 0x34]), 0);
    let set = Identity { serial: Some(Serial { value: 0x1234 }), temperature: Some(Temperature { value_c: 231.1 }) };
    assert_eq!(last, Some(Progress::Complete { node: 3, arrival: Arrival::OutOfOrder, set }));
}

#[test]
fn a_member_again_with_the_same_values_is_told_from_one_with_others() {
    let mut measured = Assembler::<Measured, 1>::listening(100);
    let arrival = |progress| match progress {
        Some(Progress::Pending { arrival, .. }) => arrival,
        other => panic!("{other:?}"),
    };
    let mut say = |data| arrival(measured.receive(&frame(0x487, data), 0));
    assert_eq!(say([1, 0xA0, 0x09, 0x07]), Arrival::InOrder);
    assert_eq!(say([1, 0xA0, 0x09, 0x07]), Arrival::Repeated);
    assert_eq!(say([1, 0xA0, 0x09, 0x08]), Arrival::Changed);
    assert_eq!(say([2, 9, 0, 0]), Arrival::Failed);
    assert_eq!(say([3, 0xA0, 0, 0]), Arrival::Unlisted);
}

fn frame(id: u32, [a, b, c, d]: [u8; 4]) -> Frame {
    Frame::new_raw(id, false, [a, b, c, d, 0, 0, 0, 0], 4)
}
