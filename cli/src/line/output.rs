//! Turns a decoded frame into a line of JSON.

use std::io::{self, Write};

use canspec_codegen::interpret::{Decoded, Frame, Reading, Unrecognised, Value};
use canspec_codegen::model::{AddressType, FieldId, Protocol, SelectorId, Signal, StatusBit, Table};

use crate::fields::{Field, Read, fields};
use crate::line::json::{integer, list, long_integer, members, name, object, optional, text};
use crate::line::transport;
use crate::log;
use crate::severity::Severity;

/// A frame of a log, and what a protocol makes of it.
pub struct Outcome<'a> {
    pub line: usize,
    /// The text of a number of JSON.
    pub time: Option<&'a str>,
    pub channel: Option<&'a str>,
    pub frame: &'a Frame,
    pub protocol: &'a Protocol,
    pub decoded: &'a Result<Decoded, Unrecognised>,
    /// What several frames say together; `None` for a frame.
    pub whole: Option<Whole<'a>>,
}

/// What a long message has besides its values.
pub struct Whole<'a> {
    /// The lines of its frames.
    pub lines: &'a [usize],
    /// The joined data, if no part is missing.
    pub data: Option<&'a [u8]>,
    /// Bits that no signal covers.
    pub reserved: &'a [u8],
    /// The name of what tells it from the next message, and its value.
    pub counter: Option<(&'a str, u64)>,
    /// Which parts are missing.
    pub incomplete: Option<&'a str>,
}

/// Writes a frame as one line.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn write(out: &mut impl Write, outcome: &Outcome<'_>) -> io::Result<()> {
    head(out, outcome)?;
    match outcome.decoded {
        Ok(decoded) => recognised(out, outcome, decoded)?,
        Err(unrecognised) => unknown(out, outcome.protocol, unrecognised)?,
    }
    out.write_all(b"}\n")
}

fn head(out: &mut impl Write, outcome: &Outcome<'_>) -> io::Result<()> {
    match &outcome.whole {
        None => {
            out.write_all(b"{\"line\":")?;
            integer(out, outcome.line)?;
        }
        Some(whole) => {
            out.write_all(b"{\"lines\":")?;
            list(out, whole.lines, |out, line| integer(out, *line))?;
        }
    }
    out.write_all(b",\"time\":")?;
    out.write_all(outcome.time.unwrap_or("null").as_bytes())?;
    out.write_all(b",\"channel\":")?;
    optional(out, outcome.channel, text)?;
    match &outcome.whole {
        None => {
            out.write_all(b",\"id\":\"")?;
            log::write_identifier(out, outcome.frame)?;
            out.write_all(b"\",\"data\":\"")?;
            log::write_hexadecimal(out, &outcome.frame.data)?;
            out.write_all(b"\"")?;
        }
        Some(whole) => {
            out.write_all(b",\"data\":")?;
            optional(out, whole.data.map(log::hexadecimal).as_deref(), name)?;
        }
    }
    out.write_all(b",\"protocol\":\"")?;
    out.write_all(outcome.protocol.name.as_bytes())
}

fn recognised(out: &mut impl Write, outcome: &Outcome<'_>, decoded: &Decoded) -> io::Result<()> {
    let protocol = outcome.protocol;
    let message = &protocol.messages[decoded.message];
    out.write_all(b"\",\"message\":\"")?;
    let transport = transport::name(protocol, decoded);
    out.write_all(transport.as_ref().unwrap_or(&message.name).as_bytes())?;
    out.write_all(b"\",\"access\":\"")?;
    out.write_all(protocol.accesses[decoded.access].name.as_bytes())?;
    out.write_all(b"\",\"kind\":\"")?;
    out.write_all(decoded.kind.name().as_bytes())?;
    out.write_all(b"\",\"addressing\":")?;
    optional(out, decoded.addressing.map(|travel| protocol[travel.mode].name.as_str()), name)?;
    out.write_all(b",\"addresses\":")?;
    let addresses = addresses(outcome, decoded).map(|(kind, number)| (kind.name.as_str(), number));
    object(out, addresses, integer)?;
    let content = decoded.content(protocol);
    let is_number = |signal: &Signal| transport.is_some() && transport::is_number(signal);
    selectors(out, protocol, &decoded.identifier, all_selectors(outcome, decoded))?;
    out.write_all(b",\"signals\":")?;
    let values = fields(content, decoded);
    let shown = values.iter().filter(|(_, field)| match field {
        Field::Signal((signal, _)) => !is_number(signal),
        Field::Array(_) => true,
    });
    object(out, shown.map(|(name, field)| (*name, field)), |out, field| match field {
        Field::Signal((signal, reading)) => value(out, protocol, signal, reading),
        Field::Array(elements) => array(out, protocol, elements),
    })?;
    let of_frame = || decoded.reserved.get(..decoded.length).unwrap_or(&decoded.reserved);
    let reserved = outcome.whole.as_ref().map_or_else(of_frame, |whole| whole.reserved);
    if reserved.iter().any(|byte| *byte != 0) {
        // It has as many digits as the data.
        out.write_all(b",\"reserved\":")?;
        name(out, &log::hexadecimal(reserved))?;
    }
    if let Some(incomplete) = outcome.whole.as_ref().and_then(|whole| whole.incomplete) {
        out.write_all(b",\"incomplete\":")?;
        text(out, incomplete)?;
    }
    out.write_all(b",\"notes\":")?;
    list(out, &decoded.notes, |out, note| {
        out.write_all(b"{\"rule\":")?;
        name(out, note.rule.name())?;
        out.write_all(b",\"text\":")?;
        text(out, &note.text)?;
        out.write_all(b"}")
    })
}

