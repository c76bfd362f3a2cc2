//! The modules of a run, by vendor: all but those of TRIO, which do not answer, and of Huawei, which are not asked.

use canspec_protocols::{infy, megmeet, mxr};
use canspec_runtime::station::{Found, Limits, SetPoint, Settings, Station};
use canspec_runtime::{Addressed, Quantities};
use canspec_station::{ADDRESSES, LIMITS, output, settings};

use crate::bus::fleets::{infy_tells, megmeet_tells, mxr_tells};
use crate::bus::{Bus, Charger};

/// Modules of a vendor, and what they are to do. The last one has the address of another one.
pub struct Fleet<P: Quantities + Addressed, const N: usize, const G: usize> {
    pub bus: Bus<P, N, G>,
    pub groups: [u8; G],
    /// The error code of a refusal.
    pub code: u64,
    pub limits: Limits,
    pub point: SetPoint,
    /// The voltage that another controller sets, in mV.
    pub other_mv: i32,
}

/// What four modules of a group may have together is less than the program asks for.
const LIMITED: Limits = Limits { group_ma: 36_000, ..LIMITS };
const POINT: SetPoint = output(500_000, 10_000);
const OTHER_MV: i32 = 300_000;

fn limited<P: Quantities>(limits: Limits) -> Settings {
    Settings { limits, ..settings::<P>(Found::Off) }
}

/// Eight modules of INFY in the groups 1 and 2.
pub fn infies(seed: u64) -> Fleet<infy::Message, 9, 2> {
    let groups = [1, 2];
    let group = |number| (number, infy::Target::Group(number));
    let modules = [0, 1, 2, 3, 4, 5, 6, 7, 7].map(|node| (node, Charger::new(group(1 + node / 4), infy_tells)));
    let targets = groups.map(|number| (number, Some(infy::Target::Group(number))));
    let station = Station::new(limited::<infy::Message>(LIMITED), ADDRESSES, targets).expect("it fits the document");
    let bus = Bus::of(station, modules, seed);
    Fleet { bus, groups, code: 4, limits: LIMITED, point: POINT, other_mv: OTHER_MV }
}

/// Four modules of Maxwell in the group 5.
pub fn maxwells(seed: u64) -> Fleet<mxr::Message, 5, 1> {
    let group = mxr::Target::Group(5);
    let modules = [3, 4, 5, 6, 6].map(|node| (node, Charger::new((5, group), mxr_tells)));
    let station = Station::new(limited::<mxr::Message>(LIMITED), ADDRESSES, [(5, Some(group))]);
    let bus = Bus::of(station.expect("it fits the document"), modules, seed);
    Fleet { bus, groups: [5], code: 0xF2, limits: LIMITED, point: POINT, other_mv: OTHER_MV }
}

/// Four modules of MEGMEET, which have no groups, and no current that is set. The program puts them into group 1.
pub fn megmeets(seed: u64) -> Fleet<megmeet::Message, 5, 1> {
    let limits = Limits { least_mv: 42_000, most_mv: 58_000, ..LIMITED };
    let modules = [1, 2, 3, 4, 4].map(|node| (node, Charger::new((0, megmeet::Target::Broadcast), megmeet_tells)));
    let addresses = ADDRESSES.map(|address| address + 1);
    let station = Station::new(limited::<megmeet::Message>(limits), addresses, [(1, None)]);
    let mut bus = Bus::of(station.expect("it fits the document"), modules, seed);
    for node in [1, 2, 3, 4] {
        bus.station.assign(node, Some(1), 0).expect("it answers nobody yet");
    }
    let point = SetPoint { voltage_mv: 53_500, current_ma: None };
    Fleet { bus, groups: [1], code: 2, limits, point, other_mv: 48_000 }
}
