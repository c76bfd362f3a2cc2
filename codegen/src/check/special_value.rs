//! `special_value`: a special value that lies inside the range.
//!
//! A raw value either counts or has a name. Take it out of the range, or drop the name.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Encoding, Protocol};
use crate::number::Rational;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            let Encoding::Number { scale, offset, .. } = signal.encoding else { continue };
            let Some(range) = signal.range else { continue };
            for special in &signal.specials {
                let value = Rational::integer(special.raw).times(scale).and_then(|value| value.plus(offset));
                if value.is_some_and(|value| range.minimum <= value && value <= range.maximum) {
                    let text = format!(
                        "the special value `{}` of `{}.{}` lies inside its range {}..{}",
                        special.name, message.name, signal.name, range.minimum, range.maximum
                    );
                    let help = "take it out of the range, or drop its name";
                    let at = signal.doc.path.key("range").at_value();
                    diagnostics.push(Diagnostic::error("special_value", at, text).help(help));
                }
            }
        }
    }
}
