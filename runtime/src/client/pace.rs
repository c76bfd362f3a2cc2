//! How fast a client asks, and how long it waits.

use core::time::Duration;

use crate::clock::LONGEST;
use crate::{Time, Timing};

/// How fast a client asks, and how long it waits, in milliseconds.
///
/// Each time must be below 24 days, and so must `wait` and `late` together. A longer one ends at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pace {
    /// The time from one request to the next.
    pub gap: u32,
    /// The wait for an answer.
    pub wait: u32,
    /// How often a request is sent before it is lost.
    pub tries: u8,
    /// How long after the wait an answer can still come. So long no request is sent that it could be
    /// taken to answer.
    pub late: u32,
}

impl Pace {
    /// Returns the pace that a document states, or `None` if it does not say the gap, the wait or how
    /// often to try. It is also `None` if a time is too long for a client. No document says how late an
    /// answer can come.
    ///
    /// ```
    /// use core::time::Duration;
    ///
    /// use canspec_runtime::client::Pace;
    /// use canspec_runtime::{Time, Timing};
    ///
    /// let gap = Time::between(Duration::from_millis(50), Duration::from_millis(200));
    /// let stated = Timing::NONE.with_request_gap(gap);
    /// assert_eq!(Pace::of(&stated, 120), None);
    /// let chosen = stated.with_reply_timeout(Time::of(Duration::from_millis(120))).with_tries(3);
    /// assert_eq!(Pace::of(&chosen, 120), Some(Pace { gap: 50, wait: 120, tries: 3, late: 120 }));
    /// ```
    pub fn of(timing: &Timing, late: u32) -> Option<Self> {
        let gap = timing.request_gap.map(|Time { shortest, minimum, .. }| minimum.unwrap_or(shortest).max(shortest))?;
        let wait = milliseconds(timing.reply_timeout?.longest)?;
        wait.checked_add(late).filter(|time| *time <= LONGEST)?;
        Some(Self { gap: milliseconds(gap)?, wait, tries: timing.tries?, late })
    }
}

impl Pace {
    /// Returns the time to leave between two values of what is [held](super::Client::hold), in milliseconds. No answer to
    /// the first one can come after that, so an answer to the second one counts at once.
    ///
    /// ```
    /// use canspec_runtime::client::Pace;
    ///
    /// assert_eq!(Pace { gap: 20, wait: 100, tries: 3, late: 50 }.between_values(), 170);
    /// ```
    #[must_use]
    pub const fn between_values(&self) -> u32 {
        self.gap.saturating_add(self.wait).saturating_add(self.late)
    }
}

/// Counts whole milliseconds, none too few.
fn milliseconds(time: Duration) -> Option<u32> {
    u32::try_from(time.as_nanos().div_ceil(1_000_000)).ok().filter(|time| *time <= LONGEST)
}
