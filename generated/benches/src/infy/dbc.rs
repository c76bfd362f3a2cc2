//! What dbc-codegen makes of a DBC of the same messages, and what a DBC leaves to be written by hand.
//!
//! A DBC names whole identifiers, so the addresses are taken out before a frame is looked up and put in again after it
//! is built. Scaled values come as `f32`, out of a product and without rounding; floating-point ones as integers.

use std::fmt::Debug;

use embedded_can::{ExtendedId, Frame as _, Id};

use super::hand::{Asked, Failure, Message, Received, Request, Target, is_controller, to_request};
use super::{Infy, hand};
use crate::Codec;
use crate::frame::Frame;
use crate::work::each;

#[expect(clippy::pedantic, reason = "it is generated")]
mod code {
    include!(concat!(env!("OUT_DIR"), "/infy_dbc.rs"));
}

use code::{self as dbc, CanError, Messages};

/// The codec that dbc-codegen generates, with what a DBC cannot say written by hand.
pub struct Dbc;

impl Codec for Dbc {
    const NAME: &'static str = "dbc-codegen";
    type Received = (u32, Messages);
    type Values = Received;
    type Request = Request;
    type ByHand = Received;

    #[inline(always)]
    fn decode(frame: &Frame) -> Result<(u32, Messages), impl Debug> {
        decode(frame)
    }

    #[inline(always)]
    fn take((id, messages): &(u32, Messages)) {
        let [.., source] = id.to_be_bytes();
        take!(source);
        take(messages);
    }

    #[inline(always)]
    fn encode(Received { id, message }: &Received) -> Option<impl embedded_can::Frame> {
        Some(Frame::of(*id, data(message).ok()?))
    }

    #[inline(always)]
    fn request(Request { message, target, controller }: &Request) -> Option<impl embedded_can::Frame> {
        let (_, id) = target.shown().filter(|_| is_controller(*controller))?;
        let (command, data) = (command(message), data(message).ok()?);
        Some(Frame::of(id | u32::from(command) << 16 | u32::from(*controller), data))
    }

    fn to_values(received: &(u32, Messages)) -> Received {
        Self::to_hand(received)
    }

    fn to_request(values: &Received) -> Option<Request> {
        to_request(values)
    }

    fn to_hand((id, messages): &(u32, Messages)) -> Received {
        Received { id: *id, message: values(messages, *id) }
    }
}

impl Infy for Dbc {
    type Asked = Asked;

    fn payloads(command: u8, payloads: &[[u8; 8]]) {
        fn all(payloads: &[[u8; 8]], decode: impl Fn(&[u8]) -> Result<Messages, CanError>) {
            each(payloads, |payload| {
                decode(payload).as_ref().map(take).ok();
            });
        }
        match command {
            0x01 => all(payloads, |data| dbc::SystemOutput::try_from(data).map(Messages::SystemOutput)),
            0x02 => all(payloads, |data| dbc::ModuleCount::try_from(data).map(Messages::ModuleCount)),
            0x03 => all(payloads, |data| dbc::ModuleOutput::try_from(data).map(Messages::ModuleOutput)),
            0x04 => all(payloads, |data| dbc::ModuleStatus::try_from(data).map(Messages::ModuleStatus)),
            0x06 => all(payloads, |data| dbc::InputVoltage::try_from(data).map(Messages::InputVoltage)),
            0x08 => all(payloads, |data| dbc::SystemOutputFixed::try_from(data).map(Messages::SystemOutputFixed)),
            0x09 => all(payloads, |data| dbc::ModuleOutputFixed::try_from(data).map(Messages::ModuleOutputFixed)),
            0x0A => all(payloads, |data| dbc::ModuleLimits::try_from(data).map(Messages::ModuleLimits)),
            0x0B => all(payloads, |data| dbc::Barcode::try_from(data).map(Messages::Barcode)),
            0x0C => all(payloads, |data| dbc::ExternalVoltage::try_from(data).map(Messages::ExternalVoltage)),
            0x13 => all(payloads, |data| dbc::SetWalkIn::try_from(data).map(Messages::SetWalkIn)),
            0x14 => all(payloads, |data| dbc::SetLed::try_from(data).map(Messages::SetLed)),
            0x16 => all(payloads, |data| dbc::SetGroup::try_from(data).map(Messages::SetGroup)),
            0x19 => all(payloads, |data| dbc::SetSleep::try_from(data).map(Messages::SetSleep)),
            0x1A => all(payloads, |data| dbc::SetPower::try_from(data).map(Messages::SetPower)),
            0x1B => all(payloads, |data| dbc::SetTotalOutput::try_from(data).map(Messages::SetTotalOutput)),
            0x1C => all(payloads, |data| dbc::SetModuleSetpoint::try_from(data).map(Messages::SetModuleSetpoint)),
            _ => all(payloads, |data| dbc::SetAddressMode::try_from(data).map(Messages::SetAddressMode)),
        }
    }

