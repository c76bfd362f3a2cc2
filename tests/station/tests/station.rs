//! A station on buses whose modules fail, over hundreds of seeds.

mod bus;
mod seeds;

use bus::fleets::{infies, maxwells};
use bus::{Bus, Charger};
use canspec_protocols::{infy, mxr};
use canspec_runtime::client::Output;
use canspec_runtime::station::{Known, Refused, Rival, SetPoint};
use canspec_runtime::{Addressed, Quantities, Quantity, Received, Severity};
use canspec_station::{LIMITS, output};
use seeds::{CYCLE, Counts, run};

const FULL: SetPoint = output(500_000, 10_000);
/// How many seeds run here, for a poor and a fair cycle each. `just seeds` runs more and longer.
const SEEDS: u64 = 200;

#[test]
fn modules_are_found_and_the_current_rises_step_by_step() {
    let mut bus = infies(1);
    bus.run(3000);
    let found: Vec<_> = bus.station.modules().map(|node| (node, bus.station.group(node))).collect();
    assert_eq!(found, [0, 1, 2, 3, 4, 5, 6, 7].map(|node| (node, Some(1 + node / 4))));
    bus.deliver(1, FULL, 14_000);
    for node in 0..8 {
        let is_told = node < 4;
        let device = *bus.device(node);
        let point = device.voltage_mv.map(|voltage_mv| SetPoint { voltage_mv, current_ma: device.current_ma });
        assert_eq!((device.is_on, point), (is_told, is_told.then_some(FULL)), "module {node}");
        assert_eq!(device.steepest_ma, if is_told { LIMITS.rise_ma } else { 0 });
        let (station, now) = (&bus.station, bus.now);
        assert_eq!(station.output(node, now), if is_told { Output::On } else { Output::Off });
        let shown = if is_told { (500_000, 10_000) } else { (0, 0) };
        let measured = (station.voltage_mv(node, now), station.current_ma(node, now));
        assert_eq!(measured, (Known::Fresh(shown.0), Known::Fresh(shown.1)));
        assert_eq!(station.severity(node, now), Known::Fresh(if is_told { None } else { Some(Severity::State) }));
    }
}

#[test]
fn a_module_that_restarts_gets_its_set_point_before_its_switch_on_whenever_that_happens() {
    for restart in (0..4000).step_by(13) {
        let (mut infies, mut maxwells) = (infies(7), maxwells(7));
        for (bus, group) in [(&mut infies as &mut dyn Restarts, 1), (&mut maxwells, 5)] {
            assert_eq!(bus.after_restart(group, 12_000 + restart), (true, false, 2), "at {restart} ms");
        }
    }
}

/// A bus of any protocol.
trait Restarts {
    /// Returns of a module that has restarted whether it is on, whether it ever was without a set-point, and how often
    /// it was switched on.
    fn after_restart(&mut self, group: u8, restart: u32) -> (bool, bool, u32);
}

impl<P: Quantities + Addressed, const N: usize, const G: usize> Restarts for Bus<P, N, G>
where
    P::Target: PartialEq,
{
    fn after_restart(&mut self, group: u8, restart: u32) -> (bool, bool, u32) {
        self.run(3000);
        self.deliver(group, FULL, restart);
        self.bench.restart(3, self.now);
        self.run(restart + 8000);
        let device = self.device(3);
        (device.is_on, device.was_bare, device.switched_on)
    }
}

#[test]
fn a_switch_on_that_is_lost_in_a_restart_comes_again_after_its_set_point() {
    let mut bus = infies(3);
    bus.run(3000);
    bus.station.deliver(1, FULL, bus.now).expect("the document allows it");
    // It restarts when its set-point has come, and before its switch-on.
    while bus.device(3).voltage_mv.is_none() {
        bus.run(bus.now + 1);
    }
    assert_eq!(bus.device(3).switched_on, 0);
    bus.bench.restart(3, bus.now);
    bus.run(bus.now + 1000);
    let is_switched_on = |(_, frame): &(u32, canspec_runtime::Frame)| {
        let received = Received::<infy::Message>::decode(frame).expect("the station sent it");
        received.node() == Some(3) && received.setting(Quantity::DELIVERING) == Some(1)
    };
    assert_eq!(bus.sent.iter().filter(|sent| is_switched_on(sent)).count(), 1, "one was lost");
    assert_eq!(bus.device(3).switched_on, 0);
    bus.run(bus.now + 6000);
    let device = bus.device(3);
    assert_eq!((device.is_on, device.was_bare, device.voltage_mv), (true, false, Some(500_000)));
}

