//! Codecs of the same frames, to be measured beside each other, and the client.

/// Hands values over, and the compiler cannot know what happens to them.
macro_rules! take {
    ($($value:expr),*) => {{ $(::std::hint::black_box($value);)* }};
}

pub mod client;
pub mod frame;
pub mod infy;
pub mod processor_time;
pub mod steps;
pub mod supply;
pub mod work;
pub mod workload;

use std::fmt::Debug;

use frame::Frame;

/// A codec under measurement.
pub trait Codec: Sized + 'static {
    /// Name in the table.
    const NAME: &'static str;
    /// A decoded frame, as the codec itself has it.
    type Received: 'static;
    /// What a frame is encoded from.
    type Values: 'static;
    /// The values of a request, and whom it addresses.
    type Request: 'static;
    /// A decoded frame, as the codec by hand has it.
    type ByHand;

    /// Returns a frame that the codec knows, with the same data.
    fn known(frame: &Frame) -> Frame {
        *frame
    }

    /// Decodes a frame.
    ///
    /// # Errors
    ///
    /// Refuses a frame that is none of the protocol.
    fn decode(frame: &Frame) -> Result<Self::Received, impl Debug>;

    /// Takes the address of the sender and each physical value, one after the other.
    fn take(received: &Self::Received);

    /// Builds the frame of values that were decoded, whatever its kind.
    fn encode(values: &Self::Values) -> Option<impl embedded_can::Frame>;

    /// Builds the frame of a request from its values and its target.
    fn request(request: &Self::Request) -> Option<impl embedded_can::Frame>;

    /// Returns the values of a decoded frame.
    fn to_values(received: &Self::Received) -> Self::Values;

    /// Returns what a frame with these values asks for, unless it is a reply.
    fn to_request(values: &Self::Values) -> Option<Self::Request>;

    /// Returns the values in the types of the hand-written codec, so that they can be compared.
    fn to_hand(received: &Self::Received) -> Self::ByHand;
}
