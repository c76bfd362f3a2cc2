//! What a station makes of what modules say.

use std::borrow::ToOwned;
use std::vec::Vec;

use super::bus::{Charger, Grouped, grouped, reply, separate, settings, volts};
use super::deliver::{deliver, known};
use crate::Severity;
use crate::client::Output;
use crate::station::{Event, Found, Known};

/// Returns the events of charger 1.
fn of_first(bus: &mut Grouped) -> Vec<Event> {
    let is_its = |event: &Event| std::format!("{event:?}").contains("node: 1");
    bus.events().into_iter().map(|(_, event)| event).filter(is_its).collect()
}

const fn output(output: Output) -> Event {
    Event::Output { node: 1, output }
}

/// Adds another charger at the address of the first one, which answers later.
fn double(bus: &mut Grouped, is_on: bool, measures: [u16; 2]) {
    let twin = Charger { is_on, measures: Some(measures), delay: 8, ignores: Some(2), ..Charger::new(1) };
    bus.chargers.push(twin);
}

#[test]
fn two_modules_with_one_address_contradict_each_other_and_are_stopped_on() {
    for (is_on, measures) in [(true, [0, 0]), (false, [4000, 0]), (false, [0, 50])] {
        let mut bus = known(settings(Found::Off));
        bus.run(1900);
        double(&mut bus, is_on, measures);
        bus.run(4900);
        assert_eq!(of_first(&mut bus), [Event::Conflict { node: 1 }, output(Output::Unknown)], "{is_on} {measures:?}");
        assert!(!bus.station.is_off(1, bus.clock()));
        assert!(bus.told("1").len() >= 3);
        bus.chargers.pop();
        // The next answer is the first without a second one, and the one after that makes it known.
        bus.run(6900);
        assert_eq!(of_first(&mut bus), [output(Output::Off)], "{is_on} {measures:?}");
        assert!(bus.station.is_off(1, bus.clock()));
        // It is told again.
        double(&mut bus, is_on, measures);
        bus.run(7900);
        assert_eq!(of_first(&mut bus)[0], Event::Conflict { node: 1 });
    }
}

#[test]
fn a_frame_that_comes_twice_contradicts_nothing() {
    let mut bus = known(settings(Found::Off));
    double(&mut bus, false, [0, 0]);
    bus.run(4900);
    assert_eq!(of_first(&mut bus), []);
}

#[test]
fn answers_to_two_sendings_may_differ() {
    let mut bus = known(settings(Found::Off));
    // Each read is sent again after 100 ms, and both are answered.
    bus.charger(1).delay = 102;
    (bus.charger(1).measures, bus.charger(1).drift) = (Some([100, 0]), 1);
    bus.run(6900);
    assert!(bus.charger(1).measures.is_some_and(|[voltage, _]| voltage > 105));
    assert!(of_first(&mut bus).iter().all(|event| *event != Event::Conflict { node: 1 }));
}

#[test]
fn a_contradiction_is_found_in_the_first_round_after_one_without_an_answer() {
    let faults: [fn(&mut Charger); 3] = [
        |charger| charger.is_there = false,
        |charger| charger.refuses = Some((8, 2)),
        |charger| charger.is_short = Some(8),
    ];
    for fault in faults {
        let mut bus = known(settings(Found::Off));
        fault(bus.charger(1));
        bus.run(2900);
        let group = bus.charger(1).group;
        *bus.charger(1) = Charger { group, ..Charger::new(1) };
        double(&mut bus, true, [0, 0]);
        bus.run(3900);
        assert!(of_first(&mut bus).contains(&Event::Conflict { node: 1 }));
    }
}

#[test]
fn a_refusal_shows_that_a_module_is_there() {
    let mut bus = super::bus::grouped(settings(Found::Off));
    bus.charger(1).refuses = Some((0, 2));
    bus.run(10);
    assert!(bus.station.modules().eq([1]));
}

#[test]
fn a_module_that_wakes_is_an_event_and_is_stopped_at_once() {
    let mut bus = known(settings(Found::Off));
    bus.charger(1).is_on = true;
    bus.run(2100);
    // It is read at 2005.
    assert_eq!(bus.events(), [(2010, Event::Woke { node: 1 }), (2010, output(Output::Unknown))]);
    assert!(!bus.charger(1).is_on);
    bus.run(4900);
    assert_eq!(of_first(&mut bus), [output(Output::Off)]);
    bus.charger(1).is_on = true;
    bus.run(5900);
    assert_eq!(of_first(&mut bus)[0], Event::Woke { node: 1 }, "it wakes again");
}

