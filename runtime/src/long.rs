//! Messages that are longer than a frame.
//!
//! What several frames carry together is a struct with a [`LongLayout`]: it reads the joined data
//! and writes them. How the frames carry the data does not matter here.

pub(crate) mod buffer;
mod elements;
pub mod parts;
mod signal;
mod text;
pub mod transfers;

use crate::{Error, Payload};

pub use elements::Elements;
pub use signal::{LongPayload, LongSignal};
pub use text::{ByteRun, LongText};

#[cfg(test)]
mod tests;

/// Tests whether the fields of a message can have some number of data bytes if its constants end with the first `head`.
fn has_size<L: LongLayout>(head: usize, size: usize) -> bool {
    match L::ELEMENTS {
        None => size == L::SHORTEST.max(head),
        Some((least, most)) => (least..=most).any(|elements| L::BYTES(elements).max(head) == size),
    }
}

/// The values that several frames carry together. Generated code implements it.
pub trait LongLayout: Copy + 'static {
    /// Name of the message.
    const MESSAGE: &'static str;
    /// The least number of data bytes: those up to the end of the last field that is always there.
    const SHORTEST: usize;
    /// The greatest number of data bytes, those of constants included.
    const LONGEST: usize;
    /// The byte in which no field has a bit.
    const BLANK: u8 = 0;
    /// The least and the greatest number of elements of the arrays that vary in length, if there are any.
    const ELEMENTS: Option<(usize, usize)> = None;
    /// Returns how many data bytes there are if these arrays have some number of elements.
    const BYTES: fn(usize) -> usize = |_| Self::LONGEST;
    /// Reads the values from at least [`SHORTEST`](Self::SHORTEST) data bytes.
    const DECODE: fn(&[u8]) -> Self;
    /// Writes the values to the data.
    const ENCODE: fn(&Self, &mut LongPayload<'_>) -> Result<(), Error>;

    /// Reads the values from the joined data. Arrays that vary in length have as many elements as
    /// the data hold whole.
    ///
    /// Returns `None` for fewer bytes than [`SHORTEST`](Self::SHORTEST). Bytes that no field covers
    /// do not count.
    fn decode(data: &[u8]) -> Option<Self> {
        (data.len() >= Self::SHORTEST).then(|| Self::DECODE(data))
    }

    /// The same as [`decode`](Self::decode), of a message of a device model. Optional values that the model does not
    /// have are left out, unless bits show them.
    fn decode_for(model: impl Into<u8>, data: &[u8]) -> Option<Self> {
        Self::decode(data).map(|values| values.on_model(data, Some(model.into())))
    }

    /// Leaves out optional values that the device model does not have, if no bit of the data shows them.
    #[doc(hidden)]
    #[must_use]
    fn on_model(self, _data: &[u8], _model: Option<u8>) -> Self {
        self
    }

    /// Writes the values to the front of a buffer, and returns what is written. It also overwrites
    /// the rest of the buffer. [`LONGEST`](Self::LONGEST) bytes are always enough. Bits that no
    /// field covers are those of [`BLANK`](Self::BLANK). Constants are none of the fields: what sends
    /// the message writes them.
    ///
    /// # Errors
    ///
    /// Refuses
    /// - a value that the bits of its signal cannot hold,
    /// - an array with fewer elements than the document allows, or not as many as the others that
    ///   vary with it,
    /// - a field that is missing before one that is there,
    /// - a buffer with too few bytes.
    fn encode<'a>(&self, buffer: &'a mut [u8]) -> Result<&'a [u8], Error> {
        self.encode_by(Payload::new(Self::MESSAGE, [0; 8]), 0, buffer).map(|data| &*data)
    }

    /// The same as [`encode`](Self::encode), of values that keep to the limits that `rules` say, in
    /// at least `least` bytes.
    ///
    /// # Errors
    ///
    /// The same as those of [`encode`](Self::encode), and values outside the limits.
    #[doc(hidden)]
    fn encode_by<'a>(&self, rules: Payload, least: usize, buffer: &'a mut [u8]) -> Result<&'a mut [u8], Error> {
        buffer.fill(Self::BLANK);
        let mut payload = LongPayload::new(rules, Self::ELEMENTS, buffer);
        Self::ENCODE(self, &mut payload)?;
        let by_elements = || payload.elements().map_or(Self::SHORTEST, Self::BYTES);
        let length = payload.length().unwrap_or_else(by_elements).max(least);
        let room = buffer.len();
        buffer.get_mut(..length).ok_or(Error::Room { message: Self::MESSAGE, length, room })
    }
}
