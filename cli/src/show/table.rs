//! The table of frames that `decode` writes for people.

use canspec_codegen::interpret::{Decoded, Unrecognised, Value};
use canspec_codegen::model::{Kind, Mode, Protocol, SelectorId, Side};

use crate::log;
use crate::show::columns::{Columns, Lines};
use crate::show::fields::{Field, Read, elements, fields};
use crate::show::kept::Kept;
use crate::show::line::addresses;
use crate::show::outcome::Outcome;
use crate::show::value;

/// The columns that stand before that of the identifier: stamp and channel.
const OF_STAMP: usize = 2;

const HEADINGS: [&str; 6] = ["TIME", "CHANNEL", "IDENTIFIER", "ADDRESS", "ACCESS", "MESSAGE"];

/// The digits of a day in seconds. A stamp has room for as many before its point.
const DIGITS: usize = "86400".len();

/// What stands between two signals.
const GAP: &str = "  ";

/// A table whose rows are written as their frames come.
#[derive(Clone)]
pub struct Table {
    columns: Columns,
    /// Every row says by which protocol it was read.
    several: bool,
    started: bool,
    /// Room for what may be parted before it is added.
    item: Vec<u8>,
}

impl Table {
    /// Makes columns that the names of these protocols fit.
    pub fn new(protocols: &[Protocol]) -> Self {
        let (columns, several) = (Columns::new(&HEADINGS), protocols.len() > 1);
        let mut table = Self { columns, several, started: false, item: Vec::new() };
        for protocol in protocols {
            table.make_room(protocol);
        }
        table
    }

    /// Keeps to the width of a terminal, if there is one.
    #[must_use]
    pub fn within(self, terminal: Option<usize>) -> Self {
        Self { columns: self.columns.within(terminal), ..self }
    }

