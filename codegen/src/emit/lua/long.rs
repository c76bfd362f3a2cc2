//! Writes long messages: what their frames carry together, and how.

use std::time::Duration;

use super::signal::{place, signal, wide};
use super::table::Value;
use super::{in_data, in_identifier};
use crate::model::{
    Carrier, Continuation, FrameLayout, Groups, LongMessage, Parts, Protocol, SelectorPlace, Signal, Standard,
    Transport, TransportId, Varying,
};

pub fn long(protocol: &Protocol, long: &LongMessage) -> Value {
    let lengths = (!long.lengths.is_empty()).then(|| Value::list(&long.lengths, |length| Value::number(*length)));
    let elements = long.varying().map(|field| [field.least, field.most]);
    let record = Value::record()
        .maybe("lengths", lengths)
        .maybe("varying", long.varying().map(varying))
        .maybe("elements", elements.map(|ends| Value::list(ends, |end| Value::Plain(end.to_string()))))
        .with("signals", Value::list(&long.content.signals, |known| long_signal(protocol, long, known)));
    match &long.carrier {
        Carrier::Parts(known) => record.with("parts", parts(known, protocol.silence(long))),
        Carrier::Transport(transport) => record.with("via", via(protocol, *transport, &long.frames)),
    }
}

/// Names what varies in length.
fn varying(field: Varying) -> Value {
    let what = if field.is_text { "bytes" } else { "elements" };
    Value::text(&format!("{what} of `{}`", field.name))
}

/// Returns a signal with the first of the eight bytes in which it has its place.
fn long_signal(protocol: &Protocol, long: &LongMessage, known: &Signal) -> Value {
    signal(protocol, (&long.content, long.shortest_sent()), known)
        .with("window", Value::number(known.window))
        .maybe("least", known.run.map(|run| Value::number(run.least)))
        .maybe("most", known.run.map(|run| Value::number(run.most)))
        .maybe("index", long.counted(known).map(|index| Value::Plain(index.to_string())))
}

fn parts(parts: &Parts, silence: Option<Duration>) -> Value {
    let firsts = parts.model_firsts.iter().map(|own| (Value::id(own.model), Value::number(own.value)));
    let count = parts
        .count
        .map(|(message, signal)| Value::record().with("message", Value::id(message)).with("signal", Value::id(signal)));
    Value::record()
        .with("number", Value::id(parts.number))
        .maybe("counter", parts.counter.map(Value::id))
        .with("data", place(parts.data))
        .with("size", Value::number(parts.size))
        .maybe("length", parts.length.map(|length| place(length.place)))
        .maybe("first", parts.first.map(Value::number))
        .maybe("firsts", parts.first.is_none().then(|| Value::map(firsts)))
        .maybe("count", count)
        .maybe("silence", silence.map(|silence| Value::Plain(silence.as_secs_f64().to_string())))
}

/// Returns what announces a message: the constants that it shows first, and who sends it.
fn via(protocol: &Protocol, transport: TransportId, frames: &[FrameLayout]) -> Value {
    let transport = &protocol[transport];
    let layout = |frame: &FrameLayout| {
        let record = Value::record()
            .with("to_module", Value::flag(frame.is_to_module()))
            .with("in_identifier", in_identifier(frame));
        match transport.standard {
            Standard::J1939(_) => record,
            Standard::Isotp(_) => joined(protocol, frame, record),
        }
    };
    Value::record().with("name", Value::text(&transport.name)).with("layouts", Value::list(frames, layout))
}

/// Adds what the joined data show of a message whose constants stand in them.
fn joined(protocol: &Protocol, frame: &FrameLayout, record: Value) -> Value {
    record
        .with("access", Value::text(&protocol[frame.access].name))
        .with("kind", Value::text(frame.kind.name()))
        .with("selectors", Value::list(&frame.selectors, |id| Value::id(*id)))
        .with("in_data", in_data(frame))
        .with("head", Value::Plain(frame.head().to_string()))
        .maybe("bare", frame.signals.is_empty().then(|| Value::flag(true)))
}

pub fn transport(transport: &Transport) -> Value {
    let names = transport.standard.frames().iter().map(|(_, name)| *name);
    let frames =
        names.zip(&transport.frames).fold(Value::record(), |record, (name, id)| record.with(name, Value::id(*id)));
    let record = Value::record().with("name", Value::text(&transport.name));
    let record = match &transport.standard {
        Standard::J1939(Groups { group, target, source }) => record
            .with("group", Value::list(group, |field| Value::id(*field)))
            .with("target", Value::id(*target))
            .with("source", Value::id(*source)),
        Standard::Isotp(_) => record,
    };
    record.with("frames", frames)
}

/// Returns the field that says whether more parts follow, and its value if they do.
pub fn continuation(protocol: &Protocol, known: Continuation) -> Value {
    let width = match known.place {
        SelectorPlace::Identifier(_) => 32,
        SelectorPlace::Payload(place) => place.width(),
    };
    let record = Value::record().with("value", wide(known.raw, width));
    match known.place {
        SelectorPlace::Identifier(field) => record.with("field", Value::id(field)),
        SelectorPlace::Payload(known) => {
            let selector = protocol.selectors.position(|selector| selector.place == SelectorPlace::Payload(known));
            record.maybe("selector", selector.map(Value::id))
        }
    }
}
