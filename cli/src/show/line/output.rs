//! Turns a decoded frame into a line of JSON.

use canspec_codegen::interpret::{Decoded, Reading, Unrecognised, Value};
use canspec_codegen::model::{AddressType, IdentifierField, Protocol, SelectorId, Signal, StatusBit};

use crate::log;
use crate::show::fields::{Field, Read, elements, fields};
use crate::show::kept::Kept;
use crate::show::line::json::{integer, list, members, name, natural, number, object, optional, text};
use crate::show::line::transport;
use crate::show::outcome::Outcome;
use crate::show::severity::Severity;

/// Writes a frame as one line.
pub fn write(out: &mut Vec<u8>, kept: &mut Kept, outcome: &Outcome<'_>) {
    head(out, outcome);
    match outcome.decoded {
        Ok(decoded) => {
            kept.add(out, outcome, decoded, |out| shown_by_identifier(out, outcome, decoded));
            recognised(out, outcome, decoded);
        }
        Err(unrecognised) => unknown(out, outcome.protocol, unrecognised),
    }
    out.extend_from_slice(b"}\n");
}

fn head(out: &mut Vec<u8>, outcome: &Outcome<'_>) {
    match &outcome.whole {
        None => {
            out.extend_from_slice(b"{\"line\":");
            natural(out, outcome.line as u64);
        }
        Some(whole) => {
            out.extend_from_slice(b"{\"lines\":");
            list(out, whole.lines, |out, line| natural(out, *line as u64));
        }
    }
    out.extend_from_slice(b",\"time\":");
    out.extend_from_slice(outcome.time.unwrap_or("null").as_bytes());
    out.extend_from_slice(b",\"channel\":");
    optional(out, outcome.channel, text);
    match &outcome.whole {
        None => {
            out.extend_from_slice(b",\"id\":\"");
            log::write_identifier(out, outcome.frame);
            out.extend_from_slice(b"\",\"data\":\"");
            log::write_hexadecimal(out, &outcome.frame.data);
            out.extend_from_slice(b"\"");
        }
        Some(whole) => {
            out.extend_from_slice(b",\"data\":");
            optional(out, whole.data.map(log::hexadecimal).as_deref(), name);
        }
    }
}

fn of_protocol(out: &mut Vec<u8>, protocol: &Protocol) {
    out.extend_from_slice(b",\"protocol\":");
    name(out, &protocol.name);
}

/// Writes what identifier and kind of the frame alone decide.
fn shown_by_identifier(out: &mut Vec<u8>, outcome: &Outcome<'_>, decoded: &Decoded) {
    let protocol = outcome.protocol;
    let message = &protocol.messages[decoded.message];
    of_protocol(out, protocol);
    out.extend_from_slice(b",\"message\":\"");
    let transport = transport::name(protocol, decoded);
    out.extend_from_slice(transport.as_ref().unwrap_or(&message.name).as_bytes());
    out.extend_from_slice(b"\",\"access\":\"");
    out.extend_from_slice(protocol.accesses[decoded.access].name.as_bytes());
    out.extend_from_slice(b"\",\"kind\":\"");
    out.extend_from_slice(decoded.kind.name().as_bytes());
    out.extend_from_slice(b"\",\"addressing\":");
    optional(out, decoded.addressing.map(|travel| protocol[travel.mode].name.as_str()), name);
    out.extend_from_slice(b",\"addresses\":");
    let addresses = addresses(outcome, decoded).map(|(kind, number)| (kind.name.as_str(), number));
    object(out, &addresses, integer);
    identifier(out, decoded.identifier(protocol));
}