fn unknown(out: &mut impl Write, protocol: &Protocol, unrecognised: &Unrecognised) -> io::Result<()> {
    out.write_all(b"\",\"message\":null,\"problem\":{\"kind\":")?;
    name(out, unrecognised.problem.name())?;
    out.write_all(b",\"text\":")?;
    text(out, &unrecognised.text)?;
    out.write_all(b"}")?;
    selectors(out, protocol, &unrecognised.identifier, selected(protocol, &unrecognised.selectors))
}

/// Names the selectors of a frame, and what numbers a frame of a transport or a message in parts.
pub fn all_selectors<'a>(
    outcome: &'a Outcome<'a>,
    decoded: &'a Decoded,
) -> impl Iterator<Item = (&'a str, u64)> + Clone {
    let content = decoded.content(outcome.protocol);
    let signals = decoded.signals.iter().filter(|_| transport::name(outcome.protocol, decoded).is_some());
    let numbers = signals.map(|reading| (&content[reading.signal], reading.bits));
    let numbers = numbers.filter(|(signal, _)| transport::is_number(signal));
    let numbers = numbers.map(|(signal, bits)| (signal.name.as_str(), bits));
    let counter = outcome.whole.as_ref().and_then(|whole| whole.counter);
    selected(outcome.protocol, &decoded.selectors).chain(numbers).chain(counter)
}

/// Names selectors.
pub fn selected<'a>(
    protocol: &'a Protocol,
    selectors: &'a [(SelectorId, u64)],
) -> impl Iterator<Item = (&'a str, u64)> + Clone {
    selectors.iter().map(|&(selector, value)| (protocol[selector].name.as_str(), value))
}

/// Writes the fields of the identifier, and the selectors of the data bytes.
fn selectors<'a>(
    out: &mut impl Write,
    protocol: &Protocol,
    identifier: &Table<FieldId, u32>,
    selectors: impl Iterator<Item = (&'a str, u64)> + Clone,
) -> io::Result<()> {
    out.write_all(b",\"identifier\":")?;
    let names = protocol.identifier.fields.iter().map(|field| field.name.as_str());
    members(out, names.zip(identifier.iter().copied()), integer)?;
    out.write_all(b",\"selectors\":")?;
    object(out, selectors, integer)
}

fn value(out: &mut impl Write, protocol: &Protocol, signal: &Signal, reading: &Reading) -> io::Result<()> {
    out.write_all(b"{\"raw\":")?;
    if let Value::Status { set, unknown } = &reading.value {
        integer(out, reading.bits)?;
        out.write_all(b",\"set\":")?;
        list(out, bit_names(protocol, signal, set), name)?;
        out.write_all(b",\"unknown\":")?;
        integer(out, *unknown)?;
        severities(out, &set_bits(protocol, signal, set).collect::<Vec<_>>())?;
        return out.write_all(b"}");
    }
    raw(out, (signal, reading))?;
    out.write_all(b",\"value\":")?;
    physical(out, (signal, reading))?;
    end(out, signal)
}

fn raw(out: &mut impl Write, (signal, reading): Read) -> io::Result<()> {
    match signal.run {
        Some(_) => name(out, &log::hexadecimal(&reading.bytes)),
        None => long_integer(out, signal.raw_of(reading.bits)),
    }
}

fn physical(out: &mut impl Write, (_, reading): Read) -> io::Result<()> {
    match &reading.value {
        Value::None | Value::Status { .. } => out.write_all(b"null"),
        Value::Integer(value) => long_integer(out, *value),
        Value::Number(value) => Ok(serde_json::to_writer(out, value)?),
        Value::Name(value) => name(out, value),
        Value::Text(value) => text(out, value),
    }
}

/// Ends an object with the unit.
fn end(out: &mut impl Write, signal: &Signal) -> io::Result<()> {
    if let Some(unit) = signal.unit {
        out.write_all(b",\"unit\":")?;
        name(out, &unit.symbol)?;
    }
    out.write_all(b"}")
}

