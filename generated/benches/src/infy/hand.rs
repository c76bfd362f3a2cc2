//! A codec of the same frames as firmware has it: written by hand, with the checks of the generated one.
//!
//! It keeps nothing that a program can work out later, and looks for the reason only once a frame is refused.
#![expect(clippy::cast_possible_truncation, reason = "parts of a word are taken so")]

use embedded_can::Id;

use super::frame::Frame;
use super::steps::{half, halves, milli, rounded, words};

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
            #[inline]
            fn from(raw: u8) -> Self {
                match raw {
                    0 => Self::$zero,
                    1 => Self::$one,
                    _ => Self::Unknown(raw),
                }
            }
        }

        impl From<$name> for u8 {
            #[inline]
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

/// The values of a frame; a request that reads has its command.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Message {
    Read(u8),
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
    /// It goes from one module to another.
    Foreign,
    /// The identifier has 11 bits, or does not show where the frame goes.
    Identifier,
    /// There is no such command.
    Command,
    /// It has not eight bytes.
    Length,
}

/// Returns what a frame says.
///
/// Identifiers between modules need no test: no message has their command.
///
/// # Errors
///
/// Refuses a frame that is none of the protocol.
#[inline(always)]
pub fn decode(frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
    let Id::Extended(id) = frame.id() else { return refused(frame) };
    let Ok(data) = frame.data().try_into() else { return refused(frame) };
    let id = id.as_raw();
    if frame.is_remote_frame() || !has_direction(id) {
        return refused(frame);
    }
    let command = command(id);
    if !is_reply(id) && is_among(READS, command) {
        return Ok(Received { id, message: Message::Read(command) });
    }
    payload(command, u64::from_be_bytes(data), || refused(frame), |message| Ok(Received { id, message }))
}

#[cold]
fn refused(frame: &impl embedded_can::Frame) -> Result<Received, Problem> {
    let id = match frame.id() {
        _ if frame.is_remote_frame() => return Err(Problem::Frame),
        Id::Standard(_) => return Err(Problem::Identifier),
        Id::Extended(id) => id.as_raw(),
    };
    Err(match command(id) {
        _ if id & !0xFF == 0x0757_F800 => Problem::Foreign,
        _ if !has_direction(id) => Problem::Identifier,
        command if !is_reply(id) && is_among(READS, command) => Problem::Length,
        command => payload(command, 0, || Problem::Command, |_| Problem::Length),
    })
}

/// Tests whether exactly one of both addresses is a controller's.
#[inline(always)]
fn has_direction(id: u32) -> bool {
    is_controller(source(id)) != is_reply(id)
}

#[inline(always)]
fn is_reply(id: u32) -> bool {
    is_controller((id >> 8) as u8)
}

#[inline(always)]
pub(crate) fn is_controller(address: u8) -> bool {
    (0xF0..=0xF8).contains(&address)
}

#[inline(always)]
pub(crate) fn source(id: u32) -> u8 {
    id as u8
}

#[inline(always)]
pub(crate) fn command(id: u32) -> u8 {
    (id >> 16) as u8 & 0x3F
}

/// The commands that read, as bits.
const READS: u64 = TOTALS | 1 << 0x03 | 1 << 0x04 | 1 << 0x06 | 0xF << 0x09;
/// Those of them that read totals.
const TOTALS: u64 = 1 << 0x01 | 1 << 0x02 | 1 << 0x08;

#[inline(always)]
fn is_among(commands: u64, command: u8) -> bool {
    command < 64 && commands >> command & 1 != 0
}

/// Hands the values of a payload on. Were they returned first, they would be copied twice.
#[inline(always)]
pub(crate) fn payload<T>(command: u8, word: u64, unknown: impl FnOnce() -> T, then: impl Fn(Message) -> T) -> T {
    let byte = |number: u32| (word >> (56 - 8 * number)) as u8;
    let half = |number: u32| (word >> (48 - 16 * number)) as u16;
    let single = |number: u32| f32::from_bits((word >> (32 - 32 * number)) as u32);
    let milli = |number: u32| f64::from((word >> (32 - 32 * number)) as u32) / 1000.0;
    let tenths = |number: u32| f64::from(half(number)) / 10.0;
    match command {
        0x01 => then(Message::SystemOutput { voltage_v: single(0), current_a: single(1) }),
        0x02 => then(Message::ModuleCount(byte(2))),
        0x03 => then(Message::ModuleOutput { voltage_v: single(0), current_a: single(1) }),
        0x04 => then(Message::ModuleStatus {
            group: byte(2),
            temperature_c: byte(4).cast_signed(),
            status: [byte(5), byte(6), byte(7)],
        }),
        0x06 => then(Message::InputVoltage { ab_v: tenths(0), bc_v: tenths(1), ca_v: tenths(2) }),
        0x08 => then(Message::SystemOutputFixed { voltage_v: milli(0), current_a: milli(1) }),
        0x09 => then(Message::ModuleOutputFixed { voltage_v: milli(0), current_a: milli(1) }),
        0x0A => then(Message::ModuleLimits {
            maximum_v: half(0),
            minimum_v: half(1),
            maximum_a: tenths(2),
            rated_w: f64::from(u32::from(half(3)) * 10),
        }),
        0x0B => then(Message::Barcode { letter: byte(0), number: word >> 16 & 0xFF_FFFF_FFFF, suffix: half(3) }),
        0x0C => then(Message::ExternalVoltage { voltage_v: tenths(0), allowed_current_a: tenths(1) }),
        0x13 => then(Message::WalkIn(byte(0).into())),
        0x14 => then(Message::Led(byte(0).into())),
        0x16 => then(Message::Group(byte(0))),
        0x19 => then(Message::Sleep(byte(0).into())),
        0x1A => then(Message::Power(byte(0).into())),
        0x1B => then(Message::TotalOutput { voltage_v: milli(0), current_a: milli(1) }),
        0x1C => then(Message::ModuleSetpoint { voltage_v: milli(0), current_a: milli(1) }),
        0x1F => then(Message::AddressMode(byte(0).into())),
        _ => unknown(),
    }
}

