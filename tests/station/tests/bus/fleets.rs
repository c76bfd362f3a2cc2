//! Modules of five vendors.

use canspec_protocols::{huawei, infy, megmeet, mxr, trio};
use canspec_runtime::station::{Settings, Station};
use canspec_runtime::{Frame, Received};
use canspec_station::ADDRESSES;

use super::{Bus, Charger, Reports};

fn infy_tells(request: &Received<infy::Message>, module: &Charger<infy::Message>) -> Option<infy::Message> {
    use infy::{Message, ModuleOutput, ModuleStatus, Status0, Status1, Status2};
    Some(match request.content() {
        Message::ReadModuleOutput => {
            Message::ModuleOutput(ModuleOutput { voltage_v: module.volts(), current_a: module.amperes() })
        }
        Message::ReadModuleStatus => Message::ModuleStatus(ModuleStatus {
            group: module.group.0,
            temperature_c: 30,
            status_2: Status2::default(),
            status_1: if module.is_on { Status1::default() } else { Status1::DC_OFF },
            status_0: Status0::default(),
        }),
        _ => return None,
    })
}

fn mxr_tells(request: &Received<mxr::Message>, module: &Charger<mxr::Message>) -> Option<mxr::Message> {
    use mxr::{Alarms, GroupAndAddress, Message, ModuleStatus, OutputCurrent, OutputVoltage};
    let value = if module.is_on { Alarms::default() } else { Alarms::DCDC_OFF };
    Some(match request.content() {
        Message::ReadOutputVoltage => Message::OutputVoltage(OutputVoltage { value_v: module.volts() }),
        Message::ReadOutputCurrent => Message::OutputCurrent(OutputCurrent { value_a: module.amperes() }),
        Message::ReadModuleStatus => Message::ModuleStatus(ModuleStatus { value }),
        Message::ReadGroupAndAddress => {
            Message::GroupAndAddress(GroupAndAddress { group: module.group.0.into(), address: 0 })
        }
        _ => return None,
    })
}

fn megmeet_tells(request: &Received<megmeet::Message>, module: &Charger<megmeet::Message>) -> Option<megmeet::Message> {
    use megmeet::{Alarms, ExtendedAlarms, Message, ModuleStatus, OutputCurrent, OutputVoltage};
    let alarms = if module.is_on { Alarms::default() } else { Alarms::SHUT_DOWN };
    Some(match request.content() {
        Message::ReadOutputVoltage => Message::OutputVoltage(OutputVoltage { value_v: module.volts().into() }),
        Message::ReadOutputCurrent => Message::OutputCurrent(OutputCurrent { value_a: module.amperes().into() }),
        Message::ReadModuleStatus => {
            Message::ModuleStatus(ModuleStatus { extended: ExtendedAlarms::default(), alarms })
        }
        _ => return None,
    })
}

fn huawei_tells(request: &Received<huawei::Message>, module: &Charger<huawei::Message>) -> Option<huawei::Message> {
    use huawei::{Message, OutputCurrent2, OutputVoltage};
    Some(match request.content() {
        Message::GetOutputVoltage => Message::OutputVoltage(OutputVoltage { value_v: module.volts().into() }),
        Message::GetOutputCurrent2 => Message::OutputCurrent2(OutputCurrent2 { value_a: module.amperes().into() }),
        _ => return None,
    })
}

/// A module of Huawei says by itself whether it is active.
fn huawei_reports(node: u8, place: u8, module: &Charger<huawei::Message>) -> Option<Frame> {
    use huawei::{ActiveState, Activity, Message};
    let activity = if module.is_on { Activity::Active } else { Activity::NotActive };
    let active = Message::ActiveState(ActiveState { activity, load_percent: 0.0 });
    (place == 0).then(|| ActiveState::ANNOUNCE.report_from(node, active).expect("a state of a module"))
}