/// Writes an array, each member as a list with an item an element. An element that the frame lacks is null.
fn array(out: &mut impl Write, protocol: &Protocol, elements: &[Option<Read>]) -> io::Result<()> {
    let Some((signal, _)) = elements.iter().flatten().next() else { return out.write_all(b"{}") };
    out.write_all(b"{\"raw\":")?;
    items(out, elements, raw)?;
    if signal.encoding.status_word().is_some() {
        return status_words(out, protocol, elements);
    }
    out.write_all(b",\"value\":")?;
    items(out, elements, physical)?;
    end(out, signal)
}

/// Writes the bits of an array's status words.
fn status_words(out: &mut impl Write, protocol: &Protocol, elements: &[Option<Read>]) -> io::Result<()> {
    let bits = |(signal, reading): Read| set_bits(protocol, signal, status(reading).0).collect::<Vec<_>>();
    out.write_all(b",\"set\":")?;
    items(out, elements, |out, read| list(out, bits(read), |out, bit| name(out, &bit.name)))?;
    out.write_all(b",\"unknown\":")?;
    items(out, elements, |out, (_, reading)| integer(out, status(reading).1))?;
    if elements.iter().flatten().any(|read| !by_severity(&bits(*read)).is_empty()) {
        out.write_all(b",\"severity\":")?;
        items(out, elements, |out, read| groups(out, by_severity(&bits(read))))?;
    }
    out.write_all(b"}")
}

/// Returns the set bits of a status word, and those without a name.
fn status(reading: &Reading) -> (&[u8], u64) {
    if let Value::Status { set, unknown } = &reading.value { (set, *unknown) } else { (&[], 0) }
}

fn items<W: Write>(
    out: &mut W,
    elements: &[Option<Read>],
    mut write: impl FnMut(&mut W, Read) -> io::Result<()>,
) -> io::Result<()> {
    list(out, elements, |out, element| match element {
        Some(read) => write(out, *read),
        None => out.write_all(b"null"),
    })
}

/// Writes the names of set bits by their severity, if one of them has any.
fn severities(out: &mut impl Write, bits: &[&StatusBit]) -> io::Result<()> {
    let by_severity = by_severity(bits);
    if by_severity.is_empty() {
        return Ok(());
    }
    out.write_all(b",\"severity\":")?;
    groups(out, by_severity)
}

/// Returns the names of set bits by their severity.
fn by_severity<'a>(bits: &[&'a StatusBit]) -> Vec<(&'static str, Vec<&'a str>)> {
    let names = |severity| {
        let bits = bits.iter().filter(move |bit| Severity::of(bit) == Some(severity));
        bits.map(|bit| bit.name.as_str()).collect::<Vec<_>>()
    };
    let groups = Severity::ALL.into_iter().map(|severity| (severity.word(), names(severity)));
    groups.filter(|(_, names)| !names.is_empty()).collect()
}

fn groups(out: &mut impl Write, groups: Vec<(&str, Vec<&str>)>) -> io::Result<()> {
    members(out, groups.into_iter(), |out, names| list(out, names, name))
}

/// Returns the addresses that the identifier shows, each with its kind.
pub fn addresses<'a>(
    outcome: &Outcome<'a>,
    decoded: &Decoded,
) -> impl Iterator<Item = (&'a AddressType, i64)> + Clone + use<'a> {
    let addresses = decoded.addresses(outcome.protocol, outcome.frame.id);
    let protocol = outcome.protocol;
    addresses.map(move |(kind, number)| (&protocol[kind], number))
}

/// Returns the set bits of a status word that have a name.
pub fn set_bits<'a>(
    protocol: &'a Protocol,
    signal: &Signal,
    set: &[u8],
) -> impl Iterator<Item = &'a StatusBit> + Clone {
    let bits = signal.encoding.status_word().map_or(&[][..], |word| &protocol.status_words[word].bits);
    bits.iter().filter(|bit| set.contains(&bit.bit))
}

/// Returns the names of the set bits of a status word.
pub fn bit_names<'a>(protocol: &'a Protocol, signal: &Signal, set: &[u8]) -> impl Iterator<Item = &'a str> {
    set_bits(protocol, signal, set).map(|bit| bit.name.as_str())
}

#[cfg(test)]
mod tests {
    use canspec_codegen::interpret::decode;
    use canspec_codegen::source::Source;

    use super::*;

