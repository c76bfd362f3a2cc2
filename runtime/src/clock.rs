//! Times in milliseconds that wrap around, as a program without a calendar has them.
//!
//! A time is a number of milliseconds from any start. It wraps around after 49 days. So two times are only compared if
//! they lie less than 2^31 ms apart, which is somewhat more than 24 days.
//!
//! ```
//! use canspec_runtime::clock::{earlier, has_come, has_lasted, later_of};
//!
//! let start = u32::MAX - 10;
//! let now = start.wrapping_add(20);
//! assert_eq!(now, 9);
//! assert!(has_come(start, now) && has_come(now, now) && !has_come(now, start));
//! assert!(has_lasted(start, 20, now) && !has_lasted(start, 21, now));
//! assert!(earlier(start, now, now));
//! assert_eq!(later_of(start, now), now);
//! ```

/// The longest time in milliseconds after which a later time is still told from an earlier one.
pub(crate) const LONGEST: u32 = (1 << 31) - 1;

/// Tests whether a time has come. A time counts as future if it is less than 2^31 ms ahead.
pub fn has_come(time: u32, now: u32) -> bool {
    now.wrapping_sub(time) < 1 << 31
}

/// Returns how many milliseconds are left until a time, or 0 if it has come.
pub fn time_left(until: u32, now: u32) -> u32 {
    if has_come(until, now) { 0 } else { until.wrapping_sub(now) }
}

/// Tests whether so much time has passed since a time, which may lie ahead.
pub fn has_lasted(since: u32, patience: u32, now: u32) -> bool {
    has_come(since, now) && now.wrapping_sub(since) >= patience
}

/// Tests whether a time is before another one, both within 24 days of now.
pub fn earlier(time: u32, other: u32, now: u32) -> bool {
    let since = |time: u32| now.wrapping_sub(time) as i32;
    since(time) > since(other)
}

/// Tests whether a time is after another one, both within 24 days of each other.
pub fn is_later(time: u32, other: u32) -> bool {
    !has_come(time, other)
}

/// Returns the later one of two times, both within 24 days of each other.
pub fn later_of(one: u32, other: u32) -> u32 {
    if is_later(other, one) { other } else { one }
}

/// Returns the later one of two times, or the only one.
pub fn latest_of(one: Option<u32>, other: Option<u32>) -> Option<u32> {
    one.zip(other).map(|(one, other)| later_of(one, other)).or(one).or(other)
}

/// A clock that never goes back, made from one that may.
///
/// A computer sets its clock by another one, and a driver stamps frames by a third. When the program's clock goes back,
/// no time counts as passed. After that, the steady clock is ahead of it. A jump forward counts as time that has
/// passed. One of 2^31 ms or more cannot be told from one that goes back.
///
/// ```
/// use canspec_runtime::clock::Steady;
///
/// let mut clock = Steady::NEW;
/// assert_eq!([60_000, 60_020].map(|now| clock.pass(now)), [60_000, 60_020]);
/// // The clock is set back by a minute.
/// assert_eq!([20, 50].map(|now| clock.pass(now)), [60_020, 60_050]);
/// assert_eq!([clock.went_back(), clock.went_back()], [Some(60_000), None]);
/// // What is due at 60,100 of the steady clock is due at 100 of the program's.
/// assert_eq!((clock.of_program(60_100), clock.steady(100)), (100, 60_100));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Steady {
    /// The last time of the program's clock, if it has told one.
    last: Option<u32>,
    /// How far the steady clock is ahead.
    ahead: u32,
    /// How far the program's clock went back, and nobody was told.
    back: u32,
}

impl Steady {
    /// A clock that has told no time yet.
    pub const NEW: Self = Self { last: None, ahead: 0, back: 0 };

    /// Takes the time of the program's clock. Returns the steady time, which is not before any that it returned.
    pub fn pass(&mut self, now: u32) -> u32 {
        let back = self.last.filter(|last| !has_come(*last, now)).map_or(0, |last| last.wrapping_sub(now));
        self.ahead = self.ahead.wrapping_add(back);
        self.back = self.back.saturating_add(back);
        self.last = Some(now);
        self.steady(now)
    }

    /// Returns the last time that the program's clock has told, if it has told one.
    pub const fn last(&self) -> Option<u32> {
        self.last
    }

    /// Returns the steady time for one of the program's clock, as it goes since it was last set. No time passes.
    pub const fn steady(&self, time: u32) -> u32 {
        time.wrapping_add(self.ahead)
    }

    /// Returns the time of the program's clock for a steady one.
    pub const fn of_program(&self, steady: u32) -> u32 {
        steady.wrapping_sub(self.ahead)
    }

    /// Returns by how many milliseconds the program's clock has gone back since this was last asked, if it has.
    pub fn went_back(&mut self) -> Option<u32> {
        Some(core::mem::take(&mut self.back)).filter(|back| *back > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_time_is_left_of_what_has_come() {
        assert_eq!([(7, 7), (6, 7), (8, 7), (3, u32::MAX)].map(|(until, now)| time_left(until, now)), [0, 0, 1, 4]);
    }

    #[test]
    fn a_clock_that_goes_back_counts_as_no_time_passed() {
        let mut clock = Steady::NEW;
        let times = [u32::MAX - 5, 4, u32::MAX - 1, 0, 1 << 31].map(|now| clock.pass(now));
        // It goes back by 6 ms, and jumps forward by 2^31 ms, which counts as 2^31 ms back.
        assert_eq!(times, [u32::MAX - 5, 4, 4, 6, 6]);
        assert_eq!([clock.went_back(), clock.went_back()], [Some(6 + (1 << 31)), None]);
        assert_eq!((clock.last(), Steady::NEW.last()), (Some(1 << 31), None));
        assert_eq!([clock.of_program(7), clock.steady((1 << 31) + 1)], [(1 << 31) + 1, 7]);
    }

    #[test]
    fn a_jump_forward_is_time_that_has_passed() {
        let mut clock = Steady::NEW;
        let far = (1 << 31) - 1;
        assert_eq!([9, 9 + far, 9_u32.wrapping_add(2 * far)].map(|now| clock.pass(now)), [9, 9 + far, 7]);
        assert_eq!(clock.went_back(), None);
    }

    #[test]
    fn the_times_that_a_clock_went_back_add_up_and_no_further_than_they_can() {
        let mut clock = Steady::NEW;
        let _ = [1 << 31, 1, 1 << 31, 1, 1 << 31].map(|now: u32| clock.pass(now));
        let _ = [0_u32, u32::MAX - 9, u32::MAX - 19].map(|now| clock.pass(now));
        assert_eq!(clock.went_back(), Some(u32::MAX));
    }
}