#[test]
fn a_stopped_group_from_which_nobody_was_awaited_is_not_off() {
    let mut bus = maxwells(5);
    for node in [3, 4, 5, 6] {
        bus.faults(node).lost = 100;
        *bus.device(node) = Charger { is_on: true, ..*bus.device(node) };
    }
    bus.run(2000);
    assert_eq!(bus.station.modules().count(), 0);
    bus.stop(5, 9000);
    assert!(!bus.station.is_off(5, bus.now));
    // It was told all the same, and again and again.
    assert!([3, 4, 5, 6].into_iter().all(|node| !bus.device(node).is_on));
    let offs = bus.sent.iter().filter(|(_, frame)| {
        let received = Received::<mxr::Message>::decode(frame).expect("the station sent it");
        received.target() == Some(mxr::Target::Group(5)) && received.setting(Quantity::DELIVERING) == Some(0)
    });
    assert_eq!(offs.count(), 3);
    assert_eq!(bus.station.stop(6, bus.now), Err(Refused::Group(6)));
}

#[test]
fn a_stop_is_the_next_frame_and_a_silent_module_is_unknown() {
    let mut bus = infies(9);
    bus.run(3000);
    for group in [1, 2] {
        bus.station.deliver(group, FULL, bus.now).expect("the document allows it");
    }
    bus.run(15_000);
    bus.faults(2).lost = 100;
    let stopped = bus.now;
    bus.stop(1, stopped + 60);
    let &(at, first) = bus.sent.iter().find(|(at, _)| *at >= stopped).expect("the station sends");
    assert_eq!((at - stopped < 50, first.to_string()), (true, "02DA01F0#0100000000000000".to_owned()));
    bus.run(stopped + 5000);
    assert_eq!([0, 1, 2, 3, 4].map(|node| bus.device(node).is_on), [false, false, false, false, true]);
    let states = [0, 1, 2, 3, 4].map(|node| bus.state(node).expect("it is found"));
    assert_eq!(states, [Output::Off, Output::Off, Output::Unknown, Output::Off, Output::On]);
    assert_eq!([1, 2].map(|group| bus.station.is_off(group, bus.now)), [false, false]);
    bus.faults(2).lost = 0;
    bus.run(stopped + 10_000);
    assert_eq!([1, 2].map(|group| bus.station.is_off(group, bus.now)), [true, false]);
}

#[test]
fn the_station_gives_way_to_another_controller_and_still_stops() {
    let mut bus = infies(11);
    bus.run(3000);
    bus.deliver(1, FULL, 12_000);
    assert_eq!(bus.rivals(), []);
    let route = canspec_runtime::Route::new(infy::Target::Module(0), 0xF1);
    let request = infy::SetModuleOutput { voltage_v: 300.0, current_a: 2.0 }.set(route).expect("it is legal");
    bus.bench.another_controller(*request.frame(), 1000, 12_100).expect("room");
    bus.run(20_000);
    let rival = Rival { node: Some(0), voltage_mv: Some(300_000), current_ma: Some(2000), is_on: None };
    assert_eq!(bus.rivals().first(), Some(&rival));
    let settings = |bus: &Bus<infy::Message, 8, 2>, from: u32| {
        let later = bus.sent.iter().filter(|(at, _)| *at > from);
        let received = later.map(|(_, frame)| Received::<infy::Message>::decode(frame).expect("the station sent it"));
        received.filter(|received| received.setting(Quantity::OUTPUT_VOLTAGE).is_some()).count()
    };
    assert_eq!(settings(&bus, 12_101), 0);
    assert_eq!([0, 1].map(|node| bus.device(node).voltage_mv), [Some(300_000), Some(500_000)]);
    bus.stop(1, 26_000);
    assert_eq!((settings(&bus, 12_101), bus.device(1).is_on, bus.station.is_off(1, bus.now)), (0, false, true));
}

#[test]
fn a_station_keeps_its_promises_whatever_fails() {
    let mut sum = Counts::default();
    for seed in 0..SEEDS {
        match run(seed, 2 * CYCLE) {
            Ok(counts) => sum += counts,
            Err(wrong) => panic!("seed {seed}: {wrong}"),
        }
    }
    assert_eq!(sum.too_rare(), None, "{sum}");
}
