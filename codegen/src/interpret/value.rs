//! Turns the raw bits of one signal into a physical value, and back.

use super::{Input, Refusal, Value};
use crate::encoding::{Allowed, Words};
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
    let raw = Words::from(protocol).with(signal, |room| room.raw(input, &allowed));
    let raw = raw.and_then(|bits| match limits.model().and_then(|model| protocol.lack(message, signal, model, bits)) {
        Some(why) => Err(why),
        None => Ok(bits),
    });
    raw.map_err(|why| Refusal(format!("{}.{}: {why}", message.name, signal.name)))
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
