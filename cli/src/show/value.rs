//! Values as people read them in a table; JSON has the exact ones.

use std::io::{self, Write};

use canspec_codegen::interpret::{Reading, Value, escape};
use canspec_codegen::model::{Linear, Protocol, Signal};

use crate::log;
use crate::show::line::bit_names;

/// More decimals than any scale needs that `check` accepts.
const MOST_DECIMALS: usize = 18;

/// People still read an exact value with this many decimals easily.
const EXACT_DECIMALS: usize = 4;

/// Adds the value of a signal, without its unit, to a text.
pub fn write(text: &mut Vec<u8>, protocol: &Protocol, signal: &Signal, reading: &Reading) {
    let _ = match &reading.value {
        Value::None if signal.run.is_some() => write!(text, "? (raw 0x{})", log::hexadecimal(&reading.bytes)),
        Value::None => write!(text, "? (raw 0x{:X})", reading.bits),
        Value::Integer(number) => text.write_all(itoa::Buffer::new().format(*number).as_bytes()),
        Value::Number(number) => match signal.encoding.linear() {
            Some(linear) => fixed(text, *number, decimals(&linear)),
            None => single(text, *number),
        },
        Value::Name(name) => text.write_all(name.as_bytes()),
        Value::Text(value) => text.write_all(escape::written(value).as_bytes()),
        Value::Status { set, unknown } => status(text, bit_names(protocol, signal, *set), *unknown),
    };
}

/// Writes a number with a fixed number of decimals.
///
/// Values lie on the grid of their scale. So a value is nearly always next to a whole number of its last decimal, as
/// an integer, which is cheap to write.
fn fixed(text: &mut Vec<u8>, number: f64, decimals: usize) -> io::Result<()> {
    /// 2 to the power of 50.
    const EXACT: f64 = 1_125_899_906_842_624.0;
    #[expect(clippy::cast_precision_loss, reason = "a double has these powers of ten")]
    let scaled = POWERS.get(decimals).map_or(f64::NAN, |power| number.abs() * *power as f64);
    let whole = scaled.round();
    // The product is off by less than an eighth.
    if whole < EXACT && (scaled - whole).abs() < 0.25 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is a small whole number")]
        digits(text, number.is_sign_negative(), whole as u64, decimals)
    } else {
        write!(text, "{number:.decimals$}")
    }
}

/// Powers of ten.
const POWERS: [i64; 10] = [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000, 1_000_000_000];

/// Writes a number of units of the last decimal.
fn digits(text: &mut Vec<u8>, is_negative: bool, number: u64, decimals: usize) -> io::Result<()> {
    let mut digits = [b'0'; 24];
    let (mut rest, mut start) = (number, digits.len());
    let mut put = |byte: u8| {
        start -= 1;
        digits[start] = byte;
    };
    for place in 0.. {
        if rest == 0 && place > decimals {
            break;
        }
        if place == decimals && decimals > 0 {
            put(b'.');
        }
        put(b'0' + u8::try_from(rest % 10).unwrap_or(0));
        rest /= 10;
    }
    if is_negative {
        put(b'-');
    }
    text.write_all(&digits[start..])
}

/// Returns how many decimals values have. They show each value exactly if four do. Else they are the fewest with which
/// each still leads back to its own raw number.
///
/// A value is rounded by at most half a unit of its last decimal. It stays the nearest on the grid of the scale if that
/// unit is smaller than a step, or if nothing is rounded at all.
fn decimals(linear: &Linear) -> usize {
    let (scale, offset) = (linear.scale, linear.offset);
    let numbers = [scale.numerator(), scale.denominator(), offset.denominator()];
    // The checks ensure that they fit.
    let [step, scale, offset] = numbers.map(|number| i64::try_from(number).unwrap_or(i64::MAX));
    if let Some(places) = POWERS.iter().position(|power| (step, offset) == (1, 1) && *power == scale) {
        return places;
    }
    let is_exact = |units: i64| units % scale == 0 && units % offset == 0;
    let suffices =
        |units: i64| is_exact(units) || step.saturating_abs().checked_mul(units).is_none_or(|step| step > scale);
    let units = || std::iter::successors(Some(1_i64), |units| units.checked_mul(10));
    let exact = units().take(EXACT_DECIMALS + 1).position(is_exact);
    exact.or_else(|| units().take(MOST_DECIMALS).position(suffices)).unwrap_or(MOST_DECIMALS)
}

/// Writes the shortest text of a number that came as an `f32`.
#[expect(clippy::cast_possible_truncation, reason = "it was an `f32` on the bus")]
fn single(text: &mut Vec<u8>, number: f64) -> io::Result<()> {
    write!(text, "{:?}", number as f32)
}

fn status<'a>(text: &mut Vec<u8>, set: impl Iterator<Item = &'a str>, unknown: u64) -> io::Result<()> {
    let mut separator = "{";
    for name in set {
        text.extend_from_slice(separator.as_bytes());
        text.extend_from_slice(name.as_bytes());
        separator = ", ";
    }
    if unknown != 0 {
        write!(text, "{separator}0x{unknown:X}")?;
        separator = ", ";
    }
    text.write_all(if separator == "{" { b"{}" } else { b"}" })
}

#[cfg(test)]
mod tests {
    use canspec_codegen::interpret::{Input, Limits, physical, raw_of};
    use canspec_codegen::model::{Message, Numeral, SignalId};
    use canspec_codegen::number::Rational;
    use canspec_specs::SPECS;

