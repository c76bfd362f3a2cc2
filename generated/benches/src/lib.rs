//! Three codecs of the same frames, to be measured beside each other.

pub mod dbc;
pub mod frame;
pub mod frames;
pub mod generated;
pub mod hand;
pub mod processor_time;

use std::fmt::Debug;
use std::hint::black_box;

use frame::Frame;

/// A codec under measurement.
pub trait Codec {
    /// Name in the table.
    const NAME: &'static str;
    /// A decoded frame.
    type Received;
    /// The values of a request, and whom it addresses.
    type Request;

    /// Decodes a frame into typed physical values.
    ///
    /// # Errors
    ///
    /// Refuses a frame that is none of the protocol.
    fn decode(frame: &Frame) -> Result<Self::Received, impl Debug>;

    /// Builds the frame of values that were decoded, whatever its kind.
    fn encode(received: &Self::Received) -> Option<impl embedded_can::Frame>;

    /// Builds the frame of a request from its values and its target.
    fn request(request: &Self::Request) -> Option<impl embedded_can::Frame>;

    /// Returns what a decoded frame asks for, unless it is a reply.
    fn to_request(received: &Self::Received) -> Option<Self::Request>;

    /// Returns the values in the types of the hand-written codec, so that they can be compared.
    fn to_hand(received: &Self::Received) -> hand::Received;
}

/// Decodes every frame.
pub fn decode<C: Codec>(frames: &[Frame]) {
    for frame in frames {
        black_box(&C::decode(black_box(frame)));
    }
}

/// Encodes everything that was decoded.
pub fn encode<C: Codec>(received: &[C::Received]) {
    for received in received {
        black_box(&C::encode(black_box(received)));
    }
}

/// Builds every request.
pub fn request<C: Codec>(requests: &[C::Request]) {
    for request in requests {
        black_box(&C::request(black_box(request)));
    }
}

/// Returns what the frames are decoded to.
///
/// # Panics
///
/// If the codec refuses one.
pub fn received<C: Codec>(frames: &[Frame]) -> Vec<C::Received> {
    frames.iter().map(|frame| C::decode(frame).expect("a frame of the protocol")).collect()
}

/// Returns the requests among the frames.
pub fn requests<C: Codec>(frames: &[Frame]) -> Vec<C::Request> {
    received::<C>(frames).iter().filter_map(C::to_request).collect()
}
