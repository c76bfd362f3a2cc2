//! Frames under way.

use crate::Frame;
use crate::clock::{earlier, has_come};

/// Frames under way to the client, at most `W`.
#[derive(Clone, Copy, Debug)]
pub struct Wire<const W: usize>(pub [Option<(u32, Frame)>; W]);

impl<const W: usize> Wire<W> {
    /// Sends a frame that comes at a time. It is lost if there is no room.
    pub fn send(&mut self, at: u32, frame: Frame) {
        if let Some(slot) = self.0.iter_mut().find(|slot| slot.is_none()) {
            *slot = Some((at, frame));
        }
    }

    /// Takes out the frame that has come first.
    pub fn arrived(&mut self, now: u32) -> Option<Frame> {
        let come = self.0.iter_mut().filter(|slot| slot.is_some_and(|(at, _)| has_come(at, now)));
        let at = |slot: &Option<(u32, Frame)>| slot.map_or(now, |(at, _)| at);
        let first = come.reduce(|one, other| if earlier(at(other), at(one), now) { other } else { one })?;
        first.take().map(|(_, frame)| frame)
    }
}