#[test]
fn a_module_that_confirms_a_stop_and_delivers_on_does_not_meet_it() {
    let mut bus = known(settings(Found::Watch));
    deliver(&mut bus, volts(500, 10), 3400);
    bus.charger(1).ignores = Some(2);
    bus.station.stop(1, 3400).expect("there is such a group");
    bus.forget();
    bus.run(9000);
    let events = of_first(&mut bus);
    assert_eq!(events.iter().filter(|event| **event == Event::Unmet { node: 1 }).count(), 1, "{events:?}");
    assert!(!events.contains(&Event::Woke { node: 1 }));
    assert!(bus.told("1").len() >= 6, "it is told at once in each round");
    bus.charger(1).ignores = None;
    bus.run(12_000);
    assert!(bus.station.is_off(1, bus.clock()));
    bus.forget();
    bus.charger(1).refuses = Some((2, 2));
    bus.run(13_000);
    assert_eq!(of_first(&mut bus), [Event::Unmet { node: 1 }], "it is told again");
}

#[test]
fn what_a_module_denies_is_not_met_until_it_confirms_it() {
    let mut bus = known(settings(Found::Watch));
    bus.charger(1).denies = Some(1);
    deliver(&mut bus, volts(500, 20), 5400);
    assert_eq!(of_first(&mut bus), [output(Output::Unknown), Event::Unmet { node: 1 }]);
    assert!(!bus.charger(1).is_on);
    bus.charger(1).denies = None;
    bus.run(8400);
    assert!(bus.charger(1).is_on && bus.charger(1).set == [5000, 200]);
    bus.forget();
    bus.charger(1).denies = Some(1);
    bus.run(10_400);
    assert_eq!(of_first(&mut bus), [Event::Unmet { node: 1 }]);
}

#[test]
fn the_worst_of_what_a_module_reports_is_told_when_it_changes() {
    let mut bus = known(settings(Found::Off));
    let mut severity = |status, until| {
        bus.charger(1).status = status;
        bus.run(until);
        (of_first(&mut bus), bus.station.severity(1, bus.clock()))
    };
    let alarm = |severity| std::vec![Event::Alarm { node: 1, severity }];
    assert_eq!(severity(0b100, 2400), (std::vec![], Known::Fresh(None)), "it has no severity");
    let hot = Some(Severity::Alarm);
    assert_eq!(severity(0b110, 3400), (alarm(hot), Known::Fresh(hot)));
    assert_eq!(severity(0b010, 4400), (std::vec![], Known::Fresh(hot)));
    let broken = Some(Severity::Fault);
    assert_eq!(severity(0b011, 5400), (alarm(broken), Known::Fresh(broken)));
    assert_eq!(severity(0, 6400), (alarm(None), Known::Fresh(None)));
    assert_eq!(bus.station.severity(9, bus.clock()), Known::Unknown);
    assert_eq!(bus.station.status(1).map(|status| status.conditions().count()), Some(0));
}

#[test]
fn what_the_driver_does_not_take_is_sent_later() {
    let mut bus = known(settings(Found::Off));
    bus.is_taken = false;
    bus.run(4000);
    assert!(bus.sent().is_empty());
    bus.is_taken = true;
    bus.run(6000);
    assert!(bus.sent().len() >= 8);
    assert!(bus.station.is_off(1, bus.clock()));
}

#[test]
fn what_the_driver_does_not_take_for_long_does_not_pile_up() {
    let mut bus = grouped(settings(Found::Off));
    bus.chargers.clear();
    bus.is_taken = false;
    bus.run(8500);
    bus.is_taken = true;
    bus.run(8900);
    let sent: Vec<_> = bus.sent().iter().map(|sent| sent.split(": ").last().unwrap_or_default().to_owned()).collect();
    assert_eq!(sent, ["1 off", "2 off"]);
    // The same is true of what asks for a group.
    let mut bus = separate(settings(Found::Off));
    bus.charger(1).refuses = Some((7, 1));
    bus.run(1500);
    bus.is_taken = false;
    bus.run(8500);
    bus.is_taken = true;
    bus.run(8900);
    assert_eq!(bus.sent().iter().filter(|sent| sent.ends_with("group?")).count(), 3, "in two rounds, and then once");
}

#[test]
fn what_is_unknown_is_nothing_of_a_module() {
    let mut bus = known(settings(Found::Off));
    bus.hear(reply(12, 1, [0; 4]));
    bus.hear(reply(8, 9, [1, 1, 0, 0]));
    bus.run(1900);
    assert_eq!(bus.events(), []);
}
