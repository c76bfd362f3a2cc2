//! The codec written by hand, as it is measured.

use std::fmt::Debug;

use super::hand::{self, Message, Received, Request};
use crate::Codec;
use crate::frame::Frame;

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
    #[expect(clippy::cast_possible_truncation, reason = "the address is the last byte")]
    fn take(Received { id, message }: &Received) {
        take!((id >> 8) as u8);
        match *message {
            Message::Output { voltage_v, current_a } => take!(voltage_v, current_a),
            Message::SetPoint { voltage_v, current_a } => take!(voltage_v, current_a),
            Message::State { group, temperature_c, status } => take!(group, temperature_c, status),
            Message::Input { ab_v, bc_v, ca_v } => take!(ab_v, bc_v, ca_v),
            Message::Real { value, .. } => take!(value),
            Message::Whole { value, .. } => take!(value),
            Message::Signal { value_v, .. } => take!(value_v),
        }
    }

    #[inline(always)]
    fn encode(received: &Received) -> Option<impl embedded_can::Frame> {
        hand::encode(received)
    }

    #[inline(always)]
    fn request(request: &Request) -> Option<impl embedded_can::Frame> {
        hand::request(request)
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
