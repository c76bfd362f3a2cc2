//! The messages as structs that binrw reads and writes, and what it leaves to be written by hand.
//!
//! binrw knows bytes alone, so identifiers and the numbers of registers and signals are tested by hand. Values are
//! rounded, but keep to no limits.

use std::fmt::{self, Debug, Display};
use std::io::Cursor;

use binrw::meta::{ReadEndian, WriteEndian};
use binrw::{BinRead, BinWrite, binrw};
use embedded_can::Id;

use super::hand::{self, Target, is_controller};
use super::steps;
use crate::Codec;
use crate::frame::Frame;

/// The codec that binrw generates, with all tests by hand.
pub struct Binrw;

/// The values of a frame.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Message {
    Output(Output),
    SetPoint(SetPoint),
    State(State),
    Input(Input),
    Real(Real),
    Whole(Whole),
    Signal(Signal),
}

/// Measured output.
#[binrw]
#[brw(big)]
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Output {
    pub voltage_v: f32,
    pub current_a: f32,
}

/// Wanted output.
#[binrw]
#[brw(big)]
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct SetPoint {
    #[br(map = from_milli)]
    #[bw(try_map = |value: &f64| milli(*value))]
    pub voltage_v: f64,
    #[br(map = from_milli)]
    #[bw(try_map = |value: &f64| milli(*value))]
    pub current_a: f64,
}

/// State.
#[binrw]
#[brw(big)]
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct State {
    #[brw(pad_before = 2)]
    pub group: u8,
    #[brw(pad_before = 1)]
    pub temperature_c: i8,
    #[br(map = |[high, middle, low]: [u8; 3]| u32::from_be_bytes([0, high, middle, low]))]
    #[bw(try_map = |status: &u32| match status.to_be_bytes() { [0, bytes @ ..] => Ok(bytes), _ => Err(Beyond) })]
    pub status: u32,
}

/// Input voltages.
#[binrw]
#[brw(big)]
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Input {
    #[br(map = from_tenths)]
    #[bw(try_map = |value: &f64| tenths(*value))]
    pub ab_v: f64,
    #[br(map = from_tenths)]
    #[bw(try_map = |value: &f64| tenths(*value))]
    pub bc_v: f64,
    #[br(map = from_tenths)]
    #[bw(try_map = |value: &f64| tenths(*value))]
    #[brw(pad_after = 2)]
    pub ca_v: f64,
}

/// A register with a real number.
#[binrw]
#[brw(big)]
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Real {
    #[brw(pad_after = 2)]
    pub register: u16,
    pub value: f32,
}

/// A register with a whole number.
#[binrw]
#[brw(big)]
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Whole {
    #[brw(pad_after = 2)]
    pub register: u16,
    pub value: u32,
}

/// One of the signals.
#[binrw]
#[brw(big)]
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Signal {
    #[brw(pad_after = 2)]
    pub number: u16,
    #[br(map = |raw: i32| f64::from(raw) / 1024.0)]
    #[bw(try_map = |value: &f64| steps::signed(value * 1024.0).ok_or(Beyond))]
    pub value_v: f64,
}

/// A value does not fit.
#[derive(Debug)]
struct Beyond;

impl Display for Beyond {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the value does not fit")
    }
}

#[inline]
fn from_milli(raw: u32) -> f64 {
    f64::from(raw) / 1000.0
}

#[inline]
fn milli(value: f64) -> Result<u32, Beyond> {
    steps::milli(value).ok_or(Beyond)
}

#[inline]
fn from_tenths(raw: u16) -> f64 {
    f64::from(raw) / 10.0
}

#[inline]
fn tenths(value: f64) -> Result<u16, Beyond> {
    steps::half(value * 10.0).ok_or(Beyond)
}

/// A decoded frame: its identifier and its values.
type Received = (u32, Message);

/// What is asked for, whom it addresses, and the address of the controller.
type Request = (Message, Target, u8);

impl Codec for Binrw {
    const NAME: &'static str = "binrw";
    type Received = Received;
    type Values = Received;
    type Request = Request;
    type ByHand = hand::Received;

