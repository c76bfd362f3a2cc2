//! The codec written by hand, as it is measured.

use std::fmt::Debug;

use super::Infy;
use super::hand::{self, Asked, Failure, Message, Received, Request, Target};
use crate::Codec;
use crate::frame::Frame;
use crate::work::each;

/// Hands over each value, as a program takes it.
#[inline(always)]
pub fn take(message: &Message) {
    match *message {
        Message::Read(_) => (),
        Message::SystemOutput { voltage_v, current_a } | Message::ModuleOutput { voltage_v, current_a } => {
            take!(voltage_v, current_a);
        }
        Message::ModuleCount(count) => take!(count),
        Message::ModuleStatus { group, temperature_c, status: [two, one, zero] } => {
            take!(group, temperature_c, two, one, zero);
        }
        Message::InputVoltage { ab_v, bc_v, ca_v } => take!(ab_v, bc_v, ca_v),
        Message::ModuleLimits { maximum_v, minimum_v, maximum_a, rated_w } => {
            take!(maximum_v, minimum_v, maximum_a, rated_w);
        }
        Message::Barcode { letter, number, suffix } => take!(letter, number, suffix),
        Message::ExternalVoltage { voltage_v, allowed_current_a } => take!(voltage_v, allowed_current_a),
        Message::WalkIn(value) => take!(value),
        Message::Led(value) => take!(value),
        Message::Group(group) => take!(group),
        Message::Sleep(value) => take!(value),
        Message::Power(value) => take!(value),
        Message::SystemOutputFixed { voltage_v, current_a }
        | Message::ModuleOutputFixed { voltage_v, current_a }
        | Message::TotalOutput { voltage_v, current_a }
        | Message::ModuleSetpoint { voltage_v, current_a } => take!(voltage_v, current_a),
        Message::AddressMode(value) => take!(value),
    }
}

/// The codec written by hand.
pub struct Hand;

impl Codec for Hand {
    const NAME: &'static str = "by hand";
    type Received = Received;
    type Values = Received;
    type Request = Request;
    type ByHand = Received;

    #[inline(always)]
    fn decode(frame: &Frame) -> Result<Received, impl Debug> {
        hand::decode(frame)
    }

    #[inline(always)]
    fn take(Received { id, message }: &Received) {
        take!(hand::source(*id));
        take(message);
    }

    #[inline(always)]
    fn encode(received: &Received) -> Option<impl embedded_can::Frame> {
        hand::encode(received)
    }

    #[inline(always)]
    fn request(values: &Request) -> Option<impl embedded_can::Frame> {
        hand::request(values)
    }

    fn to_values(received: &Received) -> Received {
        *received
    }

    fn to_request(received: &Received) -> Option<Request> {
        hand::to_request(received)
    }

    fn to_hand(received: &Received) -> Received {
        *received
    }
}

impl Infy for Hand {
    type Asked = Asked;

    fn payloads(command: u8, words: &[[u8; 8]]) {
        fn all<const COMMAND: u8>(words: &[[u8; 8]]) {
            each(words, |word| hand::payload(COMMAND, u64::from_be_bytes(*word), || (), |message| take(&message)));
        }
        let all = match command {
            0x01 => all::<0x01>,
            0x02 => all::<0x02>,
            0x03 => all::<0x03>,
            0x04 => all::<0x04>,
            0x06 => all::<0x06>,
            0x08 => all::<0x08>,
            0x09 => all::<0x09>,
            0x0A => all::<0x0A>,
            0x0B => all::<0x0B>,
            0x0C => all::<0x0C>,
            0x13 => all::<0x13>,
            0x14 => all::<0x14>,
            0x16 => all::<0x16>,
            0x19 => all::<0x19>,
            0x1A => all::<0x1A>,
            0x1B => all::<0x1B>,
            0x1C => all::<0x1C>,
            _ => all::<0x1F>,
        };
        all(words);
    }

    fn ask(target: Target, controller: u8) -> Option<Asked> {
        Asked::new(target, controller)
    }

    #[inline(always)]
    fn reply(asked: &Asked, frame: &Frame) -> Option<Result<(f32, f32), Failure>> {
        asked.reply(frame)
    }
}