    /// Signed and unsigned, scaled and unscaled, named and status.
    const SPEC: &str = r#"
canspec: 1
protocol: acme
title: Made up
document: {title: Made up, version: "1"}
length: 8
identifier:
  device:  {bits: 10..8, values: {1: one}}
  command: {bits: 7..4}
  target:  {bits: 3..2}
  source:  {bits: 1..0}
types:
  controller: {range: 3..3, outside: refused, send: 3, section: "1"}
  module:     {range: 0..1, section: "1"}
  power:      {values: {0: "on", 1: "off"}, section: "1"}
  state:      {status: {fault: {bit: 0, severity: fault}, full: {bit: 6}}, section: "1"}
addressing:
  one:
    section: "1"
    request: {device: 1, target: module, source: controller}
    one:     {device: 1, target: controller, source: module}
access:
  read: {request: {}, reply: {}, in: [reply], answers: {one: one}, section: "1"}
messages:
  values:
    section: "1"
    match: {command: 1}
    access: [read]
    fields:
      temperature: {bytes: 0, as: signed, unit: °C}
      voltage:     {bytes: 1..2, scale: 1/10, unit: V}
      power:       {bytes: 3, type: power}
      state:       {bytes: 4, type: state}
    examples:
      - {request: 113#0000000000000000}
      - {reply: 11C#FE0FB40141000000, means: {temperature: -2 °C, voltage: 402 V, power: "off", state: [fault, full]}}
"#;

    fn protocol() -> Protocol {
        let source = Source::new("acme.yaml", SPEC.as_bytes().to_vec()).expect("the spec is text");
        let outcome = canspec_codegen::compile(source);
        assert_eq!(outcome.diagnostics.concise(), "");
        outcome.protocol.expect("the spec has no errors")
    }

    /// Decodes a line of a log to a line of JSON.
    fn line(text: &str) -> String {
        let protocol = protocol();
        let mut reader = log::Reader::default();
        let entry = reader.read(text).expect("the line is readable").expect("the line is not blank");
        let (time, channel, frame) = (entry.time.as_deref(), entry.channel, &entry.frame);
        let decoded = &decode(&protocol, None, frame);
        let outcome = Outcome { line: 7, time, channel, frame, protocol: &protocol, decoded, whole: None };
        let mut out = Vec::new();
        write(&mut out, &outcome).expect("a vector takes everything");
        String::from_utf8(out).expect("JSON is text")
    }

    #[test]
    fn a_reply_is_written_member_by_member() {
        let expected = concat!(
            r#"{"line":7,"time":1.50,"channel":"can0","id":"11C","data":"FE0FB40141000000","protocol":"acme","#,
            r#""message":"values","access":"read","kind":"reply","addressing":"one","#,
            r#""addresses":{"controller":3,"module":0},"#,
            r#""identifier":{"device":1,"command":1,"target":3,"source":0},"selectors":{},"#,
            r#""signals":{"temperature":{"raw":-2,"value":-2,"unit":"°C"},"voltage":{"raw":4020,"value":402.0,"unit":"V"},"#,
            r#""power":{"raw":1,"value":"off"},"#,
            r#""state":{"raw":65,"set":["fault","full"],"unknown":0,"severity":{"fault":["fault"]}}},"notes":[]}"#,
            "\n",
        );
        assert_eq!(line("(1.50) can0 11c#fe0fb40141000000"), expected);
    }

    #[test]
    fn what_the_document_does_not_know_is_kept() {
        let written = line("11C#FE0FB40243000080");
        for part in [
            r#"{"line":7,"time":null,"channel":null,"id":"11C""#,
            r#""power":{"raw":2,"value":null}"#,
            r#""state":{"raw":67,"set":["fault","full"],"unknown":2,"severity":{"fault":["fault"]}}"#,
            r#""reserved":"0000000000000080","notes":[{"rule":""#,
        ] {
            assert!(written.contains(part), "{part} in {written}");
        }
    }

    #[test]
    fn a_frame_that_is_not_recognised_shows_its_problem() {
        let expected = concat!(
            r#"{"line":7,"time":null,"channel":null,"id":"123","data":"00","protocol":"acme","#,
            r#""message":null,"problem":{"kind":"unknown_message","text":""#,
        );
        let written = line("123#00");
        assert!(written.starts_with(expected), "{written}");
        let end = r#""},"identifier":{"device":1,"command":2,"target":0,"source":3},"selectors":{}}"#;
        assert!(written.trim_end().ends_with(end), "{written}");
    }

    #[test]
    fn an_error_remote_or_fd_frame_is_no_message_of_a_protocol_with_11_bits() {
        let of_frame = r#""message":null,"problem":{"kind":"frame","text":""#;
        for frame in ["20000113#0000000000000000", "20000113#", "113#R", "113#R8", "113##00000000000000000"] {
            let written = line(&format!("(1.50) can0 {frame}"));
            assert!(written.contains(of_frame), "{frame}: {written}");
        }
        assert!(line("113#0000000000000000").contains(r#""message":"values""#));
    }
}
