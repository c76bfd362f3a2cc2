//! What codecs make of frames, to be compared.

use std::fmt::Debug;

use canspec_benches::Codec;
use canspec_benches::frame::Frame;
use embedded_can::{ExtendedId, Frame as _, StandardId};
use fastrand::Rng;

/// Returns what is encoded of a decoded frame.
pub fn encoded<C: Codec>(frame: &Frame) -> Option<Frame> {
    copied(C::encode(&C::to_values(&C::decode(frame).ok()?)))
}

/// Returns what is built of the values of a request, unless the frame is none.
pub fn requested<C: Codec>(frame: &Frame) -> Option<Result<Frame, Refused>> {
    let request = C::to_request(&C::to_values(&C::decode(frame).ok()?))?;
    Some(copied(C::request(&request)).ok_or(Refused))
}

/// A request is not built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refused;

pub fn copied(frame: Option<impl embedded_can::Frame>) -> Option<Frame> {
    frame.and_then(|frame| Frame::copy(&frame))
}

/// Compares what two codecs make of random frames, and counts the refusals.
///
/// Values, modes and addresses come from random bytes, so the codecs refuse many of them.
pub fn refusals<T: PartialEq + Debug>(
    frames: impl Iterator<Item = Frame>,
    [one, other]: [fn(&Frame) -> T; 2],
    refusal: &T,
) -> usize {
    let made = frames.map(|frame| {
        let made = one(&frame);
        assert_eq!(other(&frame), made, "{frame:?}");
        made
    });
    made.filter(|made| made == refusal).count()
}

/// Returns a million random frames.
pub fn many(seed: u64, frame: fn(&mut Rng) -> Frame) -> impl Iterator<Item = Frame> {
    let mut rng = Rng::with_seed(seed);
    (0..1_000_000).map(move |_| frame(&mut rng))
}

/// Returns a frame of any type and length, often with this identifier and these data.
pub fn of_any_type(rng: &mut Rng, id: u32, data: [u8; 8]) -> Frame {
    let id = ExtendedId::new(id).expect("29 bits");
    let length = if rng.bool() { 8 } else { rng.usize(..=8) };
    let frame = match rng.u8(..10) {
        0 => Frame::new_remote(id, length),
        1 => Frame::new(StandardId::new(rng.u16(..0x800)).expect("11 bits"), &data[..length]),
        _ => Frame::new(id, &data[..length]),
    };
    frame.expect("at most eight bytes")
}