    /// Makes room for the stamp and the channel of a frame that will come.
    pub fn expect(&mut self, time: Option<&str>, channel: Option<&str>) {
        self.columns.widen(&[time.unwrap_or_default(), channel.unwrap_or_default()]);
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

    /// Tests whether both tables write the same of each frame to come.
    pub fn is_like(&self, other: &Self) -> bool {
        self.started == other.started && self.columns.is_like(&other.columns)
    }

    fn message(&self, protocol: &Protocol, name: &str) -> String {
        let mut text = String::new();
        message(&mut text, self.several.then_some(protocol), name);
        text
    }

    /// Writes a frame as a row, with its notes below.
    pub fn write(&mut self, out: &mut Vec<u8>, kept: &mut Kept, outcome: &Outcome<'_>) {
        if !self.started {
            self.begin(out, outcome);
        }
        let Self { columns, several, item, .. } = self;
        let named = several.then_some(outcome.protocol);
        let line = out.len();
        columns.fill(out, 0, &[outcome.time.unwrap_or_default(), outcome.channel.unwrap_or_default()]);
        kept.fit(columns.widths());
        let mut fill = |out: &mut Vec<u8>| columns.fill(out, OF_STAMP, &cells(outcome, named));
        match outcome.decoded {
            Ok(decoded) => kept.add(out, outcome, decoded, fill),
            Err(_) => fill(out),
        }
        let mut lines = columns.lines(out, line);
        signals(&mut lines, item, outcome);
        lines.end();
    }

    /// Writes the headings above the first frame, whose cells make room for those of later ones.
    fn begin(&mut self, out: &mut Vec<u8>, outcome: &Outcome<'_>) {
        let Self { columns, several, .. } = self;
        let (time, channel) = (outcome.time.unwrap_or_default(), outcome.channel.unwrap_or_default());
        let [identifier, address, access, message] = &cells(outcome, several.then_some(outcome.protocol));
        columns.widen(&[time, channel, identifier, address, access, message]);
        columns.widen(&[&grown(time)]);
        let mut lines = columns.row(out, &HEADINGS);
        lines.add("SIGNALS", "");
        lines.end();
        self.started = true;
    }
}

/// Returns identifier, address, access and message. The name of a protocol that is given stands before the message.
fn cells(outcome: &Outcome<'_>, named: Option<&Protocol>) -> [String; 4] {
    let protocol = outcome.protocol;
    let (mut address_cell, mut message_cell) = (String::new(), String::new());
    let access = if let Ok(decoded) = outcome.decoded {
        address(&mut address_cell, outcome, decoded);
        message(&mut message_cell, named, &protocol.messages[decoded.message].name);
        protocol.accesses[decoded.access].name.clone()
    } else {
        address_cell.push('?');
        message(&mut message_cell, named, "?");
        String::new()
    };
    [log::identifier_text(outcome.frame), address_cell, access, message_cell]
}

/// Adds the name of a message, behind that of its protocol if one is given.
fn message(text: &mut String, protocol: Option<&Protocol>, name: &str) {
    if let Some(protocol) = protocol {
        text.extend([&protocol.name, "."]);
    }
    text.push_str(name);
}

/// Fills up a stamp to the width that later ones may have.
fn grown(time: &str) -> String {
    let whole = time.split('.').next().map_or(0, str::len);
    let missing = if time.is_empty() { 0 } else { DIGITS.saturating_sub(whole) };
    format!("{time}{}", " ".repeat(missing))
}

/// Returns what stands for the addresses of a frame that has none: the mode, or the module if there is but one.
fn alone_in<'a>(protocol: &'a Protocol, mode: &'a Mode) -> &'a str {
    let is_alone = protocol.sides.are_named() && protocol.address_types.is_empty();
    if is_alone { &protocol.sides.module } else { &mode.name }
}

/// Returns the longest text that a request shows in this mode, as far as the document goes.
fn widest_address(protocol: &Protocol, mode: &Mode) -> String {
    match mode.target.map(|target| &protocol.address_types[target]) {
        Some(target) => format!("→ {} {}", target.name, target.first.max(target.last)),
        None => format!("→ {}", alone_in(protocol, mode)),
    }
}

/// Adds an arrow and the addresses of a frame, but for those that everybody uses.
fn address(text: &mut String, outcome: &Outcome<'_>, decoded: &Decoded) {
    text.push_str(match (decoded.kind, decoded.sender) {
        (Kind::Request, _) => "→ ",
        (Kind::Reply, _) => "← ",
        (Kind::Report, Side::Module) => "⇐ ",
        (Kind::Report, Side::Controller) => "⇒ ",
    });
    let Some(travel) = decoded.addressing else { return text.push('?') };
    let alone = text.len();
    others(text, outcome, decoded);
    if text.len() == alone {
        text.push_str(alone_in(outcome.protocol, &outcome.protocol[travel.mode]));
    }
}

/// Adds the addresses of a frame, but for those that everybody uses.
pub fn others(text: &mut String, outcome: &Outcome<'_>, decoded: &Decoded) {
    let mut separator = "";
    for (kind, number) in addresses(outcome, decoded).filter(|(kind, number)| kind.send != Some(*number)) {
        text.extend([separator, &kind.name]);
        text.extend([" ", itoa::Buffer::new().format(number)]);
        separator = ", ";
    }
}

/// Adds the items of the last column. `item` is room to write in.
fn signals(lines: &mut Lines<'_>, item: &mut Vec<u8>, outcome: &Outcome<'_>) {
    match outcome.decoded {
        Ok(decoded) if decoded.is_error_reply() => refusal(lines, outcome, decoded),
        Ok(decoded) => {
            for (name, value) in open_selectors(outcome.protocol, decoded) {
                lines.add_by(|text| push(text, [name, " ", &value, GAP]));
            }
            let content = decoded.content(outcome.protocol);
            for (name, field) in fields(content, decoded) {
                let add = |text: &mut Vec<u8>| {
                    push(text, [name, " "]);
                    match field {
                        Field::Signal(read) => add_signal(text, outcome.protocol, read),
                        Field::Array(id) => array(text, outcome.protocol, &elements(content, decoded, id)),
                    }
                    push(text, [GAP]);
                };
                if may_be_parted(&field) {
                    item.clear();
                    add(item);
                    let pieces = str::from_utf8(item).unwrap_or_default().split_inclusive(", ");
                    pieces.for_each(|piece| lines.add_by(|text| push(text, [piece])));
                } else {
                    lines.add_by(add);
                }
            }
            decoded.notes.iter().for_each(|note| remark(lines, note.rule.name(), &note.text));
            if let Some(text) = outcome.whole.as_ref().and_then(|whole| whole.incomplete) {
                lines.add_sentence(&format!("! {text}"));
            }
        }
        Err(Unrecognised { problem, text, .. }) => {
            let data = log::hexadecimal(&outcome.frame.data);
            let separated = if data.is_empty() { data } else { data + GAP };
            lines.add_sentence(&format!("{separated}! {}: {text}", problem.name()));
        }
    }
}

/// Returns the fields of the header that neither the message nor its access fixes, and their values. Those that tell an
/// error are none, since a note says it.
fn open_selectors<'a>(protocol: &'a Protocol, decoded: &'a Decoded) -> impl Iterator<Item = (&'a str, String)> {
    let is_fixed = |id: SelectorId| {
        let mut layouts = protocol.layouts_of(&protocol[decoded.message]);
        let layout = layouts.find(|layout| (layout.access, layout.kind) == (decoded.access, decoded.kind));
        layout
            .is_some_and(|layout| layout.constants.iter().any(|constant| constant.selector == id && constant.open == 0))
    };
    let is_open = move |(id, _): &&(SelectorId, u64)| protocol[*id].normal.is_none() && !is_fixed(*id);
    let open = decoded.selectors.iter().filter(is_open);
    open.map(|(id, raw)| (protocol[*id].name.as_str(), protocol.selector_value(*id, *raw)))
}

