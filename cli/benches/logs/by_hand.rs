//! What somebody writes who needs the lines of INFY decoded fast, and nothing else. It works on one core.
//!
//! It makes the checks that `canspec decode` makes of each frame. At what it has no words for, it gives up. As `format!`
//! takes most of the time of a first attempt, nothing is formatted by it.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;

use Severity::{Alarm, Fault, State};

/// The address of the only controller of the bus.
const CONTROLLER: u32 = 0xF0;

const HEADING: &str =
    "TIME               CHANNEL  IDENTIFIER  ADDRESS       ACCESS      MESSAGE              SIGNALS\n";

/// Where the last column of the table begins, and its width.
const LEFT: usize = 87;
const ROOM: usize = 53;

/// Writes a log as a table, or as lines of JSON.
pub fn run(format: &str, log: &Path) -> io::Result<()> {
    let (mut log, mut out) = (BufReader::new(File::open(log)?), BufWriter::new(io::stdout().lock()));
    let is_table = format == "text";
    if is_table {
        out.write_all(HEADING.as_bytes())?;
    }
    let (mut text, mut row, mut values) = (String::new(), String::new(), Vec::new());
    for number in 1.. {
        text.clear();
        row.clear();
        values.clear();
        if log.read_line(&mut text)? == 0 {
            break;
        }
        let line = Line::read(text.trim_end());
        let message = line.as_ref().and_then(|line| Some((line, Message::read(line, &mut values)?)));
        let Some((line, message)) = message else {
            return Err(io::Error::other(format!("line {number} has what this program does not know")));
        };
        if is_table {
            table(&mut row, line, &message, &values);
        } else {
            object(&mut row, number, line, &message, &values);
        }
        out.write_all(row.as_bytes())?;
    }
    out.flush()
}

/// A line of candump.
struct Line<'a> {
    time: &'a str,
    channel: &'a str,
    /// The digits of identifier and data.
    shown: [&'a str; 2],
    id: u32,
    data: u64,
}

impl<'a> Line<'a> {
    /// Reads `(TIME) CHANNEL ID#DATA` with 29 bits and eight bytes.
    fn read(line: &'a str) -> Option<Self> {
        let (time, rest) = line.strip_prefix('(')?.split_once(')')?;
        let (channel, frame) = rest.strip_prefix(' ')?.split_once(' ')?;
        let (id, data) = frame.split_once('#')?;
        let is_stamp = time.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
        let is_name = channel.bytes().all(|byte| byte.is_ascii_alphanumeric());
        if !is_stamp || !is_name || id.len() != 8 || data.len() != 16 {
            return None;
        }
        let shown = [id, data];
        let (id, data) = (u32::try_from(hexadecimal(id)?).ok()?, hexadecimal(data)?);
        Some(Self { time, channel, shown, id, data })
    }
}

/// Reads digits that have no small letters.
fn hexadecimal(digits: &str) -> Option<u64> {
    digits.bytes().try_fold(0, |number, digit| {
        let digit = match digit {
            b'0'..=b'9' => digit - b'0',
            b'A'..=b'F' => digit - b'A' + 10,
            _ => return None,
        };
        Some(number << 4 | u64::from(digit))
    })
}

