//! A row of CSV a signal, as programs for tables of data want it.

use std::borrow::Cow;
use std::iter::repeat_n;

use canspec_codegen::interpret::{Decoded, Note, Reading, Unrecognised, Value, escape};

use crate::log;
use crate::show::kept::Kept;
use crate::show::line::{all_selectors, bit_names, integer, natural, selected};
use crate::show::outcome::Outcome;
use crate::show::table::{others, push};

const HEADING: &str =
    "line,time,channel,id,protocol,message,access,kind,address,signal,raw,value,unit,notes,data,selectors\n";

/// Rows that are written as their frames come.
#[derive(Clone, Default, PartialEq)]
pub struct Rows {
    started: bool,
}

impl Rows {
    /// Writes a row for each signal of a frame, or one if it has none.
    pub fn write(&mut self, out: &mut Vec<u8>, kept: &mut Kept, outcome: &Outcome<'_>) {
        out.extend_from_slice(self.begin().as_bytes());
        let readings = outcome.decoded.as_ref().map_or(&[][..], |decoded| &decoded.signals);
        let start = out.len();
        of_frame(out, kept, outcome);
        let head = start..out.len();
        of_signal(out, outcome, readings.first());
        let start = out.len();
        of_data(out, outcome);
        let tail = start..out.len();
        for reading in readings.iter().skip(1) {
            out.extend_from_within(head.clone());
            of_signal(out, outcome, Some(reading));
            out.extend_from_within(tail.clone());
        }
    }

    /// Returns the heading, if it is not written yet.
    pub fn begin(&mut self) -> &'static str {
        if std::mem::replace(&mut self.started, true) { "" } else { HEADING }
    }
}

/// Writes the cells with which each row of a frame begins.
fn of_frame(out: &mut Vec<u8>, kept: &mut Kept, outcome: &Outcome<'_>) {
    cell(out, |out| natural(out, outcome.line as u64));
    text(out, outcome.time.unwrap_or_default());
    text(out, &neutral(outcome.channel.unwrap_or_default()));
    match outcome.decoded {
        Ok(decoded) => kept.add(out, outcome, decoded, |out| of_identifier(out, outcome, Some(decoded))),
        Err(_) => of_identifier(out, outcome, None),
    }
}

/// Writes identifier, protocol, message, access, kind and address.
fn of_identifier(out: &mut Vec<u8>, outcome: &Outcome<'_>, decoded: Option<&Decoded>) {
    let (protocol, mut address) = (outcome.protocol, String::new());
    cell(out, |out| log::write_identifier(out, outcome.frame));
    text(out, &protocol.name);
    let names = decoded.map_or([""; 3], |decoded| {
        others(&mut address, outcome, decoded);
        [&protocol[decoded.message].name, &protocol[decoded.access].name, decoded.kind.name()]
    });
    for name in names {
        text(out, name);
    }
    text(out, &address);
}

/// Writes name, raw number, value and unit of a signal.
fn of_signal(out: &mut Vec<u8>, outcome: &Outcome<'_>, reading: Option<&Reading>) {
    let (Ok(decoded), Some(reading)) = (outcome.decoded, reading) else { return out.extend_from_slice(b",,,,") };
    let signal = decoded.content(outcome.protocol).signals[reading.signal].on(decoded.model);
    text(out, &signal.name);
    cell(out, |out| match signal.run {
        Some(_) => log::write_hexadecimal(out, &reading.bytes),
        None => integer(out, signal.raw_of(reading.bits)),
    });
    cell(out, |out| match &reading.value {
        // It would look like a measurement.
        _ if decoded.is_error_reply() => {}
        Value::None => {}
        Value::Integer(number) => integer(out, *number),
        Value::Number(number) => push(out, [&format!("{number:?}")]),
        Value::Name(name) => push(out, [name]),
        Value::Text(text) => push(out, [&neutral(&escape::written(text))]),
        Value::Status { set, .. } => joined(out, " ", bit_names(outcome.protocol, signal, *set).map(|name| [name])),
    });
    text(out, &neutral(signal.unit.as_ref().map_or("", |unit| &unit.symbol)));
}

