//! Units that a document prints, and the language writes with a scale: `mV` is 1/1000 V.

use crate::model::Unit;
use crate::words::number::Rational;

/// Prefixes and their factors, as numerator and denominator.
const PREFIXES: [(&str, i128, i128); 6] =
    [("m", 1, 1_000), ("k", 1_000, 1), ("K", 1_000, 1), ("M", 1_000_000, 1), ("µ", 1, 1_000_000), ("u", 1, 1_000_000)];

/// Times in seconds.
const TIMES: [(&str, i128, i128); 4] = [("ms", 1, 1_000), ("s", 1, 1), ("min", 60, 1), ("h", 3_600, 1)];

/// Other spellings of units of the language.
const SPELLINGS: [(&str, &str); 9] = [
    ("C", "°C"),
    ("degC", "°C"),
    ("deg C", "°C"),
    ("℃", "°C"),
    ("r/min", "rpm"),
    // The sign for ohms, which looks like the Greek letter.
    ("\u{2126}", "Ω"),
    ("ohm", "Ω"),
    ("Ohm", "Ω"),
    ("VAr", "var"),
];

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

/// Returns the unit of whole steps that are a decimal prefix of `unit`, and the ending of names in
/// it: `mV` and `mv`. No name ends in `mhz` for megahertz.
pub(crate) fn of_steps(unit: Unit, step: Rational) -> Option<(String, String)> {
    let (prefix, ..) = PREFIXES.iter().find(|(_, above, below)| Rational::new(*above, *below) == Some(step))?;
    let ending = match *prefix {
        "µ" => "u",
        "M" => return None,
        prefix => prefix,
    };
    let is_prefixed =
        matches!(&*unit.symbol, "V" | "A" | "W" | "VA" | "var" | "Ah" | "Wh" | "Ω" | "Pa" | "Hz" | "s" | "m");
    is_prefixed.then(|| (format!("{prefix}{}", unit.symbol), format!("{ending}{}", unit.suffix)))
}

/// Returns how many `unit` one `symbol` is, if both measure the same quantity. The symbol may be
/// spelled in another way.
pub fn factor(symbol: &str, unit: Unit) -> Option<Rational> {
    if respelled(symbol) == Some(unit) { Some(Rational::ONE) } else { exact_factor(symbol, unit) }
}

/// Returns how many `unit` one `symbol` of the language is, with or without a prefix.
pub fn exact_factor(symbol: &str, unit: Unit) -> Option<Rational> {
    if *unit.symbol == *symbol {
        return Some(Rational::ONE);
    }
    if let (Some(one), Some(other)) = (seconds(symbol), seconds(&unit.symbol)) {
        return one.over(other);
    }
    prefixed(symbol).filter(|(known, _)| *known == unit).map(|(_, factor)| factor)
}

/// Reads a number with a symbol, in steps of `unit`: `750 V`, `750V` or `0.75 kV`.
///
/// `factor_of` says which symbols count. A hexadecimal number needs a blank before the symbol, which
/// may look like one more digit.
pub fn read(text: &str, unit: Unit, factor_of: impl Fn(&str, Unit) -> Option<Rational>) -> Option<Rational> {
    let splits = text.char_indices().map(|(at, _)| text.split_at(at));
    splits.skip(1).find_map(|(number, symbol)| {
        let factor = factor_of(symbol.trim_start(), unit)?;
        let is_apart = symbol.starts_with(' ') || !number.contains('x');
        Rational::parse(number).filter(|_| is_apart)?.times(factor)
    })
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
    fn steps_that_are_a_decimal_prefix_are_a_unit_of_their_own() {
        let steps = |unit, step| of_steps(Unit::find(unit)?, Rational::parse(step)?);
        let known = |symbol: &str, ending: &str| Some((symbol.to_owned(), ending.to_owned()));
        assert_eq!(steps("V", "1/1000"), known("mV", "mv"));
        assert_eq!(steps("W", "1000"), known("kW", "kw"));
        assert_eq!(steps("A", "1/1000000"), known("µA", "ua"));
        for (unit, step) in
            [("V", "0.1"), ("V", "1"), ("Hz", "1000000"), ("°C", "0.001"), ("ms", "0.001"), ("%", "0.001")]
        {
            assert_eq!(steps(unit, step), None, "{step} {unit}");
        }
    }

    #[test]
    fn times_are_exact_multiples_of_each_other() {
        assert_eq!(factor_text("s", "ms").as_deref(), Some("1000"));
        assert_eq!(factor_text("h", "min").as_deref(), Some("60"));
        assert_eq!(factor_text("min", "h").as_deref(), Some("1/60"));
    }

    #[test]
    fn a_number_is_read_in_the_unit_of_its_signal() {
        let read = |text, unit| Some(read(text, Unit::find(unit)?, factor)?.to_string());
        for (text, unit, wanted) in [
            ("750V", "V", "750"),
            ("53500 mV", "V", "53.5"),
            ("123456 mAh", "Ah", "123.456"),
            ("-1/3 kW", "W", "-1000/3"),
            ("2 min", "s", "120"),
            ("0x1A A", "A", "26"),
            ("25 C", "°C", "25"),
        ] {
            assert_eq!(read(text, unit).as_deref(), Some(wanted), "{text}");
        }
        // The last letter of the first is a digit.
        for (text, unit) in [("0x1A", "A"), ("5", "V"), ("5 A", "V"), ("V", "V"), ("5 mm", "s")] {
            assert_eq!(read(text, unit), None, "{text}");
        }
    }

    #[test]
    fn a_unit_of_something_else_is_no_multiple() {
        for (symbol, unit) in [("A", "V"), ("mA", "V"), ("m", "s"), ("K", "°C"), ("", "V")] {
            assert_eq!(factor_text(symbol, unit), None, "{symbol}");
        }
    }
}
