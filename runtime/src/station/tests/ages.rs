//! How long what modules have said counts.

use super::bus::{Grouped, PACE, foreign, grouped, lone, reply, settings, volts};
use super::chargers::{InGroups, Message};
use super::deliver::{deliver, known};
use crate::Received;
use crate::client::{Output, Pace};
use crate::station::fit::LONGEST;
use crate::station::known::Said;
use crate::station::module::Module;
use crate::station::{Event, Found, Known, Settings};

const STARTS: [u32; 5] = [0, (1 << 31) - 2500, 1 << 31, (1 << 31) + 5, u32::MAX - 2500];

/// Returns a bus whose modules deliver at 3400 ms, and whose clock began at a time.
fn delivering(start: u32) -> Grouped {
    let mut bus = grouped(settings(Found::Watch)).from(start);
    bus.run(1500);
    deliver(&mut bus, volts(500, 10), 3400);
    bus.forget();
    bus
}

#[test]
fn values_count_for_three_seconds_and_are_stale_after_that() {
    for start in STARTS {
        let mut bus = delivering(start);
        bus.chargers.clear();
        // Charger 1 has measured at 3030, and said its state at 3010.
        let (said, stale) = (start.wrapping_add(3030), start.wrapping_add(3030 + 3001));
        bus.run(6100);
        let known = |now| (bus.station.voltage_mv(1, now), bus.station.current_ma(1, now));
        let old = (Known::Stale { value: 500_000, since: said }, Known::Stale { value: 10_000, since: said });
        assert_eq!(known(stale.wrapping_sub(1)), (Known::Fresh(500_000), Known::Fresh(10_000)), "{start}");
        assert_eq!(known(stale), old, "{start}");
        let severity = |now| bus.station.severity(1, now);
        let since = start.wrapping_add(3010);
        assert_eq!(severity(since.wrapping_add(3000)), Known::Fresh(None), "{start}");
        assert_eq!(severity(since.wrapping_add(3001)), Known::Stale { value: None, since }, "{start}");
        assert_eq!(bus.station.voltage_mv(3, stale), Known::Unknown);
        let unknown = |node, at| (at, Event::Output { node, output: Output::Unknown });
        assert_eq!(bus.events(), [unknown(1, 6011), unknown(2, 6051)], "{start}");
    }
}

#[test]
fn a_module_that_has_not_answered_for_the_watchdog_is_lost_and_told_what_to_do_before_it_is_read() {
    for start in STARTS {
        let mut bus = delivering(start);
        bus.charger(1).is_there = false;
        // It has answered at 3030 for the last time. The watchdog waits for 10 s, and answers come within 200 ms.
        bus.run(3030 + 9800);
        assert!(bus.events().iter().all(|(_, event)| *event != Event::Lost { node: 1 }), "{start}");
        assert!(bus.station.modules().eq([1, 2]));
        bus.forget();
        bus.run(14_000);
        assert_eq!(bus.events(), [(12_830, Event::Lost { node: 1 })], "{start}");
        assert!(bus.station.modules().eq([2]));
        let sent: std::vec::Vec<_> = bus.sent().into_iter().filter(|text| text.contains(": 1 ")).collect();
        assert_eq!(sent.len(), 2, "{sent:?}");
        assert!(sent.iter().all(|text| text.ends_with(": 1 500 V 10 A")), "{sent:?}");
        bus.charger(1).is_there = true;
        bus.run(15_900);
        assert!(bus.charger(1).is_on);
        assert_eq!(bus.events()[0].1, Event::Found { node: 1 });
    }
}

#[test]
fn a_stopped_module_that_is_lost_hears_nothing_but_stops() {
    let mut bus = delivering(0);
    bus.charger(1).is_there = false;
    bus.run(9000);
    bus.station.stop(1, 9000).expect("there is such a group");
    bus.run(13_100);
    bus.forget();
    bus.run(15_900);
    let sent: std::vec::Vec<_> = bus.sent().into_iter().filter(|text| text.contains(": 1 ")).collect();
    assert!(sent.len() >= 2 && sent.iter().all(|text| text.ends_with("off")), "{sent:?}");
    assert!(bus.charger(1).is_on);
    bus.charger(1).is_there = true;
    bus.run(17_100);
    assert!(!bus.charger(1).is_on);
}

#[test]
fn without_a_watchdog_a_module_is_lost_after_three_rounds() {
    let mut bus = lone(settings(Found::Off));
    bus.run(900);
    let heard = 205;
    bus.chargers.clear();
    bus.run(heard + 3000);
    assert!(bus.events().iter().all(|(_, event)| *event != Event::Lost { node: 1 }));
    bus.run(heard + 3001);
    assert_eq!(bus.events(), [(heard + 3000, Event::Lost { node: 1 })]);
}

