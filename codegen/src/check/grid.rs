#![doc = include_str!("../rules/grid.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::emit::Scaled;
use crate::model::{Linear, Numeral, Protocol, Signal};
use crate::number::Rational;
use crate::rule::rules;

rules! {
    GRID "grid" Check ERROR;
}

/// Sums and products of raw values must stay below this power of two.
const DOUBLE: u32 = 50;

/// The same in single precision, for raw values within the documented range if there is one.
///
/// This is measured. Among 2000 scales without offset, the first raw value that changes on the way
/// is 4 207 191, in steps of 1/1027. With offsets, none of 440 million random cases below 2^22
/// changes.
const SINGLE: u32 = 22;

/// Below this power of two, a single holds every integer exactly. If the common denominator is one,
/// every step is exact. Limits with a fraction must stay below it, too, if the number is unscaled.
const EXACT: u32 = 24;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let help = "write the step that the document prints, or a smaller place; or leave `scale` and `offset` out, \
                and say the step in `title`";
    each_scaled(protocol, diagnostics, help, |signal, linear| {
        let (width, scale) = (signal.place.width(), linear.scale);
        if scale == Rational::ZERO {
            return Some("a scale of 0 makes every value 0".to_owned());
        }
        (!has_exact_steps(width, linear))
            .then(|| format!("{width} bits in steps of {scale} reach 2^50, beyond which an `f64` misses steps"))
    });
}

/// Tests whether a double tells apart all steps of a scaled number that is `width` bits wide.
pub fn has_exact_steps(width: u8, linear: Linear) -> bool {
    linear.scale != Rational::ZERO && is_below(largest(beyond(width, linear.numeral), linear), DOUBLE)
}

/// Looks for scales and limits that do not fit single precision, if generated code calculates in
/// it.
pub fn fits(protocol: &Protocol, scaled: Scaled, diagnostics: &mut Diagnostics) {
    if scaled == Scaled::F32 {
        let help = "generate code in whole steps or with `f64`, or write the range that the document states";
        each_scaled(protocol, diagnostics, help, missed_by_single);
        limits(protocol, diagnostics);
    }
}

fn missed_by_single(signal: &Signal, linear: Linear) -> Option<String> {
    if Scaled::F32.of(signal) != Scaled::F32 {
        return None;
    }
    let (width, scale) = (signal.place.width(), linear.scale);
    let Some(denominator) = scale.common_denominator(linear.offset).filter(|common| is_below(Some(*common), EXACT))
    else {
        return Some(format!("the denominator of {scale} reaches 2^{EXACT}, beyond which a single misses integers"));
    };
    let limit = if denominator.count_ones() == 1 { EXACT } else { SINGLE };
    let documented = documented(signal, linear);
    let extreme = largest(documented.unwrap_or_else(|| farthest(width, linear.numeral)), linear);
    let raw = documented.map_or_else(|| format!("{width} bits"), |raw| format!("raw values to {raw}"));
    (!is_below(extreme, limit))
        .then(|| format!("{raw} times {scale} reach 2^{limit}, beyond which a single misses steps"))
}

/// Looks for faults in the scale of each scaled signal.
fn each_scaled(
    protocol: &Protocol,
    diagnostics: &mut Diagnostics,
    help: &str,
    fault: impl Fn(&Signal, Linear) -> Option<String>,
) {
    for message in protocol.contents() {
        let signals = message.signals.iter().flat_map(Signal::on_each);
        for signal in signals.filter(|signal| !signal.encoding.is_unscaled()) {
            let fault = signal.encoding.linear().and_then(|linear| fault(signal, linear));
            if let Some(why) = fault {
                let text = format!("`{}.{}`: {why}", message.name, signal.name);
                let at = signal.doc.path.key("scale").at_value();
                diagnostics.push_first(Diagnostic::error(&GRID, at, text).help(help));
            }
        }
    }
}

/// Looks for limits of unscaled numbers that a single does not hold. Limits without a fraction are
/// integers.
fn limits(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let help = "generate code in whole steps or with `f64`, or say the limits in the note";
    for message in protocol.contents() {
        let is_compared = |signal: &&Signal| signal.encoding.is_unscaled() && !signal.has_whole_limits();
        for signal in message.signals.iter().flat_map(Signal::on_each).filter(is_compared) {
            let is_missed = |end: Rational| !is_below(Some(end.numerator()), EXACT);
            let limits = signal.limits();
            for (_, path) in limits.filter(|(range, _)| is_missed(range.minimum) || is_missed(range.maximum)) {
                let text = format!(
                    "the limits of `{}.{}` reach 2^{EXACT}, beyond which a single misses integers",
                    message.name, signal.name
                );
                diagnostics.push_first(Diagnostic::error(&GRID, path.at_value(), text).help(help));
            }
        }
    }
}

fn is_below(number: Option<i128>, power: u32) -> bool {
    number.is_some_and(|number| number.unsigned_abs() < 1 << power)
}

/// Returns one more than the largest integer that the bits can hold.
fn beyond(width: u8, numeral: Numeral) -> i128 {
    numeral.limits(width).1 + 1
}

/// Returns the largest |integer| that the bits can hold.
fn farthest(width: u8, numeral: Numeral) -> i128 {
    let (first, last) = numeral.limits(width);
    last.max(-first)
}

/// Returns the largest |integer| of the documented range, if there is one.
fn documented(signal: &Signal, linear: Linear) -> Option<i128> {
    signal.range?;
    let integer = |end: Rational| {
        let integer = end.minus(linear.offset)?.over(linear.scale)?;
        (integer.numerator() / integer.denominator()).checked_abs()
    };
    let ends = signal.ranges().flat_map(|(range, _)| [range.minimum, range.maximum]).map(integer);
    let specials = signal.specials.iter().map(|special| special.raw).chain(signal.default);
    let specials = specials.chain(signal.model_defaults.iter().map(|own| own.value));
    let specials = specials.filter_map(|raw| linear.numeral.integer(raw));
    ends.chain(specials.map(i128::checked_abs)).try_fold(0, |largest: i128, integer| Some(integer?.max(largest)))
}

/// Returns the largest |integer * a + b| where physical = (integer * a + b) / c; `None` on overflow.
fn largest(integer: i128, Linear { scale, offset, .. }: Linear) -> Option<i128> {
    let common = Rational::integer(scale.common_denominator(offset)?);
    let step = scale.times(common)?.to_integer()?;
    let start = offset.times(common)?.to_integer()?;
    integer.checked_mul(step.checked_abs()?)?.checked_add(start.checked_abs()?)
}
