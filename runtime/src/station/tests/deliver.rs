//! What a station lets modules deliver.

use std::vec::Vec;

use super::bus::{Bus, Grouped, LIMITS, grouped, lone, separate, settings, volts};
use super::chargers::Make;
use crate::Error;
use crate::client::Output;
use crate::station::{Beyond, Event, Found, Known, Limits, Refused, SetPoint, Settings};

/// Returns a bus whose modules are known, at 1500 ms. What happened before is forgotten.
pub fn known(settings: Settings) -> Grouped {
    let mut bus = grouped(settings);
    bus.run(1500);
    bus.forget();
    bus
}

/// Lets group 1 deliver, and goes on to a time.
pub fn deliver<K: Make, const M: usize, const G: usize, const R: usize>(
    bus: &mut Bus<K, M, G, R>,
    point: SetPoint,
    until: u32,
) {
    bus.station.deliver(1, point, bus.clock()).expect("it is allowed");
    bus.run(until);
}

#[test]
fn the_current_rises_by_a_step_in_each_round_up_to_the_share_of_a_module() {
    let mut bus = known(settings(Found::Watch));
    deliver(&mut bus, volts(500, 40), 5400);
    let expected = [
        "1500: 1 500 V 10 A",
        "1520: 1 on",
        "2500: 1 500 V 20 A",
        "2520: 1 on",
        "3500: 1 500 V 30 A",
        "3520: 1 on",
        // The group may have 60 A.
        "4500: 1 500 V 30 A",
        "4520: 1 on",
    ];
    assert_eq!(bus.told("1"), expected);
    assert_eq!(bus.station.told(1), Some(volts(500, 30)));
    let output = [1, 2].map(|node| bus.station.output(node, bus.clock()));
    assert_eq!(output, [Output::On; 2]);
    assert_eq!(bus.station.voltage_mv(1, bus.clock()), Known::Fresh(500_000));
    assert_eq!(bus.station.current_ma(1, bus.clock()), Known::Fresh(30_000));
}

#[test]
fn to_deliver_the_same_again_changes_nothing() {
    let mut bus = known(settings(Found::Watch));
    for until in [1600, 1700, 1800, 2400] {
        deliver(&mut bus, volts(500, 10), until);
    }
    assert_eq!(bus.told("1"), ["1500: 1 500 V 10 A", "1520: 1 on"]);
}

#[test]
fn a_greater_set_point_waits_until_the_last_one_is_in_effect_and_a_lower_one_does_not() {
    let told = |at, point| {
        let mut bus = known(settings(Found::Watch));
        bus.charger(2).is_there = false;
        deliver(&mut bus, volts(500, 8), at);
        deliver(&mut bus, point, 2600);
        bus.told("1")
    };
    let (first, on) = ("1500: 1 500 V 8 A", "1520: 1 on");
    assert_eq!(told(1510, volts(510, 8)), [first, on, "2500: 1 510 V 8 A", "2520: 1 on"]);
    assert_eq!(told(1510, volts(500, 9))[2], "2500: 1 500 V 9 A");
    // The set-point of charger 2 has waited longer.
    assert_eq!(told(1510, volts(490, 8))[..2], [first, "1540: 1 490 V 8 A"]);
    assert_eq!(told(1510, volts(500, 7))[..2], [first, "1540: 1 500 V 7 A"]);
    assert_eq!(told(1510, volts(510, 7))[..2], [first, "1540: 1 510 V 7 A"]);
    // The last one is in effect at 1525.
    assert_eq!(told(1600, volts(510, 8))[..3], [first, on, "1600: 1 510 V 8 A"]);
}

#[test]
fn a_set_point_that_rises_all_the_time_does_not_keep_modules_off() {
    let mut bus = known(settings(Found::Watch));
    for step in 1..100 {
        deliver(&mut bus, volts(500 + step, 10), 1500 + 20 * step.unsigned_abs());
    }
    let on: Vec<_> = bus.told("1").into_iter().filter(|text| text.ends_with("on")).collect();
    assert!(on.len() >= 2, "{on:?}");
}

