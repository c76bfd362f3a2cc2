//! Finds out whether the other byte order explains a value that the document does not foresee.

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;

use super::shown;
use crate::encoding::Words;
use crate::interpret::Reading;
use crate::model::{Id, Protocol, Signal};

/// Says what a signal would be by the other byte order, if nothing is odd about it then.
pub fn explain(protocol: &Protocol, signal: &Signal, data: [u8; 8]) -> Option<String> {
    let (first, last) = reversed(signal.place)?;
    let other = Signal { place: Place::bytes(first, last), ..signal.clone() };
    let is_odd = |signal: &Signal| {
        let bits = signal.place.get(&data);
        Words::from(protocol).with(signal, |room| room.oddity(bits, &room.value(bits)).is_some())
    };
    if !is_odd(signal) || is_odd(&other) {
        return None;
    }
    let bits = other.place.get(&data);
    let read = shown(protocol, &other, &Reading::of(protocol, (Id::new(0), &other), bits));
    Some(format!(
        "with `bytes: {first}..{last}`, `{}` would be {read}; write that place, or correct the frame",
        signal.name
    ))
}

/// Returns the ends of several whole bytes in the other order.
fn reversed(place: Place) -> Option<(u8, u8)> {
    let mask = u64::from_be_bytes(place.mask());
    let (before, after) = (mask.leading_zeros(), mask.trailing_zeros());
    let is_whole = before % 8 == 0 && after % 8 == 0 && before + after < 56;
    let (first, last) = (u8::try_from(before / 8).ok()?, 7_u8.checked_sub(u8::try_from(after / 8).ok()?)?);
    let ends = if place.order() == ByteOrder::Big { (last, first) } else { (first, last) };
    is_whole.then_some(ends)
}
