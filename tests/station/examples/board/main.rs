//! A station and its simulated modules on a microcontroller, or on the machine at hand.
//!
//! The story is the same on both, so what is printed must be the same, too. `.ci/board` compares it.
#![cfg_attr(target_os = "none", no_std, no_main)]
#![cfg_attr(not(target_os = "none"), expect(clippy::print_stdout, reason = "people read the story"))]

#[path = "../../tests/bus/mod.rs"]
mod bus;
#[cfg(target_os = "none")]
mod start;

use bus::Bus;
use bus::fleets::{infies, maxwells};
use canspec_runtime::{Addressed, Quantities, sim::Faults};
use canspec_station::output;

#[cfg(target_os = "none")]
use cortex_m_semihosting::hprintln as say;
#[cfg(not(target_os = "none"))]
use std::println as say;

/// The voltage in mV, and the current in mA.
const OUTPUT: (i32, i32) = (500_000, 10_000);

/// Lets groups deliver while a module restarts and another one dies, and stops them.
fn story<P: Quantities + Addressed, const N: usize, const G: usize>(
    mut bus: Bus<P, N, G>,
    groups: [u8; G],
    [restarting, dying]: [u8; 2],
) where
    P::Target: PartialEq,
{
    bus.run(3000);
    show("found", &bus);
    for group in groups {
        bus.station.deliver(group, output(OUTPUT.0, OUTPUT.1), bus.now).expect("the document allows it");
    }
    bus.run(20_000);
    show("delivering", &bus);
    bus.bench.restart(restarting, bus.now);
    bus.run(30_000);
    show("one has restarted", &bus);
    *bus.faults(dying) = Faults { lost: 100, ..Faults::NONE };
    bus.run(40_000);
    show("one is silent", &bus);
    for group in groups {
        bus.station.stop(group, bus.now).expect("the group is known");
    }
    bus.run(50_000);
    show("stopped", &bus);
    say!("{} frames sent, {} heard", bus.sent.len(), bus.heard);
}

fn show<P: Quantities + Addressed, const N: usize, const G: usize>(when: &str, bus: &Bus<P, N, G>) {
    say!("{}, {} ms:", { when }, bus.now);
    for node in bus.station.modules() {
        let output = bus.station.output(node, bus.now);
        let measured = [bus.station.voltage_mv(node, bus.now), bus.station.current_ma(node, bus.now)];
        say!("  module {} of group {:?}: {:?}, {:?} mV and mA", node, bus.station.group(node), output, measured);
    }
}

fn tell() {
    say!("eight modules of INFY in two groups");
    story(infies(1), [1, 2], [3, 6]);
    say!("four modules of Maxwell");
    story(maxwells(1), [5], [4, 5]);
}

#[cfg(not(target_os = "none"))]
fn main() {
    tell();
}
