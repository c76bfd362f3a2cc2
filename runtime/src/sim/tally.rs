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
}

impl Tally {
    /// Nothing has happened.
    pub const NONE: Self =
        Self { lost: 0, twice: 0, broken: 0, disguised: 0, refused: 0, drifted: 0, delay: 0, restarts: 0, deaths: 0 };
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        let Self { lost, twice, broken, disguised, refused, drifted, delay, restarts, deaths } = self;
        let own = [lost, twice, broken, disguised, refused, drifted, delay, restarts, deaths];
        let Self { lost, twice, broken, disguised, refused, drifted, delay, restarts, deaths } = other;
        let others = [lost, twice, broken, disguised, refused, drifted, delay, restarts, deaths];
        own.into_iter().zip(others).for_each(|(own, other)| *own = own.wrapping_add(other));
    }
}
