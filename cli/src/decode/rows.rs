//! A row of CSV a signal, as programs for tables of data want it.

use std::borrow::Cow;

use canspec_codegen::interpret::{Decoded, Note, Reading, Unrecognised, Value, escape};

use crate::line::{Outcome, all_selectors, bit_names, selected};
use crate::log;
use crate::table::others;

const HEADING: &str =
    "line,time,channel,id,protocol,message,access,kind,address,signal,raw,value,unit,notes,data,selectors\n";

/// Rows that are written as their frames come.
#[derive(Clone, Default, PartialEq)]
pub struct Rows {
    started: bool,
}

impl Rows {
    /// Writes a row for each signal of a frame, or one if it has none.
    pub fn write(&mut self, out: &mut Vec<u8>, outcome: &Outcome<'_>) {
        out.extend_from_slice(self.begin().as_bytes());
        let mut address = String::new();
        let (names, readings, notes, selectors) = match outcome.decoded {
            Ok(decoded) => {
                others(&mut address, outcome, decoded);
                let notes = notes(outcome, &decoded.notes);
                (names(outcome, decoded), &decoded.signals[..], notes, pairs(all_selectors(outcome, decoded)))
            }
            Err(Unrecognised { problem, text, selectors, .. }) => {
                let notes = format!("{}: {text}", problem.name());
                (Default::default(), &[][..], notes, pairs(selected(outcome.protocol, selectors)))
            }
        };
        let line = outcome.line.to_string();
        let (time, channel) = (outcome.time.unwrap_or_default(), &neutral(outcome.channel.unwrap_or_default()));
        let of_whole = outcome.whole.as_ref().map(|whole| whole.data.unwrap_or_default());
        let data = log::hexadecimal(of_whole.unwrap_or(&outcome.frame.data));
        let id = log::identifier_text(outcome.frame);
        let frame =
            [&line, time, channel, &id, &outcome.protocol.name].into_iter().chain(names).chain([address.as_str()]);
        let signals = readings.iter().map(|reading| cells(outcome, reading));
        let signals: Vec<_> = if readings.is_empty() { vec![Default::default()] } else { signals.collect() };
        let behind = [notes.as_str(), &data, &selectors];
        for signal in signals {
            let cells = frame.clone().chain(signal.iter().map(String::as_str)).chain(behind);
            out.extend_from_slice(cells.map(quoted).collect::<Vec<_>>().join(",").as_bytes());
            out.push(b'\n');
        }
    }

    /// Returns the heading, if it is not written yet.
    pub fn begin(&mut self) -> &'static str {
        if std::mem::replace(&mut self.started, true) { "" } else { HEADING }
    }
}

/// Writes numbers with their names.
fn pairs<'a>(selectors: impl Iterator<Item = (&'a str, u64)>) -> String {
    selectors.map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(" ")
}

/// Returns message, access and kind.
fn names<'a>(outcome: &Outcome<'a>, decoded: &Decoded) -> [&'a str; 3] {
    let protocol = outcome.protocol;
    [&protocol.messages[decoded.message].name, &protocol.accesses[decoded.access].name, decoded.kind.name()]
}

/// Returns name, raw number, value and unit of a signal.
fn cells(outcome: &Outcome<'_>, reading: &Reading) -> [String; 4] {
    let Ok(decoded) = outcome.decoded else { return Default::default() };
    let signal = decoded.content(outcome.protocol).signals[reading.signal].on(decoded.model);
    let value = match &reading.value {
        // It would look like a measurement.
        _ if decoded.is_error_reply() => String::new(),
        Value::None => String::new(),
        Value::Integer(number) => number.to_string(),
        Value::Number(number) => format!("{number:?}"),
        Value::Name(name) => name.clone(),
        Value::Text(text) => neutral(&escape::written(text)).into_owned(),
        Value::Status { set, .. } => bit_names(outcome.protocol, signal, *set).collect::<Vec<_>>().join(" "),
    };
    let unit = signal.unit.map_or_else(String::new, |unit| unit.symbol.to_string());
    let raw = match signal.run {
        Some(_) => log::hexadecimal(&reading.bytes),
        None => signal.raw_of(reading.bits).to_string(),
    };
    [signal.name.clone(), raw, value, unit]
}

fn notes(outcome: &Outcome<'_>, notes: &[Note]) -> String {
    let incomplete = outcome.whole.as_ref().and_then(|whole| whole.incomplete);
    let incomplete = incomplete.map(|text| format!("incomplete: {text}"));
    let texts = notes.iter().map(|Note { rule, text }| format!("{}: {text}", rule.name())).chain(incomplete);
    texts.collect::<Vec<_>>().join("; ")
}

/// Begins a text with an apostrophe if a spreadsheet could take it for a formula. One that begins with an apostrophe gets
/// another, so that both can be told apart.
fn neutral(text: &str) -> Cow<'_, str> {
    if text.starts_with(['=', '+', '-', '@', '\'']) { Cow::Owned(format!("'{text}")) } else { Cow::Borrowed(text) }
}

/// Puts what could be taken for the end of a cell into quotes, by RFC 4180.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{neutral, quoted};

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
            [("a b", "a b"), ("a,b", "\"a,b\""), ("a\"b", "\"a\"\"b\""), ("a\nb", "\"a\nb\""), ("", "")]
        {
            assert_eq!(quoted(cell), expected);
        }
    }
}
