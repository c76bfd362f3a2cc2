//! What a station refuses to be.

use super::bus::{LIMITS, PACE, settings, volts};
use super::chargers::{Apart, AtOnce, InGroups, Message, Mute, Talkative, Twofold, group};
use crate::client::Pace;
use crate::station::{Beyond, Found, Limits, Refused, SetPoint, Settings, Station, Unfit};
use crate::{Error, Quantity};

/// Returns why there is no station with two modules of two groups.
fn unfit(settings: Settings) -> Option<Unfit> {
    let groups = [(1, Some(group(1))), (2, Some(group(2)))];
    Station::<Message<InGroups>, 2, 2, 14>::new(settings, [1, 2], groups).err()
}

/// Returns why there is no station with one module that has no groups.
fn unfit_alone(settings: Settings, address: u8) -> Option<Unfit> {
    Station::<Message<AtOnce>, 1, 2, 7>::new(settings, [address], [(1, None), (2, None)]).err()
}

#[test]
fn the_room_holds_what_each_module_reads_and_sets_its_group_and_each_stop() {
    // They read two messages and set two, three and one of three, three of two, and one by two accesses.
    assert_eq!(Station::<Message<InGroups>, 2, 2, 14>::ROOM, 2 * (2 + 2 + 2) + 2);
    assert_eq!(Station::<Message<AtOnce>, 1, 2, 7>::ROOM, 2 + 1 + 2 + 2);
    assert_eq!(Station::<Message<Apart>, 3, 1, 22>::ROOM, 3 * (2 + 3 + 2) + 1);
    assert_eq!(Station::<Message<Twofold>, 1, 0, 6>::ROOM, 2 + 2 + 2);
}

#[test]
fn a_round_takes_all_requests_of_all_modules_and_the_wait_for_an_answer() {
    let with = |pace, round| unfit(Settings::new(pace, round, Found::Off, LIMITS));
    // Four requests of two modules and two stops, each 20 ms after the other, and a third of 10 s.
    let quick = Pace { wait: 100, late: 99, ..PACE };
    assert_eq!(with(quick, 199), Some(Unfit::Round { least: 200, most: 3333 }));
    assert_eq!([with(quick, 200), with(quick, 3333)], [None, None]);
    assert_eq!(with(quick, 3334), Some(Unfit::Round { least: 200, most: 3333 }));
    // An answer comes within 200 ms.
    assert_eq!(with(PACE, 200), Some(Unfit::Round { least: 201, most: 3333 }));
    assert_eq!(with(PACE, 201), None);
}

#[test]
fn what_does_not_answer_a_switch_off_or_is_not_asked_whether_it_delivers_has_no_station() {
    let settings = settings(Found::Off);
    let mute = Station::<Message<Mute>, 1, 0, 5>::new(settings, [1], []).err();
    let talkative = Station::<Message<Talkative>, 1, 0, 5>::new(settings, [1], []).err();
    assert_eq!([mute, talkative], [Some(Unfit::Unanswered), Some(Unfit::Unread)]);
}

#[test]
fn without_a_watchdog_a_round_lasts_no_longer_than_a_third_of_six_days() {
    let with = |round| unfit_alone(Settings { round, valid: round, ..settings(Found::Off) }, 1);
    let most = (1 << 29) / 3;
    assert_eq!([with(201), with(most)], [None, None]);
    assert_eq!(with(most + 1), Some(Unfit::Round { least: 201, most }));
}

#[test]
fn values_count_for_a_round_and_no_longer_than_the_watchdog() {
    let with = |valid| unfit(Settings { valid, ..settings(Found::Off) });
    let refused = Some(Unfit::Valid { least: 1000, most: 10_000 });
    assert_eq!([999, 1000, 10_000, 10_001].map(with), [refused, None, None, refused]);
    assert_eq!(settings(Found::Off).valid, 3000, "three rounds");
}

#[test]
fn an_address_must_be_one_of_a_module() {
    assert_eq!(unfit_alone(settings(Found::Off), 100), Some(Unfit::Address(100)), "no mode has such numbers");
    let refused = unfit_alone(settings(Found::Off), 10);
    assert!(matches!(refused, Some(Unfit::Document(Error::Address { number: 10, .. }))), "{refused:?}");
    assert_eq!(unfit_alone(settings(Found::Off), 9), None);
}

