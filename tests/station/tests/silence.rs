//! What stays off, whatever the bus, the clock and other controllers do.

mod bus;

use bus::fleets::infies;
use bus::{Bus, Charger, ONCE};
use canspec_protocols::{daly, gcp, huawei, infy, megmeet, mxr, trio};
use canspec_runtime::client::Output;
use canspec_runtime::sim::Faults;
use canspec_runtime::station::{Event, Found, Known, Limits, Refused, Rival, SetPoint, Settings, Station, Unfit};
use canspec_runtime::{AfterSilence, Protocol, Route};
use canspec_station::{ADDRESSES, LIMITS, ROUND, output, settings};

type Infies = Bus<infy::Message, 8, 2>;

const OUTPUT: SetPoint = output(400_000, 4000);

/// Returns a bus on which the modules of group 1 were found, and deliver until a time.
fn delivering(seed: u64, until: u32) -> Infies {
    let mut bus = infies(seed);
    bus.run(3000);
    bus.deliver(1, OUTPUT, until);
    bus
}

/// Returns a bus on which the modules of group 1 were found and stopped, and are known to be off.
fn stopped(seed: u64) -> Infies {
    let mut bus = infies(seed);
    bus.run(3000);
    bus.stop(1, 12_000);
    assert!(bus.station.is_off(1, bus.now));
    bus
}

/// Lets time pass, and returns the modules that are on at the end of any millisecond.
fn on(bus: &mut Infies, until: u32) -> Vec<u8> {
    let mut on = Vec::new();
    while bus.now < until {
        bus.run_unfed(bus.now + 1);
        let found = (0..8).filter(|node| bus.device(*node).is_on && !on.contains(node));
        on.extend(found.collect::<Vec<_>>());
    }
    on
}

#[test]
fn what_an_output_does_after_silence_is_what_the_document_says() {
    // INFY 3.1: what delivered delivers again when it hears a command. MEGMEET 4: what was shut down starts.
    assert_eq!(infy::Message::AFTER_SILENCE, AfterSilence::Resumes);
    assert_eq!(megmeet::Message::AFTER_SILENCE, AfterSilence::Starts);
    // Huawei 11.1: it delivers its defaults. TRIO 3.3: what was switched off starts by a command alone.
    assert_eq!(huawei::Message::AFTER_SILENCE, AfterSilence::Starts);
    assert_eq!(trio::Message::AFTER_SILENCE, AfterSilence::Keeps);
    // GCP 3.4 says that a module goes off, and not whether it comes back. Maxwell 3.2 has a status bit for lost
    // communication, and says no more. Daly has no output.
    assert_eq!(gcp::Message::AFTER_SILENCE, AfterSilence::Unknown);
    assert_eq!(mxr::Message::AFTER_SILENCE, AfterSilence::Unknown);
    assert_eq!(daly::Message::AFTER_SILENCE, AfterSilence::Unknown);
}

#[test]
fn a_controller_that_comes_back_wakes_no_module() {
    let mut bus = infies(1);
    // The modules deliver 400 V, as another program has told them. Then they hear nobody.
    for node in 0..8 {
        let device = bus.device(node);
        (device.voltage_mv, device.current_ma, device.is_on) = (Some(400_000), Some(10_000), true);
    }
    bus.is_stalled = true;
    bus.run_unfed(15_000);
    bus.is_stalled = false;
    assert_eq!(bus.device(3).was_on, Some(true), "it resumes when it hears anything");
    assert_eq!(on(&mut bus, 30_000), []);
    assert!((0..8).all(|node| bus.state(node) == Some(Output::Off)));
}

#[test]
fn a_bus_that_comes_back_carries_what_the_program_wants_first() {
    let mut bus = delivering(2, 20_000);
    assert!((0..4).all(|node| bus.device(node).is_on));
    bus.is_down = true;
    bus.run_unfed(25_000);
    bus.station.stop(1, bus.now).expect("the group is known");
    bus.run_unfed(40_000);
    assert_eq!(bus.device(0).was_on, Some(true));
    bus.is_down = false;
    assert_eq!(on(&mut bus, 60_000), []);
    assert!(bus.station.is_off(1, bus.now));
}

/// Adds another controller, which sends a request again and again.
fn rival(bus: &mut Infies, request: &canspec_runtime::Frame) {
    let from = bus.now;
    bus.bench.another_controller(*request, 1000, from).expect("it is the first one");
}

/// The route of another controller to a module.
fn from_another(module: u8) -> Route<infy::Target> {
    Route::new(infy::Target::Module(module), 0xF1)
}

