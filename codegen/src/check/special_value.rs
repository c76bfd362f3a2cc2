#![doc = include_str!("../../docs/rules/special_value.md")]

use crate::model::{Protocol, Range, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    SPECIAL_VALUE "special_value" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in protocol.contents() {
        for signal in message.signals.iter().flat_map(Signal::on_each) {
            for (range, path) in signal.ranges() {
                let names = names_inside(signal, range);
                if names.is_empty() {
                    continue;
                }
                let (values, lie) = if names.len() == 1 { ("value", "lies") } else { ("values", "lie") };
                let text = format!(
                    "the special {values} {} of `{}.{}` {lie} inside its range {}..{}",
                    names.join(" and "),
                    message.name,
                    signal.name,
                    range.minimum,
                    range.maximum
                );
                let what = if names.len() == 1 {
                    "it out of the range, or its name"
                } else {
                    "them out of the range, or their names"
                };
                let help = match names.len() {
                    1 if signal.absent().is_some_and(|absent| signal.is_inside(range, absent.raw)) => {
                        "take it out of the range, or write `absent: none`".to_owned()
                    }
                    _ => format!("take {what} out of `values`"),
                };
                diagnostics.push_first(Diagnostic::error(&SPECIAL_VALUE, path.at_value(), text).help(help));
            }
        }
    }
}

/// Returns the names of special values inside the range.
fn names_inside(signal: &Signal, range: Range) -> Vec<String> {
    let specials = signal.specials.iter().filter(|special| signal.is_inside(range, special.raw));
    specials.map(|special| format!("`{}` ({})", special.name, special.raw)).collect()
}
