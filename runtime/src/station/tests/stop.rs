//! Stops, emergencies, and what is off.

use super::bus::{Bus, Grouped, grouped, lone, settings, volts};
use super::chargers::{Apart, At, AtOnce, InGroups, Message, group};
use super::deliver::{deliver, known};
use crate::client::Output;
use crate::station::{Event, Found, Known, Refused, SetPoint, Station};
use crate::{Addressed, Quantities, Quantity};

/// Returns a bus whose modules deliver, at 4400 ms.
fn delivering() -> Grouped {
    let mut bus = known(settings(Found::Watch));
    deliver(&mut bus, volts(500, 10), 4400);
    bus.forget();
    bus
}

#[test]
fn a_stop_goes_to_the_group_first_and_then_to_each_module_again_and_again() {
    let mut bus = delivering();
    bus.charger(2).is_there = false;
    bus.station.stop(1, bus.clock()).expect("there is such a group");
    bus.run(7000);
    let off = bus.sent().into_iter().filter(|text| text.ends_with("off")).collect::<std::vec::Vec<_>>();
    assert_eq!(off[..3], ["4400: all of 1 off", "4420: 1 off", "4440: 2 off"]);
    for whom in ["all of 1", "1", "2"] {
        let count = off.iter().filter(|text| text.ends_with(&std::format!(": {whom} off"))).count();
        assert!(count >= 3, "{whom}: {off:?}");
    }
    assert!(!bus.charger(1).is_on);
}

#[test]
fn what_goes_to_a_group_is_sent_while_a_module_can_be_in_it() {
    let mut bus = grouped(settings(Found::Off));
    for group in [1, 2] {
        bus.station.stop(group, 0).expect("there is such a group");
    }
    bus.run(5500);
    let sent = bus.sent();
    assert!(sent[..2].iter().any(|text| text == "0: all of 2 off" || text == "20: all of 2 off"), "{sent:?}");
    let count = |sent: &[std::string::String], whom: &str| sent.iter().filter(|text| text.contains(whom)).count();
    assert_eq!(count(&sent, "all of 2"), 1, "both are in group 1: {sent:?}");
    assert_eq!(count(&sent, "all of 1"), 6, "one in each round: {sent:?}");
    bus.station.assign(1, Some(2), bus.clock()).expect("it is off");
    bus.run(8400);
    assert_eq!(count(&bus.sent(), "all of 2"), 3);
    // A module in no group hears none.
    for node in [1, 2] {
        bus.station.assign(node, None, bus.clock()).expect("it is off");
    }
    bus.run(10_400);
    assert_eq!(count(&bus.sent(), "all of"), 0);
}

#[test]
fn a_group_that_delivers_again_is_not_stopped_any_more() {
    let mut bus = delivering();
    bus.station.stop(1, bus.clock()).expect("there is such a group");
    bus.run(7000);
    bus.forget();
    deliver(&mut bus, volts(500, 10), 12_000);
    let sent = bus.sent();
    assert!(!sent.iter().any(|text| text.contains("off")), "{sent:?}");
    assert!(bus.charger(1).is_on);
}

#[test]
fn a_stop_overtakes_what_is_due() {
    let mut bus = delivering();
    // The second read is due at 5005, and waits for 20 ms.
    bus.run(5010);
    bus.forget();
    bus.station.stop(1, 5010).expect("there is such a group");
    bus.run(5026);
    assert_eq!(bus.sent(), ["5025: all of 1 off"]);
    let mut bus = lone(settings(Found::Watch));
    bus.station.assign(1, Some(1), 0).expect("it is in no group");
    bus.run(1010);
    bus.forget();
    bus.station.stop(1, 1010).expect("there is such a group");
    bus.run(1026);
    assert_eq!(bus.sent(), ["1025: 1 60 V off"]);
}