/// A module of TRIO says everything by itself.
fn trio_reports(node: u8, place: u8, module: &Charger<trio::Message>) -> Option<Frame> {
    use trio::{ControlMode, Identifier, Kind, Message, Operation, OutputValues, ReferenceValues, Status};
    let (exchange, content) = match place {
        0 => {
            let operation = if module.is_on { Operation::On } else { Operation::Off };
            let [minimum_voltage_v, nominal_voltage_v, maximum_voltage_v] = [23.5, 24.0, 29.8];
            let mode = ControlMode::Remote;
            let values = ReferenceValues { mode, operation, nominal_voltage_v, maximum_voltage_v, minimum_voltage_v };
            (&ReferenceValues::REPORT, Message::ReferenceValues(values))
        }
        1 => {
            let (voltage_v, current_a) = (module.volts().into(), module.amperes().into());
            let values = OutputValues { voltage_v, current_a, power_w: 0.0, status: Status::default() };
            (&OutputValues::REPORT, Message::OutputValues(values))
        }
        _ => return None,
    };
    let filter = exchange.filter(Kind::Report).expect("it is reported");
    let blank = filter.id(Identifier::TARGET, 0xF3).id(Identifier::SOURCE, node.into()).frame(8);
    Some(Message::decode(&blank).expect("a report").with_content(content).encode().expect("values in range"))
}

/// The groups of INFY's modules, by number and by address.
pub const INFY_GROUPS: [(u8, infy::Target); 2] = [(1, infy::Target::Group(1)), (2, infy::Target::Group(2))];

/// Eight modules in the groups 1 and 2.
pub fn infies(seed: u64) -> Bus<infy::Message, 8, 2> {
    Bus::new(INFY_GROUPS, infies_at([0, 1, 2, 3, 4, 5, 6, 7]), seed)
}

/// Modules of INFY. Four are in each group.
pub fn infies_at<const N: usize>(nodes: [u8; N]) -> [(u8, Charger<infy::Message>); N] {
    nodes.map(|node| (node, Charger::new(INFY_GROUPS[usize::from(node / 4)], infy_tells)))
}

/// The group of Maxwell's modules.
pub const MAXWELL_GROUP: (u8, mxr::Target) = (5, mxr::Target::Group(5));

/// Four modules in the group 5.
pub fn maxwells(seed: u64) -> Bus<mxr::Message, 4, 1> {
    Bus::new([MAXWELL_GROUP], maxwells_at([3, 4, 5, 6]), seed)
}

/// Modules of Maxwell.
pub fn maxwells_at<const N: usize>(nodes: [u8; N]) -> [(u8, Charger<mxr::Message>); N] {
    nodes.map(|node| (node, Charger::new(MAXWELL_GROUP, mxr_tells)))
}

/// Modules of MEGMEET with a station that puts `members` into group 1.
pub fn megmeets<const N: usize>(
    settings: Settings,
    nodes: [u8; N],
    members: &[u8],
    seed: u64,
) -> Bus<megmeet::Message, N, 1> {
    let addresses = ADDRESSES.map(|address| address + 1);
    let station = Station::new(settings, addresses, [(1, None)]).expect("it fits the document");
    let mut bus = Bus::of(station, megmeets_at(nodes), seed);
    for node in members {
        bus.station.assign(*node, Some(1), 0).expect("it answers nobody yet");
    }
    bus
}

/// Modules of MEGMEET. They have no groups: each is asked alone, or all together.
pub fn megmeets_at<const N: usize>(nodes: [u8; N]) -> [(u8, Charger<megmeet::Message>); N] {
    nodes.map(|node| (node, Charger::new((0, megmeet::Target::Broadcast), megmeet_tells)))
}

/// Three modules of Huawei. They have no groups, either, and say by themselves whether they deliver.
pub fn huaweis() -> [(u8, Charger<huawei::Message>); 3] {
    let module = Charger::new((0, huawei::Target::Broadcast), huawei_tells);
    [1, 2, 3].map(|node| (node, module.reporting(Reports::new(huawei_reports, 377))))
}

/// Three modules of TRIO. They answer no request, and none reaches several of them.
pub fn trios() -> [(u8, Charger<trio::Message>); 3] {
    let module = |node| Charger::new((0, trio::Target::Module(node)), |_, _| None);
    [0xE0, 0xE1, 0xE2].map(|node| (node, module(node).reporting(Reports::new(trio_reports, 200))))
}
