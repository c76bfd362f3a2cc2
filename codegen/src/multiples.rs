//! Units that a document prints, and the language writes with a scale: `mV` is 1/1000 V.

use crate::model::Unit;
use crate::number::Rational;

/// Prefixes and their factors, as numerator and denominator.
const PREFIXES: [(&str, i128, i128); 6] =
    [("m", 1, 1_000), ("k", 1_000, 1), ("K", 1_000, 1), ("M", 1_000_000, 1), ("µ", 1, 1_000_000), ("u", 1, 1_000_000)];

/// Times in seconds.
const TIMES: [(&str, i128, i128); 4] = [("ms", 1, 1_000), ("s", 1, 1), ("min", 60, 1), ("h", 3_600, 1)];

/// Other spellings of units of the language.
const SPELLINGS: [(&str, &str); 5] = [("C", "°C"), ("degC", "°C"), ("deg C", "°C"), ("℃", "°C"), ("r/min", "rpm")];

/// Returns the unit whose other spelling is `symbol`.
pub fn respelled(symbol: &str) -> Option<Unit> {
    let (_, known) = SPELLINGS.iter().find(|(other, _)| *other == symbol)?;
    Unit::find(known)
}

/// Returns the unit that `symbol` is a multiple of by a prefix, and the factor.
pub fn prefixed(symbol: &str) -> Option<(Unit, Rational)> {
    PREFIXES.iter().find_map(|(prefix, numerator, denominator)| {
        let unit = Unit::find(symbol.strip_prefix(prefix)?)?;
        Some((unit, Rational::new(*numerator, *denominator)?))
    })
}

/// Returns how many `unit` one `symbol` is, if both measure the same quantity.
pub fn factor(symbol: &str, unit: Unit) -> Option<Rational> {
    if respelled(symbol).or_else(|| Unit::find(symbol)) == Some(unit) {
        return Some(Rational::ONE);
    }
    if let (Some(one), Some(other)) = (seconds(symbol), seconds(unit.symbol)) {
        return one.over(other);
    }
    prefixed(symbol).filter(|(known, _)| *known == unit).map(|(_, factor)| factor)
}

fn seconds(symbol: &str) -> Option<Rational> {
    let (_, numerator, denominator) = TIMES.iter().find(|(known, ..)| *known == symbol)?;
    Rational::new(*numerator, *denominator)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor_text(symbol: &str, unit: &str) -> Option<String> {
        factor(symbol, Unit::find(unit)?).map(|factor| factor.to_string())
    }

    #[test]
    fn a_prefix_is_a_power_of_a_thousand() {
        assert_eq!(factor_text("mV", "V").as_deref(), Some("0.001"));
        assert_eq!(factor_text("kW", "W").as_deref(), Some("1000"));
        assert_eq!(factor_text("mm", "m").as_deref(), Some("0.001"));
    }

    #[test]
    fn times_are_exact_multiples_of_each_other() {
        assert_eq!(factor_text("s", "ms").as_deref(), Some("1000"));
        assert_eq!(factor_text("h", "min").as_deref(), Some("60"));
        assert_eq!(factor_text("min", "h").as_deref(), Some("1/60"));
    }

    #[test]
    fn a_unit_of_something_else_is_no_multiple() {
        for (symbol, unit) in [("A", "V"), ("mA", "V"), ("m", "s"), ("K", "°C"), ("", "V")] {
            assert_eq!(factor_text(symbol, unit), None, "{symbol}");
        }
    }
}
