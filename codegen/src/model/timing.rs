//! Times, and what they are for.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::model::{Doc, MessageId, Quantity, Range, Unit};
use crate::words::number::Rational;

/// A time that the document states. Both ends are equal if it names one value.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Timing {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The shortest and the longest time.
    pub range: Range,
    /// Unit of the range.
    pub unit: Unit,
    /// Lower limit that holds beside a recommended time.
    pub minimum: Option<Quantity>,
    /// What it is for, if the spec says it.
    pub role: Option<TimeRole>,
    /// How often a request is sent before it counts as unanswered.
    pub tries: Option<u8>,
    /// The only messages that it is about; empty if it is about every message.
    pub messages: Vec<MessageId>,
}

impl Timing {
    /// Returns the shortest and the longest time.
    pub fn ends(&self) -> [Duration; 2] {
        [self.range.minimum, self.range.maximum].map(|end| duration(end, self.unit))
    }

    /// Returns the lower limit.
    pub fn least(&self) -> Option<Duration> {
        self.minimum.and_then(|minimum| Some(duration(minimum.value, minimum.unit?)))
    }
}

/// What a time is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum TimeRole {
    /// The time from one request to the next.
    RequestGap,
    /// The wait for a reply.
    ReplyTimeout,
    /// The silence after which the other side acts by itself.
    Watchdog,
    /// The time from power-on until a device can be asked.
    Boot,
    /// The time from a request until what it changes is in effect.
    Settling,
}

impl TimeRole {
    /// Every role.
    pub const ALL: [Self; 5] = [Self::RequestGap, Self::ReplyTimeout, Self::Watchdog, Self::Boot, Self::Settling];

    /// Returns the word of the language.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RequestGap => "request_gap",
            Self::ReplyTimeout => "reply_timeout",
            Self::Watchdog => "watchdog",
            Self::Boot => "boot",
            Self::Settling => "settling",
        }
    }
}

/// Returns a time to the nanosecond, or the longest one that there is.
fn duration(value: Rational, unit: Unit) -> Duration {
    let nanoseconds = nanoseconds(value, unit).and_then(|time| u64::try_from(time.floor()).ok());
    Duration::from_nanos(nanoseconds.unwrap_or(u64::MAX))
}

/// Returns a time in nanoseconds, or `None` on overflow.
pub(crate) fn nanoseconds(value: Rational, unit: Unit) -> Option<Rational> {
    let factor = match &*unit.symbol {
        "ms" => 1_000_000,
        "min" => 60_000_000_000,
        "h" => 3_600_000_000_000,
        _ => 1_000_000_000,
    };
    value.times(Rational::integer(factor))
}
