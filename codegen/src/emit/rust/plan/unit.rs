//! The units of values: those of the spec, or whole steps.

use crate::emit::Scaled;
use crate::model::unit_prefixes;
use crate::model::{Linear, Signal};
use crate::words::number::Rational;

/// The unit of a signal's values in Rust.
pub struct Unit {
    /// What comments say of it behind a title, such as ` in V`.
    pub phrase: String,
    /// The ending of the member's name.
    pub ending: Option<String>,
}

impl Unit {
    /// Returns the unit of a signal's values.
    pub fn new(signal: &Signal, scaled: Scaled) -> Self {
        if !signal.encoding.by_model().is_empty() {
            let phrase = " in steps that depend on the device model".to_owned();
            return Self { phrase, ending: Some("raw".to_owned()) };
        }
        match signal.encoding.linear() {
            Some(linear) if scaled.of(signal) == Scaled::Steps && !signal.encoding.is_unscaled() => {
                Self::of_steps(signal, linear)
            }
            _ => Self {
                phrase: signal.unit.map_or_else(String::new, |unit| format!(" in {}", unit.symbol)),
                ending: signal.unit.map(|unit| unit.suffix.to_string()),
            },
        }
    }

    /// Returns a unit with a decimal prefix if the steps are such a unit, counted from 0.
    fn of_steps(signal: &Signal, Linear { scale, offset, .. }: Linear) -> Self {
        let unit = signal.unit.filter(|_| offset == Rational::ZERO);
        match unit.and_then(|unit| unit_prefixes::of_steps(unit, scale)) {
            Some((symbol, ending)) => Self { phrase: format!(" in {symbol}"), ending: Some(ending) },
            None => {
                Self { phrase: format!(" in steps of {scale}{}", signal.unit_text()), ending: Some("raw".to_owned()) }
            }
        }
    }
}