#[test]
fn a_clock_that_goes_back_counts_as_no_time_passed() {
    let mut bus = delivering(100_000);
    bus.run(3500);
    bus.start -= 60_000;
    bus.run(3501);
    // It was polled at 3400 ms for the last time.
    assert_eq!(bus.events(), [(3500, Event::ClockBack { by: 59_900 })]);
    bus.run(7000);
    let sent = bus.sent();
    assert!(sent.len() >= 20, "the rounds go on: {sent:?}");
    assert_eq!(bus.station.voltage_mv(1, bus.clock()), Known::Fresh(500_000));
    bus.charger(1).refuses = Some((9, 2));
    bus.run(12_000);
    let Known::Stale { since, .. } = bus.station.voltage_mv(1, bus.clock()) else { panic!("it is old") };
    // The rounds are 100 ms later since then.
    assert_eq!(since, bus.start + 6130);
}

#[test]
fn a_late_answer_shows_that_a_module_is_there_and_nothing_of_its_output() {
    let pace = Pace { tries: 1, ..PACE };
    let mut bus = grouped(Settings { pace, ..settings(Found::Watch) });
    bus.charger(1).delay = 150;
    bus.charger(2).is_there = false;
    bus.run(3000);
    assert_eq!(bus.events(), [(0, Event::MayWake), (150, Event::Found { node: 1 })]);
    assert_eq!(bus.station.output(1, bus.clock()), Output::Unknown);
    assert_eq!(bus.station.voltage_mv(1, bus.clock()), Known::Unknown);
    assert_eq!(bus.station.group(1), Some(1));
}

#[test]
fn reports_tell_measured_values_and_not_that_a_module_hears_anything() {
    let mut bus = grouped(settings(Found::Watch));
    bus.chargers.clear();
    bus.run(10);
    bus.hear(reply(10, 1, [0x0F, 0xA0, 0, 50]));
    bus.run(20);
    assert!(bus.station.modules().next().is_none());
    assert_eq!(bus.station.voltage_mv(1, 20), Known::Fresh(400_000));
    assert_eq!(bus.station.current_ma(1, 20), Known::Fresh(5000));
    // What was received before counts less.
    bus.coming.push((5, reply(10, 1, [0, 0, 0, 0])));
    bus.run(30);
    assert_eq!(bus.station.voltage_mv(1, 30), Known::Fresh(400_000));
    bus.hear(foreign(10, 1, [0; 4]));
    bus.run(40);
    assert_eq!(bus.station.voltage_mv(1, 40), Known::Fresh(400_000), "it goes to the module");
}

#[test]
fn short_answers_show_that_a_module_is_there() {
    let mut bus = known(settings(Found::Off));
    bus.charger(1).is_short = Some(0);
    bus.run(15_000);
    assert!(bus.station.modules().eq([1, 2]));
    assert_eq!(bus.station.output(1, bus.clock()), Output::Unknown);
    assert!(bus.events().iter().all(|(_, event)| !matches!(event, Event::Lost { .. } | Event::Conflict { .. })));
    // Also before it is known.
    bus = grouped(settings(Found::Off));
    bus.charger(1).is_short = Some(0);
    bus.run(10);
    assert!(bus.station.modules().eq([1]));
}

#[test]
fn refusals_for_ever_let_values_become_stale() {
    let mut bus = delivering(0);
    bus.charger(1).refuses = Some((8, 2));
    bus.charger(2).refuses = Some((9, 2));
    bus.run(30_000);
    assert!(bus.station.modules().eq([1, 2]));
    assert_eq!(bus.station.output(1, bus.clock()), Output::Unknown);
    assert_eq!(bus.station.voltage_mv(1, bus.clock()), Known::Fresh(500_000));
    assert_eq!(bus.station.output(2, bus.clock()), Output::On);
    assert_eq!(bus.station.voltage_mv(2, bus.clock()), Known::Stale { value: 500_000, since: 3070 });
}

#[test]
fn what_is_older_than_six_days_is_forgotten() {
    let mut module = Module::<Message<InGroups>>::new(1);
    let start = 1 << 31;
    let frame = reply(8, 1, [1, 1, 0, 0]);
    let status = Received::decode(&frame).expect("it is the state");
    module.said_at = start;
    module.voltage_mv = Some(Said { value: 500_000, at: start });
    module.current_ma = Some(Said { value: 10_000, at: start });
    module.status = Some(Said { value: status, at: start });
    let is_known = |module: &Module<Message<InGroups>>| {
        [module.voltage_mv.is_some(), module.current_ma.is_some(), module.status.is_some()]
    };
    module.expire(start + LONGEST - 1);
    assert_eq!((is_known(&module), module.said_at), ([true; 3], start));
    module.expire(start + LONGEST);
    assert_eq!((is_known(&module), module.said_at), ([false; 3], start));
    // It stays as old.
    module.expire(start + LONGEST + 7);
    assert_eq!(module.said_at, start + 7);
}
