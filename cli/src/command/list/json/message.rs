//! A message with its frames and signals.

use canspec_codegen::model::{self, LongMessage, MessageId, Protocol, WrittenPlace};
use serde::Serialize;

use super::frame::Frame;
use super::remarks::{Remarks, names};
use super::signal::Signal;
use crate::command::list::derivation;

/// A message.
#[derive(Serialize)]
pub struct Message<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    models: Vec<&'a str>,
    /// Which spec it comes from, if the spec has a base.
    from: Option<String>,
    lengths: &'a [u8],
    every: Option<&'a str>,
    reserved: Reserved,
    sends: Vec<Sent<'a>>,
    fixed: Vec<Fixed<'a>>,
    members: Vec<&'a str>,
    frames: Vec<Frame<'a>>,
    refusals: Vec<Frame<'a>>,
    signals: Vec<Signal<'a>>,
    long: Option<Long<'a>>,
}

/// What the bits are that nothing names.
#[derive(Serialize)]
struct Reserved {
    send: u8,
    expect: &'static str,
}

/// A field of the identifier that a message sends with a value of its own.
#[derive(Serialize)]
struct Sent<'a> {
    field: &'a str,
    value: u32,
}

/// A field that has one value in the message.
#[derive(Serialize)]
struct Fixed<'a> {
    selector: &'a str,
    value: u64,
    #[serde(flatten)]
    remarks: Remarks<'a>,
}

impl<'a> Fixed<'a> {
    fn of(protocol: &'a Protocol, known: &'a model::FixedField) -> Self {
        Self { selector: &protocol[known.selector].name, value: known.value, remarks: (&known.doc).into() }
    }
}

impl<'a> Message<'a> {
    /// Returns a message of a protocol.
    pub fn of(protocol: &'a Protocol, id: MessageId) -> Self {
        let message = &protocol[id];
        let members = message.set.iter().flat_map(|set| &set.members);
        let sends = message.sends.iter().map(|(field, value)| Sent { field: &protocol[*field].name, value: *value });
        let model::Reserved { are_ones, are_free, .. } = message.reserved;
        Self {
            name: &message.name,
            remarks: (&message.doc).into(),
            models: names(protocol, &message.models),
            from: derivation::descent(protocol, id),
            lengths: &message.lengths,
            every: message.every.map(|timing| protocol[timing].name.as_str()),
            reserved: Reserved { send: are_ones.into(), expect: if are_free { "any" } else { "sent" } },
            sends: sends.collect(),
            fixed: message.fixed.iter().map(|known| Fixed::of(protocol, known)).collect(),
            members: members.map(|member| protocol[*member].name.as_str()).collect(),
            frames: protocol.frames_of(message).map(|frame| Frame::of(protocol, frame)).collect(),
            refusals: message.refusals.iter().map(|frame| Frame::of(protocol, frame)).collect(),
            signals: Signal::all(protocol, message),
            long: protocol.long_message(message).map(|(_, long)| Long::of(protocol, long)),
        }
    }
}

/// What several frames say together.
#[derive(Serialize)]
struct Long<'a> {
    minimum: usize,
    maximum: usize,
    lengths: &'a [u16],
    transport: Option<&'a str>,
    parts: Option<Parts<'a>>,
    frames: Vec<Frame<'a>>,
    signals: Vec<Signal<'a>>,
}

/// How the parts of a long message are numbered.
#[derive(Serialize)]
struct Parts<'a> {
    size: u8,
    first: Option<u16>,
    firsts: Vec<First<'a>>,
    length: Option<WrittenPlace>,
    count: Option<String>,
    silence: Option<&'a str>,
}

/// The number of the first part on a device model.
#[derive(Serialize)]
struct First<'a> {
    model: &'a str,
    number: u16,
}

impl<'a> Long<'a> {
    fn of(protocol: &'a Protocol, long: &'a LongMessage) -> Self {
        let transport = long.transport().map(|transport| protocol[transport].name.as_str());
        Self {
            minimum: long.shortest(),
            maximum: long.longest(),
            lengths: &long.lengths,
            transport,
            parts: long.parts().map(|parts| Parts::of(protocol, parts)),
            frames: long.frames.iter().map(|frame| Frame::of(protocol, frame)).collect(),
            signals: Signal::all(protocol, &long.content),
        }
    }
}

impl<'a> Parts<'a> {
    fn of(protocol: &'a Protocol, parts: &'a model::Parts) -> Self {
        let firsts = parts.model_firsts.iter();
        let firsts = firsts.map(|own| First { model: &protocol[own.model].name, number: own.value });
        let count = parts.count.map(|(message, signal)| {
            let message = &protocol[message];
            format!("{}.{}", message.name, message[signal].name)
        });
        Self {
            size: parts.size,
            first: parts.first,
            firsts: firsts.collect(),
            length: parts.length.map(|length| WrittenPlace::of(length.place)),
            count,
            silence: parts.silence.map(|timing| protocol[timing].name.as_str()),
        }
    }
}
