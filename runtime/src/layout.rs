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
