//! Numbers with a unit, as people and specs write them.

use super::Input;
use crate::model::unit_prefixes;
use crate::model::{Misfit, Range, Signal, Unit};
use crate::words::number::Rational;

/// Splits the unit off and reads the number.
pub fn quantity(signal: &Signal, text: &str, with_unit: bool) -> Result<Rational, Misfit> {
    let Some(unit) = signal.unit.filter(|_| with_unit) else {
        return Rational::parse(text).ok_or_else(|| format!("`{text}` is not a number for `{}`", signal.name).into());
    };
    unit_prefixes::read(text, unit, unit_prefixes::exact_factor).ok_or_else(|| {
        let why = format!("`{text}` is not a number of {} for `{}`", unit.symbol, signal.name);
        let help =
            converted(text, unit).map_or_else(|| what_fits(signal, unit), |value| format!("write it as `{value}`"));
        Misfit::with_help(why, help)
    })
}

/// Reads a rounded number, and returns the values that give it: those within half of its last digit.
pub fn rounded(signal: &Signal, text: &str) -> Result<Range, Misfit> {
    let value = quantity(signal, text, true)?;
    let range = || {
        let half = quantity(signal, &last_digit(text)?, true).ok()?.over(Rational::integer(2))?;
        Some(Range { minimum: value.minus(half)?, maximum: value.plus(half)? })
    };
    range().ok_or_else(|| {
        let why = format!("`~{text}` is not a rounded decimal number for `{}`", signal.name);
        Misfit::with_help(why, "write the digits that are printed, as in `~51.4 V`")
    })
}

/// Returns the text with 1 as the last digit of its number and 0 as all others. It is `None` if the
/// number is hexadecimal or a fraction.
fn last_digit(text: &str) -> Option<String> {
    let last = text.rfind(|letter: char| letter.is_ascii_digit()).filter(|_| !text.contains(['x', '/']))?;
    let digit = |(at, letter): (usize, char)| match letter {
        '-' => None,
        '0'..='9' => Some(if at == last { '1' } else { '0' }),
        _ => Some(letter),
    };
    Some(text.char_indices().filter_map(digit).collect())
}

/// Reads `750V`, `750 V`, `0.75 kV`, `750` or a name. A fraction is refused where doubles have none.
pub fn typed(signal: &Signal, text: &str) -> Result<Input, String> {
    let of_unit = |text| signal.unit.and_then(|unit| unit_prefixes::read(text, unit, unit_prefixes::factor));
    let Some(value) = of_unit(text).or_else(|| Rational::parse(text.trim())) else {
        return Ok(Input::Text(text.to_owned()));
    };
    match value.to_integer() {
        Some(whole) => Ok(Input::Integer(whole)),
        None if value.to_f64().abs() >= WHOLE => Err(format!("{value} has a fraction; numbers of that size are whole")),
        None => Ok(Input::Number(value.to_f64())),
    }
}

/// From here on doubles have no fraction.
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// Names the values that a signal takes.
pub fn wanted(signal: &Signal) -> String {
    let unit = signal.unit.map_or_else(|| " without a unit".to_owned(), |unit| format!(" in {}", unit.symbol));
    format!("a number{unit}{}", specials(signal))
}

/// Returns the nearest double.
#[allow(clippy::cast_precision_loss, reason = "rounds to nearest")]
pub fn as_double(value: i128) -> f64 {
    value as f64
}

/// Writes a value in the unit of its signal, if it has no unit or a multiple of that unit.
fn converted(text: &str, unit: Unit) -> Option<String> {
    let is_of_number = |letter: char| letter.is_ascii_digit() || matches!(letter, '-' | '.' | '/');
    let (number, symbol) = text.split_at(text.find(|letter| !is_of_number(letter)).unwrap_or(text.len()));
    let factor = match symbol.trim_start() {
        "" => Rational::ONE,
        symbol => unit_prefixes::factor(symbol, unit)?,
    };
    let value = Rational::parse(number)?.times(factor)?;
    Some(format!("{value} {}", unit.symbol))
}

/// Says which values a signal has.
fn what_fits(signal: &Signal, unit: Unit) -> String {
    format!("values of `{}` are numbers in {}{}", signal.name, unit.symbol, specials(signal))
}

fn specials(signal: &Signal) -> String {
    let names: Vec<_> = signal.specials.iter().map(|special| format!(" or `{}`", special.name)).collect();
    names.concat()
}