/// Builds the frame of an identifier and values, unless they do not belong together or a value does not fit.
///
/// A request must also keep to its limits, and show an addressing mode and addresses that the document names.
#[inline]
pub fn encode(Received { id, message }: &Received) -> Option<Frame> {
    if !has_direction(*id) {
        return None;
    }
    let (known, word) = if is_reply(*id) {
        reply(message)?
    } else {
        let Content { command, modes, word } = content(message)?;
        (modes & mode(*id) != 0).then_some((command, word))?
    };
    (known == command(*id)).then(|| Frame::of(*id, word.to_be_bytes()))
}

/// Returns command and payload of a reply.
#[inline(always)]
fn reply(message: &Message) -> Option<(u8, u64)> {
    Some(match *message {
        Message::Read(_) => return None,
        Message::SystemOutput { voltage_v, current_a } => (0x01, words(voltage_v.to_bits(), current_a.to_bits())),
        Message::ModuleCount(count) => (0x02, u64::from(count) << 40),
        Message::ModuleOutput { voltage_v, current_a } => (0x03, words(voltage_v.to_bits(), current_a.to_bits())),
        Message::ModuleStatus { group, temperature_c, status: [two, one, zero] } => {
            (0x04, u64::from_be_bytes([0, 0, group, 0, temperature_c.cast_unsigned(), two, one, zero]))
        }
        Message::InputVoltage { ab_v, bc_v, ca_v } => {
            (0x06, halves([half(ab_v * 10.0)?, half(bc_v * 10.0)?, half(ca_v * 10.0)?, 0]))
        }
        Message::SystemOutputFixed { voltage_v, current_a } => (0x08, words(milli(voltage_v)?, milli(current_a)?)),
        Message::ModuleOutputFixed { voltage_v, current_a } => (0x09, words(milli(voltage_v)?, milli(current_a)?)),
        Message::ModuleLimits { maximum_v, minimum_v, maximum_a, rated_w } => {
            (0x0A, halves([maximum_v, minimum_v, half(maximum_a * 10.0)?, half(rated_w / 10.0)?]))
        }
        Message::Barcode { number, .. } if number >> 40 != 0 => return None,
        Message::Barcode { letter, number, suffix } => {
            (0x0B, u64::from(letter) << 56 | number << 16 | u64::from(suffix))
        }
        Message::ExternalVoltage { voltage_v, allowed_current_a } => {
            (0x0C, halves([half(voltage_v * 10.0)?, half(allowed_current_a * 10.0)?, 0, 0]))
        }
        Message::WalkIn(value) => (0x13, first(value)),
        Message::Led(value) => (0x14, first(value)),
        Message::Group(group) => (0x16, first(group)),
        Message::Sleep(value) => (0x19, first(value)),
        Message::Power(value) => (0x1A, first(value)),
        Message::TotalOutput { voltage_v, current_a } => (0x1B, words(milli(voltage_v)?, milli(current_a)?)),
        Message::ModuleSetpoint { voltage_v, current_a } => (0x1C, words(milli(voltage_v)?, milli(current_a)?)),
        Message::AddressMode(value) => (0x1F, first(value)),
    })
}

/// What a request shows beside its addresses.
struct Content {
    command: u8,
    /// The bits of its addressing modes.
    modes: u8,
    word: u64,
}

const MODULE: u8 = 1;
const GROUP: u8 = 2;
const BROADCAST: u8 = 4;
const ALL_GROUPS: u8 = 8;
/// Modes of what one module answers for all.
const TOTAL: u8 = GROUP | BROADCAST | ALL_GROUPS;