#[test]
fn a_stop_of_a_group_that_nobody_knows_is_refused() {
    let mut bus = delivering();
    assert_eq!(bus.station.stop(3, 4400), Err(Refused::Group(3)));
    assert_eq!(bus.station.watch(3, 4400), Err(Refused::Group(3)));
}

/// Asks what nobody answers until there is room for so many requests.
fn ask_elsewhere(bus: &mut Grouped, room: usize) {
    let nowhere = <Message<InGroups> as Addressed>::module(9).expect("modules have numbers");
    while bus.station.client.room() > room {
        let request = Message::<InGroups>::read::<At<InGroups>>(&[Quantity::DELIVERING], nowhere);
        let request = request.expect("it is legal").next().expect("it is read");
        bus.station.client.ask(request, bus.now).expect("there is room");
    }
}

#[test]
fn what_delivers_leaves_room_for_the_stop_of_each_module_and_of_each_group() {
    for (room, is_told) in [(2 + 2 + 1, false), (2 + 2 + 2, true)] {
        let mut bus = known(settings(Found::Watch));
        ask_elsewhere(&mut bus, room);
        let now = bus.now;
        bus.station.deliver(1, volts(500, 10), now).expect("it is allowed");
        bus.run(now + 1);
        assert_eq!(bus.station.told(1).is_some(), is_told, "the set-point and the switch-on have room: {room}");
        assert!(bus.station.client.room() >= 2 + 2, "{room}");
        bus.run(now + 4000);
        assert!(bus.chargers.iter().all(|charger| charger.is_on), "{room}");
    }
}

#[test]
fn a_stop_without_room_is_sent_when_there_is_room() {
    let mut bus = delivering();
    ask_elsewhere(&mut bus, 0);
    bus.station.stop(1, 4400).expect("there is such a group");
    bus.run(4401);
    assert_eq!(bus.station.told(1), None);
    bus.run(6400);
    assert!(bus.chargers.iter().all(|charger| !charger.is_on));
    assert!(bus.told("all of 1").len() >= 2);
    bus.run(7400);
    assert!(bus.station.is_off(1, bus.clock()));
}

#[test]
fn a_group_is_off_when_each_module_has_said_so_after_it_confirmed_the_stop() {
    let mut bus = known(settings(Found::Watch));
    assert!(bus.station.is_off(1, 1500) && !bus.station.is_off(2, 1500), "no module is in group 2");
    bus.station.stop(1, 1500).expect("there is such a group");
    bus.run(1501);
    assert!(!bus.station.is_off(1, bus.clock()));
    // The modules say it at 2010 and at 2050.
    bus.run(2050);
    assert_eq!([1, 2].map(|node| bus.station.output(node, bus.clock())), [Output::Off, Output::Unknown]);
    assert!(!bus.station.is_off(1, bus.clock()));
    bus.run(2051);
    assert!(bus.station.is_off(1, bus.clock()));
    assert!(bus.station.is_off(1, 2010 + 3000) && !bus.station.is_off(1, 2010 + 3001), "it counts for 3 s");
    assert_eq!(bus.station.output(3, bus.clock()), Output::Unknown, "there is no such module");
}

#[test]
fn a_contactor_may_open_when_all_is_off_and_each_voltage_is_low() {
    let safe = |measured| {
        let mut bus = known(settings(Found::Off));
        bus.charger(2).measures = Some([measured, 0]);
        bus.run(3500);
        assert!(bus.station.is_off(1, bus.clock()));
        bus.station.is_safe_to_open(1, bus.clock())
    };
    // Less than 60 V.
    assert_eq!([599, 600, 4000].map(safe), [true, false, false]);
    let mut bus = known(settings(Found::Off));
    bus.charger(2).refuses = Some((9, 2));
    bus.run(1500 + 3000);
    assert!(bus.station.is_off(1, bus.clock()) && !bus.station.is_safe_to_open(1, bus.clock()), "it is not measured");
    bus = delivering();
    bus.charger(2).measures = Some([0, 0]);
    bus.charger(1).measures = Some([0, 0]);
    bus.run(6400);
    assert!(!bus.station.is_safe_to_open(1, bus.clock()), "it delivers");
}

