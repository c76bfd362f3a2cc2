//! Modules of two vendors.

use canspec_protocols::{infy, mxr};
use canspec_runtime::Received;

use super::{Bus, Charger};

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
