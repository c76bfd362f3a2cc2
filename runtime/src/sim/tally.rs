//! How often faults happened.

use core::ops::AddAssign;

/// How often faults happened to devices and to their frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tally {
    /// Requests that did not reach a device, and replies that got lost.
    pub lost: u64,
    /// Replies that came twice.
    pub twice: u64,
    /// Replies of a wrong length.
    pub broken: u64,
    /// Replies that showed another sender.
    pub disguised: u64,
    /// Requests that were refused.
    pub refused: u64,
    /// Replies whose values drifted.
    pub drifted: u64,
    /// Milliseconds until replies came, in all.
    pub delay: u64,
    /// How often devices started anew.
    pub restarts: u64,
    /// How many devices died.
    pub deaths: u64,
    /// Devices that heard a request again after their watchdog had run out.
    pub wakes: u64,
    /// Replies to a request to one module, beside that of another device with its number.
    pub doubles: u64,
    /// Frames of other controllers.
    pub others: u64,
    /// Frames that got lost because the bus was away.
    pub blocked: u64,
    /// Frames of the client that came late, when the bus was back.
    pub delayed: u64,
}

impl Tally {
    /// Nothing has happened.
    pub const NONE: Self = Self {
        lost: 0,
        twice: 0,
        broken: 0,
        disguised: 0,
        refused: 0,
        drifted: 0,
        delay: 0,
        restarts: 0,
        deaths: 0,
        wakes: 0,
        doubles: 0,
        others: 0,
        blocked: 0,
        delayed: 0,
    };

    /// Returns every count.
    fn counts(&mut self) -> [&mut u64; 14] {
        let Self { lost, twice, broken, disguised, refused, drifted, delay, restarts, deaths, .. } = self;
        let Self { wakes, doubles, others, blocked, delayed, .. } = self;
        [
            lost, twice, broken, disguised, refused, drifted, delay, restarts, deaths, wakes, doubles, others, blocked,
            delayed,
        ]
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, mut other: Self) {
        let others = other.counts();
        self.counts().into_iter().zip(others).for_each(|(own, other)| *own = own.wrapping_add(*other));
    }
}

/// Counts something that happens.
pub fn count(counter: &mut u64, happens: bool) {
    *counter = counter.wrapping_add(happens.into());
}
