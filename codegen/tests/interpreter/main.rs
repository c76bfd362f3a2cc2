//! What the interpreter reads and writes: the frames of the documents, and frames calculated by hand.

mod arrays;
mod assembled;
mod busy;
mod examples;
mod isotp;
mod j1939;
mod long_revisions;
mod parts;
mod products;
mod reading;
mod requests;
mod revisions;
mod scales;
mod texts;
mod values;
mod writing;

use std::fs;
use std::path::{Path, PathBuf};

use canspec_codegen::interpret::{Decoded, Form, Frame, Problem, Refusal, Target, Value, decode, request};
use canspec_codegen::model::{ModelId, Protocol};
use canspec_codegen::source::Source;
use canspec_codegen::{Bases, Outcome, compile};

/// Numbers of 64 bits that are set and read.
const WIDE: &str = r#"
canspec: 1
protocol: wide
title: Counters
document: {title: Made up, version: "1"}
length: 8
identifier: {direction: {bits: 10}, command: {bits: 9..4}, node: {bits: 3..0}}
types: {counter: {range: 1..9}}
addressing: {single: {request: {direction: 0, node: counter}, one: {direction: 1, node: counter}}}
access: {set: {request: {}, reply: {}, answers: {single: one}}}
messages:
  positive: {section: "1", match: {command: 1}, access: [set], value: {bytes: 0..7, range: 0..1000}}
  negative: {section: "1", match: {command: 2}, access: [set], value: {bytes: 7..0, as: signed, range: 0..1000}}
  single: {section: "1", match: {command: 3}, access: [set], value: {bytes: 0..3, as: float, range: 0.7..1.1}}
  scaled: {section: "1", match: {command: 4}, access: [set], value: {bytes: 0..3, scale: 1/10000, range: 0..16777.218}}
  digits: {section: "1", match: {command: 5}, access: [set], value: {bytes: 0..1, as: bcd, range: 10..500, values: {0xFFFF: never}}}
  lock: {section: "1", match: {command: 6}, access: [set], value: {bytes: 2..0, as: bytes}}
"#;

/// Returns the specs of a folder of the workspace, in order.
fn specs(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder);
    let entries = fs::read_dir(folder).expect("the folder exists").flatten().map(|entry| entry.path());
    let mut specs: Vec<_> = entries.filter(|path| path.extension().is_some_and(|ending| ending == "yaml")).collect();
    specs.sort();
    specs
}

fn outcome(path: &Path) -> Outcome {
    compile(Bases::default().read(path).expect("the spec is a text"))
}

fn feature(name: &str) -> Protocol {
    protocol(&format!("tests/specs/features/{name}.yaml"))
}

/// Compiles a spec of the workspace.
fn protocol(path: &str) -> Protocol {
    let Outcome { protocol, diagnostics, .. } = outcome(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path));
    protocol.unwrap_or_else(|| panic!("{}", diagnostics.concise()))
}

/// Compiles a text.
fn written(spec: &str) -> Protocol {
    let Outcome { protocol, diagnostics, .. } =
        compile(Source::new("written.yaml", spec.into()).expect("it is a text"));
    protocol.unwrap_or_else(|| panic!("{}", diagnostics.concise()))
}

/// Returns a device model.
fn model(protocol: &Protocol, name: &str) -> ModelId {
    protocol.models.position(|model| model.name == name).expect("the device model exists")
}

/// Reads a frame as documents print it.
fn frame(text: &str) -> Frame {
    let (id, data) = text.split_once('#').expect("an identifier and data");
    let digits: Vec<_> = data.as_bytes().chunks(2).map(|byte| str::from_utf8(byte).expect("ASCII")).collect();
    Frame {
        id: u32::from_str_radix(id, 16).expect("hexadecimal digits"),
        extended: id.len() == 8,
        data: digits.iter().map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal digits")).collect(),
        form: Form::Data,
    }
}

fn printed(frame: &Frame) -> String {
    let digits = if frame.extended { 8 } else { 3 };
    frame.data.iter().fold(format!("{:0digits$X}#", frame.id), |text, byte| format!("{text}{byte:02X}"))
}

fn decoded(protocol: &Protocol, text: &str) -> Decoded {
    decode(protocol, None, &frame(text)).expect("a frame of the protocol")
}

fn problem(protocol: &Protocol, text: &str) -> Option<Problem> {
    decode(protocol, None, &frame(text)).err().map(|unrecognised| unrecognised.problem)
}

/// Returns the name of the message that a frame carries for a device model.
fn message<'a>(protocol: &'a Protocol, model: Option<ModelId>, text: &str) -> &'a str {
    let decoded = decode(protocol, model, &frame(text)).expect("a frame of the protocol");
    &protocol.messages[decoded.message].name
}

/// Returns the values of a frame, by signal.
fn values(protocol: &Protocol, text: &str) -> Vec<(String, Value)> {
    let decoded = decoded(protocol, text);
    let signals = &protocol.messages[decoded.message].signals;
    decoded.signals.into_iter().map(|reading| (signals[reading.signal].name.clone(), reading.value)).collect()
}

/// Returns the texts of a frame's notes.
fn note_texts(protocol: &Protocol, text: &str) -> Vec<String> {
    decoded(protocol, text).notes.into_iter().map(|note| note.text).collect()
}

/// Returns the rules of a frame's notes.
fn notes(protocol: &Protocol, text: &str) -> Vec<&'static str> {
    decoded(protocol, text).notes.iter().map(|note| note.rule.name()).collect()
}

/// Makes a request of texts as a person types them.
fn requested(
    protocol: &Protocol,
    model: Option<ModelId>,
    message: &str,
    to: &str,
    signals: &[(&str, &str)],
) -> Result<String, Refusal> {
    let signals: Vec<_> = signals.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let (access, message) =
        message.split_once(' ').map_or((None, message), |(access, message)| (Some(access), message));
    let made = request(protocol, model, access, message, &Target::parse(protocol, to)?, None, &signals)?;
    Ok(printed(&made))
}
