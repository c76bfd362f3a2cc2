//! Physical values as texts, both ways: what a spec writes after `means`, what a packed value reads like.

use crate::model::{
    Encoding, Enumeration, EnumerationId, Misfit, PartId, Piece, Signal, StatusWord, Table, Unit, raw_limits,
};
use crate::multiples;
use crate::number::Rational;

/// Returns the raw bits of a physical value as a spec writes it, with its unit if `unit` says so.
///
/// # Errors
///
/// Says what is wrong: no such name, not a number, the wrong unit, off the grid, too large.
pub fn raw_of_text(
    enumerations: &Table<EnumerationId, Enumeration>,
    signal: &Signal,
    text: &str,
    unit: bool,
) -> Result<u64, Misfit> {
    match &signal.encoding {
        Encoding::Number { signed, scale, offset } => {
            if let Some(special) = signal.specials.iter().find(|special| special.name == text) {
                return raw_bits(signal, special.raw, *signed);
            }
            let value = quantity(signal, text, unit)?;
            let raw = value.minus(*offset).and_then(|value| value.over(*scale)).and_then(Rational::to_integer);
            let raw =
                raw.ok_or_else(|| format!("`{text}` is no whole number of steps of {scale} for `{}`", signal.name))?;
            raw_bits(signal, raw, *signed)
        }
        Encoding::Float => float_bits(signal, text, unit),
        Encoding::Named(index) => named_bits(&enumerations[*index], signal, text),
        Encoding::Status(_) => {
            Err(format!("`{}` is a status word; write the names of its set bits as a list", signal.name).into())
        }
        Encoding::Text => text_bits(signal, text).map_err(Misfit::from),
        Encoding::Packed { pieces, parts } => parse_packed(pieces, parts, signal, text)
            .ok_or_else(|| format!("`{text}` is not of the form of `{}`", signal.name).into()),
    }
}

/// Returns the raw bits of a status word whose set bits are named.
///
/// # Errors
///
/// Names the bit that does not exist.
pub fn raw_of_bits(word: &StatusWord, names: &[String]) -> Result<u64, String> {
    names.iter().try_fold(0, |bits, name| {
        let bit = word.bits.iter().find(|bit| bit.name == *name);
        bit.map(|bit| bits | 1 << bit.bit).ok_or_else(|| format!("`{}` has no bit `{name}`", word.name))
    })
}

/// Splits the unit off and reads the number.
fn quantity(signal: &Signal, text: &str, with_unit: bool) -> Result<Rational, Misfit> {
    let Some(unit) = signal.unit.filter(|_| with_unit) else {
        return Rational::parse(text).ok_or_else(|| format!("`{text}` is not a number for `{}`", signal.name).into());
    };
    let number = text.strip_suffix(unit.symbol).and_then(|number| Rational::parse(number.trim_end()));
    number.ok_or_else(|| {
        let why = format!("`{text}` is not a number of {} for `{}`", unit.symbol, signal.name);
        let help =
            converted(text, unit).map_or_else(|| what_fits(signal, unit), |value| format!("write it as `{value}`"));
        Misfit::with_help(why, help)
    })
}

/// Writes a value in the unit of its signal, if it stands without a unit or in a multiple of it.
fn converted(text: &str, unit: Unit) -> Option<String> {
    let is_of_number = |letter: char| letter.is_ascii_digit() || matches!(letter, '-' | '.' | '/');
    let (number, symbol) = text.split_at(text.find(|letter| !is_of_number(letter)).unwrap_or(text.len()));
    let factor = match symbol.trim_start() {
        "" => Rational::ONE,
        symbol => multiples::factor(symbol, unit)?,
    };
    let value = Rational::parse(number)?.times(factor)?;
    Some(format!("{value} {}", unit.symbol))
}

/// Says which values a signal has.
fn what_fits(signal: &Signal, unit: Unit) -> String {
    let numbers = format!("values of `{}` are numbers in {}", signal.name, unit.symbol);
    let names = signal.specials.iter().map(|special| format!(" or `{}`", special.name));
    std::iter::once(numbers).chain(names).collect()
}

fn float_bits(signal: &Signal, text: &str, unit: bool) -> Result<u64, Misfit> {
    let value = quantity(signal, text, unit)?;
    let single: Option<f32> = value.to_string().parse().ok();
    let single = single.unwrap_or({
        #[allow(clippy::cast_possible_truncation, reason = "rounds to nearest")]
        let single = value.to_f64() as f32;
        single
    });
    Ok(u64::from(single.to_bits()))
}

fn named_bits(enumeration: &Enumeration, signal: &Signal, text: &str) -> Result<u64, Misfit> {
    let named = enumeration.values.iter().find(|value| value.name == text).map(|value| value.raw);
    let raw = named.or_else(|| Rational::parse(text).and_then(Rational::to_integer));
    raw_bits(signal, raw.ok_or_else(|| unnamed(enumeration, signal, text))?, false)
}

