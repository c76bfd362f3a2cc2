//! What is due by time: messages that are sent in cycles, and waits that end.
//!
//! A [`Schedule`] has keys, such as names of messages. The program asks what is due, and does it:
//!
//! ```
//! use canspec_runtime::schedule::Schedule;
//!
//! let mut schedule = Schedule::<_, 4>::new();
//! schedule.every("demand", 50, 0)?;
//! schedule.once("no answer", 120, 0)?;
//! let mut done = Vec::new();
//! for now in 0..=120 {
//!     while let Some(key) = schedule.due(now, |_| true) {
//!         done.push((now, key));
//!     }
//! }
//! assert_eq!(done, [(0, "demand"), (50, "demand"), (100, "demand"), (120, "no answer")]);
//! # Ok::<(), canspec_runtime::schedule::Full>(())
//! ```
//!
//! Time is a number of milliseconds from any start, and may wrap around. Call [`due`](Schedule::due) at
//! least once in 24 days.

use core::fmt;
use core::num::NonZeroU32;

use crate::clock::{LONGEST, earlier, has_come};

#[cfg(test)]
mod tests;

/// Times at which things are due, each with a key, with room for `N` of them.
#[derive(Clone, Copy, Debug)]
pub struct Schedule<K, const N: usize> {
    slots: [Option<Slot<K>>; N],
}

/// What is due, and when.
#[derive(Clone, Copy, Debug)]
struct Slot<K> {
    key: K,
    at: u32,
    period: Option<NonZeroU32>,
}

/// There is no room for another key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Full;

impl fmt::Display for Full {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the schedule has no room for another key")
    }
}

impl core::error::Error for Full {}

impl<K: Copy + PartialEq, const N: usize> Default for Schedule<K, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K: Copy + PartialEq, const N: usize> Schedule<K, N> {
    /// Returns a schedule without keys.
    pub const fn new() -> Self {
        Self { slots: [None; N] }
    }

    /// Lets a key be due now, and again in each period, in milliseconds. A period of 0 counts as
    /// 1 ms, and one above 2^31 - 1 as that, which is 24 days. What the key was due for before is forgotten.
    ///
    /// # Errors
    ///
    /// Refuses another key if there is no room for it.
    pub fn every(&mut self, key: K, period: u32, now: u32) -> Result<(), Full> {
        let period = NonZeroU32::new(period.min(LONGEST)).unwrap_or(NonZeroU32::MIN);
        self.put(Slot { key, at: now, period: Some(period) })
    }

    /// Lets a key be due once, after a delay in milliseconds, less than 2^31. What the key was due for before
    /// is forgotten. So a wait starts anew.
    ///
    /// # Errors
    ///
    /// Refuses another key if there is no room for it.
    pub fn once(&mut self, key: K, delay: u32, now: u32) -> Result<(), Full> {
        self.put(Slot { key, at: now.wrapping_add(delay), period: None })
    }

    /// Forgets a key.
    pub fn cancel(&mut self, key: K) {
        for slot in self.slots.iter_mut().filter(|slot| slot.is_some_and(|slot| slot.key == key)) {
            *slot = None;
        }
    }

    /// Forgets all keys.
    pub fn clear(&mut self) {
        self.slots = [None; N];
    }

    /// Tests whether a key will be due.
    pub fn has(&self, key: K) -> bool {
        self.slots.iter().flatten().any(|slot| slot.key == key)
    }

    /// Returns the key that has been due for the longest time, among those that `may` take their turn. The
    /// others stay due. A round that comes a whole period late is left out. Call it until nothing is due.
    pub fn due(&mut self, now: u32, may: impl Fn(K) -> bool) -> Option<K> {
        let is_due = |slot: &&mut Option<Slot<K>>| slot.is_some_and(|slot| has_come(slot.at, now) && may(slot.key));
        let at = |slot: &Option<Slot<K>>| slot.map_or(now, |slot| slot.at);
        let due = self.slots.iter_mut().filter(is_due);
        let place = due.reduce(|one, other| if earlier(at(other), at(one), now) { other } else { one })?;
        let slot = place.take()?;
        *place = slot.period.map(|period| Slot { at: next_round(slot.at, period, now), ..slot });
        Some(slot.key)
    }

    /// Returns when the next key is due, if there is one. A key that is due already is due now, even if it
    /// may not take its turn. So the program then waits for what it needs, and not for a time.
    pub fn next(&self, now: u32) -> Option<u32> {
        let times = self.slots.iter().flatten().map(|slot| if has_come(slot.at, now) { now } else { slot.at });
        times.reduce(|one, other| if earlier(other, one, now) { other } else { one })
    }

    fn put(&mut self, new: Slot<K>) -> Result<(), Full> {
        let place = self.slots.iter().position(|slot| slot.is_some_and(|slot| slot.key == new.key));
        let place = place.or_else(|| self.slots.iter().position(Option::is_none));
        *place.and_then(|place| self.slots.get_mut(place)).ok_or(Full)? = Some(new);
        Ok(())
    }
}

/// Returns the first round that comes after now.
fn next_round(at: u32, period: NonZeroU32, now: u32) -> u32 {
    let late = now.wrapping_sub(at) % period;
    now.wrapping_sub(late).wrapping_add(period.get())
}
