//! A codec of the same frames as firmware has it: written by hand, without anything that a frame does not need.

use std::fmt::Debug;

use embedded_can::{ExtendedId, Frame as _, Id};

use crate::Codec;
use crate::frame::Frame;

/// Named values: an enum that keeps what it has no name for.
macro_rules! named {
    ($($name:ident { $zero:ident, $one:ident })*) => {$(
        #[doc = concat!("The values of `", stringify!($name), "`.")]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum $name {
            #[doc = "0."]
            $zero,
            #[doc = "1."]
            $one,
            #[doc = "Any other number."]
            Unknown(u8),
        }

        impl From<u8> for $name {
            fn from(raw: u8) -> Self {
                match raw {
                    0 => Self::$zero,
                    1 => Self::$one,
                    _ => Self::Unknown(raw),
                }
            }
        }

        impl From<$name> for u8 {
            fn from(value: $name) -> Self {
                match value {
                    $name::$zero => 0,
                    $name::$one => 1,
                    $name::Unknown(raw) => raw,
                }
            }
        }
    )*};
}

named! {
    WalkIn { Disabled, Enabled }
    Led { Normal, Flashing }
    Sleep { Awake, Asleep }
    Power { On, Off }
    AddressMode { Automatic, DipSwitch }
}

/// The fields of an identifier.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Identifier {
    pub error: u8,
    pub device: u8,
    pub command: u8,
    pub target: u8,
    pub source: u8,
}

impl From<u32> for Identifier {
    fn from(id: u32) -> Self {
        let [high, command, target, source] = id.to_be_bytes();
        Self { error: high >> 2, device: (high & 3) << 2 | command >> 6, command: command & 0x3F, target, source }
    }
}

impl Identifier {
    /// Joins the fields.
    pub fn raw(self) -> u32 {
        let high = self.error << 2 | self.device >> 2;
        u32::from_be_bytes([high, self.device << 6 | self.command, self.target, self.source])
    }
}

/// The values of a frame; a request that reads has none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Message {
    Read,
    SystemOutput { voltage_v: f32, current_a: f32 },
    ModuleCount(u8),
    ModuleOutput { voltage_v: f32, current_a: f32 },
    ModuleStatus { group: u8, temperature_c: i8, status: [u8; 3] },
    InputVoltage { ab_v: f64, bc_v: f64, ca_v: f64 },
    SystemOutputFixed { voltage_v: f64, current_a: f64 },
    ModuleOutputFixed { voltage_v: f64, current_a: f64 },
    ModuleLimits { maximum_v: u16, minimum_v: u16, maximum_a: f64, rated_w: f64 },
    Barcode { letter: u8, number: u64, suffix: u16 },
    ExternalVoltage { voltage_v: f64, allowed_current_a: f64 },
    WalkIn(WalkIn),
    Led(Led),
    Group(u8),
    Sleep(Sleep),
    Power(Power),
    TotalOutput { voltage_v: f64, current_a: f64 },
    ModuleSetpoint { voltage_v: f64, current_a: f64 },
    AddressMode(AddressMode),
}

/// A frame: its identifier and its values.
pub type Received = (Identifier, Message);

/// A frame is none of the protocol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unknown;

/// Returns what a frame says.
///
/// # Errors
///
/// Refuses a frame that is none of the protocol.
#[inline]
pub fn decode(frame: &impl embedded_can::Frame) -> Result<Received, Unknown> {
    let Id::Extended(id) = frame.id() else { return Err(Unknown) };
    let id = id.as_raw();
    if frame.is_remote_frame() || id & !0xFF == 0x0757_F800 {
        return Err(Unknown);
    }
    let data: [u8; 8] = frame.data().try_into().map_err(|_| Unknown)?;
    let identifier = Identifier::from(id);
    let message = match direction(&identifier).ok_or(Unknown)? {
        Direction::ToModule if identifier.command < 0x13 => read(identifier.command)?,
        _ => values(identifier.command, data)?,
    };
    Ok((identifier, message))
}

/// Where a frame goes.
pub enum Direction {
    /// A request.
    ToModule,
    /// A reply.
    ToController,
}

/// Tells requests from replies by the addresses.
pub fn direction(identifier: &Identifier) -> Option<Direction> {
    let is_controller = |address: u8| (0xF0..=0xF8).contains(&address);
    match (is_controller(identifier.target), is_controller(identifier.source)) {
        (false, true) => Some(Direction::ToModule),
        (true, false) => Some(Direction::ToController),
        _ => None,
    }
}

