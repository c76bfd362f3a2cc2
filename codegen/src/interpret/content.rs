//! Turns what was decoded into what can be encoded.

use super::{Assembled, Content, Decoded, Form, Frame, Input, Reading, Value};
use crate::model::{Example, FrameLayout, Message, Protocol, Signal};

impl Frame {
    /// Returns the frame of an example. If it is printed without data, only the bytes that choose
    /// its message are set.
    pub fn of(protocol: &Protocol, example: &Example) -> Self {
        let message = example.message.map(|id| &protocol[id]);
        let data = example.data.clone().unwrap_or_else(|| {
            let length = message.map_or(8, Message::shortest);
            let constants = message.map_or([0; 8], |message| constants(protocol, message, example));
            constants.into_iter().take(length.into()).collect()
        });
        Self { id: example.id, extended: example.extended, data, form: Form::Data }
    }
}

/// Returns the data bytes that choose the frame of an example.
fn constants(protocol: &Protocol, message: &Message, example: &Example) -> [u8; 8] {
    let frame = protocol.frames_of(message).find(|frame| frame.kind == example.kind);
    frame.map_or([0; 8], constant_data)
}

/// Returns the data bytes of a kind of frame that is built: its constants, and what is sent where nothing is named.
pub fn blank_data(frame: &FrameLayout) -> [u8; 8] {
    (u64::from_be_bytes(constant_data(frame)) | frame.filled()).to_be_bytes()
}

/// Returns the data bytes of a kind of frame with only its constants set.
pub fn constant_data(frame: &FrameLayout) -> [u8; 8] {
    let mut data = [0; 8];
    frame.payload().for_each(|(place, value)| place.put(&mut data, value));
    data
}

impl Content {
    /// Takes over a decoded frame, so that encoding gives the same frame.
    pub fn of(protocol: &Protocol, decoded: &Decoded) -> Self {
        let message = decoded.content(protocol);
        let fields = decoded.identifier(protocol);
        let selectors = decoded.selectors.iter().map(|(id, value)| (protocol[*id].name.clone(), *value));
        let signals = decoded.signals.iter().map(|reading| {
            let signal = &message[reading.signal];
            (signal.name.clone(), Input::of(protocol, signal, reading))
        });
        Self {
            message: message.name.clone(),
            access: Some(protocol[decoded.access].name.clone()),
            kind: Some(decoded.kind),
            identifier: fields.map(|(field, value)| (field.name.clone(), u64::from(value))).collect(),
            selectors: selectors.collect(),
            signals: signals.collect(),
            arrays: Vec::new(),
            reserved: decoded.reserved.iter().copied().take(decoded.length).collect(),
        }
    }
}

impl Content {
    /// Takes over a long message, so that encoding gives the same frames.
    pub fn of_long<M>(protocol: &Protocol, assembled: &Assembled<M>) -> Self {
        let mut whole = Self::of(protocol, &assembled.decoded);
        whole.selectors.extend(assembled.counter.clone());
        Self { reserved: assembled.reserved.clone(), ..whole }
    }
}

impl Input {
    /// Takes over a value. Without a physical value it takes the bits.
    pub fn of(protocol: &Protocol, signal: &Signal, reading: &Reading) -> Self {
        let bits = reading.bits;
        match &reading.value {
            _ if signal.run.is_some() => Self::Bytes { bytes: reading.bytes.clone(), text: None },
            Value::None => Self::Raw(signal.raw_of(bits)),
            Value::Integer(value) => Self::Integer(*value),
            Value::Number(value) => Self::Number(*value),
            Value::Name(text) | Value::Text(text) => Self::Text(text.clone()),
            Value::Status { set, unknown } => {
                let Some(word) = signal.encoding.status_word() else { return Self::Raw(bits.into()) };
                let names = protocol[word].bits.iter().filter(|bit| set >> bit.bit & 1 == 1);
                Self::Status { set: names.map(|bit| bit.name.clone()).collect(), unknown: *unknown }
            }
        }
    }
}
