//! Lists what a protocol says and a DBC cannot.

use super::file::is_writable;
use super::signals::written;
use crate::model::{Kind, Message, Protocol, Signal};

/// Returns a sentence for each loss.
pub fn losses(protocol: &Protocol, mask: u32) -> Vec<String> {
    let mut losses = Vec::new();
    losses.extend(identifier(protocol, mask));
    losses.extend(foreign(protocol));
    losses.extend(models(protocol));
    losses.extend(about(protocol, |signal| written(protocol, signal, &signal.name).loss));
    losses.extend(about(protocol, |signal| {
        (!signal.model_ranges.is_empty() && signal.encoding.by_model().is_empty())
            .then_some("has limits that depend on the device model; the widest are given")
    }));
    losses.extend(about(protocol, |signal| {
        let word = signal.encoding.status_word().map(|word| &protocol[word]);
        let bits = word.into_iter().flat_map(|word| &word.bits);
        let values = protocol.named_values(signal).iter().map(|value| &value.models);
        let mut lists = bits.map(|bit| &bit.models).chain(values).chain([&signal.models]);
        lists
            .any(|models| !models.is_empty())
            .then_some("is not on all device models, or some of its bits or values are not")
    }));
    losses.extend(about(protocol, |signal| {
        let is_beyond = protocol.named_values(signal).iter().any(|value| !is_writable(value.raw));
        is_beyond.then_some("names raw values from 2^63 on")
    }));
    losses.extend(protocol.messages.iter().filter_map(lengths));
    losses.extend(
        protocol.long_messages.iter().map(|long| {
            format!("what the frames of `{}` say together; it has their numbers and data", long.content.name)
        }),
    );
    if protocol.frames.iter().any(|frame| frame.payload().next().is_some()) {
        losses.push(
            "whether all constants in the data are right; so an unknown message may be read as a known one".to_owned(),
        );
    }
    if protocol.frames.iter().any(|frame| frame.kind == Kind::Reply) {
        losses.push("which request a reply answers, and who answers it".to_owned());
    }
    if !protocol.procedures.is_empty() || !protocol.timing.is_empty() {
        losses.push("times and procedures of the document, but for the cycles of reports".to_owned());
    }
    losses
}

/// Names the shorter frames of a message.
fn lengths(message: &Message) -> Option<String> {
    let (_, shorter) = message.lengths.split_last()?;
    let shorter: Vec<_> = shorter.iter().map(u8::to_string).collect();
    let text = || format!("`{}` can also have {} bytes", message.name, shorter.join(" or "));
    (!shorter.is_empty()).then(text)
}

/// Names the fields of the identifier with bits outside the mask.
fn identifier(protocol: &Protocol, mask: u32) -> Option<String> {
    let fields = protocol.identifier.fields.iter().filter(|field| field.mask() & !mask != 0);
    let names: Vec<_> = fields.map(|field| field.name.as_str()).collect();
    (!names.is_empty()).then(|| format!("what varies in the identifier: {}", names.join(", ")))
}

fn foreign(protocol: &Protocol) -> Option<String> {
    let names: Vec<_> = protocol.foreign.iter().map(|foreign| foreign.name.as_str()).collect();
    (!names.is_empty()).then(|| format!("identifiers of somebody else: {}", names.join(", ")))
}

fn models(protocol: &Protocol) -> Option<String> {
    let names: Vec<_> = protocol.models.iter().map(|model| model.name.as_str()).collect();
    (!names.is_empty()).then(|| format!("the device models {}; it has the messages of all models", names.join(", ")))
}

/// Lists signals with a loss, and says what it is.
fn about(protocol: &Protocol, what: impl Fn(&Signal) -> Option<&'static str>) -> Vec<String> {
    let of = |message: &Message| {
        let signals = message.signals.iter().filter_map(|signal| Some((signal, what(signal)?)));
        let sentence = |(signal, what): (&Signal, &str)| format!("`{}.{}` {what}", message.name, signal.name);
        signals.map(sentence).collect::<Vec<_>>()
    };
    protocol.messages.iter().flat_map(of).collect()
}
