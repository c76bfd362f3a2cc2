//! What somebody writes who needs the lines of INFY decoded fast, and nothing else. It works on one core.
//!
//! It makes the checks that `canspec decode` makes of each frame. At what it has no words for, it gives up. `format!`
//! took most of the time of a first attempt, so nothing is formatted by it.

mod json;
mod message;
mod table;

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;

use message::Message;

/// The address of the only controller of the bus.
const CONTROLLER: u32 = 0xF0;

/// Writes a log as a table, or as lines of JSON.
pub fn run(format: &str, log: &Path) -> io::Result<()> {
    let (mut log, mut out) = (BufReader::new(File::open(log)?), BufWriter::new(io::stdout().lock()));
    let is_table = format == "text";
    if is_table {
        out.write_all(table::HEADING.as_bytes())?;
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
            table::write(&mut row, line, &message, &values);
        } else {
            json::write(&mut row, number, line, &message, &values);
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

fn natural(row: &mut String, number: impl itoa::Integer) {
    row.push_str(itoa::Buffer::new().format(number));
}
