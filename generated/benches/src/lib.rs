//! Three codecs of the same frames, to be measured beside each other.

/// Hands values over, and the compiler cannot know what happens to them.
macro_rules! take {
    ($($value:expr),*) => {{ $(::std::hint::black_box($value);)* }};
}

pub mod by_hand;
pub mod dbc;
pub mod frame;
pub mod frames;
pub mod generated;
pub mod hand;
pub mod processor_time;
pub mod work;

use std::fmt::Debug;
use std::hint::black_box;

use frame::Frame;

/// A codec under measurement.
pub trait Codec: 'static {
    /// Name in the table.
    const NAME: &'static str;
    /// A decoded frame, as the codec itself has it.
    type Received: 'static;
    /// What a frame is encoded from.
    type Values: 'static;
    /// The values of a request, and whom it addresses.
    type Request: 'static;
    /// A request that waits for its reply.
    type Asked: 'static;

    /// Decodes a frame.
    ///
    /// # Errors
    ///
    /// Refuses a frame that is none of the protocol.
    fn decode(frame: &Frame) -> Result<Self::Received, impl Debug>;

    /// Takes the address of the sender and each physical value, one after the other.
    fn take(received: &Self::Received);

    /// Decodes payloads of one command, and takes their values.
    fn payloads(command: u8, payloads: &[[u8; 8]]);

    /// Builds the frame of values that were decoded, whatever its kind.
    fn encode(values: &Self::Values) -> Option<impl embedded_can::Frame>;

    /// Builds the frame of a request from its values and its target.
    fn request(request: &Self::Request) -> Option<impl embedded_can::Frame>;

    /// Asks for a module's output, if the codec knows of replies.
    fn ask(target: hand::Target, controller: u8) -> Option<Self::Asked>;

    /// Returns voltage and current from a frame that answers.
    fn reply(asked: &Self::Asked, frame: &Frame) -> Option<Result<(f32, f32), hand::Failure>>;

    /// Returns the values of a decoded frame.
    fn to_values(received: &Self::Received) -> Self::Values;

    /// Returns what a frame with these values asks for, unless it is a reply.
    fn to_request(values: &Self::Values) -> Option<Self::Request>;

    /// Returns the values in the types of the hand-written codec, so that they can be compared.
    fn to_hand(received: &Self::Received) -> hand::Received;
}

/// Runs `work` on inputs that the compiler cannot foresee.
#[inline(always)]
fn each<T>(inputs: &[T], work: impl Fn(&T)) {
    for input in inputs {
        work(black_box(input));
    }
}
