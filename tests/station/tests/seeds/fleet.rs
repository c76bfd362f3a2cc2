//! The modules of a run, by vendor: all but those of TRIO, which do not answer, and of Huawei, which are not asked.

use canspec_protocols::{infy, megmeet, mxr};
use canspec_runtime::station::{Found, Limits, SetPoint, Settings, Station};
use canspec_runtime::{Addressed, Quantities};
use canspec_station::{ADDRESSES, LIMITS, output, settings};

use crate::bus::Bus;
use crate::bus::fleets::{self, INFY_GROUPS, MAXWELL_GROUP, infies_at, maxwells_at};

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
    let targets = INFY_GROUPS.map(|(number, target)| (number, Some(target)));
    let station = Station::new(limited::<infy::Message>(LIMITED), ADDRESSES, targets).expect("it fits the document");
    let bus = Bus::of(station, infies_at([0, 1, 2, 3, 4, 5, 6, 7, 7]), seed);
    Fleet { bus, groups: [1, 2], code: 4, limits: LIMITED, point: POINT, other_mv: OTHER_MV }
}

/// Four modules of Maxwell in the group 5.
pub fn maxwells(seed: u64) -> Fleet<mxr::Message, 5, 1> {
    let (number, target) = MAXWELL_GROUP;
    let station = Station::new(limited::<mxr::Message>(LIMITED), ADDRESSES, [(number, Some(target))]);
    let bus = Bus::of(station.expect("it fits the document"), maxwells_at([3, 4, 5, 6, 6]), seed);
    Fleet { bus, groups: [number], code: 0xF2, limits: LIMITED, point: POINT, other_mv: OTHER_MV }
}

/// Four modules of MEGMEET, which have no groups, and no current that is set. The program puts them into group 1.
pub fn megmeets(seed: u64) -> Fleet<megmeet::Message, 5, 1> {
    let limits = Limits { least_mv: 42_000, most_mv: 58_000, ..LIMITED };
    let bus = fleets::megmeets(limited::<megmeet::Message>(limits), [1, 2, 3, 4, 4], &[1, 2, 3, 4], seed);
    let point = SetPoint { voltage_mv: 53_500, current_ma: None };
    Fleet { bus, groups: [1], code: 2, limits, point, other_mv: 48_000 }
}
