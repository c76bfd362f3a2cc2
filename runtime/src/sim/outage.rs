//! A bus that goes away.

use crate::clock::has_come;

/// A time in which nothing passes on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outage {
    /// When it begins.
    pub from: u32,
    /// When frames pass again.
    pub until: u32,
    /// What becomes of the frames that the client sends meanwhile.
    pub driver: Driver,
}

/// What the driver of the client does with frames while nothing passes on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// It drops them.
    Drops,
    /// It keeps them, and sends them in a burst when the bus is back. They take the room of frames under way.
    Buffers,
}

impl Outage {
    /// Tests whether nothing passes at a time.
    pub fn covers(&self, time: u32) -> bool {
        self.has_begun(time) && !self.is_over(time)
    }

    /// Tests whether it has begun.
    pub fn has_begun(&self, now: u32) -> bool {
        has_come(self.from, now)
    }

    /// Tests whether frames pass again.
    pub fn is_over(&self, now: u32) -> bool {
        has_come(self.until, now)
    }
}
