//! Where frames go between peers that all have addresses of their own.

use winch_driver::tester::embedded_can::{ExtendedId, Frame as _};
use winch_driver::tester::{Frame, Kind, Limit, Message, Problem, Target};

#[test]
fn addresses_of_both_ends_show_where_a_frame_goes() {
    // Charger to car, car to charger, charger to all, tester to the charger.
    let kinds = [0x0001_F456, 0x0001_56F4, 0x0001_FF57, 0x0001_FE21].map(kind);
    assert_eq!(kinds, [Ok(Kind::Request), Ok(Kind::Reply), Ok(Kind::Request), Ok(Kind::Request)]);
    // Car to car, car to tester, charger to charger.
    let kinds = [0x0001_F4F5, 0x0001_21F4, 0x0001_5657].map(kind);
    assert_eq!(kinds, [Err(Problem::Identifier); 3]);
}

#[test]
fn a_tester_asks_under_its_own_usual_address() {
    let limit = Limit { current_a: 125.0 };
    let sent = |target| limit.offer(target).map(|request| request.frame().to_string());
    assert_eq!(sent(Target::Service).as_deref(), Ok("0001FE21#04E2"));
    assert_eq!(sent(Target::Car).as_deref(), Ok("0001F456#04E2"));
}

fn kind(id: u32) -> Result<Kind, Problem> {
    let id = ExtendedId::new(id).expect("29 bits");
    let frame = Frame::new(id, &[0x04, 0xE2]).expect("two bytes");
    Message::decode(&frame).map(|received| received.kind())
}
