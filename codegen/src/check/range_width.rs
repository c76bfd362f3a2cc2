//! `range_width`: a range that the raw value cannot hold.
//!
//! The limits or the scale are wrong: a byte in steps of 1/10 V never reaches 750 V.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Encoding, Protocol, Range, Signal};
use crate::number::Rational;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            let (Some(range), Some(holds)) = (signal.range, holds(signal)) else { continue };
            if range.minimum < holds.minimum || range.maximum > holds.maximum {
                let text = format!(
                    "the range {}..{} of `{}.{}` exceeds the {}..{} of {}",
                    range.minimum,
                    range.maximum,
                    message.name,
                    signal.name,
                    holds.minimum,
                    holds.maximum,
                    number_of_bits(signal.place.width())
                );
                let help =
                    "correct the limits, the scale or the place; numbers below 0 need `as: signed` or an `offset`";
                let at = signal.doc.path.key("range").at_value();
                diagnostics.push(Diagnostic::error("range_width", at, text).help(help));
            }
        }
    }
}

fn number_of_bits(width: u8) -> String {
    if width == 1 { "one bit".to_owned() } else { format!("{width} bits") }
}

/// Returns the physical limits of the raw value.
fn holds(signal: &Signal) -> Option<Range> {
    let Encoding::Number { signed, scale, offset } = signal.encoding else { return None };
    let width = u32::from(signal.place.width());
    let (first, last) = if signed { (-(1_i128 << (width - 1)), (1 << (width - 1)) - 1) } else { (0, (1 << width) - 1) };
    let end = |raw: i128| Rational::integer(raw).times(scale)?.plus(offset);
    let (one, other) = (end(first)?, end(last)?);
    Some(Range { minimum: one.min(other), maximum: one.max(other) })
}