/// What a frame is beside its values.
struct Message {
    name: &'static str,
    access: &'static str,
    is_request: bool,
    mode: &'static str,
    /// The kind of the address beside the controller's, and the address.
    address: Option<(&'static str, u32)>,
}

enum Value {
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
type Bit = Option<(Severity, &'static str)>;

#[derive(Clone, Copy, PartialEq)]
enum Severity {
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
    fn read(line: &Line, values: &mut Vec<(&'static str, Value)>) -> Option<Self> {
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

const BLANKS: &str = "                                                                                       ";

/// Writes a row of the table.
fn table(row: &mut String, line: &Line, message: &Message, values: &[(&str, Value)]) {
    cell(row, line.time, 17);
    cell(row, line.channel, 7);
    cell(row, line.shown[0], 10);
    let start = row.len();
    row.push_str(if message.is_request { "→ " } else { "← " });
    match message.address {
        Some((kind, number)) => {
            row.extend([kind, " "]);
            natural(row, number);
        }
        None => row.push_str(message.mode),
    }
    // An arrow has three bytes.
    row.push_str(&BLANKS[..start + 16 - row.len()]);
    cell(row, message.access, 10);
    cell(row, message.name, 19);
    let mut width = 0;
    for (name, value) in values {
        let start = row.len();
        row.extend([name, " "]);
        value.show(row);
        row.push_str("  ");
        if !matches!(value, Value::Status(..)) {
            place(row, start, &mut width);
            continue;
        }
        let item = row.split_off(start);
        for part in item.split_inclusive(", ") {
            let start = row.len();
            row.push_str(part);
            place(row, start, &mut width);
        }
    }
    end_line(row);
}

fn cell(row: &mut String, text: &str, width: usize) {
    row.push_str(text);
    row.push_str(&BLANKS[..width.saturating_sub(text.len()) + 2]);
}

fn natural(row: &mut String, number: impl itoa::Integer) {
    row.push_str(itoa::Buffer::new().format(number));
}

/// Moves what was written since `start` into a line of its own if it does not fit into the last one.
fn place(row: &mut String, start: usize, width: &mut usize) {
    let added = row[start..].chars().count();
    // A blank may stand beyond the column.
    if *width > 0 && *width + added > ROOM + 1 {
        let item = row.split_off(start);
        end_line(row);
        row.extend([&BLANKS[..LEFT], &item]);
        *width = 0;
    }
    *width += added;
}

/// Ends a line without the blanks at its end.
fn end_line(row: &mut String) {
    row.truncate(row.trim_end().len());
    row.push('\n');
}

impl Value {
    /// Writes what the table shows.
    fn show(&self, row: &mut String) {
        match self {
            Self::Whole(value, _) => natural(row, *value),
            Self::Fixed { raw, decimals, .. } => {
                let unit = 10_u32.pow(*decimals);
                natural(row, raw / unit);
                row.push('.');
                let fraction = raw % unit;
                (1..*decimals).filter(|place| fraction < 10_u32.pow(*place)).for_each(|_| row.push('0'));
                natural(row, fraction);
            }
            Self::Tens(raw, _) => natural(row, raw * 10),
            Self::Single(bits, _) => row.push_str(zmij::Buffer::new().format(f32::from_bits(*bits))),
            Self::Name(_, name) => row.push_str(name),
            Self::Text(_, text) => row.push_str(text),
            Self::Status(raw, bits) => {
                let mut separator = "{";
                for (_, name) in set(*raw, bits) {
                    row.extend([separator, name]);
                    separator = ", ";
                }
                row.push_str(if separator == "{" { "{}" } else { "}" });
            }
        }
        let unit = self.unit();
        if !unit.is_empty() {
            row.extend([" ", unit]);
        }
    }

    fn unit(&self) -> &'static str {
        match self {
            Self::Whole(_, unit) | Self::Fixed { unit, .. } | Self::Tens(_, unit) | Self::Single(_, unit) => unit,
            Self::Name(..) | Self::Text(..) | Self::Status(..) => "",
        }
    }

    /// Writes the members of an object.
    fn members(&self, row: &mut String) {
        row.push_str("\"raw\":");
        match self {
            Self::Whole(value, _) => natural(row, *value),
            Self::Fixed { raw, .. } | Self::Tens(raw, _) | Self::Single(raw, _) => natural(row, *raw),
            Self::Name(raw, _) => natural(row, *raw),
            Self::Text(raw, _) => natural(row, *raw),
            Self::Status(raw, bits) => return status(row, *raw, bits),
        }
        row.push_str(",\"value\":");
        let mut number = |value: f64| row.push_str(zmij::Buffer::new().format(value));
        match self {
            Self::Whole(value, _) => natural(row, *value),
            Self::Fixed { raw, decimals, .. } => number(f64::from(*raw) / f64::from(10_u32.pow(*decimals))),
            Self::Tens(raw, _) => number(f64::from(*raw) * 10.0),
            Self::Single(bits, _) => number(f32::from_bits(*bits).into()),
            Self::Name(_, name) => row.extend(["\"", name, "\""]),
            Self::Text(_, text) => row.extend(["\"", text, "\""]),
            Self::Status(..) => {}
        }
        let unit = self.unit();
        if !unit.is_empty() {
            row.extend([",\"unit\":\"", unit, "\""]);
        }
    }
}

/// Returns severity and name of the bits that are set.
fn set(raw: u8, bits: &[Bit]) -> impl Iterator<Item = (Severity, &'static str)> {
    bits.iter().enumerate().filter(move |(bit, _)| raw >> bit & 1 == 1).filter_map(|(_, known)| *known)
}

/// Writes the members of a status word.
fn status(row: &mut String, raw: u8, bits: &[Bit]) {
    natural(row, raw);
    row.push_str(",\"set\":");
    list(row, set(raw, bits).map(|(_, name)| name));
    row.push_str(",\"unknown\":0");
    let mut separator = ",\"severity\":{\"";
    for (severity, word) in [(Fault, "fault"), (Alarm, "alarm"), (State, "state")] {
        let of = || set(raw, bits).filter(|(of, _)| *of == severity).map(|(_, name)| name);
        if of().next().is_some() {
            row.extend([separator, word, "\":"]);
            list(row, of());
            separator = ",\"";
        }
    }
    row.push_str(if raw == 0 { "" } else { "}" });
}

fn list(row: &mut String, names: impl Iterator<Item = &'static str>) {
    let mut separator = "[\"";
    for name in names {
        row.extend([separator, name, "\""]);
        separator = ",\"";
    }
    row.push_str(if separator == "[\"" { "[]" } else { "]" });
}

/// Writes a line of JSON.
fn object(row: &mut String, number: u32, line: &Line, message: &Message, values: &[(&str, Value)]) {
    let Message { name, access, is_request, mode, address } = message;
    let Line { time, channel, shown: [id, data], .. } = line;
    row.push_str("{\"line\":");
    natural(row, number);
    row.extend([",\"time\":", time, ",\"channel\":\"", channel, "\",\"id\":\"", id, "\",\"data\":\"", data]);
    row.extend(["\",\"protocol\":\"infy\",\"message\":\"", name, "\",\"access\":\"", access, "\",\"kind\":\""]);
    row.extend([if *is_request { "request" } else { "reply" }, "\",\"addressing\":\"", mode, "\",\"addresses\":{"]);
    match address {
        Some((kind, number)) if *is_request => {
            row.extend(["\"", kind, "\":"]);
            natural(row, *number);
            row.push_str(",\"controller\":240");
        }
        Some((kind, number)) => {
            row.extend(["\"controller\":240,\"", kind, "\":"]);
            natural(row, *number);
        }
        None => row.push_str("\"controller\":240"),
    }
    let [.., target, source] = line.id.to_be_bytes();
    row.push_str("},\"identifier\":{\"error\":0,\"device\":");
    natural(row, line.id >> 22);
    row.push_str(",\"command\":");
    natural(row, line.id >> 16 & 0x3F);
    row.push_str(",\"target\":");
    natural(row, target);
    row.push_str(",\"source\":");
    natural(row, source);
    row.push_str("},\"selectors\":{},\"signals\":{");
    let mut separator = "\"";
    for (name, value) in values {
        row.extend([separator, name, "\":{"]);
        value.members(row);
        row.push('}');
        separator = ",\"";
    }
    row.push_str("},\"notes\":[]}\n");
}