/// Says which names a signal has.
pub fn unnamed(enumeration: &Enumeration, signal: &Signal, text: &str) -> String {
    let names: Vec<_> = enumeration.values.iter().map(|value| format!("`{}`", value.name)).collect();
    format!("`{}` has no value `{text}`; it has {}", signal.name, names.join(", "))
}

/// Returns a raw number as bits of the signal's width.
fn raw_bits(signal: &Signal, raw: i128, signed: bool) -> Result<u64, Misfit> {
    let width = signal.place.width();
    let (first, last) = raw_limits(width, signed);
    if !(first..=last).contains(&raw) {
        let why = format!("the raw value {raw} does not fit the {width} bits of `{}`", signal.name);
        let help = (raw < 0 && !signed).then(|| "numbers below 0 need `as: signed` or an `offset`".to_owned());
        return Err(Misfit { why, help });
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the mask keeps the bits that fit")]
    let bits = raw as u64;
    Ok(bits & signal.place.max())
}

/// Returns the bits of an ASCII text, filled up with NUL.
///
/// # Errors
///
/// Says how long the text may be.
pub fn text_bits(signal: &Signal, text: &str) -> Result<u64, String> {
    let bytes = usize::from(signal.place.width() / 8);
    let printable = text.bytes().all(|byte| byte == b' ' || byte.is_ascii_graphic());
    if !printable || text.len() > bytes {
        return Err(format!("`{text}` is not a text of at most {bytes} ASCII characters for `{}`", signal.name));
    }
    let filled = text.bytes().chain(std::iter::repeat_n(0, bytes - text.len()));
    Ok(filled.fold(0, |bits, byte| bits << 8 | u64::from(byte)))
}

/// Returns the text of raw bits, without the NULs at its end; `None` if that text would not give the same bits.
pub fn text_of_bits(signal: &Signal, bits: u64) -> Option<String> {
    let bytes = bits.to_be_bytes();
    let from = 8 - usize::from(signal.place.width() / 8);
    let text = std::str::from_utf8(&bytes[from..]).ok()?.trim_end_matches('\0');
    (text_bits(signal, text) == Ok(bits)).then(|| text.to_owned())
}

/// Reads a packed value's text; `None` if it has another form or a part does not fit.
pub fn parse_packed(pieces: &[Piece], parts: &Table<PartId, Signal>, signal: &Signal, text: &str) -> Option<u64> {
    let mut data = [0; 8];
    let mut rest = text;
    for (index, piece) in pieces.iter().enumerate() {
        match piece {
            Piece::Literal(literal) => rest = rest.strip_prefix(literal.as_str())?,
            Piece::Part { part, digits } => {
                let part = &parts[*part];
                let length = match (&part.encoding, digits) {
                    (Encoding::Text, _) => usize::from(part.place.width() / 8),
                    (_, Some(digits)) => *digits,
                    _ if index + 1 == pieces.len() => rest.len(),
                    _ => rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len()),
                };
                let (piece, after) = rest.split_at_checked(length)?;
                part.place.put(&mut data, parse_part(part, piece)?);
                rest = after;
            }
        }
    }
    rest.is_empty().then(|| signal.place.get(&data))
}

fn parse_part(part: &Signal, text: &str) -> Option<u64> {
    if matches!(part.encoding, Encoding::Text) {
        return text_bits(part, text).ok();
    }
    let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let raw: u64 = digits.then(|| text.parse().ok()).flatten()?;
    (raw <= part.place.max() && in_range(part, raw)).then_some(raw)
}

/// Writes a packed value; `None` if its text would not give the same bits.
pub fn write_packed(pieces: &[Piece], parts: &Table<PartId, Signal>, signal: &Signal, bits: u64) -> Option<String> {
    let mut data = [0; 8];
    signal.place.put(&mut data, bits);
    let texts = pieces.iter().map(|piece| write_piece(piece, parts, data));
    let text = texts.collect::<Option<String>>()?;
    (parse_packed(pieces, parts, signal, &text) == Some(bits)).then_some(text)
}

fn write_piece(piece: &Piece, parts: &Table<PartId, Signal>, data: [u8; 8]) -> Option<String> {
    match piece {
        Piece::Literal(literal) => Some(literal.clone()),
        Piece::Part { part, digits } => {
            let part = &parts[*part];
            let raw = part.place.get(&data);
            if matches!(part.encoding, Encoding::Text) {
                return text_of_bits(part, raw);
            }
            Some(format!("{raw:0width$}", width = digits.unwrap_or(1)))
        }
    }
}

/// Tests a part against its range.
fn in_range(part: &Signal, raw: u64) -> bool {
    let raw = Rational::integer(raw.into());
    part.range.is_none_or(|range| range.minimum <= raw && raw <= range.maximum)
}