#[test]
fn another_controller_that_only_reads_changes_nothing() {
    let mut bus = delivering(4, 12_000);
    let read = infy::ModuleLimits::read(from_another(0)).expect("it is legal");
    rival(&mut bus, read.frame());
    bus.run(30_000);
    assert_eq!(bus.rivals(), []);
    bus.deliver(1, output(450_000, 4000), 40_000);
    assert_eq!([0, 3].map(|node| bus.device(node).voltage_mv), [Some(450_000); 2]);
}

#[test]
fn a_station_that_gives_way_keeps_nothing_on_that_nobody_feeds() {
    let mut bus = delivering(5, 12_000);
    let set = infy::SetModuleOutput { voltage_v: 300.0, current_a: 2.0 }.set(from_another(0)).expect("it is legal");
    bus.bench.another_controller(*set.frame(), ONCE, bus.now).expect("it is the first one");
    bus.run_unfed(30_000);
    let rival = Rival { node: Some(0), voltage_mv: Some(300_000), current_ma: Some(2000), is_on: None };
    assert_eq!(bus.rivals(), [rival]);
    // Nobody has fed the modules for longer than the watchdog, so they are off.
    assert_eq!([0, 1, 2, 3].map(|node| bus.device(node).is_on), [false; 4]);
    // A stop goes on. What the program says next is done, too.
    bus.station.stop(1, bus.now).expect("the group is known");
    assert_eq!(on(&mut bus, 40_000), []);
    bus.station.deliver(1, OUTPUT, bus.now).expect("the document allows it");
    bus.run_unfed(50_000);
    assert_eq!([0, 3].map(|node| bus.device(node).is_on), [true; 2]);
}

#[test]
fn what_another_controller_switches_on_is_stopped_at_once_while_it_is_to_be_off() {
    let mut bus = stopped(6);
    let switch = infy::SwitchModules { power: infy::Power::On }.set(from_another(2)).expect("it is legal");
    bus.bench.another_controller(*switch.frame(), ONCE, bus.now).expect("it is the first one");
    bus.run(12_001);
    assert!(bus.device(2).is_on);
    bus.run(12_300);
    assert!(!bus.device(2).is_on);
    assert_eq!(bus.rivals().first().and_then(|rival| rival.is_on), Some(true));
}

#[test]
fn what_a_module_said_long_ago_is_not_known() {
    let mut bus = stopped(7);
    assert_eq!(bus.station.voltage_mv(2, bus.now), Known::Fresh(0));
    // It refuses everything from now on, and comes on by other means.
    *bus.faults(2) = Faults { refused: 100, code: 4, ..Faults::NONE };
    bus.device(2).is_on = true;
    bus.run(12_000 + 3 * ROUND + 1);
    assert_eq!(bus.state(2), Some(Output::Unknown));
    assert!(!bus.station.is_off(1, bus.now));
    assert!(matches!(bus.station.voltage_mv(2, bus.now), Known::Stale { value: 0, since } if since < 12_001));
}

#[test]
fn two_modules_with_one_address_are_a_conflict_and_not_off() {
    let mut one = *infies(8).device(2);
    one.group = (1, infy::Target::Group(1));
    // The first answers that it is off. The second one is on whatever it is told.
    let other = Charger { is_on: true, is_stuck: true, ..one };
    let modules = [(0, one), (1, one), (2, one), (2, other), (4, one), (5, one), (6, one), (7, one)];
    let mut bus: Infies = Bus::new([(1, infy::Target::Group(1)), (2, infy::Target::Group(2))], modules, 8);
    bus.run(3000);
    bus.stop(1, 12_000);
    assert!(bus.events.iter().any(|(_, event)| *event == Event::Conflict { node: 2 }));
    assert_eq!([1, 2, 4].map(|node| bus.state(node)), [Output::Off, Output::Unknown, Output::Off].map(Some));
    assert!(!bus.station.is_off(1, bus.now));
    let offs = bus.sent.iter().filter(|(at, frame)| *at > 6000 && frame.to_string() == "029A02F0#0100000000000000");
    assert_eq!(offs.count(), 2, "the stop goes on");
}

#[test]
fn no_limit_of_the_program_is_passed() {
    let mut bus = infies(9);
    bus.run(3000);
    for point in [output(600_100, 4000), output(500_000, 20_001), output(500_000, 16_001), output(39_900, 1000)] {
        let refused = bus.station.deliver(1, point, bus.now);
        assert!(matches!(refused, Err(Refused::Beyond(_))), "{point:?}: {refused:?}");
    }
    let narrow = Limits { group_ma: 8000, ..LIMITS };
    let settings = Settings { limits: narrow, ..settings::<infy::Message>(Found::Off) };
    let groups = [(1, Some(infy::Target::Group(1))), (2, Some(infy::Target::Group(2)))];
    bus.station = Station::new(settings, ADDRESSES, groups).expect("it fits");
    bus.run(6000);
    // Each of four has a quarter of it.
    bus.deliver(1, output(500_000, 10_000), 30_000);
    assert_eq!([0, 1, 2, 3].map(|node| bus.device(node).current_ma), [Some(2000); 4]);
}