    /// A DBC does not say who answers.
    fn ask(_: Target, _: u8) -> Option<Asked> {
        None
    }

    fn reply(_: &Asked, _: &Frame) -> Option<Result<(f32, f32), Failure>> {
        None
    }
}

/// Recognises a frame by the addresses that the DBC knows: request of controller F0 to module 00, and its reply.
#[inline(always)]
fn decode(frame: &Frame) -> Result<(u32, Messages), CanError> {
    const UNKNOWN: CanError = CanError::UnknownMessageId(Id::Extended(ExtendedId::ZERO));
    let Id::Extended(id) = frame.id() else { return Err(UNKNOWN) };
    let id = id.as_raw();
    let [.., target, source] = id.to_be_bytes();
    let usual = match (is_controller(target), is_controller(source)) {
        (false, true) => 0x0280_00F0,
        (true, false) => 0x0280_F000,
        _ => return Err(UNKNOWN),
    };
    let known = ExtendedId::new(id & 0x003F_0000 | usual).filter(|_| !frame.is_remote_frame()).ok_or(UNKNOWN)?;
    Ok((id, Messages::from_can_message(Id::Extended(known), frame.data())?))
}

/// Hands over each value, as a program takes it.
#[inline(always)]
fn take(messages: &Messages) {
    match messages {
        Messages::SystemOutput(m) => take!(f32::from_bits(m.voltage()), f32::from_bits(m.current())),
        Messages::ModuleCount(m) => take!(m.count()),
        Messages::ModuleOutput(m) => take!(f32::from_bits(m.voltage()), f32::from_bits(m.current())),
        Messages::ModuleStatus(m) => take!(m.group(), m.temperature(), m.status_2(), m.status_1(), m.status_0()),
        Messages::InputVoltage(m) => take!(m.ab(), m.bc(), m.ca()),
        Messages::SystemOutputFixed(m) => take!(m.voltage(), m.current()),
        Messages::ModuleOutputFixed(m) => take!(m.voltage(), m.current()),
        Messages::ModuleLimits(m) => {
            take!(m.maximum_voltage(), m.minimum_voltage(), m.maximum_current(), m.rated_power());
        }
        Messages::Barcode(m) => take!(m.letter(), m.number(), m.suffix()),
        Messages::ExternalVoltage(m) => take!(m.voltage(), m.allowed_current()),
        Messages::SetWalkIn(m) => take!(m.walk_in()),
        Messages::WalkInInEffect(m) => take!(m.walk_in()),
        Messages::SetLed(m) => take!(m.led()),
        Messages::LedInEffect(m) => take!(m.led()),
        Messages::SetGroup(m) => take!(m.group()),
        Messages::GroupInEffect(m) => take!(m.group()),
        Messages::SetSleep(m) => take!(m.sleep()),
        Messages::SleepInEffect(m) => take!(m.sleep()),
        Messages::SetPower(m) => take!(m.power()),
        Messages::PowerInEffect(m) => take!(m.power()),
        Messages::SetTotalOutput(m) => take!(m.voltage(), m.current()),
        Messages::TotalOutputInEffect(m) => take!(m.voltage(), m.current()),
        Messages::SetModuleSetpoint(m) => take!(m.voltage(), m.current()),
        Messages::ModuleSetpointInEffect(m) => take!(m.voltage(), m.current()),
        Messages::SetAddressMode(m) => take!(m.mode()),
        Messages::AddressModeInEffect(m) => take!(m.mode()),
        _ => (),
    }
}

/// Returns the values in the types of the codec by hand.
fn values(messages: &Messages, id: u32) -> Message {
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
        _ => Message::Read(hand::command(id)),
    }
}

/// Encodes what a module has in effect as what sets it: they have one layout.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it wants such types")]
fn data(message: &Message) -> Result<[u8; 8], CanError> {
    let single = |value: f64| value as f32;
    Ok(match *message {
        Message::Read(_) => *dbc::ReadModuleOutput::new()?.raw(),
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

/// Returns the command of a request.
#[inline(always)]
fn command(message: &Message) -> u8 {
    match message {
        Message::Read(command) => *command,
        Message::WalkIn(_) => 0x13,
        Message::Led(_) => 0x14,
        Message::Group(_) => 0x16,
        Message::Sleep(_) => 0x19,
        Message::Power(_) => 0x1A,
        Message::TotalOutput { .. } => 0x1B,
        Message::ModuleSetpoint { .. } => 0x1C,
        _ => 0x1F,
    }
}
