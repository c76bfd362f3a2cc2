//! Layouts: the structs that messages decode to.

use crate::{AnySignal, Data, Error, Payload};

/// What a kind of frame carries.
pub trait Layout {
    /// Takes the values out of the data of such a frame.
    fn decode(data: &Data) -> Self
    where
        Self: Sized;

    /// Writes the values into data.
    ///
    /// # Errors
    ///
    /// Refuses what the signals cannot hold, and what lies outside their limits if `payload` keeps to them.
    fn encode(&self, payload: &mut Payload) -> Result<(), Error>;

    /// Returns the signals, by first byte.
    fn signals(&self) -> &'static [&'static dyn AnySignal];
}

/// A layout of one signal, from which [`Layout`] follows.
pub trait Single: Sized + 'static {
    /// The signal.
    const SIGNAL: &'static dyn AnySignal;
    /// Takes its value out of the data.
    const DECODE: Decode<Self>;
    /// Writes its value into data.
    const ENCODE: Encode<Self>;
}

/// As [`Layout::decode`].
pub type Decode<T> = fn(&Data) -> T;

/// As [`Layout::encode`].
pub type Encode<T> = fn(&T, &mut Payload) -> Result<(), Error>;

impl<T: Single> Layout for T {
    fn decode(data: &Data) -> Self {
        Self::DECODE(data)
    }

    fn encode(&self, payload: &mut Payload) -> Result<(), Error> {
        Self::ENCODE(self, payload)
    }

    fn signals(&self) -> &'static [&'static dyn AnySignal] {
        const { &[Self::SIGNAL] }
    }
}

/// Frames without signals.
impl Layout for () {
    fn decode(_: &Data) {}

    fn encode(&self, _: &mut Payload) -> Result<(), Error> {
        Ok(())
    }

    fn signals(&self) -> &'static [&'static dyn AnySignal] {
        &[]
    }
}
