//! Places in a long message: eight bytes of it at a time.

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;

use crate::model::Signal;

/// Most data bytes of a long message. ISO 15765-2 has no more, either.
pub const MOST_BYTES: u16 = 4095;

/// A place, and how many bytes of a long message come before its window.
pub type Windowed = (u16, Place);

/// Returns a signal of the first eight bytes with its place in a frame.
pub fn in_frame(signal: &Signal) -> Option<Signal> {
    let moved = 8 * u8::try_from(signal.window).ok()?;
    let in_frame = |place: Place| {
        let (low, width) = (place.bits_of_payload().shift(), place.width());
        let (payload, low) = match place.order() {
            ByteOrder::Big => (Place::bytes(0, 7), low.checked_sub(moved)?),
            ByteOrder::Little => (Place::bytes(7, 0), low + moved),
        };
        (low + width <= 64).then(|| payload.bits(low + width - 1, low))
    };
    let place = in_frame(signal.place)?;
    let word = in_frame(signal.word).unwrap_or(place);
    Some(signal.clone().changed(|signal| (signal.window, signal.place, signal.word) = (0, place, word)))
}
