//! What dbc-codegen makes of a DBC of the same messages, and what a DBC leaves to be written by hand.
//!
//! A DBC names whole identifiers, so the addresses are taken out before a frame is looked up and put in again after it
//! is built. Scaled values come as `f32`, out of a product and without rounding; floating-point ones as integers.

use std::fmt::Debug;

use embedded_can::{ExtendedId, Frame as _, Id};

use super::hand::{self, Message, Received, Request, is_controller};
use crate::Codec;
use crate::frame::Frame;

#[expect(clippy::pedantic, clippy::redundant_field_names, reason = "it is generated")]
mod code {
    include!(concat!(env!("OUT_DIR"), "/supply_dbc.rs"));
}

use code::{self as dbc, CanError, Messages, RegistersNumberIndex, SignalsNumberIndex};

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
    #[expect(clippy::cast_possible_truncation, reason = "the address is a byte")]
    fn take((id, messages): &(u32, Messages)) {
        take!((id >> 8) as u8);
        take(messages);
    }

    #[inline(always)]
    fn encode(Received { id, message }: &Received) -> Option<impl embedded_can::Frame> {
        let (_, data) = data(message).ok()?;
        Some(Frame::of(*id, data))
    }

    #[inline(always)]
    fn request(Request { message, target, controller }: &Request) -> Option<impl embedded_can::Frame> {
        let id = target.shown().filter(|_| is_controller(*controller))?;
        let (command, data) = data(message).ok()?;
        Some(Frame::of(id | command << 16 | u32::from(*controller), data))
    }

    fn to_values(received: &(u32, Messages)) -> Received {
        Self::to_hand(received)
    }

    fn to_request(values: &Received) -> Option<Request> {
        hand::to_request(values)
    }

    fn to_hand((id, messages): &(u32, Messages)) -> Received {
        Received { id: *id, message: values(messages) }
    }
}

/// The same without anything by hand, for frames with the one address that the DBC knows.
pub struct OneAddress;

impl Codec for OneAddress {
    const NAME: &'static str = "dbc-codegen, one address";
    type Received = Messages;
    type Values = Message;
    type Request = Message;
    type ByHand = Message;

    fn known(frame: &Frame) -> Frame {
        Frame::of(known(frame.raw_id()), frame.bytes())
    }

    #[inline(always)]
    fn decode(frame: &Frame) -> Result<Messages, impl Debug> {
        Messages::from_can_message(frame.id(), frame.data())
    }

    #[inline(always)]
    fn take(messages: &Messages) {
        take(messages);
    }

    #[inline(always)]
    fn encode(message: &Message) -> Option<impl embedded_can::Frame> {
        let (command, data) = data(message).ok()?;
        Some(Frame::of(known(command << 16), data))
    }

    #[inline(always)]
    fn request(message: &Message) -> Option<impl embedded_can::Frame> {
        Self::encode(message)
    }

    fn to_values(messages: &Messages) -> Message {
        values(messages)
    }

    fn to_request(message: &Message) -> Option<Message> {
        Some(*message)
    }

    fn to_hand(messages: &Messages) -> Message {
        values(messages)
    }
}

/// Returns the identifier of a message between the addresses that the DBC knows: of controller F0 and supply 00.
#[inline(always)]
fn known(id: u32) -> u32 {
    id & 0x003F_0000 | 0x1500_00F0
}

const UNKNOWN: CanError = CanError::UnknownMessageId(Id::Extended(ExtendedId::ZERO));

/// Recognises a frame by the addresses that the DBC knows.
#[inline(always)]
fn decode(frame: &Frame) -> Result<(u32, Messages), CanError> {
    let Id::Extended(id) = frame.id() else { return Err(UNKNOWN) };
    let id = id.as_raw();
    let [.., controller] = id.to_be_bytes();
    let known = ExtendedId::new(known(id));
    let known = known.filter(|_| is_controller(controller) && !frame.is_remote_frame()).ok_or(UNKNOWN)?;
    Ok((id, Messages::from_can_message(Id::Extended(known), frame.data())?))
}

