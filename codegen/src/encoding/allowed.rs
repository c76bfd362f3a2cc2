//! The limits of a value to send.

use std::cmp::Ordering;
use std::fmt::Display;

use crate::model::{Limit, Range, Signal};

/// The limits of one signal's values, beside the width of its bits.
#[derive(Clone, Copy, Debug)]
pub enum Allowed {
    /// No limits, as in a reply.
    Everything,
    /// Those of a request: a finite number, within the range if there is one.
    Within {
        /// The limits of the device model, or of all models together.
        range: Option<Range>,
        /// What to do about a number outside them.
        advice: &'static str,
    },
}

impl Allowed {
    /// Tests a number that may be infinite or no number.
    pub fn check_float(&self, signal: &Signal, value: f64) -> Result<(), String> {
        if matches!(self, Self::Within { .. }) && !value.is_finite() {
            return Err(format!("{value} is not a finite number"));
        }
        self.check(signal, value)
    }

    /// Tests a raw value that is no number.
    pub fn check_meaning(&self, raw: i128) -> Result<(), String> {
        match self {
            Self::Everything => Ok(()),
            Self::Within { .. } => Err(format!("raw {raw:#X} is no number")),
        }
    }

    /// Tests a number.
    pub fn check(&self, signal: &Signal, value: f64) -> Result<(), String> {
        self.check_by(signal, value, |range| signal.is_within(range, value))
    }

    /// Tests an integer of any size that is its own physical value.
    pub fn check_whole(&self, signal: &Signal, value: i128) -> Result<(), String> {
        self.check_by(signal, value, |range| range.has_whole(value))
    }

    fn check_by(&self, signal: &Signal, shown: impl Display, is_within: impl Fn(&Range) -> bool) -> Result<(), String> {
        let missed = self.missed(signal, is_within);
        missed.map_or(Ok(()), |limits| Err(format!("{shown}{} is outside {limits}", signal.unit_text())))
    }

    /// Tests a raw value exactly, and shows its number.
    pub fn check_raw(&self, signal: &Signal, raw: i128, shown: f64) -> Result<(), String> {
        self.check_by(signal, shown, |range| signal.is_inside(*range, raw))
    }

    /// Tests a number to send, and the raw value that it is rounded to, whose number is `sent`.
    pub fn check_sent(
        &self,
        signal: &Signal,
        value: f64,
        (raw, sent): (i128, f64),
        special: Option<&str>,
    ) -> Result<(), String> {
        let is_exact = sent.partial_cmp(&value) == Some(Ordering::Equal);
        if matches!(self, Self::Everything) || is_exact && special.is_some() {
            return Ok(());
        }
        self.check(signal, value)?;
        let unit = signal.unit_text();
        match (special, self.missed(signal, |range| signal.is_inside(*range, raw))) {
            (Some(name), _) => Err(format!("{value}{unit} would be sent as `{name}`")),
            (None, Some(limits)) => {
                Err(format!("{value}{unit} would be sent as {sent}{unit}, which is outside {limits}"))
            }
            (None, None) => Ok(()),
        }
    }

    /// Returns the limits that a number exceeds. The limit of the product comes first.
    fn missed(&self, signal: &Signal, is_within: impl Fn(&Range) -> bool) -> Option<String> {
        let Self::Within { range, advice } = self else { return None };
        let of_product = |limit: &Limit| (limit.range, format!(", the limit of `{}` in `product`", limit.quantity));
        let limits = signal.limit.iter().map(of_product).chain(range.map(|range| (range, (*advice).to_owned())));
        let (missed, advice) = limits.into_iter().find(|(range, _)| !is_within(range))?;
        Some(format!("{}..{}{}{advice}", missed.minimum, missed.maximum, signal.unit_text()))
    }
}