#[test]
fn what_switches_off_must_be_allowed_by_the_document() {
    let least = |least_mv| unfit_alone(Settings { limits: Limits { least_mv, ..LIMITS }, ..settings(Found::Off) }, 1);
    assert_eq!(least(50_000), None);
    assert!(matches!(least(49_900), Some(Unfit::Document(_))), "the voltage is sent with the switch-off");
}

#[test]
fn what_is_adopted_must_be_within_the_limits_and_allowed_by_the_document() {
    let adopt = |point| unfit(settings(Found::Adopt(point)));
    assert_eq!(adopt(volts(800, 20)), None);
    let beyond = Beyond { quantity: Quantity::OUTPUT_VOLTAGE, value: 801_000, limit: 800_000 };
    assert_eq!(adopt(volts(801, 20)), Some(Unfit::Adopt(Refused::Beyond(beyond))));
    let without = adopt(SetPoint { current_ma: None, ..volts(500, 0) });
    assert_eq!(without, Some(Unfit::Adopt(Refused::NoCurrent)));
    // The document has currents from 1 A.
    let refused = adopt(SetPoint { current_ma: Some(900), ..volts(500, 0) });
    assert!(matches!(refused, Some(Unfit::Adopt(Refused::Output(Error::Value { .. })))), "{refused:?}");
}

#[test]
fn an_address_or_a_group_that_is_named_twice_has_no_station() {
    let named = |addresses, groups: [u8; 2]| {
        let groups = groups.map(|number| (number, Some(group(1))));
        Station::<Message<InGroups>, 2, 2, 14>::new(settings(Found::Off), addresses, groups).err()
    };
    assert_eq!([named([3, 3], [1, 2]), named([1, 2], [2, 2])], [Some(Unfit::Twice(3)), Some(Unfit::Twice(2))]);
    assert_eq!(named([1, 2], [1, 2]), None, "a module and a group may have one number");
}

#[test]
fn limits_that_let_nothing_be_set_have_no_station() {
    let with = |limits| unfit(Settings { limits, ..settings(Found::Off) });
    let limits = [
        Limits { most_mv: 59_999, ..LIMITS },
        Limits { most_ma: 0, ..LIMITS },
        Limits { most_mw: 0, ..LIMITS },
        Limits { group_ma: 0, ..LIMITS },
        Limits { rise_ma: 0, ..LIMITS },
    ];
    assert_eq!(limits.map(with), [Some(Unfit::Limits); 5]);
    assert_eq!(with(Limits { most_mv: 60_000, most_ma: 1, most_mw: 1, group_ma: 1, rise_ma: 1, ..LIMITS }), None);
}

#[test]
fn limits_refuse_the_first_value_that_is_beyond() {
    let allow = |voltage_mv, current_ma| LIMITS.allow(SetPoint { voltage_mv, current_ma });
    let beyond = |quantity, value, limit| Err(Beyond { quantity, value, limit });
    assert_eq!([allow(60_000, None), allow(800_000, Some(0)), allow(500_000, Some(40_000))], [Ok(()); 3]);
    assert_eq!(allow(59_999, None), beyond(Quantity::OUTPUT_VOLTAGE, 59_999, 60_000));
    assert_eq!(allow(800_001, Some(-1)), beyond(Quantity::OUTPUT_VOLTAGE, 800_001, 800_000));
    assert_eq!(allow(500_000, Some(-1)), beyond(Quantity::OUTPUT_CURRENT, -1, 40_000));
    assert_eq!(allow(800_000, Some(40_001)), beyond(Quantity::OUTPUT_CURRENT, 40_001, 40_000));
    // 800 V and 25 A are 20 kW.
    assert_eq!(allow(800_000, Some(25_000)), Ok(()));
    assert_eq!(allow(800_000, Some(25_001)), beyond(Quantity::OUTPUT_POWER, 20_000_800, 20_000_000));
    let open = Limits { most_mv: i32::MAX, most_ma: i32::MAX, ..LIMITS };
    let most = SetPoint { voltage_mv: i32::MAX, current_ma: Some(i32::MAX) };
    assert_eq!(open.allow(most), beyond(Quantity::OUTPUT_POWER, i32::MAX, 20_000_000));
}

#[test]
fn modules_of_a_group_share_its_current() {
    assert_eq!([0, 1, 2, 7].map(|members| LIMITS.share(members)), [60_000, 60_000, 30_000, 8571]);
}