#[test]
fn a_clock_that_goes_back_stops_nothing() {
    let mut bus = infies(10);
    bus.ahead = 70_000;
    bus.run(3000);
    bus.deliver(1, OUTPUT, 12_000);
    bus.ahead = 10_000;
    bus.run(40_000);
    assert!(bus.events.iter().any(|(_, event)| *event == Event::ClockBack { by: 60_000 - 1 }));
    assert_eq!([0, 3].map(|node| (bus.device(node).is_on, bus.state(node))), [(true, Some(Output::On)); 2]);
}

#[test]
fn a_program_may_start_at_any_time() {
    for ahead in [1 << 31, (1 << 31) + 77_777, u32::MAX - 2000] {
        let mut bus = infies(11);
        bus.ahead = ahead;
        bus.run(3000);
        assert_eq!(bus.station.modules().count(), 8, "{ahead}");
        bus.stop(1, 12_000);
        assert!(bus.station.is_off(1, bus.clock()), "{ahead}");
    }
}

#[test]
fn a_module_whose_answers_are_always_too_short_is_there_and_its_output_is_unknown() {
    let mut bus = infies(12);
    bus.faults(2).broken = 100;
    // It delivers, as another program has told it.
    bus.device(2).is_on = true;
    bus.run(3000);
    bus.stop(1, 40_000);
    assert_eq!(bus.state(2), Some(Output::Unknown));
    let lost = bus.events.iter().filter(|(_, event)| matches!(event, Event::Lost { .. })).count();
    assert_eq!((lost, bus.device(2).is_on), (0, false));
}

#[test]
fn losses_make_no_module_silent_and_do_not_lower_its_current() {
    for seed in 0..20 {
        let mut bus = infies(seed);
        for node in 0..8 {
            *bus.faults(node) = Faults { deaf: 20, lost: 20, ..Faults::NONE };
        }
        bus.run(6000);
        bus.deliver(1, output(400_000, 10_000), 60_000);
        let lost = bus.events.iter().filter(|(_, event)| matches!(event, Event::Lost { .. })).count();
        assert_eq!(lost, 0, "seed {seed}");
        assert_eq!([0, 1, 2, 3].map(|node| bus.device(node).current_ma), [Some(10_000); 4], "seed {seed}");
    }
}

#[test]
fn a_set_point_that_changes_all_the_time_does_not_keep_its_switch_on_back() {
    let mut bus = infies(13);
    bus.run(3000);
    for step in 0..200 {
        bus.deliver(1, output(400_000 + 100 * step, 4000), bus.now + 50);
    }
    assert_eq!([0, 1, 2, 3].map(|node| bus.device(node).is_on), [true; 4]);
    bus.run(bus.now + 2 * ROUND);
    assert_eq!([0, 3].map(|node| bus.device(node).voltage_mv), [Some(419_900); 2]);
}

#[test]
fn a_station_whose_times_do_not_fit_is_none() {
    let groups = [(1, Some(infy::Target::Group(1)))];
    let station = |round| {
        let settings = Settings { round, ..settings::<infy::Message>(Found::Off) };
        Station::<infy::Message, 16, 1, 160>::new(settings, ADDRESSES, groups).err()
    };
    // Sixteen modules, two requests each that read and two that set, and a stop of the group, 50 ms apart. At most it is a
    // third of 10 s.
    let unfit = Some(Unfit::Round { least: 3250, most: 3333 });
    assert_eq!([0, 3249, 3334].map(station), [unfit; 3]);
    assert_eq!(station(3300), None);
}

#[test]
fn frames_that_lay_in_a_buffer_are_as_old_as_they_are() {
    let mut bus = stopped(14);
    // The program stands still, and another one reads the module. The driver keeps the answers.
    let read = infy::ModuleOutput::read(from_another(2)).expect("it is legal");
    rival(&mut bus, read.frame());
    bus.is_stalled = true;
    bus.run_unfed(20_000);
    bus.bench.no_other_controllers();
    bus.run_unfed(40_000);
    bus.is_stalled = false;
    assert!(!bus.kept.is_empty());
    bus.act();
    assert_eq!(bus.station.output(2, bus.now), Output::Unknown);
    let known = bus.station.voltage_mv(2, bus.now);
    assert!(matches!(known, Known::Stale { value: 0, since: 19_001..20_000 }), "{known:?}");
}
