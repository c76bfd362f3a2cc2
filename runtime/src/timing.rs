//! Times of a document, by what they are for.

use core::time::Duration;

/// A time that a document states. Both ends are equal if it names one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Time {
    /// The shortest time.
    pub shortest: Duration,
    /// The longest time.
    pub longest: Duration,
    /// A lower limit that holds beside a recommended time.
    pub minimum: Option<Duration>,
}

impl Time {
    /// Returns a time between two ends.
    pub const fn between(shortest: Duration, longest: Duration) -> Self {
        Self { shortest, longest, minimum: None }
    }

    /// Returns a time with one value.
    pub const fn of(time: Duration) -> Self {
        Self::between(time, time)
    }

    /// Adds a lower limit.
    #[must_use]
    pub const fn at_least(self, minimum: Duration) -> Self {
        Self { minimum: Some(minimum), ..self }
    }
}

/// The times of a protocol by their roles. What the document does not state is `None`, and then the
/// program must choose: `TIMING.with_reply_timeout(Time::of(wait))`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// The time from one request to the next.
    pub request_gap: Option<Time>,
    /// The wait for a reply.
    pub reply_timeout: Option<Time>,
    /// How often a request is sent before it counts as unanswered.
    pub tries: Option<u8>,
    /// The silence after which the other side acts by itself.
    pub watchdog: Option<Time>,
    /// The time from power-on until a device can be asked.
    pub boot: Option<Time>,
    /// The time from a request until what it changes is in effect.
    pub settling: Option<Time>,
    /// The times that are about one message, by its name.
    pub of_messages: &'static [(&'static str, Timing)],
}

impl Timing {
    /// No time has a role.
    pub const NONE: Self = Self {
        request_gap: None,
        reply_timeout: None,
        tries: None,
        watchdog: None,
        boot: None,
        settling: None,
        of_messages: &[],
    };

    /// Sets the time from one request to the next.
    #[must_use]
    pub const fn with_request_gap(self, time: Time) -> Self {
        Self { request_gap: Some(time), ..self }
    }

    /// Sets the wait for a reply.
    #[must_use]
    pub const fn with_reply_timeout(self, time: Time) -> Self {
        Self { reply_timeout: Some(time), ..self }
    }

    /// Sets how often a request is sent before it counts as unanswered.
    #[must_use]
    pub const fn with_tries(self, tries: u8) -> Self {
        Self { tries: Some(tries), ..self }
    }

    /// Sets the silence after which the other side acts by itself.
    #[must_use]
    pub const fn with_watchdog(self, time: Time) -> Self {
        Self { watchdog: Some(time), ..self }
    }

    /// Sets the time from power-on until a device can be asked.
    #[must_use]
    pub const fn with_boot(self, time: Time) -> Self {
        Self { boot: Some(time), ..self }
    }

    /// Sets the time from a request until what it changes is in effect.
    #[must_use]
    pub const fn with_settling(self, time: Time) -> Self {
        Self { settling: Some(time), ..self }
    }

    /// Sets the times that are about one message.
    #[must_use]
    pub const fn with_messages(self, of_messages: &'static [(&'static str, Timing)]) -> Self {
        Self { of_messages, ..self }
    }

    /// Returns the times of a message: its own, and those of every message in place of what it does
    /// not have.
    #[must_use]
    pub fn of(&self, message: &str) -> Self {
        let own = self.of_messages.iter().find(|(name, _)| *name == message);
        own.map_or(*self, |(_, own)| Self {
            request_gap: own.request_gap.or(self.request_gap),
            reply_timeout: own.reply_timeout.or(self.reply_timeout),
            // How often to try belongs to the wait.
            tries: if own.reply_timeout.is_some() { own.tries } else { self.tries },
            watchdog: own.watchdog.or(self.watchdog),
            boot: self.boot,
            settling: own.settling.or(self.settling),
            of_messages: self.of_messages,
        })
    }
}

/// Returns a time in milliseconds.
pub const fn milliseconds(count: u64) -> Duration {
    Duration::from_millis(count)
}

/// Returns a time in nanoseconds.
pub const fn nanoseconds(count: u64) -> Duration {
    Duration::from_nanos(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn seconds(count: u64) -> Time {
        Time::of(Duration::from_secs(count))
    }

    const OWN: Timing = Timing::NONE.with_reply_timeout(seconds(7)).with_watchdog(seconds(8));
    const TIMING: Timing = Timing::NONE
        .with_request_gap(seconds(1))
        .with_reply_timeout(seconds(2))
        .with_tries(3)
        .with_boot(seconds(4))
        .with_settling(seconds(5))
        .with_messages(&[("scan", Timing::NONE.with_settling(seconds(6))), ("alive", OWN)]);
    const STUBBORN: Timing = TIMING.with_messages(&[("alive", OWN.with_tries(2))]);

    #[test]
    fn a_message_has_its_own_times_and_those_of_every_message() {
        let alive = TIMING.of("alive");
        assert_eq!([alive.request_gap, alive.settling, alive.boot], [1, 5, 4].map(|time| Some(seconds(time))));
        assert_eq!([alive.reply_timeout, alive.watchdog], [7, 8].map(|time| Some(seconds(time))));
        assert_eq!(TIMING.of("scan").settling, Some(seconds(6)));
        assert_eq!(TIMING.of("scan").watchdog, None);
        assert_eq!(TIMING.of("other"), TIMING);
    }

    #[test]
    fn how_often_to_try_belongs_to_the_wait() {
        assert_eq!([TIMING.of("alive").tries, TIMING.of("scan").tries], [None, Some(3)]);
        assert_eq!(STUBBORN.of("alive").tries, Some(2));
    }

    #[test]
    fn a_time_has_ends_and_a_lower_limit() {
        let limited =
            Time::between(Duration::from_millis(50), Duration::from_millis(200)).at_least(Duration::from_millis(20));
        assert_eq!([limited.shortest, limited.longest].map(|end| end.as_millis()), [50, 200]);
        assert_eq!(limited.minimum.map(|least| least.as_millis()), Some(20));
        assert_eq!(seconds(1), Time { minimum: None, ..Time::between(Duration::from_secs(1), Duration::from_secs(1)) });
    }
}
