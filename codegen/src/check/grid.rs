#![doc = include_str!("../../docs/rules/grid.md")]

use crate::emit::Scaled;
use crate::model::{Linear, Numeral, Protocol, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::words::number::Rational;

rules! {
    GRID "grid" Check ERROR;
}

/// Sums and products of raw values must stay below this power of two. Factors of two that the scale and the offset share
/// do not count, since they leave the digits of a float as they are.
const DOUBLE: u32 = 50;

/// Below this power of two, a double holds every integer exactly. If the common denominator is a power of two, every step
/// is exact.
const EXACT_DOUBLE: u32 = 53;

/// Sums and products are integers of 64 bits on the way.
const HELD: u32 = 62;

/// The same as `DOUBLE` in single precision, for raw values within the documented range if there is one.
///
/// This is measured. Among 2000 scales without offset, the first raw value that changes on the way
/// is 4 207 191, in steps of 1/1027. With offsets, none of 440 million random cases below 2^22
/// changes.
const SINGLE: u32 = 22;

/// The same as `EXACT_DOUBLE` in single precision. Limits with a fraction must stay below it, too, if the number is
/// unscaled.
const EXACT: u32 = 24;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let help = "write the step that the document prints, or a smaller place; or leave `scale` and `offset` out, \
                and say the step in `title`";
    each_scaled(protocol, diagnostics, help, |signal, linear| {
        let (width, scale) = (signal.place.width(), linear.scale);
        if scale == Rational::ZERO {
            return Some("a scale of 0 makes every value 0".to_owned());
        }
        missed(beyond(width, linear.numeral), linear, DOUBLES, || format!("{width} bits in steps of {scale}"))
    });
}

/// Tests whether a double tells apart all steps of a scaled number that is `width` bits wide.
pub fn has_exact_steps(width: u8, linear: Linear) -> bool {
    linear.scale != Rational::ZERO && missed(beyond(width, linear.numeral), linear, DOUBLES, String::new).is_none()
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
    let documented = documented(signal, linear);
    let raw = documented.map_or_else(|| format!("{width} bits"), |raw| format!("raw values to {raw}"));
    let extreme = documented.unwrap_or_else(|| farthest(width, linear.numeral));
    missed(extreme, linear, SINGLES, || format!("{raw} times {scale}"))
}

/// What a floating-point type tells apart.
struct Type {
    name: &'static str,
    /// The power of two below which it tells steps apart, and that if the common denominator is a power of two.
    powers: [u32; 2],
}

const DOUBLES: Type = Type { name: "an `f64`", powers: [DOUBLE, EXACT_DOUBLE] };
const SINGLES: Type = Type { name: "a single", powers: [SINGLE, EXACT] };

/// Says why a type misses some of the numbers that are calculated from an integer. `what` names them.
fn missed(
    integer: i128,
    linear: Linear,
    Type { name, powers: [power, exact] }: Type,
    what: impl FnOnce() -> String,
) -> Option<String> {
    let Some([largest, shared, denominator]) = largest(integer, linear) else {
        return Some(format!("{} reach 2^{HELD}, beyond which nothing calculates", what()));
    };
    if denominator >= 1 << exact {
        let scale = linear.scale;
        return Some(format!("the denominator of {scale} reaches 2^{exact}, beyond which {name} misses integers"));
    }
    let power = if denominator.is_power_of_two() { exact } else { power };
    let is_told_apart = largest < 1 << HELD && largest / shared < 1 << power;
    (!is_told_apart).then(|| {
        let most = HELD.min(power + shared.ilog2());
        format!("{} reach 2^{}, and {name} tells steps apart below 2^{most}", what(), largest.ilog2())
    })
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

/// Returns the largest |integer * a + b| where physical = (integer * a + b) / c, the greatest power of two that divides a
/// and b, and c. It is `None` on overflow.
fn largest(integer: i128, Linear { scale, offset, .. }: Linear) -> Option<[u128; 3]> {
    let denominator = scale.common_denominator(offset)?;
    let over = |number: Rational| number.times(Rational::integer(denominator))?.to_integer()?.checked_abs();
    let (step, start) = (over(scale)?, over(offset)?);
    let largest = integer.checked_mul(step)?.checked_add(start)?;
    Some([largest.unsigned_abs(), 1 << (step | start).trailing_zeros().min(HELD), denominator.unsigned_abs()])
}