#[test]
fn the_current_rises_by_a_step_in_each_round_however_often_the_set_point_changes() {
    let mut bus = known(settings(Found::Watch));
    for step in 0..40 {
        deliver(&mut bus, volts(500 + step, 30), 1500 + 50 * (step.unsigned_abs() + 1));
    }
    let told: Vec<_> = bus.told("1").into_iter().filter(|text| text.ends_with(" A")).collect();
    let first = |amperes: &str| told.iter().position(|text| text.ends_with(amperes)).map(|place| &told[place][..4]);
    assert_eq!(first("10 A"), Some("1500"));
    assert!(first("20 A").is_some_and(|at| at >= "2500") && first("30 A").is_none_or(|at| at >= "3500"), "{told:?}");
    // After a lower one, it rises from that.
    deliver(&mut bus, volts(500, 5), 3520);
    deliver(&mut bus, volts(500, 30), 3700);
    let told = bus.told("1");
    assert!(!told.iter().any(|text| text.ends_with(" 20 A") || text.ends_with(" 30 A")), "{told:?}");
}

#[test]
fn without_a_current_no_limit_of_it_would_hold() {
    let mut bus = separate(settings(Found::Off));
    bus.run(1500);
    let without = SetPoint { current_ma: None, ..volts(500, 0) };
    assert_eq!(bus.station.deliver(1, without, 1500), Err(Refused::NoCurrent));
}

#[test]
fn what_a_group_may_not_deliver_is_refused_and_it_goes_on_as_before() {
    let mut bus = known(settings(Found::Watch));
    deliver(&mut bus, volts(500, 10), 1600);
    let mut refused = |group, point| bus.station.deliver(group, point, 1600).expect_err("it is not allowed");
    assert_eq!(refused(3, volts(500, 10)), Refused::Group(3));
    let quantity = crate::Quantity::OUTPUT_VOLTAGE;
    assert_eq!(refused(1, volts(801, 10)), Refused::Beyond(Beyond { quantity, value: 801_000, limit: 800_000 }));
    // The document has currents from 1 A.
    let little = SetPoint { current_ma: Some(900), ..volts(500, 0) };
    assert!(matches!(refused(1, little), Refused::Output(Error::Value { .. })));
    bus.run(2600);
    assert_eq!(bus.told("1"), ["1500: 1 500 V 10 A", "1520: 1 on", "2500: 1 500 V 10 A", "2520: 1 on"]);
}

#[test]
fn the_limits_of_a_device_model_count() {
    let mut bus = known(Settings { model: Some(2), ..settings(Found::Watch) });
    assert!(matches!(bus.station.deliver(1, volts(500, 31), 1500), Err(Refused::Output(_))), "it has 30 A");
    assert_eq!(bus.station.deliver(1, volts(500, 30), 1500), Ok(()));
    bus = known(settings(Found::Watch));
    assert_eq!(bus.station.deliver(1, volts(500, 31), 1500), Ok(()));
}

#[test]
fn a_module_is_off_and_says_so_if_its_share_is_less_than_the_document_allows() {
    let limits = Limits { group_ma: 1900, ..LIMITS };
    let mut bus = known(Settings { limits, ..settings(Found::Watch) });
    deliver(&mut bus, volts(500, 10), 4000);
    let told = bus.told("1");
    assert!(told.len() >= 2 && told.iter().all(|text| text.ends_with("off")), "950 mA are less than 1 A: {told:?}");
    let unmet = bus.events().into_iter().filter(|(_, event)| *event == Event::Unmet { node: 1 }).count();
    assert_eq!(unmet, 1, "it is told once");
}

#[test]
fn a_module_that_has_restarted_begins_with_the_first_step() {
    let mut bus = known(settings(Found::Watch));
    deliver(&mut bus, volts(500, 30), 4900);
    bus.forget();
    (bus.charger(1).is_on, bus.charger(1).set) = (false, [0, 0]);
    bus.run(5400);
    // It says that at 5010 ms. The second read and the first one of charger 2 are due then.
    assert_eq!(bus.told("1")[0], "5045: 1 500 V 10 A");
}

