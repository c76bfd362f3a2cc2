#![doc = include_str!("../../docs/rules/no_unit.md")]

use crate::model::{Protocol, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::words::number::Rational;

rules! {
    NO_UNIT "no_unit" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in protocol.contents() {
        for signal in message.signals.iter().flat_map(Signal::on_each).filter(|signal| is_nameless(signal)) {
            let what = if has_scale(signal) { "a scale" } else { "an offset" };
            let text = format!("`{}.{}` has {what}, but neither a unit nor a title", message.name, signal.name);
            let help = "write its `unit`; if the language does not have that unit, declare it in `units`, or say it in the `title`";
            diagnostics.push_first(Diagnostic::warning(&NO_UNIT, signal.doc.path.at_key(), text).help(help));
        }
    }
}

fn has_scale(signal: &Signal) -> bool {
    signal.encoding.linear().is_some_and(|linear| linear.scale != Rational::ONE)
}

fn is_nameless(signal: &Signal) -> bool {
    let is_scaled = signal.encoding.linear().is_some() && !signal.encoding.is_unscaled();
    is_scaled && signal.unit.is_none() && signal.doc.title.is_none()
}