fn recognised(out: &mut Vec<u8>, outcome: &Outcome<'_>, decoded: &Decoded) {
    let protocol = outcome.protocol;
    let content = decoded.content(protocol);
    let is_of_transport = transport::carries(protocol, decoded);
    let is_number = |signal: &Signal| is_of_transport && transport::is_number(signal);
    selectors(out, &all_selectors(outcome, decoded));
    out.extend_from_slice(b",\"signals\":");
    let shown = fields(content, decoded).filter(|(_, field)| match field {
        Field::Signal((signal, _)) => !is_number(signal),
        Field::Array(_) => true,
    });
    object(out, &shown, |out, field| match field {
        Field::Signal((signal, reading)) => value(out, protocol, signal, reading),
        Field::Array(id) => array(out, protocol, &elements(content, decoded, id)),
    });
    let of_frame = || decoded.reserved.get(..decoded.length).unwrap_or(&decoded.reserved);
    let reserved = outcome.whole.as_ref().map_or_else(of_frame, |whole| whole.reserved);
    if reserved.iter().any(|byte| *byte != 0) || decoded.is_length_hidden(protocol, reserved.len()) {
        // It has as many digits as the data.
        out.extend_from_slice(b",\"reserved\":");
        name(out, &log::hexadecimal(reserved));
    }
    if let Some(incomplete) = outcome.whole.as_ref().and_then(|whole| whole.incomplete) {
        out.extend_from_slice(b",\"incomplete\":");
        text(out, incomplete);
    }
    out.extend_from_slice(b",\"notes\":");
    list(out, &decoded.notes, |out, note| {
        out.extend_from_slice(b"{\"rule\":");
        name(out, note.rule.name());
        out.extend_from_slice(b",\"text\":");
        text(out, &note.text);
        out.push(b'}');
    });
}

fn unknown(out: &mut Vec<u8>, protocol: &Protocol, unrecognised: &Unrecognised) {
    of_protocol(out, protocol);
    out.extend_from_slice(b",\"message\":null,\"problem\":{\"kind\":");
    name(out, unrecognised.problem.name());
    out.extend_from_slice(b",\"text\":");
    text(out, &unrecognised.text);
    out.extend_from_slice(b"}");
    identifier(out, protocol.identifier.fields.iter().zip(unrecognised.identifier.iter().copied()));
    selectors(out, &selected(protocol, &unrecognised.selectors));
}

/// Names the selectors of a frame, and what numbers a frame of a transport or a message in parts.
pub fn all_selectors<'a>(
    outcome: &'a Outcome<'a>,
    decoded: &'a Decoded,
) -> impl Iterator<Item = (&'a str, u64)> + Clone {
    let content = decoded.content(outcome.protocol);
    let is_of_transport = !decoded.signals.is_empty() && transport::carries(outcome.protocol, decoded);
    let signals = if is_of_transport { &decoded.signals[..] } else { &[] };
    let numbers = signals.iter().map(|reading| (&content[reading.signal], reading.bits));
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

/// Writes the fields of the identifier.
fn identifier<'a>(out: &mut Vec<u8>, fields: impl Iterator<Item = (&'a IdentifierField, u32)>) {
    out.extend_from_slice(b",\"identifier\":");
    members(out, fields.map(|(field, value)| (field.name.as_str(), value)), natural);
}

/// Writes the selectors of the data bytes.
fn selectors<'a>(out: &mut Vec<u8>, selectors: &(impl Iterator<Item = (&'a str, u64)> + Clone)) {
    out.extend_from_slice(b",\"selectors\":");
    object(out, selectors, natural);
}

fn value(out: &mut Vec<u8>, protocol: &Protocol, signal: &Signal, reading: &Reading) {
    out.extend_from_slice(b"{\"raw\":");
    if let Value::Status { set, unknown } = &reading.value {
        natural(out, reading.bits);
        out.extend_from_slice(b",\"set\":");
        list(out, bit_names(protocol, signal, *set), name);
        out.extend_from_slice(b",\"unknown\":");
        natural(out, *unknown);
        severities(out, &set_bits(protocol, signal, *set));
        return out.push(b'}');
    }
    raw(out, (signal, reading));
    out.extend_from_slice(b",\"value\":");
    physical(out, (signal, reading));
    end(out, signal);
}

fn raw(out: &mut Vec<u8>, (signal, reading): Read) {
    match signal.run {
        Some(_) => name(out, &log::hexadecimal(&reading.bytes)),
        None => integer(out, signal.raw_of(reading.bits)),
    }
}

