//! Examples of messages: their frames, and what these mean.

use canspec_codegen::model::{self, LongExample, Meaning, Message, MessageId, NoteRule, Protocol, ValueExample};
use serde::Serialize;

use super::remarks::Remarks;
use crate::command::list::{examples, words};
use crate::log;

/// An example of a frame, or of all frames of a long message.
#[derive(Serialize)]
pub struct Example<'a> {
    message: Option<&'a str>,
    kind: &'static str,
    model: Option<&'a str>,
    frames: Vec<Frame>,
    means: Vec<Means<'a>>,
    notes: Vec<&'static str>,
    fails: Option<&'static str>,
    origin: &'static str,
    /// The sequence in which it stands.
    sequence: Option<&'a str>,
    #[serde(flatten)]
    remarks: Remarks<'a>,
}

#[derive(Serialize)]
struct Frame {
    id: String,
    data: Option<String>,
}

/// What an example says about a signal.
#[derive(Serialize)]
struct Means<'a> {
    signal: &'a str,
    text: &'a str,
}

/// Returns the examples of some messages, and those that are of no message.
pub fn of_messages<'a>(protocol: &'a Protocol, messages: &[MessageId]) -> Vec<Example<'a>> {
    let is_shown = |message: Option<MessageId>| message.is_none_or(|message| messages.contains(&message));
    let single = protocol.examples.iter().filter(|example| is_shown(example.message));
    let long = protocol.long_examples.iter().filter(|example| is_shown(Some(protocol[example.long].message)));
    single.map(|example| of_frame(protocol, example)).chain(long.map(|example| of_long(protocol, example))).collect()
}

fn of_frame<'a>(protocol: &'a Protocol, example: &'a model::Example) -> Example<'a> {
    let id = log::identifier_digits(example.id, example.extended);
    let message = example.message.map(|message| &protocol[message]);
    Example {
        message: message.map(|message| message.name.as_str()),
        kind: example.kind.name(),
        model: example.model.map(|model| protocol[model].name.as_str()),
        frames: vec![Frame { id, data: example.data.as_deref().map(log::hexadecimal) }],
        means: message.map_or_else(Vec::new, |message| means(message, &example.means)),
        notes: rules(&example.notes),
        fails: example.fails.map(model::Failure::name),
        origin: words::origin(example.origin),
        sequence: examples::sequence(&example.doc).map(|(name, _)| name),
        remarks: (&example.doc).into(),
    }
}

fn of_long<'a>(protocol: &'a Protocol, example: &'a LongExample) -> Example<'a> {
    let long = &protocol[example.long];
    let extended = protocol.identifier.extended;
    let frames = example
        .frames
        .iter()
        .map(|(id, data)| Frame { id: log::identifier_digits(*id, extended), data: Some(log::hexadecimal(data)) });
    Example {
        message: Some(&protocol[long.message].name),
        kind: example.kind.name(),
        model: example.model.map(|model| protocol[model].name.as_str()),
        frames: frames.collect(),
        means: means(&long.content, &example.means),
        notes: rules(&example.notes),
        fails: None,
        origin: words::origin(example.origin),
        sequence: examples::sequence(&example.doc).map(|(name, _)| name),
        remarks: (&example.doc).into(),
    }
}

fn means<'a>(message: &'a Message, means: &'a [Meaning]) -> Vec<Means<'a>> {
    means.iter().map(|known| Means { signal: &message[known.signal].name, text: &known.text }).collect()
}

fn rules(notes: &[NoteRule]) -> Vec<&'static str> {
    notes.iter().map(|note| note.name()).collect()
}

/// Bytes of a type, and their value.
#[derive(Serialize)]
pub struct TypeExample<'a> {
    name: &'a str,
    data: String,
    means: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
}

impl<'a> From<&'a ValueExample> for TypeExample<'a> {
    fn from(example: &'a ValueExample) -> Self {
        Self {
            name: &example.signal.name,
            data: log::hexadecimal(examples::bytes(example)),
            means: &example.meaning.text,
            remarks: (&example.doc).into(),
        }
    }
}
