//! `grid`: a scale that cannot be computed exactly.
//!
//! A scale of zero has no way back. Where |raw * numerator + offset * denominator| can reach 2^50, neighbouring steps are no longer told
//! apart by a double in both directions. Write the signal without a scale and say the step in its note, or make it narrower.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Encoding, Protocol, Signal};
use crate::number::Rational;

/// What sum and product of a raw value must stay below.
const LIMIT: i128 = 1 << 50;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in message.signals.iter().filter(|signal| !signal.encoding.is_unscaled()) {
            let Encoding::Number { signed, scale, offset } = signal.encoding else { continue };
            if let Some(why) = fault(signal, signed, scale, offset) {
                let text = format!("`{}.{}`: {why}", message.name, signal.name);
                let help = "write another scale, or none, and say the step in the note";
                let at = signal.doc.path.key("scale").at_value();
                diagnostics.push(Diagnostic::error("grid", at, text).help(help));
            }
        }
    }
}

fn fault(signal: &Signal, signed: bool, scale: Rational, offset: Rational) -> Option<String> {
    if scale == Rational::ZERO {
        return Some("a scale of 0 makes every value 0".to_owned());
    }
    let width = u32::from(signal.place.width()) - u32::from(signed);
    let extreme = largest(1 << width, scale, offset);
    if extreme.is_none_or(|extreme| extreme >= LIMIT) {
        return Some(format!(
            "{} bits times {scale} reach 2^50, beyond which a double misses steps",
            signal.place.width()
        ));
    }
    None
}

/// Returns the largest |raw * a + b| where physical = (raw * a + b) / c; `None` on overflow.
fn largest(raw: i128, scale: Rational, offset: Rational) -> Option<i128> {
    let common = common_denominator(scale, offset)?;
    let step = scale.times(common)?.to_integer()?;
    let start = offset.times(common)?.to_integer()?;
    raw.checked_mul(step.checked_abs()?)?.checked_add(start.checked_abs()?)
}

/// Returns the least common multiple of the denominators.
fn common_denominator(one: Rational, other: Rational) -> Option<Rational> {
    let shared = Rational::new(one.denominator(), other.denominator())?.numerator();
    Some(Rational::integer(shared.checked_mul(other.denominator())?))
}
