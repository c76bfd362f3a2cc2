//! The codec that canspec generates.

use std::fmt::Debug;

use canspec_protocols::infy::{
    Barcode, Error, ExternalVoltage, Failure, Identifier, InputVoltage, Kind, Message, ModuleCount, ModuleLimits,
    ModuleOutput, ModuleOutputFixed, ModuleStatus, Received, Request, Route, SystemOutput, SystemOutputFixed, Target,
};
use canspec_runtime::Layout;

use super::{Infy, hand};
use crate::Codec;
use crate::frame::Frame;
use crate::work::each;

/// Hands over the request of a message.
macro_rules! built {
    ($route:expr, $message:expr, $take:ident) => {
        match $message {
            Message::ReadTotalSystemOutput => $take(SystemOutput::read_total($route)),
            Message::ReadTotalModuleCount => $take(ModuleCount::read_total($route)),
            Message::ReadModuleOutput => $take(ModuleOutput::read($route)),
            Message::ReadModuleStatus => $take(ModuleStatus::read($route)),
            Message::ReadInputVoltage => $take(InputVoltage::read($route)),
            Message::ReadTotalSystemOutputFixed => $take(SystemOutputFixed::read_total($route)),
            Message::ReadModuleOutputFixed => $take(ModuleOutputFixed::read($route)),
            Message::ReadModuleLimits => $take(ModuleLimits::read($route)),
            Message::ReadBarcode => $take(Barcode::read($route)),
            Message::ReadExternalVoltage => $take(ExternalVoltage::read($route)),
            Message::SetWalkIn(message) => $take(message.set($route)),
            Message::SetLed(message) => $take(message.set($route)),
            Message::SetGroup(message) => $take(message.set($route)),
            Message::SetSleep(message) => $take(message.set($route)),
            Message::SwitchModules(message) => $take(message.set($route)),
            Message::SetTotalOutput(message) => $take(message.set_total($route)),
            Message::SetModuleOutput(message) => $take(message.set($route)),
            Message::SetAddressMode(message) => $take(message.set($route)),
            _ => unreachable!("replies are no requests"),
        }
    };
}

/// The codec that canspec generates.
pub struct Generated;

impl Codec for Generated {
    const NAME: &'static str = "canspec";
    type Received = Received;
    type Values = Received;
    type Request = (Route<Target>, Message);
    type ByHand = hand::Received;

    #[inline(always)]
    fn decode(frame: &Frame) -> Result<Received, impl Debug> {
        Message::decode(frame)
    }

    #[inline(always)]
    fn take(received: &Received) {
        take!(received.identifier().source);
        take(received.content());
    }

    #[inline(always)]
    fn encode(received: &Received) -> Option<impl embedded_can::Frame> {
        received.encode().ok()
    }

    #[inline(always)]
    fn request((route, message): &Self::Request) -> Option<impl embedded_can::Frame> {
        request(*route, message).ok()
    }

    fn to_values(received: &Received) -> Received {
        *received
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
        let id = received.frame().raw_id();
        hand::Received { id, message: values(received.content(), id) }
    }
}

impl Infy for Generated {
    type Asked = Request<ModuleOutput>;

    #[inline(always)]
    fn keep((route, message): &Self::Request) {
        built!(*route, message, keep);
    }

    fn payloads(command: u8, payloads: &[[u8; 8]]) {
        fn all<L: Layout>(payloads: &[[u8; 8]], variant: impl Fn(L) -> Message) {
            each(payloads, |payload| take(&variant(L::decode(payload))));
        }
        match command {
            0x01 => all(payloads, Message::SystemOutput),
            0x02 => all(payloads, Message::ModuleCount),
            0x03 => all(payloads, Message::ModuleOutput),
            0x04 => all(payloads, Message::ModuleStatus),
            0x06 => all(payloads, Message::InputVoltage),
            0x08 => all(payloads, Message::SystemOutputFixed),
            0x09 => all(payloads, Message::ModuleOutputFixed),
            0x0A => all(payloads, Message::ModuleLimits),
            0x0B => all(payloads, Message::Barcode),
            0x0C => all(payloads, Message::ExternalVoltage),
            0x13 => all(payloads, Message::SetWalkIn),
            0x14 => all(payloads, Message::SetLed),
            0x16 => all(payloads, Message::SetGroup),
            0x19 => all(payloads, Message::SetSleep),
            0x1A => all(payloads, Message::SwitchModules),
            0x1B => all(payloads, Message::SetTotalOutput),
            0x1C => all(payloads, Message::SetModuleOutput),
            _ => all(payloads, Message::SetAddressMode),
        }
    }

