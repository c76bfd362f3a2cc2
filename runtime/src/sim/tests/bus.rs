//! A bus that goes away, with other controllers, and with two devices of one number.

use std::vec::Vec;

use super::{Heater, Heaters, RULES, events, heaters, set, texts};
use crate::sim::{Bench, Driver, Event, Outage, Tally};
use crate::tests::heaters::{HEAT, To, frame};

#[test]
fn another_controller_is_answered_and_heard() {
    let mut bench = heaters(1);
    let other = *HEAT.set(crate::Route::new(To::Heater(3), 0xF1)).expect("a legal request").frame();
    assert_eq!(bench.another_controller(other, 60, 10), Ok(()));
    let heard = texts([
        (10, "010703F1#01000096"),
        (11, "0107F103#02F00096"),
        (70, "010703F1#01000096"),
        (71, "0107F103#02F00096"),
    ]);
    assert_eq!(events(&mut bench, 0..100), heard);
    assert_eq!(bench.tally().others, 2);
    bench.no_other_controllers();
    assert_eq!(events(&mut bench, 100..300), []);
}

#[test]
fn four_other_controllers_have_room_and_send_in_the_order_of_their_times() {
    let mut bench = heaters(1);
    let others = [1, 2, 3].map(|node| set(To::Heater(node)));
    let added = others.map(|other| bench.another_controller(other, 50, 30 - (other.raw_id() >> 8 & 0xFF) * 10));
    assert_eq!(added, [Ok(()); 3]);
    assert_eq!(bench.another_controller(set(To::Heater(1)), 0, 99), Ok(()));
    let fifth = set(To::Heater(2));
    assert_eq!(bench.another_controller(fifth, 50, 0), Err(fifth));
    let come = core::iter::from_fn(|| bench.poll(99)).map(|event| match event {
        Event::Frame { frame, at } => (at, frame.raw_id()),
        Event::Complaint(complaint) => panic!("{complaint}"),
    });
    // Each is due twice within 99 ms, and each time a heater answers 1 ms later.
    let times = [(0, 3), (10, 2), (20, 1), (50, 3), (60, 2), (70, 1)];
    let of = |(due, node): (u32, u32)| [(due, 0x0107_00F0 | node << 8), (due + 1, 0x0107_F000 | node)];
    let last = [(99, 0x0107_01F0)];
    assert_eq!(come.collect::<Vec<_>>(), [times.map(of).as_flattened(), &last].concat());
}

#[test]
fn frames_wait_with_their_times_while_the_program_stalls() {
    let mut bench = heaters(1);
    bench.send(&set(To::Heater(3)), 0);
    bench.send(&set(To::Heater(2)), 20);
    let answer = |at, node: u32| Event::Frame { frame: frame(0x0107_F000 | node, [2, 0xF0, 0, 150]), at };
    let come: Vec<_> = core::iter::from_fn(|| bench.poll(900)).collect();
    assert_eq!(come, [answer(1, 3), answer(21, 2)]);
}

/// A bus that goes away from 10 to 50 ms.
fn cut(driver: Driver) -> Heaters {
    let mut bench = heaters(1);
    bench.cut(Outage { from: 10, until: 50, driver });
    bench
}

#[test]
fn nothing_passes_while_the_bus_is_away() {
    let mut bench = cut(Driver::Drops);
    let other = *HEAT.set(crate::Route::new(To::Heater(1), 0xF1)).expect("a legal request").frame();
    assert_eq!(bench.another_controller(other, 1000, 30), Ok(()));
    // The first answer is under way when the bus goes, and the last request comes when it is back.
    for times in [9..30, 30..70] {
        bench.send(&set(To::Heater(3)), times.start);
        assert_eq!(events(&mut bench, times), []);
    }
    bench.send(&set(To::Heater(3)), 70);
    assert_eq!(events(&mut bench, 70..100), texts([(71, "0107F003#02F00096")]));
    let told = bench.device(3).expect("heater 3").told.iter().map(|(now, _)| *now).collect::<Vec<_>>();
    assert_eq!((told, bench.device(1).expect("heater 1").told.len()), (Vec::from([9, 70]), 0));
    let Tally { blocked, delayed, .. } = bench.tally();
    // An answer, a request, and the frame of the other controller.
    assert_eq!((blocked, delayed), (3, 0));
}