#[test]
fn an_emergency_stops_all_and_goes_on_until_the_program_lets_groups_deliver() {
    let mut bus = delivering();
    bus.charger(2).group = 7;
    bus.run(6400);
    bus.charger(2).is_on = true;
    bus.run(7400);
    assert!(bus.charger(2).is_on, "no task of the station is that of group 7, so it is only read");
    bus.run(7600);
    bus.forget();
    bus.station.emergency(bus.clock());
    bus.run(8700);
    let sent = bus.sent();
    // Nobody is in group 2.
    assert_eq!(sent[..3], ["7600: all of 1 off", "7620: 1 off", "7640: 2 off"], "{sent:?}");
    assert!(sent.iter().all(|text| !text.contains("all of 2")));
    assert!(bus.chargers.iter().all(|charger| !charger.is_on));
    assert_eq!(bus.station.deliver(1, volts(500, 10), bus.clock()), Err(Refused::Emergency));
    assert_eq!(bus.station.watch(1, bus.clock()), Err(Refused::Emergency));
    bus.station.end_emergency();
    bus.run(9400);
    assert!(bus.chargers.iter().all(|charger| !charger.is_on));
    deliver(&mut bus, volts(500, 10), 10_400);
    assert_eq!([1, 2].map(|node| bus.charger(node).is_on), [true, false]);
}

#[test]
fn a_module_is_moved_only_while_it_is_off_or_does_not_answer() {
    let point = SetPoint { voltage_mv: 500_000, current_ma: None };
    let mut bus = lone(settings(Found::Off));
    bus.run(1500);
    assert_eq!(bus.station.assign(2, Some(1), 1500), Err(Refused::Address(2)));
    assert_eq!(bus.station.assign(1, Some(9), 1500), Err(Refused::Group(9)));
    assert_eq!(bus.station.assign(1, Some(1), 1500), Ok(()));
    deliver(&mut bus, point, 3500);
    assert_eq!(bus.station.output(1, 3500), Output::On);
    assert_eq!([Some(2), None].map(|group| bus.station.assign(1, group, 3500)), [Err(Refused::NotOff); 2]);
    assert_eq!((bus.station.assign(1, Some(1), 3500), bus.station.output(1, 3500)), (Ok(()), Output::On));
    bus.station.stop(1, 3500).expect("there is such a group");
    bus.run(5600);
    assert_eq!((bus.station.assign(1, Some(2), 5600), bus.station.group(1)), (Ok(()), Some(2)));
    assert_eq!(bus.station.output(1, 5600), Output::Unknown, "it is told anew");
    bus.run(5610);
    assert_eq!(bus.told("1").last().map(|text| &text[..4]), Some("5600"), "at once");
    bus.run(7500);
    assert_eq!((bus.station.assign(1, None, 7500), bus.station.group(1)), (Ok(()), None));
    bus.station.assign(1, Some(1), 7500).expect("it is in no group");
    deliver(&mut bus, point, 9500);
    bus.charger(1).is_there = false;
    // It has no watchdog, so it is lost after three rounds.
    bus.run(13_500);
    assert_eq!(bus.station.assign(1, Some(2), 13_500), Ok(()));
}

#[test]
fn the_program_knows_better_than_a_module_which_group_that_is_in() {
    let mut bus = known(settings(Found::Off));
    assert_eq!(bus.station.assign(1, Some(2), 1500), Ok(()));
    bus.run(4000);
    assert_eq!([1, 2].map(|node| bus.station.group(node)), [Some(2), Some(1)]);
    // What it is in already can be kept while it delivers.
    bus = delivering();
    assert_eq!(bus.station.assign(1, Some(1), 4400), Ok(()));
    bus.charger(1).group = 2;
    bus.run(6400);
    assert_eq!((bus.station.group(1), bus.charger(1).is_on), (Some(1), true));
}

