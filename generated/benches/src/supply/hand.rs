//! A codec of the same frames as firmware has it: written by hand, with the checks of the generated one.
//!
//! It keeps nothing that a program can work out later, and looks for the reason only once a frame is refused.
#![expect(clippy::cast_possible_truncation, reason = "parts of a word are taken so")]

use embedded_can::Id;

use super::frame::Frame;
use super::steps::{half, halves, milli, rounded, signed, words};

/// The values of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Message {
    Output { voltage_v: f32, current_a: f32 },
    SetPoint { voltage_v: f64, current_a: f64 },
    State { group: u8, temperature_c: i8, status: u32 },
    Input { ab_v: f64, bc_v: f64, ca_v: f64 },
    Real { register: u16, value: f32 },
    Whole { register: u16, value: u32 },
    Signal { number: u16, value_v: f64 },
}

/// A frame of the protocol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Received {
    /// The identifier.
    pub id: u32,
    /// The values.
    pub message: Message,
}

/// Why a frame is none of the protocol, in the order of the tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Problem {
    /// It is a remote frame.
    Frame,
    /// It is for the loader of programs.
    Foreign,
    /// The identifier has 11 bits, or no address of a controller.
    Identifier,
    /// It has not eight bytes.
    Length,
    /// There is no such command, register or signal.
    Unknown,
}

/// Returns what a frame says.
///
/// Frames for the loader need no test: no message has their command.
///
/// # Errors
///
/// Refuses a frame that is none of the protocol.
#[inline(always)]
pub fn decode(frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
    let Id::Extended(id) = frame.id() else { return refused(frame) };
    let Ok(data) = frame.data().try_into() else { return refused(frame) };
    let id = id.as_raw();
    if frame.is_remote_frame() || !is_controller(id as u8) {
        return refused(frame);
    }
    payload(command(id), u64::from_be_bytes(data), || refused(frame), |message| Ok(Received { id, message }))
}

#[cold]
fn refused(frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
    let id = match frame.id() {
        _ if frame.is_remote_frame() => return Err(Problem::Frame),
        Id::Standard(_) => return Err(Problem::Identifier),
        Id::Extended(id) => id.as_raw(),
    };
    Err(match command(id) {
        _ if id & !0xFF == 0x1F00_0000 => Problem::Foreign,
        _ if !is_controller(id as u8) => Problem::Identifier,
        1..=6 if frame.data().len() != 8 => Problem::Length,
        _ => Problem::Unknown,
    })
}

#[inline(always)]
pub(crate) fn is_controller(address: u8) -> bool {
    (0xF0..=0xF8).contains(&address)
}

#[inline(always)]
fn is_reply(id: u32) -> bool {
    id >> 22 & 1 != 0
}

#[inline(always)]
fn command(id: u32) -> u8 {
    (id >> 16) as u8 & 0x3F
}

/// Hands the values of a payload on. Were they returned first, they would be copied twice.
#[inline(always)]
fn payload<T>(command: u8, word: u64, unknown: impl FnOnce() -> T, then: impl Fn(Message) -> T) -> T {
    let byte = |number: u32| (word >> (56 - 8 * number)) as u8;
    let half = |number: u32| (word >> (48 - 16 * number)) as u16;
    let tenths = |number: u32| f64::from(half(number)) / 10.0;
    let [first, second] = [(word >> 32) as u32, word as u32];
    match (command, half(0)) {
        (1, _) => then(Message::Output { voltage_v: f32::from_bits(first), current_a: f32::from_bits(second) }),
        (2, _) => {
            then(Message::SetPoint { voltage_v: f64::from(first) / 1000.0, current_a: f64::from(second) / 1000.0 })
        }
        (3, _) => {
            then(Message::State { group: byte(2), temperature_c: byte(4).cast_signed(), status: second & 0x00FF_FFFF })
        }
        (4, _) => then(Message::Input { ab_v: tenths(0), bc_v: tenths(1), ca_v: tenths(2) }),
        (5, register @ 1..=20) => then(Message::Real { register, value: f32::from_bits(second) }),
        (5, register @ 21..=40) => then(Message::Whole { register, value: second }),
        (6, number @ 0x101..=0x13C) => {
            then(Message::Signal { number, value_v: f64::from(second.cast_signed()) / 1024.0 })
        }
        _ => unknown(),
    }
}

/// Builds the frame of an identifier and values, unless they do not belong together or a value does not fit.
///
/// A request must also keep to its limits, and show an addressing mode and addresses that the document names.
#[inline]
pub fn encode(Received { id, message }: &Received) -> Option<Frame> {
    let (known, word) = if is_reply(*id) { reply(message)? } else { content(message).filter(|_| has_mode(*id))? };
    (known == command(*id) && is_controller(*id as u8)).then(|| Frame::of(*id, word.to_be_bytes()))
}

