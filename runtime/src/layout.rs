//! Layouts: the structs that messages decode to.

use crate::{AnySignal, Data, Error, Frame, Payload};

/// The values that a kind of frame carries.
pub trait Layout: Sized + 'static {
    /// The signals, by first byte.
    const SIGNALS: AnySignals;
    /// The data bits that the document reserves. Requests send zeros there, or ones where a message says so.
    /// [`Received::reserved`](crate::Received::reserved) returns those that are set.
    const RESERVED: Data = [0; 8];
    /// Reads the values from the data of such a frame.
    const DECODE: Decode<Self>;
    /// The numbers of data bytes that such a frame can have, if there are several.
    const LENGTHS: &'static [u8] = &[];

    /// Reads the values from a frame of a device model. The frame may lack those that are optional.
    #[inline(always)]
    fn read(frame: &Frame, model: Option<u8>) -> Self {
        Self::read_some(&frame.bytes(), frame.length()).on_model(&frame.bytes(), model)
    }

    /// Leaves out optional values that the device model does not have, if no bit of the data shows them.
    #[must_use]
    #[inline(always)]
    fn on_model(self, _data: &Data, _model: Option<u8>) -> Self {
        self
    }

    /// Reads the values from the data of a frame of `length` bytes.
    #[inline(always)]
    fn read_some(data: &Data, _length: usize) -> Self {
        Self::decode(data)
    }

    /// Reads the values from the data of such a frame.
    #[inline(always)]
    fn decode(data: &Data) -> Self {
        Self::DECODE(data)
    }

    /// Writes the values to the data, up to the first that `payload` does not take. Returns whether it takes all.
    ///
    /// `false` must be an answer of `payload`, which then has the reason.
    fn write_to(&self, payload: &mut Payload) -> bool;

    /// Writes the values to the data.
    ///
    /// # Errors
    ///
    /// Refuses values that the signals cannot hold. If `payload` keeps to limits, it also refuses
    /// values outside them.
    #[inline(always)]
    fn encode(&self, payload: &mut Payload) -> Result<(), Error> {
        if self.write_to(payload) { Ok(()) } else { payload.outcome() }
    }
}

/// The type of [`Layout::SIGNALS`].
pub type AnySignals = &'static [&'static dyn AnySignal];

/// The same as [`Layout::decode`].
pub type Decode<T> = fn(&Data) -> T;

/// Frames without signals.
impl Layout for () {
    const SIGNALS: AnySignals = &[];
    const DECODE: Decode<Self> = |_| ();

    #[inline(always)]
    fn write_to(&self, _: &mut Payload) -> bool {
        true
    }
}

/// Something to do with the values of any message.
///
/// Each task has code of its own, so a program that only reads does not contain the code to write.
pub trait Task {
    /// The result of the task.
    type Output;

    /// Runs the task.
    fn run<L: Layout>(self, values: &L) -> Self::Output;
}

/// Returns the signals.
pub struct Signals;

impl Task for Signals {
    type Output = AnySignals;

    fn run<L: Layout>(self, _: &L) -> Self::Output {
        L::SIGNALS
    }
}
