#![doc = include_str!("../../docs/rules/grid.md")]

use crate::emit::Scaled;
use crate::model::{Linear, Protocol, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::words::number::Rational;

rules! {
    GRID "grid" Check ERROR;
}

/// In single precision, numbers on the way must stay below this power of two if the division rounds.
///
/// This is measured. Among 2000 scales without offset, the first raw value that changes on the way
/// is 4 207 191, in steps of 1/1027. With offsets, none of 440 million random cases below 2^22
/// changes.
const SINGLE: u32 = 22;

/// A single holds every integer to this power of two. Limits with a fraction must stay below it, too, if the number is
/// unscaled.
const EXACT: u32 = 24;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let help = "write the step that the document prints, or a smaller place; or leave `scale` and `offset` out, \
                and say the step in `title`";
    each_scaled(protocol, diagnostics, help, |signal, linear| {
        missed(width_limits(signal.place.width(), linear), linear, &DOUBLES, || bits(signal))
    });
}

/// Tests whether a double tells apart all steps of a scaled number that is `width` bits wide.
pub fn has_exact_steps(width: u8, linear: Linear) -> bool {
    missed(width_limits(width, linear), linear, &DOUBLES, String::new).is_none()
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
    match documented(signal, linear) {
        Some(ends) => missed(ends, linear, &SINGLES, || format!("raw values from {} to {}", ends[0], ends[1])),
        None => missed(width_limits(signal.place.width(), linear), linear, &SINGLES, || bits(signal)),
    }
}

/// A type in which numbers are calculated.
struct Type {
    name: &'static str,
    /// Tests whether it holds all numbers on a way, of which this one is the largest.
    holds: fn(&Way, u128) -> bool,
}

const INTEGERS: Type = Type { name: "an `i64`", holds: |way, largest| largest.max(way.denominator) < 1 << 63 };
const DOUBLES: Type = Type { name: "an `f64`", holds: |way, largest| way.is_exact(largest, 50, 53) };
const SINGLES: Type = Type { name: "a single", holds: |way, largest| way.is_exact(largest, SINGLE, EXACT) };

/// What an integer goes through: physical = (integer * step + start) / denominator.
struct Way {
    step: i128,
    start: i128,
    denominator: u128,
}

impl Way {
    /// Returns the way to the values of a scale, or `None` on overflow.
    fn new(Linear { scale, offset, .. }: Linear) -> Option<Self> {
        let denominator = scale.common_denominator(offset)?;
        let over = |number: Rational| number.times(Rational::integer(denominator))?.to_integer();
        Some(Self { step: over(scale)?, start: over(offset)?, denominator: denominator.unsigned_abs() })
    }

    /// Tests whether a type holds the products and the sums of all integers between two ends.
    fn suits(&self, ends: [i128; 2], ty: &Type) -> bool {
        let numbers = ends.map(|integer| {
            let product = integer.checked_mul(self.step)?;
            Some(product.unsigned_abs().max(product.checked_add(self.start)?.unsigned_abs()))
        });
        let largest = numbers.into_iter().try_fold(self.start.unsigned_abs(), |most, number| Some(most.max(number?)));
        largest.is_some_and(|largest| (ty.holds)(self, largest))
    }

    /// Tests whether a float with this many digits has each step, and leads back from it to the integer.
    ///
    /// Factors of two that all numbers share leave its digits as they are. A division by a power of two is exact. Any
    /// other one rounds, and so do the steps back: their errors add up to less than half a step if three digits are
    /// spare.
    fn is_exact(&self, largest: u128, rounded: u32, digits: u32) -> bool {
        let largest = largest >> (self.step | self.start).trailing_zeros();
        match self.denominator >> self.denominator.trailing_zeros() {
            1 => largest <= 1 << digits,
            odd => odd < 1 << digits && largest < 1 << rounded,
        }
    }
}

/// Says why code that calculates in a type misses some of the integers between two ends. `what` names them.
fn missed(ends: [i128; 2], linear: Linear, ty: &Type, what: impl FnOnce() -> String) -> Option<String> {
    let scale = linear.scale;
    if scale == Rational::ZERO {
        return Some("a scale of 0 makes every value 0".to_owned());
    }
    let Some(way) = Way::new(linear) else {
        return Some(format!("nothing calculates steps of {scale} from {}", linear.offset));
    };
    let types = [ty, &INTEGERS];
    let ty = types.into_iter().find(|ty| !way.suits(ends, ty))?;
    let suits = |width: &u8| types.iter().all(|ty| way.suits(width_limits(*width, linear), ty));
    let widths = (1..=64).rev().filter(|width| linear.numeral.is_raw() || width % 4 == 0);
    Some(match { widths }.find(suits) {
        Some(width) => format!("{} in steps of {scale} are too many for {}, while {width} bits fit", what(), ty.name),
        None => format!("steps of {scale} from {} on are too fine for {}", linear.offset, ty.name),
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

/// Returns the least and the greatest integer that the bits can hold.
fn width_limits(width: u8, linear: Linear) -> [i128; 2] {
    linear.numeral.limits(width).into()
}

fn bits(signal: &Signal) -> String {
    format!("{} bits", signal.place.width())
}

/// Returns the least and the greatest integer of the documented range, if there is one.
fn documented(signal: &Signal, linear: Linear) -> Option<[i128; 2]> {
    signal.range?;
    let ranges: Option<Vec<_>> = signal.ranges().map(|(range, _)| linear.integers(range)).collect();
    let specials = signal.specials.iter().map(|special| special.raw).chain(signal.default);
    let specials = specials.chain(signal.model_defaults.iter().map(|own| own.value));
    let specials = specials.filter_map(|raw| linear.numeral.integer(raw));
    let all: Vec<_> = ranges?.into_iter().flatten().chain(specials).collect();
    Some([*all.iter().min()?, *all.iter().max()?])
}
