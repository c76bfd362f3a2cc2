//! What is known of a value, and how old that is.

use crate::clock::has_lasted;

/// What is known of a value at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Known<T> {
    /// A module has said it, and not longer ago than values count.
    Fresh(T),
    /// A module has said it longer ago than values count.
    Stale {
        /// What it was.
        value: T,
        /// When it was said, in milliseconds of the program's clock.
        since: u32,
    },
    /// No module has said it.
    Unknown,
}

impl<T> Known<T> {
    /// Returns the value if it still counts.
    pub fn fresh(self) -> Option<T> {
        if let Self::Fresh(value) = self { Some(value) } else { None }
    }
}

/// A value that a module has said at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Said<T> {
    pub value: T,
    pub at: u32,
}

impl<T: Copy> Said<T> {
    /// Returns the value if it is not older than it may be.
    pub fn fresh(self, valid: u32, now: u32) -> Option<T> {
        (!has_lasted(self.at, valid.saturating_add(1), now)).then_some(self.value)
    }
}

/// Returns what is known of what a module has said.
pub fn known<T: Copy>(said: Option<Said<T>>, valid: u32, now: u32) -> Known<T> {
    let Some(said) = said else { return Known::Unknown };
    said.fresh(valid, now).map_or(Known::Stale { value: said.value, since: said.at }, Known::Fresh)
}
