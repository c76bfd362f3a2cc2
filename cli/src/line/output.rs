//! Turns a decoded frame into a line of JSON.

use std::io::{self, Write};

use canspec_codegen::interpret::{Decoded, Frame, Note, Reading, Unrecognised, Value};
use canspec_codegen::model::{FieldId, Message, Protocol, SelectorId, Signal, Table};
use serde::{Serialize, Serializer};
use serde_json::value::RawValue;

use super::Members;
use crate::log;

/// A frame of a log, and what a protocol makes of it.
pub struct Outcome<'a> {
    pub line: usize,
    pub time: Option<&'a RawValue>,
    pub channel: Option<&'a str>,
    pub frame: &'a Frame,
    pub protocol: &'a Protocol,
    pub decoded: &'a Result<Decoded, Unrecognised>,
}

/// Writes a frame as one line.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn write(out: &mut impl Write, outcome: &Outcome<'_>) -> io::Result<()> {
    match outcome.decoded {
        Ok(decoded) => serde_json::to_writer(&mut *out, &Recognised::new(outcome, decoded))?,
        Err(unrecognised) => serde_json::to_writer(&mut *out, &Unknown::new(outcome, unrecognised))?,
    }
    writeln!(out)
}

#[derive(Serialize)]
struct Head<'a> {
    line: usize,
    time: Option<&'a RawValue>,
    channel: Option<&'a str>,
    id: String,
    data: String,
    protocol: &'a str,
}

impl<'a> Head<'a> {
    fn new(outcome: &Outcome<'a>) -> Self {
        Self {
            line: outcome.line,
            time: outcome.time,
            channel: outcome.channel,
            id: log::identifier_text(outcome.frame),
            data: log::hexadecimal(&outcome.frame.data),
            protocol: &outcome.protocol.name,
        }
    }
}

#[derive(Serialize)]
struct Recognised<'a> {
    #[serde(flatten)]
    head: Head<'a>,
    message: &'a str,
    access: &'a str,
    kind: &'static str,
    addressing: Option<&'a str>,
    identifier: Members<&'a str, u32>,
    selectors: Members<&'a str, u64>,
    signals: Members<&'a str, SignalObject<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reserved: Option<String>,
    notes: Vec<NoteObject<'a>>,
}

impl<'a> Recognised<'a> {
    fn new(outcome: &Outcome<'a>, decoded: &'a Decoded) -> Self {
        let protocol = outcome.protocol;
        let message = &protocol.messages[decoded.message];
        Self {
            head: Head::new(outcome),
            message: &message.name,
            access: &protocol.accesses[decoded.access].name,
            kind: decoded.kind.name(),
            addressing: decoded.addressing.map(|travel| protocol[travel.mode].name.as_str()),
            identifier: identifier(protocol, &decoded.identifier),
            selectors: selectors(protocol, &decoded.selectors),
            signals: signals(protocol, message, &decoded.signals),
            reserved: reserved(decoded),
            notes: decoded.notes.iter().map(NoteObject::new).collect(),
        }
    }
}

#[derive(Serialize)]
struct Unknown<'a> {
    #[serde(flatten)]
    head: Head<'a>,
    message: (),
    problem: ProblemObject<'a>,
    identifier: Members<&'a str, u32>,
    selectors: Members<&'a str, u64>,
}

impl<'a> Unknown<'a> {
    fn new(outcome: &Outcome<'a>, unrecognised: &'a Unrecognised) -> Self {
        Self {
            head: Head::new(outcome),
            message: (),
            problem: ProblemObject { kind: unrecognised.problem.name(), text: &unrecognised.text },
            identifier: identifier(outcome.protocol, &unrecognised.identifier),
            selectors: selectors(outcome.protocol, &unrecognised.selectors),
        }
    }
}

#[derive(Serialize)]
struct ProblemObject<'a> {
    kind: &'static str,
    text: &'a str,
}

#[derive(Serialize)]
struct NoteObject<'a> {
    rule: &'static str,
    text: &'a str,
}

impl<'a> NoteObject<'a> {
    fn new(note: &'a Note) -> Self {
        Self { rule: note.rule.name(), text: &note.text }
    }
}

#[derive(Serialize)]
#[serde(untagged)]
enum SignalObject<'a> {
    Value {
        raw: i128,
        value: ValueObject<'a>,
        #[serde(skip_serializing_if = "Option::is_none")]
        unit: Option<&'static str>,
    },
    Status {
        raw: u64,
        set: Vec<&'a str>,
        unknown: u64,
    },
}

