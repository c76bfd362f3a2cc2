//! Lines of JSON.

use super::message::{Bit, Message, Severity, Value, set};
use super::{Line, natural};
use Severity::{Alarm, Fault, State};

/// Writes a line of JSON.
pub fn write(row: &mut String, number: u32, line: &Line, message: &Message, values: &[(&str, Value)]) {
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

impl Value {
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