macro_rules! codec {
    (
        [$(($real_number:literal $real:ident $of_real:ident $RealPart:ident $get_real:ident $set_real:ident $put_real:ident))*]
        [$(($whole_number:literal $whole:ident $of_whole:ident $WholePart:ident $get_whole:ident $set_whole:ident $put_whole:ident))*]
        [$(($signal_number:literal $signal:ident $of_signal:ident $SignalPart:ident $get_signal:ident $set_signal:ident $put_signal:ident))*]
    ) => {
        /// Hands over each value, as a program takes it.
        #[inline(always)]
        fn take(messages: &Messages) {
            match *messages {
                Messages::Output(m) => take!(f32::from_bits(m.voltage()), f32::from_bits(m.current())),
                Messages::SetPoint(m) => take!(m.voltage(), m.current()),
                Messages::State(m) => take!(m.group(), m.temperature(), m.status()),
                Messages::Input(m) => take!(m.ab(), m.bc(), m.ca()),
                Messages::Registers(mut m) => match m.number_multiplexed() {
                    $(Ok(RegistersNumberIndex::$of_real(m)) => take!(f32::from_bits(m.$get_real())),)*
                    $(Ok(RegistersNumberIndex::$of_whole(m)) => take!(m.$get_whole()),)*
                    Err(_) => (),
                },
                Messages::Signals(mut m) => match m.number_multiplexed() {
                    $(Ok(SignalsNumberIndex::$of_signal(m)) => take!(m.$get_signal()),)*
                    Err(_) => (),
                },
            }
        }

        /// Returns the values in the types of the codec by hand.
        fn values(messages: &Messages) -> Message {
            let double = f64::from;
            match *messages {
                Messages::Output(m) => {
                    Message::Output { voltage_v: f32::from_bits(m.voltage()), current_a: f32::from_bits(m.current()) }
                }
                Messages::SetPoint(m) => {
                    Message::SetPoint { voltage_v: double(m.voltage()), current_a: double(m.current()) }
                }
                Messages::State(m) => {
                    Message::State { group: m.group(), temperature_c: m.temperature(), status: m.status() }
                }
                Messages::Input(m) => {
                    Message::Input { ab_v: double(m.ab()), bc_v: double(m.bc()), ca_v: double(m.ca()) }
                }
                Messages::Registers(mut m) => match m.number_multiplexed() {
                    $(Ok(RegistersNumberIndex::$of_real(m)) => {
                        Message::Real { register: $real_number, value: f32::from_bits(m.$get_real()) }
                    })*
                    $(Ok(RegistersNumberIndex::$of_whole(m)) => {
                        Message::Whole { register: $whole_number, value: m.$get_whole() }
                    })*
                    Err(_) => unreachable!("the measured frames have no other number"),
                },
                Messages::Signals(mut m) => match m.number_multiplexed() {
                    $(Ok(SignalsNumberIndex::$of_signal(m)) => {
                        Message::Signal { number: $signal_number, value_v: double(m.$get_signal()) }
                    })*
                    Err(_) => unreachable!("the measured frames have no other number"),
                },
            }
        }

        /// Returns command and payload.
        #[inline(always)]
        #[expect(clippy::cast_possible_truncation, reason = "it has singles")]
        fn data(message: &Message) -> Result<(u32, [u8; 8]), CanError> {
            let single = |value: f64| value as f32;
            Ok(match *message {
                Message::Output { voltage_v, current_a } => {
                    (1, *dbc::Output::new(voltage_v.to_bits(), current_a.to_bits())?.raw())
                }
                Message::SetPoint { voltage_v, current_a } => {
                    (2, *dbc::SetPoint::new(single(voltage_v), single(current_a))?.raw())
                }
                Message::State { group, temperature_c, status } => {
                    (3, *dbc::State::new(group, temperature_c, status)?.raw())
                }
                Message::Input { ab_v, bc_v, ca_v } => {
                    (4, *dbc::Input::new(single(ab_v), single(bc_v), single(ca_v))?.raw())
                }
                $(Message::Real { register: $real_number, value } => {
                    let mut part = dbc::$RealPart::new();
                    part.$set_real(value.to_bits())?;
                    let mut whole = dbc::Registers::new($real_number)?;
                    whole.$put_real(part)?;
                    (5, *whole.raw())
                })*
                $(Message::Whole { register: $whole_number, value } => {
                    let mut part = dbc::$WholePart::new();
                    part.$set_whole(value)?;
                    let mut whole = dbc::Registers::new($whole_number)?;
                    whole.$put_whole(part)?;
                    (5, *whole.raw())
                })*
                $(Message::Signal { number: $signal_number, value_v } => {
                    let mut part = dbc::$SignalPart::new();
                    part.$set_signal(single(value_v))?;
                    let mut whole = dbc::Signals::new($signal_number)?;
                    whole.$put_signal(part)?;
                    (6, *whole.raw())
                })*
                _ => return Err(UNKNOWN),
            })
        }
    };
}
super::names!(codec);
