//! Layouts: the structs that messages decode to.

use crate::{AnySignal, Data, Error, Payload};

/// What a kind of frame carries.
pub trait Layout: Sized + 'static {
    /// The signals, by first byte.
    const SIGNALS: &'static [&'static dyn AnySignal];
    /// Takes the values out of the data of such a frame.
    const DECODE: Decode<Self>;
    /// Writes the values into data.
    const ENCODE: Encode<Self>;

    /// Takes the values out of the data of such a frame.
    fn decode(data: &Data) -> Self {
        Self::DECODE(data)
    }

    /// Writes the values into data.
    ///
    /// # Errors
    ///
    /// Refuses what the signals cannot hold, and what lies outside their limits if `payload` keeps to them.
    fn encode(&self, payload: &mut Payload) -> Result<(), Error> {
        Self::ENCODE(self, payload)
    }
}

/// As [`Layout::decode`].
pub type Decode<T> = fn(&Data) -> T;

/// As [`Layout::encode`].
pub type Encode<T> = fn(&T, &mut Payload) -> Result<(), Error>;

/// Frames without signals.
impl Layout for () {
    const SIGNALS: &'static [&'static dyn AnySignal] = &[];
    const DECODE: Decode<Self> = |_| ();
    const ENCODE: Encode<Self> = |(), _| Ok(());
}

/// What is done with the values of any message.
///
/// Each task has code of its own, so that reading does not link writing.
pub trait Task {
    /// What comes out.
    type Output;

    /// Does it.
    fn run<L: Layout>(self, values: &L) -> Self::Output;
}

/// Returns the signals.
pub struct Signals;

impl Task for Signals {
    type Output = &'static [&'static dyn AnySignal];

    fn run<L: Layout>(self, _: &L) -> Self::Output {
        L::SIGNALS
    }
}

impl Task for &mut Payload {
    type Output = Result<(), Error>;

    fn run<L: Layout>(self, values: &L) -> Self::Output {
        values.encode(self)
    }
}