/// Returns what a request shows, if its values keep to their limits.
#[inline(always)]
fn content(message: &Message) -> Option<Content> {
    const SET: u8 = MODULE | GROUP | BROADCAST;
    let (command, modes, word) = match *message {
        Message::Read(command) if is_among(TOTALS, command) => (command, TOTAL, 0),
        Message::Read(command) if is_among(READS, command) => (command, MODULE | GROUP, 0),
        Message::WalkIn(value) => (0x13, SET, first(value)),
        Message::Led(value) => (0x14, SET, first(value)),
        Message::Group(group @ 1..=0x3E) => (0x16, SET, first(group)),
        Message::Sleep(value) => (0x19, SET, first(value)),
        Message::Power(value) => (0x1A, SET | ALL_GROUPS, first(value)),
        Message::TotalOutput { voltage_v, current_a } if (50.0..=750.0).contains(&voltage_v) => {
            (0x1B, TOTAL, words(rounded(voltage_v * 1000.0), milli(current_a)?))
        }
        Message::ModuleSetpoint { voltage_v, current_a }
            if (50.0..=750.0).contains(&voltage_v) && (0.1..=50.0).contains(&current_a) =>
        {
            (0x1C, SET, words(rounded(voltage_v * 1000.0), rounded(current_a * 1000.0)))
        }
        Message::AddressMode(value) => (0x1F, SET, first(value)),
        _ => return None,
    };
    Some(Content { command, modes, word })
}

/// Returns the bit of the addressing mode that the identifier of a request shows, or none for undocumented addresses.
#[inline(always)]
fn mode(id: u32) -> u8 {
    match (id >> 22 & 0xF, id >> 8 & 0xFF) {
        (0xA, 0x00..=0x3B) => MODULE,
        (0xA, 0x3F) => BROADCAST,
        (0xB, 0x00..=0x3E) => GROUP,
        (0xB, 0x3F) => ALL_GROUPS,
        _ => 0,
    }
}

#[inline(always)]
fn first(byte: impl Into<u8>) -> u64 {
    u64::from(byte.into()) << 56
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
    /// Returns the bit of the mode and the identifier's part, unless the document does not name the address.
    #[inline(always)]
    pub(crate) fn shown(self) -> Option<(u8, u32)> {
        let id = |device: u32, address: u8| device << 22 | u32::from(address) << 8;
        Some(match self {
            Self::Module(module @ ..=0x3B) => (MODULE, id(0xA, module)),
            Self::Group(group @ ..=0x3E) => (GROUP, id(0xB, group)),
            Self::Broadcast => (BROADCAST, id(0xA, 0x3F)),
            Self::AllGroups => (ALL_GROUPS, id(0xB, 0x3F)),
            _ => return None,
        })
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

/// Builds the frame of a request, unless it has no such target, an address is none, or a value is outside its limits.
#[inline(always)]
pub fn request(Request { message, target, controller }: &Request) -> Option<Frame> {
    let Content { command, modes, word } = content(message)?;
    let (mode, id) = target.shown()?;
    let id = id | u32::from(command) << 16 | u32::from(*controller);
    (modes & mode != 0 && is_controller(*controller)).then(|| Frame::of(id, word.to_be_bytes()))
}

/// Returns what a frame asks for, unless it is a reply.
pub fn to_request(Received { id, message }: &Received) -> Option<Request> {
    let [.., target, controller] = id.to_be_bytes();
    let target = match (id >> 22 & 0xF, target) {
        (0xA, 0x3F) => Target::Broadcast,
        (_, 0x3F) => Target::AllGroups,
        (0xA, module) => Target::Module(module),
        (_, group) => Target::Group(group),
    };
    (!is_reply(*id)).then_some(Request { message: *message, target, controller })
}

/// The read of a module's output, after it was sent: what the identifier of a reply shows.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    mask: u32,
    value: u32,
}

/// Why a reply has no values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// The module reports an error.
    Error,
    /// It has not eight bytes.
    Length,
}

impl Asked {
    /// Asks a module, or each module of a group, from this controller.
    pub fn new(target: Target, controller: u8) -> Option<Self> {
        let (device, mask, source) = match target {
            Target::Module(module) => (0xA, 0x03FF_FFFF, module),
            Target::Group(_) => (0xB, 0x03FF_FF00, 0),
            _ => return None,
        };
        let value = device << 22 | 0x03 << 16 | u32::from(controller) << 8 | u32::from(source);
        target.shown().filter(|_| is_controller(controller)).map(|_| Self { mask, value })
    }

    /// Returns voltage and current if a frame answers, even with an error.
    #[inline]
    pub fn reply(&self, frame: &impl embedded_can::Frame) -> Option<Result<(f32, f32), Failure>> {
        if !frame.is_extended() || frame.is_remote_frame() {
            return None;
        }
        let Id::Extended(id) = frame.id() else { return None };
        let id = id.as_raw();
        if (id ^ self.value) & self.mask != 0 || is_controller(source(id)) {
            return None;
        }
        Some(match <[u8; 8]>::try_from(frame.data()) {
            _ if id >> 26 != 0 => Err(Failure::Error),
            Ok([v0, v1, v2, v3, a0, a1, a2, a3]) => {
                Ok((f32::from_be_bytes([v0, v1, v2, v3]), f32::from_be_bytes([a0, a1, a2, a3])))
            }
            Err(_) => Err(Failure::Length),
        })
    }
}