    #[inline(always)]
    fn decode(frame: &Frame) -> Result<Received, impl Debug> {
        decode(frame).ok_or(hand::Problem::Unknown)
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "the address is a byte")]
    fn take((id, message): &Received) {
        take!((id >> 8) as u8);
        match *message {
            Message::Output(m) => take!(m.voltage_v, m.current_a),
            Message::SetPoint(m) => take!(m.voltage_v, m.current_a),
            Message::State(m) => take!(m.group, m.temperature_c, m.status),
            Message::Input(m) => take!(m.ab_v, m.bc_v, m.ca_v),
            Message::Real(m) => take!(m.value),
            Message::Whole(m) => take!(m.value),
            Message::Signal(m) => take!(m.value_v),
        }
    }

    #[inline(always)]
    fn encode((id, message): &Received) -> Option<impl embedded_can::Frame> {
        Some(Frame::of(*id, written(message)?.1))
    }

    #[inline(always)]
    fn request((message, target, controller): &Request) -> Option<impl embedded_can::Frame> {
        let id = target.shown().filter(|_| is_controller(*controller))?;
        let (command, data) = written(message)?;
        Some(Frame::of(id | command << 16 | u32::from(*controller), data))
    }

    fn to_values(received: &Received) -> Received {
        *received
    }

    fn to_request(received: &Received) -> Option<Request> {
        let hand::Request { target, controller, .. } = hand::to_request(&Self::to_hand(received))?;
        Some((received.1, target, controller))
    }

    fn to_hand((id, message): &Received) -> hand::Received {
        hand::Received { id: *id, message: by_hand(message) }
    }
}

/// Recognises a frame by the tests of the codec by hand.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "the address is the last byte")]
fn decode(frame: &impl embedded_can::Frame) -> Option<Received> {
    let Id::Extended(id) = frame.id() else { return None };
    let (id, data) = (id.as_raw(), frame.data());
    if frame.is_remote_frame() || data.len() != 8 || !is_controller(id as u8) {
        return None;
    }
    let message = match (id >> 16 & 0x3F, u16::from_be_bytes(*data.first_chunk()?)) {
        (1, _) => Message::Output(read(data)?),
        (2, _) => Message::SetPoint(read(data)?),
        (3, _) => Message::State(read(data)?),
        (4, _) => Message::Input(read(data)?),
        (5, 1..=20) => Message::Real(read(data)?),
        (5, 21..=40) => Message::Whole(read(data)?),
        (6, 0x101..=0x13C) => Message::Signal(read(data)?),
        _ => return None,
    };
    Some((id, message))
}

#[inline(always)]
fn read<T: for<'a> BinRead<Args<'a> = ()> + ReadEndian>(data: &[u8]) -> Option<T> {
    T::read(&mut Cursor::new(data)).ok()
}

/// Returns command and payload.
#[inline(always)]
fn written(message: &Message) -> Option<(u32, [u8; 8])> {
    Some(match message {
        Message::Output(values) => (1, write(values)?),
        Message::SetPoint(values) => (2, write(values)?),
        Message::State(values) => (3, write(values)?),
        Message::Input(values) => (4, write(values)?),
        Message::Real(values) => (5, write(values)?),
        Message::Whole(values) => (5, write(values)?),
        Message::Signal(values) => (6, write(values)?),
    })
}

#[inline(always)]
fn write<T: for<'a> BinWrite<Args<'a> = ()> + WriteEndian>(values: &T) -> Option<[u8; 8]> {
    let mut data = [0; 8];
    values.write(&mut Cursor::new(&mut data[..])).ok()?;
    Some(data)
}

fn by_hand(message: &Message) -> hand::Message {
    match *message {
        Message::Output(Output { voltage_v, current_a }) => hand::Message::Output { voltage_v, current_a },
        Message::SetPoint(SetPoint { voltage_v, current_a }) => hand::Message::SetPoint { voltage_v, current_a },
        Message::State(State { group, temperature_c, status }) => hand::Message::State { group, temperature_c, status },
        Message::Input(Input { ab_v, bc_v, ca_v }) => hand::Message::Input { ab_v, bc_v, ca_v },
        Message::Real(Real { register, value }) => hand::Message::Real { register, value },
        Message::Whole(Whole { register, value }) => hand::Message::Whole { register, value },
        Message::Signal(Signal { number, value_v }) => hand::Message::Signal { number, value_v },
    }
}
