//! What modules of each vendor answer, and what they send by themselves.

use canspec_protocols::{gcp, huawei, infy, megmeet, mxr, trio};
use canspec_runtime::sim::Answer;
use canspec_runtime::{Addressed, Frame, Quantities, Quantity, Received};

use super::{CURRENT, DEFECT, DELIVERING, Kept, VOLTAGE};

/// Returns the voltage or the current that a module delivers.
fn delivered<P: Quantities + Addressed<Target: PartialEq>>(module: &Kept<P>, quantity: Quantity) -> f64 {
    let value = module.value(quantity).filter(|_| is_on(module));
    f64::from(value.unwrap_or_default()) / 1000.0
}

fn is_on<P: Quantities + Addressed<Target: PartialEq>>(module: &Kept<P>) -> bool {
    module.value(DELIVERING) == Some(1)
}

/// Chooses among the values of a status word: of a module that is off, and of one with a defect.
fn shown<P: Quantities + Addressed<Target: PartialEq>, W: Default + std::ops::BitOr<Output = W>>(
    module: &Kept<P>,
    off: W,
    defect: W,
) -> W {
    let off = if is_on(module) { W::default() } else { off };
    if module.value(DEFECT) == Some(1) { off | defect } else { off }
}

/// How modules of INFY and of GCP answer, whose messages are alike.
macro_rules! tells {
    ($tells:ident $protocol:ident) => {
        #[expect(clippy::cast_possible_truncation, reason = "what is set has few digits")]
        pub fn $tells(
            request: &Received<$protocol::Message>,
            module: &Kept<$protocol::Message>,
        ) -> Answer<$protocol::Message> {
            use $protocol::{Message, ModuleOutput, ModuleStatus, Status0, Status1, Status2};
            let [voltage_v, current_a] = [VOLTAGE, CURRENT].map(|quantity| delivered(module, quantity) as f32);
            match request.content() {
                Message::ReadModuleOutput => {
                    Answer::Values(Message::ModuleOutput(ModuleOutput { voltage_v, current_a }))
                }
                Message::ReadModuleStatus => Answer::Values(Message::ModuleStatus(ModuleStatus {
                    group: 0,
                    temperature_c: 30,
                    status_2: Status2::default(),
                    status_1: shown(module, Status1::DC_OFF, Status1::default()),
                    status_0: shown(module, Status0::default(), Status0::OUTPUT_SHORT_CIRCUIT),
                })),
                _ => Answer::Silence,
            }
        }
    };
}

tells!(infy_tells infy);
tells!(gcp_tells gcp);

#[expect(clippy::cast_possible_truncation, reason = "what is set has few digits")]
pub fn mxr_tells(request: &Received<mxr::Message>, module: &Kept<mxr::Message>) -> Answer<mxr::Message> {
    use mxr::{Alarms, Message, ModuleStatus, OutputVoltage};
    match request.content() {
        Message::ReadOutputVoltage => {
            Answer::Values(Message::OutputVoltage(OutputVoltage { value_v: delivered(module, VOLTAGE) as f32 }))
        }
        Message::ReadModuleStatus => Answer::Values(Message::ModuleStatus(ModuleStatus {
            value: shown(module, Alarms::DCDC_OFF, Alarms::FAULT),
        })),
        _ => Answer::Silence,
    }
}

pub fn megmeet_tells(
    request: &Received<megmeet::Message>,
    module: &Kept<megmeet::Message>,
) -> Answer<megmeet::Message> {
    use megmeet::{Alarms, ExtendedAlarms, Message, ModuleStatus, OutputVoltage};
    match request.content() {
        Message::ReadOutputVoltage => {
            Answer::Values(Message::OutputVoltage(OutputVoltage { value_v: delivered(module, VOLTAGE) }))
        }
        Message::ReadModuleStatus => Answer::Values(Message::ModuleStatus(ModuleStatus {
            extended: ExtendedAlarms::default(),
            alarms: shown(module, Alarms::SHUT_DOWN, Alarms::MODULE_FAILURE),
        })),
        _ => Answer::Silence,
    }
}

pub fn huawei_tells(request: &Received<huawei::Message>, module: &Kept<huawei::Message>) -> Answer<huawei::Message> {
    use huawei::{Message, OutputVoltage};
    match request.content() {
        Message::GetOutputVoltage => {
            Answer::Values(Message::OutputVoltage(OutputVoltage { value_v: delivered(module, VOLTAGE) }))
        }
        _ => Answer::Silence,
    }
}

/// What a module of Huawei sends by itself. It is ready if it has no fault.
pub fn huawei_reports(node: u8, module: &Kept<huawei::Message>) -> Vec<Frame> {
    use huawei::{ActiveState, Activity, Message, Readiness, ReadyState};
    let readiness = if module.value(DEFECT) == Some(1) { Readiness::NotReady } else { Readiness::Ready };
    let activity = if is_on(module) { Activity::Active } else { Activity::NotActive };
    let ready = Message::ReadyState(ReadyState { readiness, load_percent: 0.0 });
    let active = Message::ActiveState(ActiveState { activity, load_percent: 0.0 });
    let reports = [(ReadyState::ANNOUNCE, ready), (ActiveState::ANNOUNCE, active)];
    reports.into_iter().filter_map(|(exchange, content)| exchange.report_from(node, content).ok()).collect()
}

/// What a module of TRIO sends by itself.
pub fn trio_reports(node: u8, module: &Kept<trio::Message>) -> Vec<Frame> {
    use trio::{ControlMode, Identifier, Kind, Message, Operation, OutputValues, ReferenceValues, Status};
    let reference = ReferenceValues {
        mode: ControlMode::Remote,
        operation: if is_on(module) { Operation::On } else { Operation::Off },
        nominal_voltage_v: 24.0,
        maximum_voltage_v: 29.8,
        minimum_voltage_v: 23.5,
    };
    let output = OutputValues {
        voltage_v: delivered(module, VOLTAGE),
        current_a: 0.0,
        power_w: 0.0,
        status: shown(module, Status::default(), Status::HARDWARE_FAULT),
    };
    let blanks = [ReferenceValues::REPORT, OutputValues::REPORT].map(|exchange| {
        let filter = exchange.filter(Kind::Report).expect("it is reported");
        filter.id(Identifier::TARGET, 0xF3).id(Identifier::SOURCE, node.into()).frame(8)
    });
    let contents = [Message::ReferenceValues(reference), Message::OutputValues(output)];
    let build = |(blank, content): (&Frame, Message)| Message::decode(blank).ok()?.with_content(content).encode().ok();
    blanks.iter().zip(contents).filter_map(build).collect()
}