/// Writes the cells with which each row of a frame ends: notes, data and selectors.
fn of_data(out: &mut Vec<u8>, outcome: &Outcome<'_>) {
    cell(out, |out| notes(out, outcome));
    let of_whole = outcome.whole.as_ref().map(|whole| whole.data.unwrap_or_default());
    cell(out, |out| log::write_hexadecimal(out, of_whole.unwrap_or(&outcome.frame.data)));
    cell(out, |out| match outcome.decoded {
        Ok(decoded) => pairs(out, all_selectors(outcome, decoded)),
        Err(Unrecognised { selectors, .. }) => pairs(out, selected(outcome.protocol, selectors)),
    });
    out.pop();
    out.push(b'\n');
}

fn notes(out: &mut Vec<u8>, outcome: &Outcome<'_>) {
    let incomplete = outcome.whole.as_ref().and_then(|whole| whole.incomplete).map(|text| ["incomplete", ": ", text]);
    match outcome.decoded {
        Ok(decoded) => {
            let notes = decoded.notes.iter().map(|Note { rule, text }| [rule.name(), ": ", text]);
            joined(out, "; ", notes.chain(incomplete));
        }
        Err(Unrecognised { problem, text, .. }) => push(out, [problem.name(), ": ", text]),
    }
}

/// Writes numbers with their names.
fn pairs<'a>(out: &mut Vec<u8>, selectors: impl Iterator<Item = (&'a str, u64)>) {
    let mut number = itoa::Buffer::new();
    for (index, (name, value)) in selectors.enumerate() {
        push(out, [if index == 0 { "" } else { " " }, name, "=", number.format(value)]);
    }
}

/// Writes items with something between them.
fn joined<'a, const N: usize>(out: &mut Vec<u8>, separator: &str, items: impl Iterator<Item = [&'a str; N]>) {
    for (index, item) in items.enumerate() {
        push(out, [if index == 0 { "" } else { separator }]);
        push(out, item);
    }
}

/// Writes a cell that holds a text.
fn text(out: &mut Vec<u8>, text: &str) {
    cell(out, |out| push(out, [text]));
}

/// Begins a text with an apostrophe if a spreadsheet could take it for a formula. One that begins with an apostrophe gets
/// another, so that both can be told apart.
fn neutral(text: &str) -> Cow<'_, str> {
    if text.starts_with(['=', '+', '-', '@', '\'']) { Cow::Owned(format!("'{text}")) } else { Cow::Borrowed(text) }
}

/// Writes a cell and the comma behind it. What could be taken for the end of a cell is put into quotes, by RFC 4180.
fn cell(out: &mut Vec<u8>, write: impl FnOnce(&mut Vec<u8>)) {
    let start = out.len();
    write(out);
    if out[start..].iter().any(|byte| matches!(byte, b',' | b'"' | b'\n' | b'\r')) {
        let bare = out.split_off(start);
        out.push(b'"');
        let quotes = |byte| if byte == b'"' { 2 } else { 1 };
        out.extend(bare.into_iter().flat_map(|byte| repeat_n(byte, quotes(byte))));
        out.push(b'"');
    }
    out.push(b',');
}

#[cfg(test)]
mod tests {
    use super::{neutral, text};

    #[test]
    fn a_text_that_looks_like_a_formula_begins_with_an_apostrophe() {
        for (text, expected) in [
            ("=1+2", "'=1+2"),
            ("+49", "'+49"),
            ("-5", "'-5"),
            ("@SUM", "'@SUM"),
            ("'a", "''a"),
            ("a=b", "a=b"),
            ("", ""),
        ] {
            assert_eq!(neutral(text), expected);
        }
    }

    #[test]
    fn a_cell_is_quoted_where_it_could_end_too_early() {
        for (cell, expected) in
            [("a b", "a b,"), ("a,b", "\"a,b\","), ("a\"b", "\"a\"\"b\","), ("a\nb", "\"a\nb\","), ("", ",")]
        {
            let mut out = b"x,".to_vec();
            text(&mut out, cell);
            assert_eq!(String::from_utf8(out), Ok(format!("x,{expected}")));
        }
    }
}
