//! The codec that canspec generates.

use std::fmt::Debug;

use super::hand;
use crate::Codec;
use crate::frame::Frame;

/// What canspec generates.
pub mod code {
    canspec_runtime::include_protocol!("supply");
}

use code::{Error, Kind, Message, Received, Request, Route, Target};

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
        take!(received.identifier().supply);
        take(received.content());
    }

    #[inline(always)]
    fn encode(received: &Received) -> Option<impl embedded_can::Frame> {
        received.encode().ok()
    }

    #[inline(always)]
    fn request((route, message): &Self::Request) -> Option<impl embedded_can::Frame> {
        request(*route, message)
    }

    fn to_values(received: &Received) -> Received {
        *received
    }

    fn to_request(received: &Received) -> Option<Self::Request> {
        let identifier = received.identifier();
        let target = if identifier.device == 0x2A { Target::Supply(identifier.supply) } else { Target::All };
        (received.kind() == Kind::Request).then(|| (target.sent_by(identifier.controller), *received.content()))
    }

    fn to_hand(received: &Received) -> hand::Received {
        let [high, low, ..] = received.frame().bytes();
        let message = values(received.content(), u16::from_be_bytes([high, low]));
        hand::Received { id: received.frame().raw_id(), message }
    }
}

macro_rules! codec {
    (
        [$(($real_number:literal $real:ident $($of_real:ident)*))*]
        [$(($whole_number:literal $whole:ident $($of_whole:ident)*))*]
        [$(($signal_number:literal $signal:ident $($of_signal:ident)*))*]
    ) => {
        /// Hands over each value, as a program takes it.
        #[inline(always)]
        fn take(message: &Message) {
            match *message {
                Message::Output(m) => take!(m.voltage_v, m.current_a),
                Message::SetPoint(m) => take!(m.voltage_v, m.current_a),
                Message::State(m) => take!(m.group, m.temperature_c, m.status),
                Message::Input(m) => take!(m.ab_v, m.bc_v, m.ca_v),
                $(Message::$real(m) => take!(m.value),)*
                $(Message::$whole(m) => take!(m.value),)*
                $(Message::$signal(m) => take!(m.value_v),)*
            }
        }

        #[inline(always)]
        fn request(route: Route<Target>, message: &Message) -> Option<canspec_runtime::Frame> {
            fn frame<R>(request: Result<Request<R>, Error>) -> Option<canspec_runtime::Frame> {
                request.ok().map(|request| *request.frame())
            }
            match message {
                Message::Output(m) => frame(m.set(route)),
                Message::SetPoint(m) => frame(m.set(route)),
                Message::State(m) => frame(m.set(route)),
                Message::Input(m) => frame(m.set(route)),
                $(Message::$real(m) => frame(m.set(route)),)*
                $(Message::$whole(m) => frame(m.set(route)),)*
                $(Message::$signal(m) => frame(m.set(route)),)*
            }
        }

        /// Returns the values in the types of the codec by hand.
        fn values(message: &Message, number: u16) -> hand::Message {
            match *message {
                Message::Output(m) => hand::Message::Output { voltage_v: m.voltage_v, current_a: m.current_a },
                Message::SetPoint(m) => hand::Message::SetPoint { voltage_v: m.voltage_v, current_a: m.current_a },
                Message::State(m) => {
                    hand::Message::State { group: m.group, temperature_c: m.temperature_c, status: m.status.0 }
                }
                Message::Input(m) => hand::Message::Input { ab_v: m.ab_v, bc_v: m.bc_v, ca_v: m.ca_v },
                $(Message::$real(m) => hand::Message::Real { register: number, value: m.value },)*
                $(Message::$whole(m) => hand::Message::Whole { register: number, value: m.value },)*
                $(Message::$signal(m) => hand::Message::Signal { number, value_v: m.value_v },)*
            }
        }
    };
}
super::names!(codec);
