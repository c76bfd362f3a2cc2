//! Turns the raw bits of one signal into a physical value, and back.

use super::{Input, Refusal, Value};
use crate::encoding::{self, Allowed, Words};
use crate::model::{FrameLayout, Message, ModelId, Protocol, Signal};

/// Returns the physical value of a signal's raw bits.
pub fn physical(protocol: &Protocol, signal: &Signal, bits: u64) -> Value {
    Words::from(protocol).with(signal, |room| room.value(bits))
}

/// The limits of a value to send.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limits {
    /// Whatever the bits hold, as in a reply.
    Bits,
    /// The range, as in a request. It is that of a device model, or the hull of all models' ranges
    /// if none is chosen.
    Range(Option<ModelId>),
}

impl Limits {
    /// Returns the limits of a kind of frame.
    pub fn of(frame: &FrameLayout, model: Option<ModelId>) -> Self {
        if frame.is_to_module() { Self::Range(model) } else { Self::Bits }
    }

    /// Returns the device model whose limits they are.
    fn model(self) -> Option<ModelId> {
        match self {
            Self::Bits => None,
            Self::Range(model) => model,
        }
    }

    /// Says that the device model does not have what the bits of a signal show.
    fn refused(
        self,
        protocol: &Protocol,
        message: &Message,
        signal: &Signal,
        bits: impl IntoIterator<Item = u64>,
    ) -> Option<String> {
        let model = self.model()?;
        bits.into_iter().find_map(|bits| protocol.lack(message, signal, model, bits))
    }

    /// Returns the limits of a signal.
    fn allowed(self, protocol: &Protocol, message: &Message, signal: &Signal) -> Allowed {
        let Self::Range(model) = self else { return Allowed::Everything };
        if model.is_some_and(|model| !signal.is_of(model)) {
            return Allowed::Everything;
        }
        let range = match model {
            Some(_) => signal.range_for(model),
            None => signal.hull(protocol.models_of(message)),
        };
        let depends = model.is_none() && !signal.model_ranges.is_empty();
        let advice = if depends { ", the limits of the models taken together; choose a model for its own" } else { "" };
        Allowed::Within { range, advice }
    }
}

/// Returns the raw bits of a value to send. A request also refuses values that lie outside the
/// range or are not finite.
///
/// # Errors
///
/// Names message, signal, value, unit and limits.
pub fn raw_of(
    protocol: &Protocol,
    message: &Message,
    signal: &Signal,
    input: &Input,
    limits: Limits,
) -> Result<u64, Refusal> {
    let allowed = limits.allowed(protocol, message, signal);
    let text = if let Input::Bytes { text: Some(text), .. } = input { Some(Input::Text(text.clone())) } else { None };
    let raw = Words::from(protocol).with(signal, |room| room.raw(text.as_ref().unwrap_or(input), &allowed));
    let raw = raw.and_then(|bits| limits.refused(protocol, message, signal, [bits]).map_or(Ok(bits), Err));
    raw.map_err(|why| refused(message, signal, &why))
}

/// Returns the bytes of a text to send that is a run.
///
/// # Errors
///
/// Names message, signal and text.
pub fn bytes_of(
    protocol: &Protocol,
    message: &Message,
    signal: &Signal,
    input: &Input,
    limits: Limits,
) -> Result<Vec<u8>, Refusal> {
    let bytes = encoding::bytes_of(signal, input).and_then(|bytes| {
        let words = bytes.iter().copied().map(u64::from);
        limits.refused(protocol, message, signal, words).map_or(Ok(bytes), Err)
    });
    bytes.map_err(|why| refused(message, signal, &why))
}

fn refused(message: &Message, signal: &Signal, why: &str) -> Refusal {
    Refusal(format!("{}.{}: {why}", message.name, signal.name))
}

/// Reads a value of a signal as a person types it.
///
/// # Errors
///
/// Names message and signal, and says why it is none.
pub fn typed(protocol: &Protocol, message: &Message, signal: &Signal, text: &str) -> Result<Input, Refusal> {
    let input = Words::from(protocol).with(signal, |room| room.typed(text));
    input.map_err(|why| Refusal(format!("{}.{}: {why}", message.name, signal.name)))
}
