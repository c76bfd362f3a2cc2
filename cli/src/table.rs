//! The table of frames that `decode` writes for people.

use std::io::{self, Write};

use canspec_codegen::interpret::{Decoded, Note, Reading, Unrecognised, Value};
use canspec_codegen::model::{AddressPattern, Kind, Mode, Protocol};

use crate::columns::{Columns, wrap};
use crate::line::Outcome;
use crate::log;
use crate::value;

const HEADINGS: [&str; 6] = ["TIME", "CHANNEL", "IDENTIFIER", "ADDRESS", "ACCESS", "MESSAGE"];

/// The digits of a day in seconds. A stamp has room for as many before its point.
const DIGITS: usize = "86400".len();

/// What stands between two signals.
const GAP: &str = "  ";

/// A table whose rows are written as their frames come.
pub struct Table {
    columns: Columns,
    /// Every row says by which protocol it was read.
    several: bool,
    started: bool,
}

impl Table {
    /// Makes columns that the names of these protocols fit.
    pub fn new(protocols: &[Protocol]) -> Self {
        let mut table = Self { columns: Columns::new(&HEADINGS), several: protocols.len() > 1, started: false };
        for protocol in protocols {
            table.make_room(protocol);
        }
        table
    }

    fn make_room(&mut self, protocol: &Protocol) {
        for mode in &protocol.modes {
            self.columns.widen(&["", "", "", &widest_address(protocol, mode)]);
        }
        for access in &protocol.accesses {
            self.columns.widen(&["", "", "", "", &access.name]);
        }
        for message in &protocol.messages {
            self.columns.widen(&["", "", "", "", "", &self.message(protocol, &message.name)]);
        }
    }

    fn message(&self, protocol: &Protocol, name: &str) -> String {
        if self.several { format!("{}.{name}", protocol.name) } else { name.to_owned() }
    }

    /// Writes a frame as a row, with its notes below.
    ///
    /// # Errors
    ///
    /// Where `out` cannot be written.
    pub fn write(&mut self, out: &mut impl Write, outcome: &Outcome<'_>) -> io::Result<()> {
        let (address, access, message) = self.names(outcome);
        let identifier = log::identifier_text(outcome.frame);
        let time = outcome.time.map_or("", |time| time.get());
        let cells = [time, outcome.channel.unwrap_or(""), &identifier, &address, access, &message];
        self.columns.widen(&cells);
        if !self.started {
            self.columns.widen(&[&grown(time)]);
            self.columns.write(out, &HEADINGS, &["SIGNALS".to_owned()])?;
            self.started = true;
        }
        let lines = lines(outcome, self.columns.room());
        self.columns.write(out, &cells, &lines)
    }

    /// Returns what stands under address, access and message.
    fn names<'a>(&self, outcome: &Outcome<'a>) -> (String, &'a str, String) {
        let protocol = outcome.protocol;
        match outcome.decoded {
            Ok(decoded) => {
                let message = self.message(protocol, &protocol.messages[decoded.message].name);
                (address(protocol, decoded, outcome.frame.id), &protocol.accesses[decoded.access].name, message)
            }
            Err(_) => ("?".to_owned(), "", self.message(protocol, "?")),
        }
    }
}

/// Fills up a stamp to the width that later ones may have.
fn grown(time: &str) -> String {
    let whole = time.split('.').next().map_or(0, str::len);
    let missing = if time.is_empty() { 0 } else { DIGITS.saturating_sub(whole) };
    format!("{time}{}", " ".repeat(missing))
}

/// Returns the longest text that a request shows in this mode, as far as the document goes.
fn widest_address(protocol: &Protocol, mode: &Mode) -> String {
    match mode.target.map(|target| &protocol.address_types[target]) {
        Some(target) => format!("→ {} {}", target.name, target.first.max(target.last)),
        None => format!("→ {}", mode.name),
    }
}

/// Returns an arrow and the addresses of a frame, but for those that everybody uses.
fn address(protocol: &Protocol, decoded: &Decoded, id: u32) -> String {
    let arrow = match decoded.kind {
        Kind::Request => "→",
        Kind::Reply => "←",
        Kind::Report => "⇐",
    };
    let Some(travel) = decoded.addressing else { return format!("{arrow} ?") };
    let mode = &protocol[travel.mode];
    let pattern = mode.pattern(decoded.kind, travel.who);
    let addresses = pattern.map_or(Vec::new(), |pattern| addresses(protocol, pattern, id));
    if addresses.is_empty() { format!("{arrow} {}", mode.name) } else { format!("{arrow} {}", addresses.join(", ")) }
}

fn addresses(protocol: &Protocol, pattern: &AddressPattern, id: u32) -> Vec<String> {
    let mut addresses = Vec::new();
    for address in &pattern.addresses {
        let address_type = &protocol.address_types[address.address_type];
        let number = address_type.number(protocol.identifier.fields[address.field].get(id));
        if address_type.send != Some(number) {
            addresses.push(format!("{} {number}", address_type.name));
        }
    }
    addresses
}

/// Returns the lines of the last column.
fn lines(outcome: &Outcome<'_>, room: usize) -> Vec<String> {
    match outcome.decoded {
        Ok(decoded) if decoded.is_error_reply() => refusal(outcome, decoded, room),
        Ok(decoded) => {
            let signals = decoded.signals.iter().map(|reading| signal(outcome.protocol, decoded, reading));
            let texts: Vec<String> = signals.map(|text| text + GAP).collect();
            let pieces = texts.iter().flat_map(|text| text.split_inclusive(", "));
            let mut lines = wrap(pieces, "", room + 1);
            lines.extend(decoded.notes.iter().flat_map(|Note { rule, text }| remark(rule.name(), text, room)));
            lines
        }
        Err(Unrecognised { problem, text, .. }) => {
            let data = log::hexadecimal(&outcome.frame.data);
            let separated = if data.is_empty() { data } else { data + GAP };
            wrap(format!("{separated}! {}: {text}", problem.name()).split(' '), " ", room)
        }
    }
}

/// Returns the data of a frame that reports an error in place of its values, and why.
fn refusal(outcome: &Outcome<'_>, decoded: &Decoded, room: usize) -> Vec<String> {
    let what = if decoded.kind == Kind::Reply { "refused" } else { "in error" };
    let data = log::hexadecimal(&outcome.frame.data);
    let separator = if data.is_empty() { "" } else { ", data " };
    let mut lines = vec![format!("{what}{separator}{data}")];
    let notes = decoded.notes.iter().filter(|note| !note.is_about_value());
    lines.extend(notes.flat_map(|Note { rule, text }| remark(rule.name(), text, room)));
    lines
}

fn remark(rule: &str, text: &str, room: usize) -> Vec<String> {
    wrap(format!("! {rule}: {text}").split(' '), " ", room)
}

fn signal(protocol: &Protocol, decoded: &Decoded, reading: &Reading) -> String {
    let signal = &protocol.messages[decoded.message].signals[reading.signal];
    let value = value::shown(protocol, signal, reading);
    match (&reading.value, signal.unit) {
        (Value::Integer(_) | Value::Number(_), Some(unit)) => format!("{} {value} {}", signal.name, unit.symbol),
        _ => format!("{} {value}", signal.name),
    }
}
