//! What dbc-codegen makes of a DBC of the same messages, and what a DBC leaves to be written by hand.
//!
//! A DBC names whole identifiers, so the addresses are taken out before a frame is looked up and put in again after it
//! is built. Scaled values come as `f32`, out of a product and without rounding; floating-point ones as integers.

use std::fmt::Debug;

use embedded_can::{ExtendedId, Frame as _, Id};

use crate::frame::Frame;
use crate::hand::{Direction, Identifier, Message, Received, Request, Unknown};
use crate::{Codec, hand};

#[expect(clippy::pedantic, reason = "it is generated")]
mod code {
    include!(concat!(env!("OUT_DIR"), "/dbc.rs"));
}

use code::{self as dbc, CanError, Messages};

/// The codec that dbc-codegen generates, with what a DBC cannot say written by hand.
pub struct Dbc;

impl Codec for Dbc {
    const NAME: &'static str = "dbc-codegen";
    type Received = Received;
    type Request = Request;

    fn decode(frame: &Frame) -> Result<Received, impl Debug> {
        decode(frame)
    }

    fn encode(received: &Received) -> Option<impl embedded_can::Frame> {
        encode(received)
    }

    fn request(request: &Request) -> Option<impl embedded_can::Frame> {
        encode(&(request.identifier()?, request.message))
    }

    fn to_request(received: &Received) -> Option<Request> {
        hand::to_request(received)
    }

    fn to_hand(received: &Received) -> Received {
        *received
    }
}

fn decode(frame: &Frame) -> Result<Received, Unknown> {
    let Id::Extended(id) = frame.id() else { return Err(Unknown) };
    if frame.is_remote_frame() || id.as_raw() & !0xFF == 0x0757_F800 {
        return Err(Unknown);
    }
    let identifier = Identifier::from(id.as_raw());
    let known = usual(identifier).and_then(|known| ExtendedId::new(known.raw())).ok_or(Unknown)?;
    let messages = Messages::from_can_message(known.into(), frame.data()).map_err(|_| Unknown)?;
    Ok((identifier, values(&messages)))
}

/// Returns the identifier with the addresses that the DBC knows.
fn usual(identifier: Identifier) -> Option<Identifier> {
    let (target, source) = match hand::direction(&identifier)? {
        Direction::ToModule => (0x00, 0xF0),
        Direction::ToController => (0xF0, 0x00),
    };
    Some(Identifier { error: 0, device: 0xA, target, source, ..identifier })
}

fn values(messages: &Messages) -> Message {
    let double = f64::from;
    match messages {
        Messages::SystemOutput(m) => {
            Message::SystemOutput { voltage_v: f32::from_bits(m.voltage()), current_a: f32::from_bits(m.current()) }
        }
        Messages::ModuleCount(m) => Message::ModuleCount(m.count()),
        Messages::ModuleOutput(m) => {
            Message::ModuleOutput { voltage_v: f32::from_bits(m.voltage()), current_a: f32::from_bits(m.current()) }
        }
        Messages::ModuleStatus(m) => Message::ModuleStatus {
            group: m.group(),
            temperature_c: m.temperature(),
            status: [m.status_2(), m.status_1(), m.status_0()],
        },
        Messages::InputVoltage(m) => {
            Message::InputVoltage { ab_v: double(m.ab()), bc_v: double(m.bc()), ca_v: double(m.ca()) }
        }
        Messages::SystemOutputFixed(m) => {
            Message::SystemOutputFixed { voltage_v: double(m.voltage()), current_a: double(m.current()) }
        }
        Messages::ModuleOutputFixed(m) => {
            Message::ModuleOutputFixed { voltage_v: double(m.voltage()), current_a: double(m.current()) }
        }
        Messages::ModuleLimits(m) => Message::ModuleLimits {
            maximum_v: m.maximum_voltage(),
            minimum_v: m.minimum_voltage(),
            maximum_a: double(m.maximum_current()),
            rated_w: m.rated_power().into(),
        },
        Messages::Barcode(m) => Message::Barcode { letter: m.letter(), number: m.number(), suffix: m.suffix() },
        Messages::ExternalVoltage(m) => {
            Message::ExternalVoltage { voltage_v: double(m.voltage()), allowed_current_a: double(m.allowed_current()) }
        }
        Messages::SetWalkIn(m) => Message::WalkIn(m.walk_in().into()),
        Messages::WalkInInEffect(m) => Message::WalkIn(m.walk_in().into()),
        Messages::SetLed(m) => Message::Led(m.led().into()),
        Messages::LedInEffect(m) => Message::Led(m.led().into()),
        Messages::SetGroup(m) => Message::Group(m.group()),
        Messages::GroupInEffect(m) => Message::Group(m.group()),
        Messages::SetSleep(m) => Message::Sleep(m.sleep().into()),
        Messages::SleepInEffect(m) => Message::Sleep(m.sleep().into()),
        Messages::SetPower(m) => Message::Power(m.power().into()),
        Messages::PowerInEffect(m) => Message::Power(m.power().into()),
        Messages::SetTotalOutput(m) => {
            Message::TotalOutput { voltage_v: double(m.voltage()), current_a: double(m.current()) }
        }
        Messages::TotalOutputInEffect(m) => {
            Message::TotalOutput { voltage_v: double(m.voltage()), current_a: double(m.current()) }
        }
        Messages::SetModuleSetpoint(m) => {
            Message::ModuleSetpoint { voltage_v: double(m.voltage()), current_a: double(m.current()) }
        }
        Messages::ModuleSetpointInEffect(m) => {
            Message::ModuleSetpoint { voltage_v: double(m.voltage()), current_a: double(m.current()) }
        }
        Messages::SetAddressMode(m) => Message::AddressMode(m.mode().into()),
        Messages::AddressModeInEffect(m) => Message::AddressMode(m.mode().into()),
        _ => Message::Read,
    }
}