#[test]
fn a_module_that_was_stopped_for_a_moment_begins_with_the_first_step() {
    let mut bus = known(settings(Found::Watch));
    deliver(&mut bus, volts(500, 30), 4900);
    bus.station.stop(1, bus.clock()).expect("there is such a group");
    bus.run(4990);
    assert!(!bus.charger(1).is_on);
    bus.forget();
    deliver(&mut bus, volts(500, 30), 5100);
    assert_eq!(bus.told("1")[0], "4990: 1 500 V 10 A");
}

#[test]
fn a_module_that_starts_is_known_to_be_there_and_nothing_else() {
    let mut bus = known(settings(Found::Watch));
    deliver(&mut bus, volts(500, 30), 4900);
    bus.forget();
    (bus.charger(1).refuses, bus.charger(1).is_on) = (Some((0, 7)), false);
    bus.run(7900);
    let starting = (5010, Event::Starting { node: 1 });
    assert_eq!(bus.events(), [starting, (5010, Event::Output { node: 1, output: Output::Unknown })]);
    assert!(bus.station.modules().any(|node| node == 1));
    assert_eq!(bus.station.voltage_mv(1, bus.clock()), Known::Unknown);
    assert_eq!(bus.station.current_ma(1, bus.clock()), Known::Unknown);
    assert!(bus.station.status(1).is_none());
    let told = bus.told("1");
    assert!(told.iter().filter(|text| text.ends_with("30 A")).count() == 0, "{told:?}");
    bus.charger(1).refuses = None;
    bus.run(12_000);
    assert_eq!((bus.charger(1).is_on, bus.charger(1).set), (true, [5000, 300]));
    // It starts again.
    bus.forget();
    bus.charger(1).refuses = Some((0, 7));
    bus.run(13_900);
    assert_eq!(bus.events().iter().filter(|(_, event)| matches!(event, Event::Starting { .. })).count(), 1);
}

#[test]
fn one_message_sets_the_voltage_and_switches_on() {
    let mut bus = lone(settings(Found::Off));
    bus.run(1500);
    assert_eq!(bus.told("1")[..2], ["0: 1 60 V off", "200: 1 60 V off"], "with the least voltage");
    bus.station.assign(1, Some(1), 1500).expect("it is off");
    bus.forget();
    deliver(&mut bus, SetPoint { voltage_mv: 500_000, current_ma: None }, 2600);
    assert_eq!(bus.told("1"), ["1500: 1 500 V on", "2500: 1 500 V on"]);
    let refused = bus.station.deliver(1, volts(500, 10), 2600);
    assert!(matches!(refused, Err(Refused::Output(Error::NotSet { .. }))), "{refused:?}");
}

#[test]
fn each_of_three_messages_follows_the_one_before_and_any_of_them_can_be_refused() {
    let mut bus = separate(settings(Found::Off));
    bus.run(1500);
    bus.forget();
    deliver(&mut bus, volts(500, 10), 2400);
    assert_eq!(bus.told("1"), ["1500: 1 500 V", "1520: 1 10 A", "1540: 1 on"]);
    for refused in [4, 5, 2] {
        bus.forget();
        bus.charger(1).refuses = Some((refused, 2));
        bus.run(bus.now + 3000);
        let events = bus.events();
        assert_eq!(events.len(), 1, "{refused}: {events:?}");
        assert_eq!(events[0].1, Event::Unmet { node: 1 }, "{refused}");
        bus.charger(1).refuses = None;
        bus.run(bus.now + 3000);
    }
    // Nothing is to be met when a read is refused.
    bus.forget();
    bus.charger(1).refuses = Some((9, 2));
    bus.run(bus.now + 2000);
    assert_eq!(bus.events(), []);
}
