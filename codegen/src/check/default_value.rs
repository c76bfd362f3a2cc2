//! `default_value`: a default that lies outside the signal's range.
//!
//! A default is sent where the caller leaves the signal out, so it must be a value that a request may carry.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Encoding, Protocol};
use crate::number::Rational;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            let Encoding::Number { scale, offset, .. } = signal.encoding else { continue };
            let (Some(range), Some(raw)) = (signal.range, signal.default) else { continue };
            let value = Rational::integer(raw).times(scale).and_then(|value| value.plus(offset));
            let special = signal.specials.iter().any(|special| special.raw == raw);
            if !special && value.is_none_or(|value| value < range.minimum || value > range.maximum) {
                let value = value.map_or_else(|| raw.to_string(), |value| value.to_string());
                let text = format!(
                    "the default {value} of `{}.{}` lies outside its range {}..{}",
                    message.name, signal.name, range.minimum, range.maximum
                );
                diagnostics.push(Diagnostic::error("default_value", signal.doc.path.key("default").at_value(), text));
            }
        }
    }
}