fn read(command: u8) -> Result<Message, Unknown> {
    matches!(command, 0x01..=0x04 | 0x06 | 0x08..=0x0C).then_some(Message::Read).ok_or(Unknown)
}

#[inline]
fn values(command: u8, data: [u8; 8]) -> Result<Message, Unknown> {
    let [b0, b1, b2, b3, b4, b5, b6, b7] = data;
    let [first, second] = [[b0, b1, b2, b3], [b4, b5, b6, b7]];
    let milli = |word: [u8; 4]| f64::from(u32::from_be_bytes(word)) / 1000.0;
    let tenths = |high: u8, low: u8| f64::from(u16::from_be_bytes([high, low])) / 10.0;
    Ok(match command {
        0x01 => Message::SystemOutput { voltage_v: f32::from_be_bytes(first), current_a: f32::from_be_bytes(second) },
        0x02 => Message::ModuleCount(b2),
        0x03 => Message::ModuleOutput { voltage_v: f32::from_be_bytes(first), current_a: f32::from_be_bytes(second) },
        0x04 => Message::ModuleStatus { group: b2, temperature_c: b4.cast_signed(), status: [b5, b6, b7] },
        0x06 => Message::InputVoltage { ab_v: tenths(b0, b1), bc_v: tenths(b2, b3), ca_v: tenths(b4, b5) },
        0x08 => Message::SystemOutputFixed { voltage_v: milli(first), current_a: milli(second) },
        0x09 => Message::ModuleOutputFixed { voltage_v: milli(first), current_a: milli(second) },
        0x0A => Message::ModuleLimits {
            maximum_v: u16::from_be_bytes([b0, b1]),
            minimum_v: u16::from_be_bytes([b2, b3]),
            maximum_a: tenths(b4, b5),
            rated_w: f64::from(u16::from_be_bytes([b6, b7])) * 10.0,
        },
        0x0B => Message::Barcode {
            letter: b0,
            number: u64::from_be_bytes([0, 0, 0, b1, b2, b3, b4, b5]),
            suffix: u16::from_be_bytes([b6, b7]),
        },
        0x0C => Message::ExternalVoltage { voltage_v: tenths(b0, b1), allowed_current_a: tenths(b2, b3) },
        0x13 => Message::WalkIn(b0.into()),
        0x14 => Message::Led(b0.into()),
        0x16 => Message::Group(b0),
        0x19 => Message::Sleep(b0.into()),
        0x1A => Message::Power(b0.into()),
        0x1B => Message::TotalOutput { voltage_v: milli(first), current_a: milli(second) },
        0x1C => Message::ModuleSetpoint { voltage_v: milli(first), current_a: milli(second) },
        0x1F => Message::AddressMode(b0.into()),
        _ => return Err(Unknown),
    })
}

/// Returns the frame, or nothing if a value does not fit.
pub fn encode((identifier, message): &Received) -> Option<Frame> {
    let id = ExtendedId::new(identifier.raw())?;
    Frame::new(id, &data(message)?)
}

fn data(message: &Message) -> Option<[u8; 8]> {
    let byte = |byte: u8| [byte, 0, 0, 0, 0, 0, 0, 0];
    Some(match *message {
        Message::Read => [0; 8],
        Message::SystemOutput { voltage_v, current_a } | Message::ModuleOutput { voltage_v, current_a } => {
            words(voltage_v.to_bits(), current_a.to_bits())
        }
        Message::ModuleCount(count) => [0, 0, count, 0, 0, 0, 0, 0],
        Message::ModuleStatus { group, temperature_c, status: [two, one, zero] } => {
            [0, 0, group, 0, temperature_c.cast_unsigned(), two, one, zero]
        }
        Message::InputVoltage { ab_v, bc_v, ca_v } => halves([tenths(ab_v)?, tenths(bc_v)?, tenths(ca_v)?, 0]),
        Message::ModuleLimits { maximum_v, minimum_v, maximum_a, rated_w } => {
            halves([maximum_v, minimum_v, tenths(maximum_a)?, half(rated_w / 10.0)?])
        }
        Message::Barcode { letter, number, suffix } => {
            if number >> 40 != 0 {
                return None;
            }
            (u64::from(letter) << 56 | number << 16 | u64::from(suffix)).to_be_bytes()
        }
        Message::ExternalVoltage { voltage_v, allowed_current_a } => {
            halves([tenths(voltage_v)?, tenths(allowed_current_a)?, 0, 0])
        }
        Message::SystemOutputFixed { voltage_v, current_a }
        | Message::ModuleOutputFixed { voltage_v, current_a }
        | Message::TotalOutput { voltage_v, current_a }
        | Message::ModuleSetpoint { voltage_v, current_a } => words(milli(voltage_v)?, milli(current_a)?),
        Message::WalkIn(value) => byte(value.into()),
        Message::Led(value) => byte(value.into()),
        Message::Group(group) => byte(group),
        Message::Sleep(value) => byte(value.into()),
        Message::Power(value) => byte(value.into()),
        Message::AddressMode(value) => byte(value.into()),
    })
}

