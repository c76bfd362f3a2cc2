//! The table for people.

use super::message::{Message, Value, set};
use super::{Line, natural};

pub const HEADING: &str =
    "TIME               CHANNEL  IDENTIFIER  ADDRESS       ACCESS      MESSAGE              SIGNALS\n";

/// Where the last column of the table begins, and its width.
const LEFT: usize = 87;
const ROOM: usize = 53;

const BLANKS: &str = "                                                                                       ";

/// Writes a row of the table.
pub fn write(row: &mut String, line: &Line, message: &Message, values: &[(&str, Value)]) {
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
}