#[test]
fn a_watched_group_stays_as_it_is_and_reads_can_wake_it() {
    let mut bus = delivering();
    assert_eq!(bus.station.watch(1, 4400), Ok(()));
    bus.run(7000);
    assert!(bus.sent().iter().all(|text| text.ends_with('?')) && bus.charger(1).is_on);
    assert_eq!(bus.events()[0].1, Event::MayWake);
    assert_eq!(bus.station.told(1), None);
    assert_eq!(bus.station.voltage_mv(1, 7000), Known::Fresh(500_000));
}

#[test]
fn a_module_is_off_only_while_it_says_so() {
    let mut bus = known(settings(Found::Off));
    bus.charger(1).refuses = Some((8, 2));
    // It was read at 1010 for the last time.
    bus.run(6000);
    assert_eq!(bus.events(), [(1010 + 3001, Event::Output { node: 1, output: Output::Unknown })]);
}

#[test]
fn a_switch_off_that_is_sent_again_goes_before_what_is_read() {
    let mut bus = delivering();
    bus.charger(2).refuses = Some((2, 2));
    bus.station.stop(1, bus.clock()).expect("there is such a group");
    bus.run(6450);
    assert!(bus.charger(2).is_on && !bus.charger(1).is_on);
    bus.forget();
    // The program stands still for more than a round, so all of both modules is due. Module 1 is read first.
    bus.now += 1500;
    bus.run(bus.now + 200);
    let sent = bus.sent();
    let first = |text: &str| sent.iter().position(|sent| sent.contains(text)).expect("it is sent");
    assert!(first(": 2 off") < first(": 1 state?") && first("all of 1 off") < first(": 1 state?"), "{sent:?}");
}

#[test]
fn what_is_known_to_be_off_is_read_in_its_turn() {
    let mut bus = delivering();
    bus.station.stop(1, bus.clock()).expect("there is such a group");
    bus.run(7600);
    assert!(bus.station.is_off(1, bus.clock()));
    bus.forget();
    bus.now += 1500;
    bus.run(bus.now + 200);
    let sent = bus.sent();
    let first = |text: &str| sent.iter().position(|sent| sent.contains(text)).expect("it is sent");
    assert!(first(": 1 state?") < first(": 1 off") && first(": 2 state?") < first(": 2 off"), "{sent:?}");
}

#[test]
fn what_switches_on_is_sent_after_what_switches_off() {
    let groups = [(1, None), (2, None)];
    let mut bus = Bus::<AtOnce, 2, 2, 16>::of(Station::new(settings(Found::Off), [1, 2], groups), [1, 2]);
    for node in [1, 2] {
        bus.station.assign(node, Some(node), 0).expect("it does not answer");
    }
    bus.charger(2).ignores = Some(3);
    bus.charger(2).is_on = true;
    bus.run(1500);
    deliver(&mut bus, SetPoint { current_ma: None, ..volts(500, 0) }, 4400);
    assert!(bus.charger(1).is_on && bus.charger(2).is_on);
    // The program stands still, so both are due.
    bus.forget();
    bus.now += 1500;
    bus.run(bus.now + 300);
    let sent = bus.sent();
    let first = |text: &str| sent.iter().position(|sent| sent.contains(text)).expect("it is sent");
    assert!(first(": 2 60 V off") < first(": 1 500 V on"), "{sent:?}");
}

