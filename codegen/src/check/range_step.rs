#![doc = include_str!("../../docs/rules/range_step.md")]

use std::iter;

use crate::model::{Linear, Message, Protocol, Range, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::words::number::Rational;

rules! {
    RANGE_STEP "range_step" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in protocol.contents() {
        let signals = message.signals.iter().flat_map(Signal::on_each);
        for signal in signals.flat_map(|signal| iter::once(signal).chain(signal.encoding.parts())) {
            let Some(linear) = signal.encoding.linear() else { continue };
            for (range, path) in signal.ranges() {
                let missed = missed(range, linear);
                if !missed.is_empty() {
                    let text = text(message, signal, linear, &missed);
                    let warning = Diagnostic::warning(&RANGE_STEP, path.at_value(), text);
                    diagnostics.push_first(warning.help(help(range, linear)));
                }
            }
        }
    }
}

/// Returns the ends of a range that no step reaches.
fn missed(range: Range, linear: Linear) -> Vec<Rational> {
    let is_missed = |end: &Rational| steps_around(*end, linear).is_some_and(|[one, other]| one != other);
    [range.minimum, range.maximum].into_iter().filter(is_missed).collect()
}

/// Returns the steps on both sides of a number, the lower one first; where it is a step itself, it twice.
fn steps_around(number: Rational, linear: Linear) -> Option<[Rational; 2]> {
    let steps = number.minus(linear.offset)?.over(linear.scale)?;
    let before = steps.floor();
    let after = before + i128::from(steps.to_integer().is_none());
    let (one, other) = (linear.value(before)?, linear.value(after)?);
    Some([one.min(other), one.max(other)])
}

fn text(message: &Message, signal: &Signal, linear: Linear, missed: &[Rational]) -> String {
    let unit = signal.unit_text();
    let from = if linear.offset == Rational::ZERO { String::new() } else { format!(" from {}{unit}", linear.offset) };
    let ends = missed.iter().map(Rational::to_string).collect::<Vec<_>>().join(" and ");
    format!(
        "the range of `{}.{}` ends at {ends}{unit}, which steps of {}{unit}{from} never reach",
        message.name, signal.name, linear.scale
    )
}

fn help(range: Range, linear: Linear) -> String {
    let inner = steps_around(range.minimum, linear).zip(steps_around(range.maximum, linear));
    let what = match inner {
        Some(([_, first], [last, _])) if first <= last => format!("write {first}..{last}, which is what can be sent"),
        _ => "correct the range, within which nothing can be sent".to_owned(),
    };
    format!("{what}, or the step that the document prints; or allow it with a reason in `allow`")
}