#[test]
fn the_bus_goes_at_once_and_is_back_at_once() {
    let hears = |time| {
        let mut bench = cut(Driver::Drops);
        bench.send(&set(To::Heater(3)), time);
        bench.device(3).expect("heater 3").told.len() == 1
    };
    assert_eq!([9, 10, 49, 50].map(hears), [true, false, false, true]);
}

#[test]
fn a_driver_can_keep_what_the_client_sends_until_the_bus_is_back() {
    let mut bench = cut(Driver::Buffers);
    bench.send(&set(To::Heater(3)), 10);
    bench.send(&set(To::Heater(2)), 49);
    // This one comes behind those that wait, though they have not been sent yet.
    bench.send(&set(To::Heater(1)), 70);
    let answers = [3, 2, 1].map(|node| std::format!("0107F00{node}#02F00096"));
    assert_eq!(events(&mut bench, 70..90).into_iter().map(|(_, text)| text).collect::<Vec<_>>(), answers);
    let told = [3, 2, 1].map(|node| bench.device(node).expect("a heater").told.first().map(|(now, _)| *now));
    assert_eq!(told, [Some(50), Some(50), Some(70)]);
    assert_eq!((bench.tally().blocked, bench.tally().delayed), (0, 2));
    bench.send(&set(To::Heater(1)), 90);
    assert_eq!(bench.device(1).expect("heater 1").told.len(), 2, "nothing waits any more");
}

#[test]
fn nobody_is_blamed_for_a_watchdog_while_the_bus_is_away() {
    let mut bench = heaters(1);
    bench.cut(Outage { from: 100, until: 1500, driver: Driver::Drops });
    let unfed = |node| (2501, std::format!("module {node} has heard nothing until its watchdog ran out"));
    assert_eq!(events(&mut bench, 0..4000), [1, 2, 3].map(unfed));
    assert_eq!(bench.device(3).expect("heater 3").events, [(1001, "alone")]);
    bench.send(&set(To::Heater(3)), 4000);
    assert_eq!(events(&mut bench, 4001..5001).len(), 1);
    assert_eq!(events(&mut bench, 5001..5002).len(), 1, "this time the client is to blame");
}

#[test]
fn two_devices_can_have_one_number() {
    let mut bench: Heaters = Bench::new([3, 1, 3].map(|number| (number, Heater::default())), RULES, 1);
    bench.send(&set(To::Heater(3)), 0);
    assert_eq!(events(&mut bench, 0..50), texts([(1, "0107F003#02F00096"); 2]));
    assert_eq!(bench.tally().doubles, 1);
    let told = bench.devices().map(|(number, heater, _)| (number, heater.told.len())).collect::<Vec<_>>();
    assert_eq!(told, [(3, 1), (1, 0), (3, 1)]);
    bench.devices().for_each(|(_, _, faults)| faults.dies = Some(60));
    assert_eq!((events(&mut bench, 50..70), bench.is_up(3)), (Vec::new(), false));
    bench.restart(3, 70);
    let restarted = bench.devices().map(|(_, heater, _)| heater.events.len()).collect::<Vec<_>>();
    assert_eq!((restarted, bench.tally().restarts), (Vec::from([1, 0, 1]), 2));
}

#[test]
fn members_of_a_group_are_no_doubles() {
    let mut bench = heaters(1);
    bench.send(&set(To::Group(2)), 0);
    assert_eq!((events(&mut bench, 0..50).len(), bench.tally().doubles), (2, 0));
}
