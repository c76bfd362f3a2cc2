//! What a client refuses.

use core::fmt;

/// There is no room for another request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Full;

impl fmt::Display for Full {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("there is no room for another request")
    }
}

impl core::error::Error for Full {}

/// Why a request is not asked again and again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum NotRepeated {
    /// There is no room for another request.
    Full,
    /// The period is 0 ms.
    Period,
}

impl fmt::Display for NotRepeated {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Full => Full.fmt(formatter),
            Self::Period => formatter.write_str("the period is 0 ms, which would fill the bus: it is at least 1 ms"),
        }
    }
}

impl core::error::Error for NotRepeated {}
