//! What the frames of INFY say.

use super::{CONTROLLER, Line};
use Severity::{Alarm, Fault, State};

/// What a frame is beside its values.
pub struct Message {
    pub name: &'static str,
    pub access: &'static str,
    pub is_request: bool,
    pub mode: &'static str,
    /// The kind of the address beside the controller's, and the address.
    pub address: Option<(&'static str, u32)>,
}

pub enum Value {
    Whole(i64, &'static str),
    /// A number with that many decimals, as a whole number of its last decimal.
    Fixed {
        raw: u32,
        decimals: u32,
        unit: &'static str,
    },
    /// A number of tens.
    Tens(u32, &'static str),
    Single(u32, &'static str),
    Name(u8, &'static str),
    Status(u8, &'static [Bit]),
    Text(u64, String),
}

/// The severity and the name of a set bit.
pub type Bit = Option<(Severity, &'static str)>;

#[derive(Clone, Copy, PartialEq)]
pub enum Severity {
    Fault,
    Alarm,
    State,
}

const STATUS_2: [Bit; 8] = [
    Some((State, "power_limited")),
    Some((Fault, "duplicate_id")),
    Some((Fault, "current_imbalance")),
    Some((Alarm, "input_phase_lost")),
    Some((Alarm, "input_unbalanced")),
    Some((Alarm, "input_undervoltage")),
    Some((Alarm, "input_overvoltage")),
    Some((State, "pfc_off")),
];

const STATUS_1: [Bit; 8] = [
    Some((State, "dc_off")),
    Some((Fault, "fault")),
    Some((Alarm, "protection")),
    Some((Fault, "fan_fault")),
    Some((Alarm, "overtemperature")),
    Some((Alarm, "output_overvoltage")),
    Some((State, "walk_in_enabled")),
    Some((Alarm, "communication_lost")),
];

const STATUS_0: [Bit; 8] = [
    Some((Fault, "output_short_circuit")),
    None,
    Some((Fault, "internal_communication_fault")),
    Some((Fault, "input_or_bus_abnormal")),
    Some((State, "sleeping")),
    Some((Fault, "discharge_abnormal")),
    None,
    None,
];

impl Message {
    /// Reads what a line says, and adds the values. It is `None` for what has no words here.
    pub fn read(line: &Line, values: &mut Vec<(&'static str, Value)>) -> Option<Self> {
        let (target, source) = (line.id >> 8 & 0xFF, line.id & 0xFF);
        let is_request = source == CONTROLLER;
        if is_request == (target == CONTROLLER) || line.id >> 26 != 0 {
            return None;
        }
        let command = line.id >> 16 & 0x3F;
        let (name, access) = names(command)?;
        let is_read = is_request && access.starts_with("read");
        let covered = if is_read { 0 } else { read(command, line.data, values)? };
        if line.data & !covered != 0 {
            return None;
        }
        let is_total = access == "read_total" || access == "set_total";
        let other = if is_request { target } else { source };
        let (mode, address) = match (line.id >> 22, other) {
            (0xA, 0..=0x3B) if !is_total => ("point_to_point", Some(("module", other))),
            (0xA, 0x3F) if is_total || is_request && access == "set" => ("broadcast", None),
            (0xB, 0..=0x3B) if !is_total && !is_request => ("group", Some(("module", other))),
            (0xB, 0..=0x3E) if is_total || is_request => ("group", Some(("group", other))),
            (0xB, 0x3F) if is_total || is_request && name == "switch_modules" => ("all_groups", None),
            _ => return None,
        };
        Some(Self { name, access, is_request, mode, address })
    }
}

/// Returns name and access of the message that a command carries.
fn names(command: u32) -> Option<(&'static str, &'static str)> {
    Some(match command {
        0x01 => ("system_output", "read_total"),
        0x02 => ("module_count", "read_total"),
        0x03 => ("module_output", "read"),
        0x04 => ("module_status", "read"),
        0x06 => ("input_voltage", "read"),
        0x08 => ("system_output_fixed", "read_total"),
        0x09 => ("module_output_fixed", "read"),
        0x0A => ("module_limits", "read"),
        0x0B => ("barcode", "read"),
        0x0C => ("external_voltage", "read"),
        0x13 => ("set_walk_in", "set"),
        0x14 => ("set_led", "set"),
        0x16 => ("set_group", "set"),
        0x19 => ("set_sleep", "set"),
        0x1A => ("switch_modules", "set"),
        0x1B => ("set_total_output", "set_total"),
        0x1C => ("set_module_output", "set"),
        0x1F => ("set_address_mode", "set"),
        _ => return None,
    })
}

/// Adds the values of a message, and returns the bits that they cover.
#[expect(clippy::cast_possible_truncation, reason = "parts of a word are taken so")]
fn read(command: u32, data: u64, values: &mut Vec<(&'static str, Value)>) -> Option<u64> {
    const FIRST_BYTE: u64 = 0xFF << 56;
    let word = |number: u32| (data >> (32 - 32 * number)) as u32;
    let half = |number: u32| u32::from((data >> (48 - 16 * number)) as u16);
    let byte = |number: u32| (data >> (56 - 8 * number)) as u8;
    let single = |number, unit| f32::from_bits(word(number)).is_finite().then_some(Value::Single(word(number), unit));
    let milli = |number, unit| Value::Fixed { raw: word(number), decimals: 3, unit };
    let tenth = |number, unit| Value::Fixed { raw: half(number), decimals: 1, unit };
    let named = |names: [&'static str; 2]| Some(Value::Name(byte(0), names.get(usize::from(byte(0)))?));
    let status = |number, bits: &'static [Bit; 8]| {
        let is_known = (0..8).all(|bit| byte(number) >> bit & 1 == 0 || bits[bit].is_some());
        is_known.then_some(Value::Status(byte(number), bits))
    };
    Some(match command {
        0x01 | 0x03 => {
            values.extend([("voltage", single(0, "V")?), ("current", single(1, "A")?)]);
            u64::MAX
        }
        0x02 => {
            values.push(("count", Value::Whole(byte(2).into(), "")));
            0xFF << 40
        }
        0x04 => {
            values.push(("group", Value::Whole(byte(2).into(), "")));
            values.push(("temperature", Value::Whole(byte(4).cast_signed().into(), "°C")));
            values.push(("status_2", status(5, &STATUS_2)?));
            values.push(("status_1", status(6, &STATUS_1)?));
            values.push(("status_0", status(7, &STATUS_0)?));
            0xFF00_FFFF_FFFF
        }
        0x06 => {
            values.extend([("ab", tenth(0, "V")), ("bc", tenth(1, "V")), ("ca", tenth(2, "V"))]);
            !0xFFFF
        }
        0x08 | 0x09 | 0x1B | 0x1C => {
            values.extend([("voltage", milli(0, "V")), ("current", milli(1, "A"))]);
            u64::MAX
        }
        0x0A => {
            values.push(("maximum_voltage", Value::Whole(half(0).into(), "V")));
            values.push(("minimum_voltage", Value::Whole(half(1).into(), "V")));
            values.extend([("maximum_current", tenth(2, "A")), ("rated_power", Value::Tens(half(3), "W"))]);
            u64::MAX
        }
        0x0B => {
            let (letter, number, suffix) = (char::from(byte(0)), data >> 16 & 0xFF_FFFF_FFFF, half(3));
            if !letter.is_ascii_graphic() || number > 999_999_999_999 || suffix > 9999 {
                return None;
            }
            values.push(("value", Value::Text(data, format!("{number:012}{letter}{suffix:04}"))));
            u64::MAX
        }
        0x0C => {
            values.extend([("voltage", tenth(0, "V")), ("allowed_current", tenth(1, "A"))]);
            !0xFFFF_FFFF
        }
        0x13 => {
            values.push(("walk_in", named(["disabled", "enabled"])?));
            FIRST_BYTE
        }
        0x14 => {
            values.push(("led", named(["normal", "flashing"])?));
            FIRST_BYTE
        }
        0x16 if (1..=0x3E).contains(&byte(0)) => {
            values.push(("group", Value::Whole(byte(0).into(), "")));
            FIRST_BYTE
        }
        0x19 => {
            values.push(("sleep", named(["awake", "asleep"])?));
            FIRST_BYTE
        }
        0x1A => {
            values.push(("power", named(["on", "off"])?));
            FIRST_BYTE
        }
        0x1F => {
            values.push(("mode", named(["automatic", "dip_switch"])?));
            FIRST_BYTE
        }
        _ => return None,
    })
}

impl Value {
    /// Returns the unit, which is empty if there is none.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Whole(_, unit) | Self::Fixed { unit, .. } | Self::Tens(_, unit) | Self::Single(_, unit) => unit,
            Self::Name(..) | Self::Text(..) | Self::Status(..) => "",
        }
    }
}

/// Returns severity and name of the bits that are set.
pub fn set(raw: u8, bits: &[Bit]) -> impl Iterator<Item = (Severity, &'static str)> {
    bits.iter().enumerate().filter(move |(bit, _)| raw >> bit & 1 == 1).filter_map(|(_, known)| *known)
}
