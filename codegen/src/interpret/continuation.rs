//! How frames say that more follow.

use super::Frame;
use crate::model::{Protocol, SelectorPlace};

/// Makes all frames but the last say that more follow.
pub fn continue_all_but_last(protocol: &Protocol, frames: &mut [Frame]) {
    if let Some((_, others)) = frames.split_last_mut() {
        for frame in others {
            continue_after(protocol, frame);
        }
    }
}

/// Makes a frame say that more follow.
fn continue_after(protocol: &Protocol, frame: &mut Frame) {
    let Some(continuation) = protocol.continuation() else { return };
    match continuation.place {
        SelectorPlace::Identifier(field) => {
            let raw = u32::try_from(continuation.raw).unwrap_or(0);
            frame.id = protocol[field].put(frame.id, raw);
        }
        SelectorPlace::Payload(place) => {
            let mut data = frame.padded();
            place.put(&mut data, continuation.raw);
            frame.data = data.into_iter().take(frame.data.len()).collect();
        }
    }
}