#[test]
fn a_module_that_delivers_and_trips_is_not_off_since_it_is_switched_on_again() {
    let mut bus = delivering();
    bus.charger(2).is_there = false;
    bus.charger(1).ignores = Some(2);
    bus.charger(1).is_on = false;
    bus.run(6400);
    assert_eq!(bus.station.output(1, bus.clock()), Output::Off, "it says so");
    assert!(!bus.station.is_off(1, bus.clock()));
    // What it said before it is stopped does not show that it was stopped.
    bus.station.stop(1, bus.clock()).expect("there is such a group");
    assert!(!bus.station.is_off(1, bus.clock()) && !bus.station.is_safe_to_open(1, bus.clock()));
}

#[test]
fn a_group_that_is_to_deliver_is_not_off_before_anything_is_sent() {
    let mut bus = known(settings(Found::Off));
    bus.run(3500);
    assert!(bus.station.is_safe_to_open(1, bus.clock()));
    bus.station.deliver(1, volts(500, 10), bus.clock()).expect("it is allowed");
    assert!(!bus.station.is_off(1, bus.clock()) && !bus.station.is_safe_to_open(1, bus.clock()));
}

#[test]
fn a_voltage_that_was_low_before_an_output_delivered_lets_no_contactor_open() {
    let mut bus = known(settings(Found::Off));
    bus.run(3500);
    // From now on the voltage is not read, and 0 V count until 6030 or so.
    bus.chargers.iter_mut().for_each(|charger| charger.refuses = Some((9, 2)));
    deliver(&mut bus, volts(500, 10), 3700);
    assert!(bus.charger(1).is_on && bus.charger(2).is_on);
    bus.station.stop(1, bus.clock()).expect("there is such a group");
    bus.run(5500);
    assert!(bus.station.is_off(1, bus.clock()));
    assert_eq!(bus.station.voltage_mv(1, bus.clock()), Known::Fresh(0), "it was measured before");
    assert!(!bus.station.is_safe_to_open(1, bus.clock()));
    bus.chargers.iter_mut().for_each(|charger| charger.refuses = None);
    bus.run(7500);
    assert!(bus.station.is_safe_to_open(1, bus.clock()));
}

#[test]
fn a_module_whose_group_is_not_known_can_be_in_each() {
    let mut bus = Bus::<Apart, 2, 1, 15>::of(Station::new(settings(Found::Off), [1, 2], [(1, Some(group(1)))]), [1, 2]);
    bus.charger(2).refuses = Some((7, 2));
    bus.charger(2).ignores = Some(2);
    bus.charger(2).is_on = true;
    bus.run(4500);
    assert_eq!(bus.station.output(1, bus.clock()), Output::Off);
    assert!(!bus.station.is_off(1, bus.clock()) && !bus.station.is_safe_to_open(1, bus.clock()));
    // The program knows that it is in none.
    bus.charger(2).ignores = None;
    bus.run(8500);
    assert!(bus.station.is_off(1, bus.clock()));
    bus.station.assign(2, None, bus.clock()).expect("it is off");
    bus.run(10_500);
    assert!(bus.station.is_off(1, bus.clock()));
}

#[test]
fn an_emergency_stops_at_once_what_is_in_no_group() {
    let mut bus = lone(settings(Found::Watch));
    bus.charger(1).is_on = true;
    for group in [1, 2] {
        bus.station.stop(group, 0).expect("there is such a group");
    }
    bus.station.assign(1, None, 0).expect("it does not answer");
    bus.run(1300);
    assert!(bus.charger(1).is_on, "it is only watched");
    bus.station.emergency(bus.clock());
    bus.run(1400);
    assert!(!bus.charger(1).is_on);
}

#[test]
fn a_module_that_leaves_a_group_that_delivers_is_switched_off() {
    let mut bus = delivering();
    bus.charger(2).group = 7;
    bus.run(7400);
    assert_eq!([1, 2].map(|node| bus.charger(node).is_on), [true, false], "nobody would stop it otherwise");
    assert_eq!(bus.station.output(2, bus.clock()), Output::Off);
    bus.forget();
    bus.run(9400);
    assert!(bus.told("2").is_empty(), "it is another's now, and only watched");
}