/// Adds the data of a frame that reports an error in place of its values, and why.
fn refusal(lines: &mut Lines<'_>, outcome: &Outcome<'_>, decoded: &Decoded) {
    let what = if decoded.kind == Kind::Reply { "refused" } else { "in error" };
    let data = log::hexadecimal(&outcome.frame.data);
    let separator = if data.is_empty() { "" } else { ", data " };
    lines.add(&format!("{what}{separator}{data}"), "");
    let notes = decoded.notes.iter().filter(|note| !note.is_about_value());
    notes.for_each(|note| remark(lines, note.rule.name(), &note.text));
}

fn remark(lines: &mut Lines<'_>, rule: &str, text: &str) {
    lines.add_sentence(&format!("! {rule}: {text}"));
}

/// Tests whether values may be long, so that they are parted after a comma.
fn may_be_parted(field: &Field) -> bool {
    match field {
        Field::Signal((_, reading)) => matches!(reading.value, Value::Text(_) | Value::Status { .. }),
        Field::Array(_) => true,
    }
}

/// Adds the value of a signal, and its unit.
fn add_signal(text: &mut Vec<u8>, protocol: &Protocol, (signal, reading): Read) {
    value::write(text, protocol, signal, reading);
    unit(text, (signal, reading));
}

/// Adds the values of an array in brackets, and their unit once.
fn array(text: &mut Vec<u8>, protocol: &Protocol, elements: &[Option<Read>]) {
    let mut separator = "[";
    for element in elements {
        push(text, [separator]);
        match element {
            Some((signal, reading)) => value::write(text, protocol, signal, reading),
            None => text.push(b'-'),
        }
        separator = ", ";
    }
    text.push(b']');
    let is_number = |(_, reading): &&Read| matches!(reading.value, Value::Integer(_) | Value::Number(_));
    if let Some(read) = elements.iter().flatten().find(is_number) {
        unit(text, *read);
    }
}

/// Adds the unit of a number.
fn unit(text: &mut Vec<u8>, (signal, reading): Read) {
    if let (Value::Integer(_) | Value::Number(_), Some(unit)) = (&reading.value, signal.unit) {
        push(text, [" ", &unit.symbol]);
    }
}

/// Adds texts one behind the other.
pub fn push<const N: usize>(text: &mut Vec<u8>, parts: [&str; N]) {
    for part in parts {
        text.extend_from_slice(part.as_bytes());
    }
}
