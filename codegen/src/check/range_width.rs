#![doc = include_str!("../rules/range_width.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Protocol;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            let Some(holds) = signal.held() else { continue };
            for (range, path) in signal.ranges() {
                if range.minimum >= holds.minimum && range.maximum <= holds.maximum {
                    continue;
                }
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
                diagnostics.push_first(Diagnostic::error("range_width", path.at_value(), text).help(help));
            }
        }
    }
}

fn number_of_bits(width: u8) -> String {
    if width == 1 { "one bit".to_owned() } else { format!("{width} bits") }
}
