//! Modules of five vendors.

use canspec_protocols::{huawei, infy, megmeet, mxr, trio};
use canspec_runtime::{Frame, Received};

use super::{Bus, Charger, Reports};

pub fn infy_tells(request: &Received<infy::Message>, module: &Charger<infy::Message>) -> Option<infy::Message> {
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

pub fn mxr_tells(request: &Received<mxr::Message>, module: &Charger<mxr::Message>) -> Option<mxr::Message> {
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

pub fn megmeet_tells(
    request: &Received<megmeet::Message>,
    module: &Charger<megmeet::Message>,
) -> Option<megmeet::Message> {
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

/// Eight modules in the groups 1 and 2.
pub fn infies(seed: u64) -> Bus<infy::Message, 8, 2> {
    let group = |number| (number, infy::Target::Group(number));
    let modules = [0, 1, 2, 3, 4, 5, 6, 7].map(|node| (node, Charger::new(group(1 + node / 4), infy_tells)));
    Bus::new([group(1), group(2)], modules, seed)
}

/// Four modules in the group 5.
pub fn maxwells(seed: u64) -> Bus<mxr::Message, 4, 1> {
    let group = (5, mxr::Target::Group(5));
    let modules = [3, 4, 5, 6].map(|node| (node, Charger::new(group, mxr_tells)));
    Bus::new([group], modules, seed)
}

/// Four modules of MEGMEET. They have no groups: each is asked alone, or all together.
pub fn megmeets() -> [(u8, Charger<megmeet::Message>); 4] {
    [1, 2, 3, 4].map(|node| (node, Charger::new((0, megmeet::Target::Broadcast), megmeet_tells)))
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