    fn ask(target: hand::Target, controller: u8) -> Option<Request<ModuleOutput>> {
        let target = match target {
            hand::Target::Module(module) => Target::Module(module),
            hand::Target::Group(group) => Target::Group(group),
            hand::Target::Broadcast => Target::Broadcast,
            hand::Target::AllGroups => Target::AllGroups,
        };
        ModuleOutput::read(target.sent_by(controller)).ok()
    }

    #[inline(always)]
    fn reply(asked: &Request<ModuleOutput>, frame: &Frame) -> Option<Result<(f32, f32), hand::Failure>> {
        Some(match asked.reply(frame)?.values {
            Ok(ModuleOutput { voltage_v, current_a }) => Ok((voltage_v, current_a)),
            Err(Failure::Error) => Err(hand::Failure::Error),
            Err(Failure::Length) => Err(hand::Failure::Length),
        })
    }
}

/// Hands over each value, as a program takes it.
#[inline(always)]
fn take(message: &Message) {
    match *message {
        Message::SystemOutput(m) => take!(m.voltage_v, m.current_a),
        Message::ModuleCount(m) => take!(m.count),
        Message::ModuleOutput(m) => take!(m.voltage_v, m.current_a),
        Message::ModuleStatus(m) => take!(m.group, m.temperature_c, m.status_2, m.status_1, m.status_0),
        Message::InputVoltage(m) => take!(m.ab_v, m.bc_v, m.ca_v),
        Message::SystemOutputFixed(m) => take!(m.voltage_v, m.current_a),
        Message::ModuleOutputFixed(m) => take!(m.voltage_v, m.current_a),
        Message::ModuleLimits(m) => {
            take!(m.maximum_voltage_v, m.minimum_voltage_v, m.maximum_current_a, m.rated_power_w);
        }
        Message::Barcode(Barcode { value }) => take!(value.letter, value.number, value.suffix),
        Message::ExternalVoltage(m) => take!(m.voltage_v, m.allowed_current_a),
        Message::SetWalkIn(m) => take!(m.walk_in),
        Message::SetLed(m) => take!(m.led),
        Message::SetGroup(m) => take!(m.group),
        Message::SetSleep(m) => take!(m.sleep),
        Message::SwitchModules(m) => take!(m.power),
        Message::SetTotalOutput(m) => take!(m.voltage_v, m.current_a),
        Message::SetModuleOutput(m) => take!(m.voltage_v, m.current_a),
        Message::SetAddressMode(m) => take!(m.mode),
        _ => (),
    }
}

#[inline(always)]
fn frame<R>(request: Result<Request<R>, Error>) -> Result<canspec_runtime::Frame, Error> {
    request.map(|request| *request.frame())
}

#[inline(always)]
fn keep<R>(request: Result<Request<R>, Error>) {
    take!(&request);
}

#[inline(always)]
fn request(route: Route<Target>, message: &Message) -> Result<canspec_runtime::Frame, Error> {
    built!(route, message, frame)
}

/// Returns the values in the types of the codec by hand.
fn values(message: &Message, id: u32) -> hand::Message {
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
            letter: value.letter.as_str().and_then(|letter| letter.bytes().next()).unwrap_or(0),
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
        _ => hand::Message::Read(hand::command(id)),
    }
}
