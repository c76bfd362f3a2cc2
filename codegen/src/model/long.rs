//! Messages that are longer than a frame.

use serde::{Deserialize, Serialize};

use crate::model::{Array, LongMessageId, Message, MessageId, ModelId, OfModel, Protocol, Signal, SignalId};

/// What the data of several frames say together.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LongMessage {
    /// The message whose frames carry the parts.
    pub message: MessageId,
    /// What the parts carry together. Its signals have windows; it has no frames of its own.
    pub content: Message,
    /// How the frames carry it.
    pub parts: Parts,
}

/// How the parts of a long message are numbered and joined.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Parts {
    /// The signal of the frames that numbers them.
    pub number: SignalId,
    /// The signal of the frames that carries the data of a part.
    pub data: SignalId,
    /// Number of data bytes in a part.
    pub size: u8,
    /// Number of the first part, if it is the same for every model.
    pub first: Option<u16>,
    /// Numbers of the first part by device model, if each has its own.
    pub model_firsts: Vec<OfModel<u16>>,
    /// Where a device says how many elements the array of varying length has.
    pub count: Option<(MessageId, SignalId)>,
}

impl LongMessage {
    /// Returns the greatest number of data bytes.
    pub fn longest(&self) -> usize {
        self.bytes_with(None)
    }

    /// Returns the least number of data bytes.
    pub fn shortest(&self) -> usize {
        self.bytes_with(self.varying().and_then(|array| array.least))
    }

    /// Returns how many data bytes it has with some number of elements in arrays of varying length, or with all.
    pub fn bytes_with(&self, elements: Option<usize>) -> usize {
        let present = self.content.signals.iter().filter(|signal| self.is_among(elements, signal));
        present.map(Signal::reach).max().unwrap_or(0)
    }

    /// Tests whether a signal is there if arrays of varying length have some number of elements.
    pub fn is_among(&self, elements: Option<usize>, signal: &Signal) -> bool {
        let known = elements.zip(self.counted(signal));
        known.is_none_or(|(elements, index)| index < elements)
    }

    /// Returns how many elements come before a signal in its array, if the length of that varies.
    pub fn counted(&self, signal: &Signal) -> Option<usize> {
        let element = signal.element?;
        self.content[element.array].least.map(|_| element.index.into())
    }

    /// Returns an array whose length varies, if there is one. Others vary with it.
    pub fn varying(&self) -> Option<&Array> {
        self.content.arrays.iter().find(|array| array.least.is_some())
    }

    /// Returns how many parts carry some number of bytes.
    pub fn parts_of(&self, bytes: usize) -> usize {
        bytes.div_ceil(self.parts.size.into()).max(1)
    }

    /// Returns the number of the first part, if that is known of the device model.
    pub fn first(&self, model: Option<ModelId>) -> Option<u16> {
        let own = self.parts.model_firsts.iter().find(|own| Some(own.model) == model);
        own.map(|own| own.value).or(self.parts.first)
    }
}

impl Protocol {
    /// Returns the long message whose parts a message carries.
    pub fn long_message(&self, message: &Message) -> Option<(LongMessageId, &LongMessage)> {
        let id = message.long?;
        Some((id, &self[id]))
    }

    /// Returns what the frames of each message carry, then what the parts of each long message carry
    /// together.
    pub fn contents(&self) -> impl Iterator<Item = &Message> {
        self.messages.iter().chain(self.long_messages.iter().map(|long| &long.content))
    }
}