fn physical(out: &mut Vec<u8>, (_, reading): Read) {
    match &reading.value {
        Value::None | Value::Status { .. } => out.extend_from_slice(b"null"),
        Value::Integer(value) => integer(out, *value),
        Value::Number(value) => number(out, *value),
        Value::Name(value) => name(out, value),
        Value::Text(value) => text(out, value),
    }
}

/// Ends an object with the unit.
fn end(out: &mut Vec<u8>, signal: &Signal) {
    if let Some(unit) = signal.unit {
        out.extend_from_slice(b",\"unit\":");
        name(out, &unit.symbol);
    }
    out.push(b'}');
}

/// Writes an array, each member as a list with an item an element. An element that the frame lacks is null.
fn array(out: &mut Vec<u8>, protocol: &Protocol, elements: &[Option<Read>]) {
    let Some((signal, _)) = elements.iter().flatten().next() else { return out.extend_from_slice(b"{}") };
    out.extend_from_slice(b"{\"raw\":");
    items(out, elements, raw);
    if signal.encoding.status_word().is_some() {
        return status_words(out, protocol, elements);
    }
    out.extend_from_slice(b",\"value\":");
    items(out, elements, physical);
    end(out, signal);
}

/// Writes the bits of an array's status words.
fn status_words(out: &mut Vec<u8>, protocol: &Protocol, elements: &[Option<Read>]) {
    let bits = |(signal, reading): Read| set_bits(protocol, signal, status(reading).0);
    out.extend_from_slice(b",\"set\":");
    items(out, elements, |out, read| list(out, bits(read), |out, bit| name(out, &bit.name)));
    out.extend_from_slice(b",\"unknown\":");
    items(out, elements, |out, (_, reading)| natural(out, status(reading).1));
    if elements.iter().flatten().any(|read| has_severity(bits(*read))) {
        out.extend_from_slice(b",\"severity\":");
        items(out, elements, |out, read| by_severity(out, &bits(read)));
    }
    out.push(b'}');
}

/// Returns the set bits of a status word, and those without a name.
fn status(reading: &Reading) -> (u64, u64) {
    if let Value::Status { set, unknown } = reading.value { (set, unknown) } else { (0, 0) }
}

fn items(out: &mut Vec<u8>, elements: &[Option<Read>], mut write: impl FnMut(&mut Vec<u8>, Read)) {
    list(out, elements, |out, element| match element {
        Some(read) => write(out, *read),
        None => out.extend_from_slice(b"null"),
    });
}

/// Writes the names of set bits by their severity, if one of them has any.
fn severities<'a>(out: &mut Vec<u8>, bits: &(impl Iterator<Item = &'a StatusBit> + Clone)) {
    if has_severity(bits.clone()) {
        out.extend_from_slice(b",\"severity\":");
        by_severity(out, bits);
    }
}

fn has_severity<'a>(mut bits: impl Iterator<Item = &'a StatusBit>) -> bool {
    bits.any(|bit| bit.severity.is_some())
}

/// Writes the names of set bits by their severity.
fn by_severity<'a>(out: &mut Vec<u8>, bits: &(impl Iterator<Item = &'a StatusBit> + Clone)) {
    let of = |severity| bits.clone().filter(move |bit| Severity::of(bit) == Some(severity));
    let groups = Severity::ALL.into_iter().filter(|severity| of(*severity).next().is_some());
    members(out, groups.map(|severity| (severity.word(), of(severity))), |out, bits| {
        list(out, bits.map(|bit| bit.name.as_str()), name);
    });
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
    set: u64,
) -> impl Iterator<Item = &'a StatusBit> + Clone + use<'a> {
    let word = signal.encoding.status_word().filter(|_| set != 0);
    let bits = word.map_or(&[][..], |word| &protocol.status_words[word].bits);
    bits.iter().filter(move |bit| set >> bit.bit & 1 == 1)
}

/// Returns the names of the set bits of a status word.
pub fn bit_names<'a>(protocol: &'a Protocol, signal: &Signal, set: u64) -> impl Iterator<Item = &'a str> + use<'a> {
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
        write(&mut out, &mut Kept::default(), &outcome);
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