fn encode((identifier, message): &Received) -> Option<Frame> {
    Frame::new(ExtendedId::new(identifier.raw())?, &data(message).ok()?)
}

/// Sends and receives what a module has in effect as one and the same message: they have one layout.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it wants such types")]
fn data(message: &Message) -> Result<[u8; 8], CanError> {
    let single = |value: f64| value as f32;
    Ok(match *message {
        Message::Read => *dbc::ReadModuleOutput::new()?.raw(),
        Message::SystemOutput { voltage_v, current_a } => {
            *dbc::SystemOutput::new(voltage_v.to_bits(), current_a.to_bits())?.raw()
        }
        Message::ModuleCount(count) => *dbc::ModuleCount::new(count)?.raw(),
        Message::ModuleOutput { voltage_v, current_a } => {
            *dbc::ModuleOutput::new(voltage_v.to_bits(), current_a.to_bits())?.raw()
        }
        Message::ModuleStatus { group, temperature_c, status: [two, one, zero] } => {
            *dbc::ModuleStatus::new(group, temperature_c, two, one, zero)?.raw()
        }
        Message::InputVoltage { ab_v, bc_v, ca_v } => {
            *dbc::InputVoltage::new(single(ab_v), single(bc_v), single(ca_v))?.raw()
        }
        Message::SystemOutputFixed { voltage_v, current_a } => {
            *dbc::SystemOutputFixed::new(single(voltage_v), single(current_a))?.raw()
        }
        Message::ModuleOutputFixed { voltage_v, current_a } => {
            *dbc::ModuleOutputFixed::new(single(voltage_v), single(current_a))?.raw()
        }
        Message::ModuleLimits { maximum_v, minimum_v, maximum_a, rated_w } => {
            *dbc::ModuleLimits::new(maximum_v, minimum_v, single(maximum_a), rated_w as u32)?.raw()
        }
        Message::Barcode { letter, number, suffix } => *dbc::Barcode::new(letter, number, suffix)?.raw(),
        Message::ExternalVoltage { voltage_v, allowed_current_a } => {
            *dbc::ExternalVoltage::new(single(voltage_v), single(allowed_current_a))?.raw()
        }
        Message::WalkIn(value) => *dbc::SetWalkIn::new(value.into())?.raw(),
        Message::Led(value) => *dbc::SetLed::new(value.into())?.raw(),
        Message::Group(group) => *dbc::SetGroup::new(group)?.raw(),
        Message::Sleep(value) => *dbc::SetSleep::new(value.into())?.raw(),
        Message::Power(value) => *dbc::SetPower::new(value.into())?.raw(),
        Message::TotalOutput { voltage_v, current_a } => {
            *dbc::SetTotalOutput::new(single(voltage_v), single(current_a))?.raw()
        }
        Message::ModuleSetpoint { voltage_v, current_a } => {
            *dbc::SetModuleSetpoint::new(single(voltage_v), single(current_a))?.raw()
        }
        Message::AddressMode(value) => *dbc::SetAddressMode::new(value.into())?.raw(),
    })
}
