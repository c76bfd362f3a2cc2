//! A controller of charging modules, built on the public interface alone.
//!
//! It chooses what the documents leave open. All the rest is the [station](canspec_runtime::station) of the library.
#![no_std]

use core::time::Duration;

use canspec_runtime::client::Pace;
use canspec_runtime::station::{Found, Limits, SetPoint, Settings, Station, Unfit};
use canspec_runtime::{Addressed, Protocol, Quantities, Time, Timing};

/// The time from one round of a module to the next, in milliseconds.
pub const ROUND: u32 = 3300;

/// What no output exceeds.
pub const LIMITS: Limits = Limits {
    least_mv: 40_000,
    most_mv: 600_000,
    most_ma: 20_000,
    most_mw: 8_000_000,
    group_ma: 80_000,
    rise_ma: 4000,
    open_mv: 60_000,
};

/// Where modules can be.
pub const ADDRESSES: [u8; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// A station with sixteen addresses.
pub type Chargers<P, const G: usize> = Station<P, 16, G, 160>;

/// Returns a station that switches off what it finds, at the addresses from 0 to 15.
///
/// # Errors
///
/// Refuses what does not fit the document.
pub fn chargers<P: Quantities + Addressed, const G: usize>(
    groups: [(u8, Option<P::Target>); G],
) -> Result<Chargers<P, G>, Unfit> {
    Station::new(settings::<P>(Found::Off), ADDRESSES, groups)
}

/// Returns the settings of a station, by what becomes of modules that it finds.
pub fn settings<P: Protocol>(found: Found) -> Settings {
    Settings::new(pace::<P>(), ROUND, found, LIMITS)
}

/// Returns the pace of the document, and chooses what that does not state.
///
/// # Panics
///
/// If a time of the document is longer than 24 days.
pub fn pace<P: Protocol>() -> Pace {
    let Timing { request_gap, reply_timeout, tries, .. } = P::TIMING;
    let chosen = |time: Option<Time>, milliseconds| time.unwrap_or(Time::of(Duration::from_millis(milliseconds)));
    let timing = P::TIMING
        .with_request_gap(chosen(request_gap, 20))
        .with_reply_timeout(chosen(reply_timeout, 100))
        .with_tries(tries.unwrap_or(3));
    Pace::of(&timing, 100).expect("no time is longer than 24 days")
}

/// Returns a set-point, in mV and mA.
pub const fn output(voltage_mv: i32, current_ma: i32) -> SetPoint {
    SetPoint { voltage_mv, current_ma: Some(current_ma) }
}