fn words(first: u32, second: u32) -> [u8; 8] {
    (u64::from(first) << 32 | u64::from(second)).to_be_bytes()
}

fn halves([a, b, c, d]: [u16; 4]) -> [u8; 8] {
    (u64::from(a) << 48 | u64::from(b) << 32 | u64::from(c) << 16 | u64::from(d)).to_be_bytes()
}

fn milli(value: f64) -> Option<u32> {
    rounded(value * 1000.0, u32::MAX.into())
}

fn tenths(value: f64) -> Option<u16> {
    half(value * 10.0)
}

#[expect(clippy::cast_possible_truncation, reason = "the limit is that of 16 bits")]
fn half(value: f64) -> Option<u16> {
    rounded(value, u16::MAX.into()).map(|raw| raw as u16)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the limits are tested first")]
fn rounded(value: f64, maximum: f64) -> Option<u32> {
    (value >= 0.0 && value <= maximum).then_some((value + 0.5) as u32)
}

/// Whom a request addresses.
#[derive(Clone, Copy, Debug)]
pub enum Target {
    /// One module.
    Module(u8),
    /// All modules of a group.
    Group(u8),
    /// All modules.
    Broadcast,
    /// All groups.
    AllGroups,
}

impl Target {
    /// Returns device number and address, unless the address is out of range.
    fn address(self) -> Option<(u8, u8)> {
        match self {
            Self::Module(module) => (module <= 0x3B).then_some((0xA, module)),
            Self::Group(group) => (group <= 0x3E).then_some((0xB, group)),
            Self::Broadcast => Some((0xA, 0x3F)),
            Self::AllGroups => Some((0xB, 0x3F)),
        }
    }
}

/// A request, whom it addresses and by whom it is sent.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// The command.
    pub command: u8,
    /// The values.
    pub message: Message,
    /// Whom it addresses.
    pub target: Target,
    /// The address of the controller.
    pub controller: u8,
}

impl Request {
    /// Returns the identifier, or nothing if the command has no such target or an address is out of range.
    pub fn identifier(&self) -> Option<Identifier> {
        let Self { command, target, controller, .. } = *self;
        let is_allowed = match command {
            0x01 | 0x02 | 0x08 | 0x1B => !matches!(target, Target::Module(_)),
            0x1A => true,
            0x13.. => !matches!(target, Target::AllGroups),
            _ => matches!(target, Target::Module(_) | Target::Group(_)),
        };
        let (device, address) = target.address()?;
        let identifier = Identifier { error: 0, device, command, target: address, source: controller };
        (is_allowed && (0xF0..=0xF8).contains(&controller)).then_some(identifier)
    }
}

/// Returns the frame of a request, or nothing if it has no such target or a value does not fit.
pub fn request(request: &Request) -> Option<Frame> {
    match request.message {
        Message::Group(group) if !(1..=0x3E).contains(&group) => None,
        message => encode(&(request.identifier()?, message)),
    }
}

/// Returns what a frame asks for, unless it is a reply.
pub fn to_request((identifier, message): &Received) -> Option<Request> {
    let Identifier { device, command, target, source: controller, .. } = *identifier;
    let Direction::ToModule = direction(identifier)? else { return None };
    let target = match (device, target) {
        (0xA, 0x3F) => Target::Broadcast,
        (_, 0x3F) => Target::AllGroups,
        (0xA, module) => Target::Module(module),
        (_, group) => Target::Group(group),
    };
    Some(Request { command, message: *message, target, controller })
}

/// The codec written by hand.
pub struct Hand;

impl Codec for Hand {
    const NAME: &'static str = "by hand";
    type Received = Received;
    type Request = Request;

    fn decode(frame: &Frame) -> Result<Received, impl Debug> {
        decode(frame)
    }

    fn encode(received: &Received) -> Option<impl embedded_can::Frame> {
        encode(received)
    }

    fn request(values: &Request) -> Option<impl embedded_can::Frame> {
        request(values)
    }

    fn to_request(received: &Received) -> Option<Request> {
        to_request(received)
    }

    fn to_hand(received: &Received) -> Received {
        *received
    }
}
