//! The codec that canspec generates.

use std::fmt::Debug;

use canspec_protocols::infy::{
    Barcode, Error, ExternalVoltage, Identifier, InputVoltage, Kind, Message, ModuleCount, ModuleLimits,
    ModuleOutput, ModuleOutputFixed, ModuleStatus, Received, Request, Route, SystemOutput, SystemOutputFixed, Target,
};

use crate::frame::Frame;
use crate::{Codec, hand};

/// The codec that canspec generates.
pub struct Generated;

impl Codec for Generated {
    const NAME: &'static str = "canspec";
    type Received = Received;
    type Request = (Route<Target>, Message);

    fn decode(frame: &Frame) -> Result<Received, impl Debug> {
        Message::decode(frame)
    }

    fn encode(received: &Received) -> Option<impl embedded_can::Frame> {
        received.encode().ok()
    }

    fn request((route, message): &Self::Request) -> Option<impl embedded_can::Frame> {
        request(*route, message).ok()
    }

    fn to_request(received: &Received) -> Option<Self::Request> {
        let Identifier { device, target, source, .. } = received.identifier();
        let target = match (device, target) {
            (0xA, 0x3F) => Target::Broadcast,
            (_, 0x3F) => Target::AllGroups,
            (0xA, module) => Target::Module(module),
            (_, group) => Target::Group(group),
        };
        (received.kind() == Kind::Request).then(|| (target.sent_by(source), *received.content()))
    }

    fn to_hand(received: &Received) -> hand::Received {
        let Identifier { error, device, command, target, source } = received.identifier();
        (hand::Identifier { error: error.raw(), device, command, target, source }, values(received.content()))
    }
}

fn request(route: Route<Target>, message: &Message) -> Result<canspec_runtime::Frame, Error> {
    fn frame<R>(request: Request<R>) -> canspec_runtime::Frame {
        *request.frame()
    }
    match message {
        Message::ReadTotalSystemOutput => SystemOutput::read_total(route).map(frame),
        Message::ReadTotalModuleCount => ModuleCount::read_total(route).map(frame),
        Message::ReadModuleOutput => ModuleOutput::read(route).map(frame),
        Message::ReadModuleStatus => ModuleStatus::read(route).map(frame),
        Message::ReadInputVoltage => InputVoltage::read(route).map(frame),
        Message::ReadTotalSystemOutputFixed => SystemOutputFixed::read_total(route).map(frame),
        Message::ReadModuleOutputFixed => ModuleOutputFixed::read(route).map(frame),
        Message::ReadModuleLimits => ModuleLimits::read(route).map(frame),
        Message::ReadBarcode => Barcode::read(route).map(frame),
        Message::ReadExternalVoltage => ExternalVoltage::read(route).map(frame),
        Message::SetWalkIn(message) => message.set(route).map(frame),
        Message::SetLed(message) => message.set(route).map(frame),
        Message::SetGroup(message) => message.set(route).map(frame),
        Message::SetSleep(message) => message.set(route).map(frame),
        Message::SwitchModules(message) => message.set(route).map(frame),
        Message::SetTotalOutput(message) => message.set_total(route).map(frame),
        Message::SetModuleOutput(message) => message.set(route).map(frame),
        Message::SetAddressMode(message) => message.set(route).map(frame),
        _ => unreachable!("replies are no requests"),
    }
}

fn values(message: &Message) -> hand::Message {
    match *message {
        Message::SystemOutput(m) => hand::Message::SystemOutput { voltage_v: m.voltage_v, current_a: m.current_a },
        Message::ModuleCount(m) => hand::Message::ModuleCount(m.count),
        Message::ModuleOutput(m) => hand::Message::ModuleOutput { voltage_v: m.voltage_v, current_a: m.current_a },
        Message::ModuleStatus(m) => hand::Message::ModuleStatus {
            group: m.group,
            temperature_c: m.temperature_c,
            status: [m.status_2.0, m.status_1.0, m.status_0.0],
        },
        Message::InputVoltage(m) => hand::Message::InputVoltage { ab_v: m.ab_v, bc_v: m.bc_v, ca_v: m.ca_v },
        Message::SystemOutputFixed(m) => {
            hand::Message::SystemOutputFixed { voltage_v: m.voltage_v, current_a: m.current_a }
        }
        Message::ModuleOutputFixed(m) => {
            hand::Message::ModuleOutputFixed { voltage_v: m.voltage_v, current_a: m.current_a }
        }
        Message::ModuleLimits(m) => hand::Message::ModuleLimits {
            maximum_v: m.maximum_voltage_v,
            minimum_v: m.minimum_voltage_v,
            maximum_a: m.maximum_current_a,
            rated_w: m.rated_power_w,
        },
        Message::Barcode(Barcode { value }) => hand::Message::Barcode {
            letter: value.letter.as_str().map_or(0, |letter| letter.as_bytes()[0]),
            number: value.number,
            suffix: value.suffix,
        },
        Message::ExternalVoltage(m) => {
            hand::Message::ExternalVoltage { voltage_v: m.voltage_v, allowed_current_a: m.allowed_current_a }
        }
        Message::SetWalkIn(m) => hand::Message::WalkIn(m.walk_in.raw().into()),
        Message::SetLed(m) => hand::Message::Led(m.led.raw().into()),
        Message::SetGroup(m) => hand::Message::Group(m.group),
        Message::SetSleep(m) => hand::Message::Sleep(m.sleep.raw().into()),
        Message::SwitchModules(m) => hand::Message::Power(m.power.raw().into()),
        Message::SetTotalOutput(m) => hand::Message::TotalOutput { voltage_v: m.voltage_v, current_a: m.current_a },
        Message::SetModuleOutput(m) => hand::Message::ModuleSetpoint { voltage_v: m.voltage_v, current_a: m.current_a },
        Message::SetAddressMode(m) => hand::Message::AddressMode(m.mode.raw().into()),
        _ => hand::Message::Read,
    }
}