#[derive(Serialize)]
#[serde(untagged)]
enum ValueObject<'a> {
    None,
    Integer(i128),
    Number(f64),
    Text(&'a str),
}

impl<'a> SignalObject<'a> {
    fn new(protocol: &'a Protocol, signal: &'a Signal, reading: &'a Reading) -> Self {
        let value = match &reading.value {
            Value::None => ValueObject::None,
            Value::Integer(number) => ValueObject::Integer(*number),
            Value::Number(number) => ValueObject::Number(*number),
            Value::Name(text) | Value::Text(text) => ValueObject::Text(text),
            Value::Status { set, unknown } => {
                return Self::Status { raw: reading.bits, set: bit_names(protocol, signal, set), unknown: *unknown };
            }
        };
        Self::Value { raw: signal.raw_of(reading.bits), value, unit: signal.unit.map(|unit| unit.symbol) }
    }
}

/// Returns the names of the set bits of a status word.
pub fn bit_names<'a>(protocol: &'a Protocol, signal: &Signal, set: &[u8]) -> Vec<&'a str> {
    let Some(word) = signal.encoding.status_word() else { return Vec::new() };
    let bits = protocol.status_words[word].bits.iter();
    bits.filter(|bit| set.contains(&bit.bit)).map(|bit| bit.name.as_str()).collect()
}

fn identifier<'a>(protocol: &'a Protocol, values: &Table<FieldId, u32>) -> Members<&'a str, u32> {
    let names = protocol.identifier.fields.iter().map(|field| field.name.as_str());
    Members(names.zip(values.iter().copied()).collect())
}

fn selectors<'a>(protocol: &'a Protocol, values: &[(SelectorId, u64)]) -> Members<&'a str, u64> {
    let named = |&(selector, value): &(SelectorId, u64)| (protocol[selector].name.as_str(), value);
    Members(values.iter().map(named).collect())
}

fn signals<'a>(
    protocol: &'a Protocol,
    message: &'a Message,
    readings: &'a [Reading],
) -> Members<&'a str, SignalObject<'a>> {
    let object = |reading: &'a Reading| {
        let signal = &message.signals[reading.signal];
        (signal.name.as_str(), SignalObject::new(protocol, signal, reading))
    };
    Members(readings.iter().map(object).collect())
}

/// Returns the set reserved bits with as many digits as the data, if there are any.
fn reserved(decoded: &Decoded) -> Option<String> {
    let bytes = decoded.reserved.get(..decoded.length).unwrap_or(&decoded.reserved);
    bytes.iter().any(|byte| *byte != 0).then(|| log::hexadecimal(bytes))
}

impl<K: Serialize + PartialEq, V: Serialize> Serialize for Members<K, V> {
    /// If members have the same name, the first one counts. A field that messages have in different
    /// places is such a case.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let is_first = |index: usize, name: &K| self.0[..index].iter().all(|(other, _)| other != name);
        let members = self.0.iter().enumerate().filter(|(index, (name, _))| is_first(*index, name));
        serializer.collect_map(members.map(|(_, (name, value))| (name, value)))
    }
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
  state:      {status: {fault: {bit: 0}, full: {bit: 6}}, section: "1"}
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
        let outcome = Outcome { line: 7, time, channel, frame, protocol: &protocol, decoded };
        let mut out = Vec::new();
        write(&mut out, &outcome).expect("a vector takes everything");
        String::from_utf8(out).expect("JSON is text")
    }

    #[test]
    fn a_reply_is_written_member_by_member() {
        let expected = concat!(
            r#"{"line":7,"time":1.50,"channel":"can0","id":"11C","data":"FE0FB40141000000","protocol":"acme","#,
            r#""message":"values","access":"read","kind":"reply","addressing":"one","#,
            r#""identifier":{"device":1,"command":1,"target":3,"source":0},"selectors":{},"#,
            r#""signals":{"temperature":{"raw":-2,"value":-2,"unit":"°C"},"voltage":{"raw":4020,"value":402.0,"unit":"V"},"#,
            r#""power":{"raw":1,"value":"off"},"state":{"raw":65,"set":["fault","full"],"unknown":0}},"notes":[]}"#,
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
            r#""state":{"raw":67,"set":["fault","full"],"unknown":2}"#,
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
