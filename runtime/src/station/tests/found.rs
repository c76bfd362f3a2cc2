//! What a station looks for, and what it does with what it finds.

use super::bus::{Bus, LIMITS, grouped, lone, separate, settings, volts};
use super::chargers::group;
use crate::client::Output;
use crate::station::{Event, Found, Limits, SetPoint, Settings, Station};

/// 500 V of a charger whose current cannot be set.
const ADOPTED: SetPoint = SetPoint { voltage_mv: 500_000, current_ma: None };

#[test]
fn what_is_to_be_off_hears_the_switch_off_first_and_nothing_else_before_it_answers() {
    let mut bus = grouped(settings(Found::Off));
    bus.chargers.clear();
    bus.run(1500);
    assert_eq!(bus.sent(), ["0: 1 off", "20: 2 off", "1000: 1 off", "1020: 2 off"]);
    assert_eq!(bus.events(), []);
    bus = grouped(settings(Found::Off));
    bus.charger(1).is_on = true;
    bus.charger(2).is_there = false;
    bus.run(900);
    assert_eq!(bus.sent()[..4], ["0: 1 off", "20: 2 off", "40: 1 state?", "60: 1 measured?"]);
    assert!(!bus.charger(1).is_on);
    // It confirms the stop that is held at 205 ms, and says at 245 ms that it is off.
    let off = Event::Output { node: 1, output: Output::Off };
    assert_eq!(bus.events(), [(5, Event::Found { node: 1 }), (245, off)]);
    assert!(bus.station.modules().eq([1]));
    assert_eq!([1, 2, 3].map(|node| bus.station.group(node)), [Some(1), None, None]);
}

#[test]
fn what_is_adopted_hears_the_set_point_first_and_what_is_on_goes_on_step_by_step() {
    let mut bus = grouped(settings(Found::Adopt(volts(500, 20))));
    bus.charger(1).is_on = true;
    bus.charger(2).is_there = false;
    bus.run(3500);
    let sent = bus.told("1");
    assert_eq!(sent[0], "0: 1 500 V 10 A", "10 A are the first step");
    assert!(sent.iter().all(|text| !text.ends_with("off")));
    assert!(bus.charger(1).is_on && bus.charger(1).set == [5000, 200]);
    assert_eq!(bus.events()[..1], [(5, Event::Found { node: 1 })]);
    assert_eq!(bus.station.told(1), Some(volts(500, 20)));
}

#[test]
fn what_is_adopted_shares_the_current_of_a_group_with_all_until_its_group_is_known() {
    let limits = Limits { group_ma: 8000, ..LIMITS };
    let mut bus = grouped(Settings { limits, ..settings(Found::Adopt(volts(500, 20))) });
    (bus.charger(1).is_on, bus.charger(2).group) = (true, 2);
    bus.run(3500);
    assert_eq!(bus.sent()[0], "0: 1 500 V 4 A", "both can be in one group");
    assert_eq!(bus.charger(1).set, [5000, 80], "each has a group of its own");
}

#[test]
fn what_is_adopted_and_off_is_switched_off() {
    let mut bus = grouped(settings(Found::Adopt(volts(500, 20))));
    bus.run(3500);
    let sent = bus.told("1");
    assert!(sent[0].ends_with("500 V 10 A") && sent[1..].iter().all(|text| text.ends_with("off")), "{sent:?}");
    assert!(sent.len() >= 4 && !bus.charger(1).is_on);
    assert_eq!(bus.station.output(1, bus.clock()), Output::Off);
    assert_eq!(bus.station.told(1), None);
}

#[test]
fn what_cannot_be_set_alone_is_read_before_it_is_adopted_and_that_can_wake_it() {
    let mut bus = lone(settings(Found::Adopt(ADOPTED)));
    (bus.charger(1).is_on, bus.charger(1).set) = (true, [4000, 0]);
    bus.run(900);
    assert_eq!(bus.sent()[..2], ["0: 1 state?", "20: 1 500 V on"]);
    assert_eq!(bus.events()[0], (0, Event::MayWake));
}

#[test]
fn what_is_watched_is_only_read_and_that_can_wake_it() {
    let mut bus = grouped(settings(Found::Watch));
    bus.charger(2).is_there = false;
    bus.run(3000);
    assert!(bus.sent().iter().all(|text| text.ends_with('?')));
    let off = Event::Output { node: 1, output: Output::Off };
    assert_eq!(bus.events(), [(0, Event::MayWake), (5, Event::Found { node: 1 }), (205, off)]);
    // These go on as they were.
    let mut bus = separate(settings(Found::Watch));
    bus.run(10);
    assert_eq!(bus.events()[0], (5, Event::Found { node: 1 }));
    // What is switched off is not woken.
    let mut bus = lone(settings(Found::Off));
    bus.run(10);
    assert_eq!(bus.events(), [(5, Event::Found { node: 1 })]);
}

#[test]
fn a_group_is_asked_for_once_in_each_round_until_it_is_known() {
    let mut bus = separate(settings(Found::Watch));
    bus.charger(1).refuses = Some((7, 2));
    bus.run(2900);
    let asked = |bus: &mut super::bus::Separate| bus.sent().iter().filter(|text| text.ends_with("group?")).count();
    assert_eq!((asked(&mut bus), bus.station.group(1)), (3, None));
    bus.charger(1).refuses = None;
    bus.run(5900);
    assert_eq!((asked(&mut bus), bus.station.group(1)), (1, Some(1)));
    // It may have another one when it comes back.
    bus.charger(1).is_there = false;
    bus.run(20_000);
    (bus.charger(1).is_there, bus.charger(1).group) = (true, 2);
    bus.forget();
    bus.run(23_000);
    assert_eq!((asked(&mut bus), bus.station.group(1)), (1, Some(2)));
}

#[test]
fn a_module_that_says_another_group_does_what_that_group_is_to_do() {
    let mut bus = grouped(settings(Found::Watch));
    bus.run(1500);
    bus.station.deliver(2, volts(500, 10), 1500).expect("it is allowed");
    bus.charger(1).group = 2;
    bus.run(4000);
    assert_eq!([1, 2].map(|node| bus.station.group(node)), [Some(2), Some(1)]);
    assert_eq!(bus.chargers.iter().map(|charger| charger.is_on).collect::<std::vec::Vec<_>>(), [true, false]);
}

#[test]
fn rounds_of_all_groups_keep_room_for_what_is_read_and_set() {
    let groups = [(1, Some(group(1))), (2, Some(group(2))), (3, Some(group(3)))];
    let mut bus = Bus::<super::chargers::InGroups, 1, 3, 9>::of(Station::new(settings(Found::Off), [1], groups), [1]);
    for stopped in [2, 3] {
        bus.station.stop(stopped, 0).expect("there is such a group");
    }
    bus.station.deliver(1, volts(500, 20), 0).expect("it is allowed");
    bus.run(3500);
    assert_eq!((bus.charger(1).is_on, bus.charger(1).set), (true, [5000, 200]));
    assert_eq!(bus.station.voltage_mv(1, bus.clock()).fresh(), Some(500_000));
}
