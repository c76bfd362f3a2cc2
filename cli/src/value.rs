//! Values as people read them in a table; JSON has the exact ones.

use canspec_codegen::interpret::{Reading, Value};
use canspec_codegen::model::{Linear, Protocol, Signal};

use crate::line::bit_names;

/// More decimals than any scale needs that `check` accepts.
const MOST_DECIMALS: usize = 18;

/// Returns the value of a signal without its unit.
pub fn shown(protocol: &Protocol, signal: &Signal, reading: &Reading) -> String {
    match &reading.value {
        Value::None => format!("? (raw 0x{:X})", reading.bits),
        Value::Integer(number) => number.to_string(),
        Value::Number(number) => match signal.encoding.linear() {
            Some(linear) => format!("{number:.0$}", decimals(&linear)),
            None => single(*number),
        },
        Value::Name(text) | Value::Text(text) => text.escape_debug().to_string(),
        Value::Status { set, unknown } => status(&bit_names(protocol, signal, set), *unknown),
    }
}

/// Returns the fewest decimals with which each value still leads back to its own raw number.
///
/// A value is rounded by at most half a unit of its last decimal. It stays the nearest on the grid of the scale if that
/// unit is smaller than a step, or if nothing is rounded at all.
fn decimals(linear: &Linear) -> usize {
    let (scale, offset) = (linear.scale, linear.offset);
    let suffices = |decimals: &usize| {
        let units = u32::try_from(*decimals).ok().and_then(|decimals| 10_i128.checked_pow(decimals));
        units.is_none_or(|units| {
            let is_exact = units % scale.denominator() == 0 && units % offset.denominator() == 0;
            let step = scale.numerator().checked_abs().and_then(|numerator| numerator.checked_mul(units));
            is_exact || step.is_none_or(|step| step > scale.denominator())
        })
    };
    (0..MOST_DECIMALS).find(suffices).unwrap_or(MOST_DECIMALS)
}

/// Returns the shortest text of a number that came as an `f32`.
#[expect(clippy::cast_possible_truncation, reason = "it was an `f32` on the bus")]
fn single(number: f64) -> String {
    format!("{:?}", number as f32)
}

fn status(set: &[&str], unknown: u64) -> String {
    let unknown = (unknown != 0).then(|| format!("0x{unknown:X}"));
    let bits: Vec<&str> = set.iter().copied().chain(unknown.as_deref()).collect();
    format!("{{{}}}", bits.join(", "))
}

#[cfg(test)]
mod tests {
    use canspec_codegen::interpret::{Input, Limits, physical, raw_of};
    use canspec_codegen::model::{Message, Numeral, SignalId};
    use canspec_codegen::number::Rational;
    use canspec_specs::SPECS;

    use super::*;
    use crate::protocols;

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
                let text = shown(protocol, signal, &Reading { signal: id, bits, value });
                let found = back(protocol, message, signal, &text);
                assert_eq!(found, Some(bits), "{}.{}.{}: {text}", protocol.name, message.name, signal.name);
                numbers += 1;
            }
        });
        assert!(numbers > 1_000_000, "{numbers} numbers");
    }

    #[test]
    fn a_decimal_less_would_confuse_raw_values_of_the_built_in_protocols() {
        let mut rounded = 0;
        every_signal(|protocol, message, signal, _| {
            let Some(linear) = signal.encoding.linear().filter(|linear| decimals(linear) > 0) else { return };
            let fewer = decimals(&linear) - 1;
            let is_confused = |bits: &u64| {
                let Value::Number(number) = physical(protocol, signal, *bits) else { return false };
                back(protocol, message, signal, &format!("{number:.fewer$}")) != Some(*bits)
            };
            let name = &signal.name;
            assert!(raw_values(signal.place.width()).iter().any(is_confused), "{}.{name}", protocol.name);
            rounded += 1;
        });
        assert!(rounded >= 50, "{rounded} signals");
    }

    #[test]
    fn decimals_follow_from_scale_and_offset() {
        // Steps of 1/1024 are 0.00098: three decimals are too coarse, four are not.
        let cases = [
            ("1", "0", 0),
            ("10", "0", 0),
            ("0.1", "0", 1),
            ("1/1024", "0", 4),
            ("0.001", "0", 3),
            ("0.5", "0", 1),
            ("2", "0.5", 0),
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
