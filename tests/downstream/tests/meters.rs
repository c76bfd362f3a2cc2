//! What the manual of the meters says, and what this crate does with it.

use winch_driver::meter::{self, Clear, Frame, Message, Number, Period, Target, Voltage};
use winch_driver::meters::{measure_every, readings};

#[test]
fn every_register_that_can_be_read_is_asked_for() {
    let frames: Vec<_> = readings(7).map(|request| *request.expect("the meter is in range").frame()).collect();
    assert_eq!(frames, [0x01, 0x02, 0x20].map(|register| frame(0x147, [0x01, register, 0, 0, 0, 0])));
    assert!(readings(41).all(|request| request.is_err()));
}

#[test]
fn a_reply_to_any_of_them_is_read_by_name() {
    let bus = [frame(0x547, [0x81, 0x01, 0, 0x03, 0x82, 0x70]), frame(0x547, [0x81, 0x20, 0, 0, 0, 60])];
    let mut shown = Vec::new();
    for request in readings(7).flatten() {
        for reply in bus.iter().filter(|frame| request.is_reply(*frame)) {
            let received = Message::decode(reply).expect("it is printed");
            received.visit(|reading| shown.push(format!("{} {reading}", received.exchange().message())));
        }
    }
    assert_eq!(shown, ["voltage value 230 V", "period value 60 s"]);
}

#[test]
fn an_entry_says_what_its_row_of_the_table_says() {
    let entry = meter::MESSAGES.iter().find(|entry| entry.name() == "period").expect("it is in the table");
    assert_eq!((entry.title, entry.constants), ("Time between two measurements", &[("register", 0x20)][..]));
    assert!(entry.exchanges.iter().map(|exchange| exchange.access()).eq(["read", "write"]));
    let signal = entry.signals[0];
    assert_eq!((signal.name(), signal.unit()), ("value", Some("s")));
    assert_eq!(signal.limits(), Some((Number::Unsigned(1), Number::Unsigned(3600))));
    assert_eq!(signal.place(), Period::VALUE.place());
    assert_eq!(meter::MESSAGES[0].title, "voltage");
}

#[test]
fn an_entry_builds_the_request_that_its_type_builds() {
    let [voltage, _, period, clear, _] = meter::MESSAGES else { panic!("the table has five rows") };
    let listed = voltage.request("read", Target::Meter(7)).expect("it can be read").expect("the meter is in range");
    let typed = Voltage::read(Target::Meter(7)).expect("the meter is in range");
    assert_eq!((listed.frame(), listed.replies()), (typed.frame(), typed.replies()));
    let listed = clear.request("write", Target::Meter(7)).expect("it carries nothing").expect("the meter is in range");
    assert_eq!(listed.frame(), Clear::write(Target::Meter(7)).expect("the meter is in range").frame());
    assert_eq!(listed.frame(), &frame(0x147, [0x02, 0x30, 0, 0, 0, 0]));
    assert!(voltage.request("write", Target::Meter(7)).is_none(), "it can only be read");
    assert!(period.request("write", Target::Meter(7)).is_none(), "nobody says which time");
}

#[test]
fn a_register_that_can_be_written_takes_what_is_in_range() {
    let request = measure_every(7, 60).expect("it is in range");
    assert_eq!(request.frame(), &frame(0x147, [0x02, 0x20, 0, 0, 0, 60]));
    let reply = request.reply(&frame(0x547, [0x82, 0x20, 0, 0, 0, 60])).expect("it answers");
    assert_eq!(reply.values, Ok(Period { value_s: 60 }));
    assert!(!request.is_reply(&frame(0x547, [0x81, 0x20, 0, 0, 0, 60])), "that answers a read");
    assert!(measure_every(7, 3601).is_err());
}

#[test]
fn only_a_write_is_refused_and_the_refusal_names_its_register() {
    let request = measure_every(7, 60).expect("it is in range");
    let refusal = request.refusal().expect("a write can be refused");
    let refused = [0x20, 0x30].map(|register| frame(0x547, [0xC2, register, 0, 0, 0, 3]));
    assert_eq!(refused.each_ref().map(|frame| refusal.matches(frame)), [true, false]);
    assert_eq!(refused.each_ref().map(|frame| request.is_reply(frame)), [true, false]);
    assert!(readings(7).flatten().all(|read| read.refusal().is_none()));
}

fn frame(id: u32, [a, b, c, d, e, f]: [u8; 6]) -> Frame {
    Frame::new_raw(id, false, [a, b, c, d, e, f, 0, 0], 6)
}
