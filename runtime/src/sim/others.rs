//! Other controllers on the bus.

use crate::Frame;
use crate::clock::{earlier, has_come};

/// How many controllers there can be beside the client.
pub const MOST: usize = 4;

/// Other controllers.
#[derive(Clone, Copy, Debug)]
pub struct Others([Option<Other>; MOST]);

/// Another controller, which sends one frame again and again.
#[derive(Clone, Copy, Debug)]
struct Other {
    frame: Frame,
    /// The time between two of them.
    every: u32,
    /// When the next one is due.
    due: u32,
}

impl Others {
    pub const NONE: Self = Self([None; MOST]);

    /// Adds one, or gives the frame back if there is no room.
    pub fn add(&mut self, frame: Frame, every: u32, from: u32) -> Result<(), Frame> {
        let slot = self.0.iter_mut().find(|slot| slot.is_none()).ok_or(frame)?;
        *slot = Some(Other { frame, every: every.max(1), due: from });
        Ok(())
    }

    /// Returns a frame that is due, and when it was due.
    pub fn due(&mut self, now: u32) -> Option<(Frame, u32)> {
        let due = self.0.iter_mut().flatten().filter(|other| has_come(other.due, now));
        let other = due.reduce(|one, other| if earlier(other.due, one.due, now) { other } else { one })?;
        let due = other.due;
        other.due = due.wrapping_add(other.every);
        Some((other.frame, due))
    }
}