/// Returns command and payload of a reply.
#[inline(always)]
fn reply(message: &Message) -> Option<(u8, u64)> {
    Some(match *message {
        Message::Output { voltage_v, current_a } => (1, words(voltage_v.to_bits(), current_a.to_bits())),
        Message::SetPoint { voltage_v, current_a } => (2, words(milli(voltage_v)?, milli(current_a)?)),
        Message::State { status, .. } if status >> 24 != 0 => return None,
        Message::State { group, temperature_c, status } => (3, state(group, temperature_c, status)),
        Message::Input { ab_v, bc_v, ca_v } => {
            (4, halves([half(ab_v * 10.0)?, half(bc_v * 10.0)?, half(ca_v * 10.0)?, 0]))
        }
        Message::Real { register: number @ 1..=20, value } => (5, numbered(number, value.to_bits())),
        Message::Whole { register: number @ 21..=40, value } => (5, numbered(number, value)),
        Message::Signal { number: number @ 0x101..=0x13C, value_v } => {
            (6, numbered(number, signed(value_v * 1024.0)?.cast_unsigned()))
        }
        _ => return None,
    })
}

/// Returns command and payload of a request, if its values keep to their limits.
#[inline(always)]
fn content(message: &Message) -> Option<(u8, u64)> {
    let is_input = |value_v: f64| (0.0..=600.0).contains(&value_v);
    let tenths = |value_v: f64| rounded(value_v * 10.0) as u16;
    Some(match *message {
        Message::Output { voltage_v, current_a }
            if (0.0..=1000.0).contains(&voltage_v) && (0.0..=500.0).contains(&current_a) =>
        {
            (1, words(voltage_v.to_bits(), current_a.to_bits()))
        }
        Message::SetPoint { voltage_v, current_a }
            if (50.0..=750.0).contains(&voltage_v) && (0.1..=50.0).contains(&current_a) =>
        {
            (2, words(rounded(voltage_v * 1000.0), rounded(current_a * 1000.0)))
        }
        Message::State { group, temperature_c, status } if status >> 24 == 0 => {
            (3, state(group, temperature_c, status))
        }
        Message::Input { ab_v, bc_v, ca_v } if is_input(ab_v) && is_input(bc_v) && is_input(ca_v) => {
            (4, halves([tenths(ab_v), tenths(bc_v), tenths(ca_v), 0]))
        }
        Message::Real { register: number @ 1..=20, value } if (0.0..=1000.0).contains(&value) => {
            (5, numbered(number, value.to_bits()))
        }
        Message::Whole { register: number @ 21..=40, value } if value <= 1_000_000 => (5, numbered(number, value)),
        Message::Signal { number: number @ 0x101..=0x13C, value_v } if (-1000.0..=1000.0).contains(&value_v) => {
            (6, numbered(number, signed(value_v * 1024.0)?.cast_unsigned()))
        }
        _ => return None,
    })
}

#[inline(always)]
fn state(group: u8, temperature_c: i8, status: u32) -> u64 {
    u64::from(group) << 40 | u64::from(temperature_c.cast_unsigned()) << 24 | u64::from(status)
}

#[inline(always)]
fn numbered(number: u16, value: u32) -> u64 {
    u64::from(number) << 48 | u64::from(value)
}

/// Tests whether the identifier of a request shows a mode and an address that the document names.
#[inline(always)]
fn has_mode(id: u32) -> bool {
    matches!((id >> 23, id >> 8 & 0xFF), (0x2A, 0x00..=0x3F) | (0x2B, 0xFF))
}

/// Whom a request addresses.
#[derive(Clone, Copy, Debug)]
pub enum Target {
    /// One supply.
    Supply(u8),
    /// All supplies.
    All,
}

impl Target {
    /// Returns the identifier's part, unless the document does not name the address.
    #[inline(always)]
    pub(crate) fn shown(self) -> Option<u32> {
        match self {
            Self::Supply(supply @ ..=0x3F) => Some(0x2A << 23 | u32::from(supply) << 8),
            Self::Supply(_) => None,
            Self::All => Some(0x2B << 23 | 0xFF << 8),
        }
    }
}

/// A request: its values, whom it addresses, and the address of the controller that sends it.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Request {
    pub message: Message,
    pub target: Target,
    pub controller: u8,
}

/// Builds the frame of a request, unless an address is none, or a value is outside its limits.
#[inline(always)]
pub fn request(Request { message, target, controller }: &Request) -> Option<Frame> {
    let (command, word) = content(message)?;
    let id = target.shown()? | u32::from(command) << 16 | u32::from(*controller);
    is_controller(*controller).then(|| Frame::of(id, word.to_be_bytes()))
}

/// Returns what a frame asks for, unless it is a reply.
pub fn to_request(Received { id, message }: &Received) -> Option<Request> {
    let [.., supply, controller] = id.to_be_bytes();
    let target = if id >> 23 == 0x2A { Target::Supply(supply) } else { Target::All };
    (!is_reply(*id)).then_some(Request { message: *message, target, controller })
}
