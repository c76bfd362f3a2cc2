//! Other controllers on the bus.

use super::bus::{Grouped, foreign, settings, volts};
use super::deliver::{deliver, known};
use crate::station::{Event, Found, Rival, Rivals, Settings};

/// Returns a bus whose group 1 delivers, and whose group 2 is stopped, at 3400 ms.
fn delivering(rivals: Rivals) -> Grouped {
    let mut bus = known(Settings { rivals, ..settings(Found::Watch) });
    bus.charger(2).group = 2;
    bus.station.stop(2, 1500).expect("there is such a group");
    deliver(&mut bus, volts(500, 10), 3400);
    bus.forget();
    bus
}

const NOTHING: Rival = Rival { node: Some(1), voltage_mv: None, current_ma: None, is_on: None };

#[test]
fn another_controller_that_reads_is_no_rival() {
    let mut bus = delivering(Rivals::Leave);
    for command in [8, 9] {
        bus.hear(foreign(command, 1, [0; 4]));
    }
    bus.run(6000);
    assert_eq!(bus.events(), []);
    assert!(bus.told("1").len() >= 4);
}

#[test]
fn another_controller_that_sets_something_is_told_with_what_it_sets() {
    let rival = |frame| {
        let mut bus = delivering(Rivals::Leave);
        bus.hear(frame);
        bus.run(3410);
        bus.events().first().copied()
    };
    let event = |rival| Some((3400, Event::Rival(rival)));
    let output = Rival { voltage_mv: Some(400_000), current_ma: Some(5000), ..NOTHING };
    assert_eq!(rival(foreign(1, 1, [0x0F, 0xA0, 0, 50])), event(output));
    assert_eq!(rival(foreign(2, 1, [0; 4])), event(Rival { is_on: Some(false), ..NOTHING }));
    assert_eq!(rival(foreign(2, 2, [1, 0, 0, 0])), event(Rival { node: Some(2), is_on: Some(true), ..NOTHING }));
    let all = foreign(2, 0x5E, [1, 0, 0, 0]);
    assert_eq!(rival(all), event(Rival { node: None, is_on: Some(true), ..NOTHING }), "it goes to group 1");
    // A station sets no total.
    assert_eq!(rival(foreign(6, 1, [0; 4])), None);
}

#[test]
fn what_delivers_is_left_to_another_controller() {
    let mut bus = delivering(Rivals::Leave);
    // The first read is due at 4005 ms.
    bus.run(4000);
    bus.forget();
    bus.hear(foreign(1, 1, [0x0F, 0xA0, 0, 50]));
    bus.run(6000);
    let sent = bus.sent();
    assert!(sent.iter().all(|text| !text.contains(": 1 ")), "{sent:?}");
    assert!(sent.iter().any(|text| text.contains(": 2 off")), "what is stopped is held: {sent:?}");
    assert!(bus.events().iter().all(|(_, event)| *event != Event::KeptOn));
    assert_eq!(bus.station.told(1), None);
    // The program takes it back.
    deliver(&mut bus, volts(500, 10), 6100);
    assert_eq!(bus.told("1"), ["6000: 1 500 V 10 A", "6020: 1 on"]);
}

#[test]
fn what_is_taken_back_from_another_controller_begins_with_the_first_step() {
    for rivals in [Rivals::Leave, Rivals::Watch] {
        let mut bus = delivering(rivals);
        deliver(&mut bus, volts(500, 30), 5900);
        bus.hear(foreign(1, 1, [0x0F, 0xA0, 0, 50]));
        bus.run(5990);
        bus.forget();
        deliver(&mut bus, volts(500, 30), 6100);
        assert!(bus.told("1")[0].ends_with("1 500 V 10 A"), "{rivals:?}");
    }
}

#[test]
fn what_delivers_can_be_read_on_and_that_keeps_it_on() {
    let mut bus = delivering(Rivals::Watch);
    bus.hear(foreign(1, 1, [0x0F, 0xA0, 0, 50]));
    bus.run(6000);
    assert_eq!(bus.events()[1], (3400, Event::KeptOn));
    let sent = bus.sent();
    assert!(sent.iter().filter(|text| text.contains(": 1 ")).all(|text| text.ends_with('?')), "{sent:?}");
    assert!(sent.iter().any(|text| text.contains(": 1 state?")), "{sent:?}");
    // Nothing delivers any more for the station.
    bus.hear(foreign(1, 1, [0x0F, 0xA0, 0, 50]));
    bus.run(6100);
    assert_eq!(bus.events().len(), 1);
}

#[test]
fn what_is_stopped_and_switched_on_by_another_controller_is_stopped_again_at_once() {
    let mut bus = delivering(Rivals::Leave);
    bus.hear(foreign(2, 2, [1, 0, 0, 0]));
    bus.run(3700);
    assert_eq!(bus.sent()[..2], ["3400: all of 2 off", "3420: 2 off"]);
    // One without a group of the station is a rival, too.
    bus = known(settings(Found::Off));
    bus.run(1900);
    bus.forget();
    bus.hear(foreign(2, 1, [1, 0, 0, 0]));
    bus.run(1950);
    assert_eq!(bus.sent(), ["1900: 1 off", "1920: 2 off"]);
    // A switch-off changes nothing.
    bus = delivering(Rivals::Leave);
    bus.hear(foreign(2, 2, [0, 0, 0, 0]));
    bus.run(3490);
    assert!(bus.sent().iter().all(|text| !text.contains("off")), "it is renewed at 3500");
}

#[test]
fn what_is_adopted_is_left_and_what_is_found_to_be_off_is_not() {
    let rest = |found, rivals| {
        let mut bus = known(Settings { rivals, ..settings(found) });
        bus.charger(1).group = 7;
        bus.run(3500);
        bus.forget();
        bus.hear(foreign(1, 1, [0x0F, 0xA0, 0, 50]));
        bus.run(6000);
        let events = bus.events();
        (bus.sent().len() > 4, events.iter().any(|(_, event)| *event == Event::KeptOn))
    };
    assert_eq!(rest(Found::Adopt(volts(500, 10)), Rivals::Leave), (false, false));
    assert_eq!(rest(Found::Adopt(volts(500, 10)), Rivals::Watch), (true, true));
    assert_eq!(rest(Found::Off, Rivals::Watch), (true, false));
    assert_eq!(rest(Found::Watch, Rivals::Leave), (true, false));
}