    use super::*;
    use crate::choose::protocols;

    /// Every raw value up to 16 bits; beyond, the edges and a sample.
    fn raw_values(width: u8) -> Vec<u64> {
        let max = u64::MAX >> (64 - width);
        if width <= 16 {
            return (0..=max).collect();
        }
        let sample = (0..20_000_u64).map(|index| index.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> (64 - width));
        let edges = (0..width).flat_map(|bit| [(1 << bit) - 1, 1 << bit, max - (1 << bit), max ^ (max >> bit)]);
        sample.chain(edges).chain(0..4096).collect()
    }

    /// Returns the raw value of a shown number as the interpreter encodes it.
    fn back(protocol: &Protocol, message: &Message, signal: &Signal, text: &str) -> Option<u64> {
        let whole = text.strip_prefix("0x").map_or_else(|| text.parse(), |digits| i128::from_str_radix(digits, 16));
        let input = whole.map(Input::Integer).ok().or_else(|| text.parse().ok().map(Input::Number))?;
        raw_of(protocol, message, signal, &input, Limits::Bits).ok()
    }

    /// Calls back with every signal of the built-in protocols, and how its values are made if that is by a scale.
    fn every_signal(mut work: impl FnMut(&Protocol, &Message, &Signal, SignalId)) {
        for spec in SPECS {
            let protocol = protocols::load_built_in(spec).expect("a built-in spec has no errors");
            for message in &protocol.messages {
                message.signals.ids().for_each(|id| work(&protocol, message, &message.signals[id], id));
            }
        }
    }

    #[test]
    fn each_shown_number_of_the_built_in_protocols_leads_back_to_its_raw_value() {
        let mut numbers = 0;
        every_signal(|protocol, message, signal, id| {
            for bits in raw_values(signal.place.width()) {
                let value = physical(protocol, signal, bits);
                if !matches!(value, Value::Integer(_) | Value::Number(_)) {
                    continue;
                }
                let mut text = Vec::new();
                write(&mut text, protocol, signal, &Reading::of(protocol, (id, signal), bits));
                let text = String::from_utf8(text).expect("a value is text");
                let found = back(protocol, message, signal, &text);
                assert_eq!(found, Some(bits), "{}.{}.{}: {text}", protocol.name, message.name, signal.name);
                numbers += 1;
            }
        });
        assert!(numbers > 1_000_000, "{numbers} numbers");
    }

    #[test]
    fn a_decimal_less_would_confuse_or_round_values_of_the_built_in_protocols() {
        let mut rounded = 0;
        every_signal(|protocol, message, signal, _| {
            let Some(linear) = signal.encoding.linear().filter(|linear| decimals(linear) > 0) else { return };
            let fewer = decimals(&linear) - 1;
            let is_coarse = |bits: &u64| {
                let Value::Number(number) = physical(protocol, signal, *bits) else { return false };
                let text = format!("{number:.fewer$}");
                let is_rounded = text.parse() != Ok(number) && fewer < EXACT_DECIMALS;
                is_rounded || back(protocol, message, signal, &text) != Some(*bits)
            };
            let name = &signal.name;
            assert!(raw_values(signal.place.width()).iter().any(is_coarse), "{}.{name}", protocol.name);
            rounded += 1;
        });
        assert!(rounded >= 50, "{rounded} signals");
    }

    #[test]
    fn a_number_has_the_digits_that_the_standard_library_writes() {
        let steps = (0..200_000_u32).map(|step| f64::from(step.wrapping_mul(2_654_435_761)) / 1000.0);
        let ties = (0..4000).map(|step| f64::from(step) / 32.0);
        let edges = [0.0, 0.05, 0.45, 0.999_95, 1e15, 1_125_899_906_842.625, 1e17, 1e300, f64::INFINITY, f64::NAN];
        for number in steps.chain(ties).chain(edges).flat_map(|number| [number, -number]) {
            for decimals in [0, 1, 2, 3, 4, 9, 10, 12] {
                let mut text = Vec::new();
                fixed(&mut text, number, decimals).expect("a vector takes everything");
                assert_eq!(String::from_utf8(text), Ok(format!("{number:.decimals$}")), "{number:?} {decimals}");
            }
        }
    }

    #[test]
    fn decimals_follow_from_scale_and_offset() {
        // Steps of 1/1024 are 0.00098: three decimals are too coarse, four are not, and none below ten are exact.
        let cases = [
            ("1", "0", 0),
            ("10", "0", 0),
            ("0.1", "0", 1),
            ("1/1024", "0", 4),
            ("0.001", "0", 3),
            ("0.5", "0", 1),
            // A quarter needs two decimals, and a sixteenth four: 1/16 = 0.0625. A 32nd would need five.
            ("1/4", "0", 2),
            ("1/8", "0", 3),
            ("1/16", "0", 4),
            ("1/32", "0", 2),
            ("1", "1/4", 2),
            ("2", "0.5", 1),
            ("1", "0.5", 1),
            ("0.1", "0.05", 2),
            ("-0.1", "40", 1),
            ("1/3", "0", 1),
        ];
        for (scale, offset, expected) in cases {
            let [scale, offset] = [scale, offset].map(|text| Rational::parse(text).expect("a number"));
            let found = decimals(&Linear { numeral: Numeral::Unsigned, scale, offset });
            assert_eq!(found, expected, "{scale} {offset}");
        }
    }
}
