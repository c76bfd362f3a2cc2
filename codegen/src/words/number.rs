//! Exact numbers, from the text of a spec to the constants of a codec.

use serde::{Deserialize, Serialize};

use std::cmp::Ordering;
use std::fmt;

/// A rational number in lowest terms with a positive denominator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Rational {
    numerator: i128,
    denominator: i128,
}

/// Numerators and denominators of a spec stay below this limit. Every raw value of 64 bits does.
const LIMIT: i128 = 1 << 64;

impl Rational {
    /// Zero.
    pub const ZERO: Self = Self::integer(0);
    /// One.
    pub const ONE: Self = Self::integer(1);

    /// Returns the whole number `value`.
    pub const fn integer(value: i128) -> Self {
        Self { numerator: value, denominator: 1 }
    }

    /// Returns `numerator / denominator` in lowest terms, or `None` if the denominator is zero or the fraction overflows.
    pub fn new(numerator: i128, denominator: i128) -> Option<Self> {
        let divisor = greatest_common_divisor(numerator, denominator);
        let sign = denominator.signum();
        let reduced = |number: i128| number.checked_div(divisor)?.checked_mul(sign);
        (denominator != 0).then_some(Self { numerator: reduced(numerator)?, denominator: reduced(denominator)? })
    }

    /// Reads `12`, `-40`, `0x1F`, `0b101`, `41.5` or `1/1024`.
    pub fn parse(text: &str) -> Option<Self> {
        let (numerator, denominator) = match text.split_once('/') {
            Some((numerator, denominator)) => (numerator, natural(denominator)?),
            None => (text, 1),
        };
        let (negative, magnitude) = match numerator.strip_prefix('-') {
            Some(magnitude) => (-1, magnitude),
            None => (1, numerator),
        };
        let (digits, places) = match magnitude.split_once('.') {
            Some((whole, fraction)) if is_decimal(whole) && is_decimal(fraction) => {
                (format!("{whole}{fraction}"), fraction.len())
            }
            Some(_) => return None,
            None => (magnitude.to_owned(), 0),
        };
        let power = 10_i128.checked_pow(u32::try_from(places).ok()?)?;
        let value = Self::new(negative * natural(&digits)?, denominator.checked_mul(power)?)?;
        (value.numerator.abs() < LIMIT && value.denominator < LIMIT).then_some(value)
    }

    /// Writes the number as a spec writes a scale. A fraction such as `1/10` stays one.
    pub fn fraction(self) -> String {
        match (self.numerator, self.denominator) {
            (1, denominator @ 2..) => format!("1/{denominator}"),
            _ => self.to_string(),
        }
    }

    /// Returns the numerator.
    pub const fn numerator(self) -> i128 {
        self.numerator
    }

    /// Returns the denominator, which is positive.
    pub const fn denominator(self) -> i128 {
        self.denominator
    }

    /// Returns the number if it is whole.
    pub fn to_integer(self) -> Option<i128> {
        (self.denominator == 1).then_some(self.numerator)
    }

    /// Returns the greatest whole number that is not above.
    pub fn floor(self) -> i128 {
        self.numerator.div_euclid(self.denominator)
    }

    /// Returns the least whole number that is not below.
    pub fn ceiling(self) -> i128 {
        self.floor() + i128::from(self.denominator != 1)
    }

    /// Returns the nearest `f64`.
    #[allow(clippy::cast_precision_loss, reason = "the conversion rounds to nearest, which is what is wanted")]
    pub fn to_f64(self) -> f64 {
        let small = |number: i128| i64::try_from(number).ok().filter(|number| number.unsigned_abs() < 1 << 53);
        if let (Some(numerator), Some(denominator)) = (small(self.numerator), small(self.denominator)) {
            return numerator as f64 / denominator as f64;
        }
        self.to_string().parse().unwrap_or(self.numerator as f64 / self.denominator as f64)
    }

    /// Returns the least common multiple of both denominators, or `None` on overflow.
    pub fn common_denominator(self, other: Self) -> Option<i128> {
        (self.denominator / greatest_common_divisor(self.denominator, other.denominator)).checked_mul(other.denominator)
    }

    /// Returns `self + other`, or `None` on overflow.
    pub fn plus(self, other: Self) -> Option<Self> {
        let left = self.numerator.checked_mul(other.denominator)?;
        let right = other.numerator.checked_mul(self.denominator)?;
        Self::new(left.checked_add(right)?, self.denominator.checked_mul(other.denominator)?)
    }

    /// Returns `self - other`, or `None` on overflow.
    pub fn minus(self, other: Self) -> Option<Self> {
        self.plus(Self { numerator: other.numerator.checked_neg()?, ..other })
    }

    /// Returns `self * other`, or `None` on overflow.
    pub fn times(self, other: Self) -> Option<Self> {
        Self::new(self.numerator.checked_mul(other.numerator)?, self.denominator.checked_mul(other.denominator)?)
    }

    /// Returns `self / other`, or `None` on overflow or if `other` is zero.
    pub fn over(self, other: Self) -> Option<Self> {
        Self::new(self.numerator.checked_mul(other.denominator)?, self.denominator.checked_mul(other.numerator)?)
    }
}

fn is_decimal(digits: &str) -> bool {
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

/// Reads an unsigned number: decimal, hexadecimal after `0x`, or binary after `0b`.
fn natural(text: &str) -> Option<i128> {
    let prefixed = [("0x", 16), ("0b", 2)].into_iter();
    let mut prefixed = prefixed.filter_map(|(prefix, radix)| Some((text.strip_prefix(prefix)?, radix)));
    let (digits, radix) = prefixed.next().unwrap_or((text, 10));
    let plain = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    plain.then(|| i128::from_str_radix(digits, radix).ok()).flatten()
}

fn greatest_common_divisor(left: i128, right: i128) -> i128 {
    let (mut left, mut right) = (left.unsigned_abs(), right.unsigned_abs());
    while right != 0 {
        (left, right) = (right, left % right);
    }
    i128::try_from(left).unwrap_or(1).max(1)
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        if self.denominator == other.denominator {
            return self.numerator.cmp(&other.numerator);
        }
        let exact = |one: &Self, another: &Self| one.numerator.checked_mul(another.denominator);
        match (exact(self, other), exact(other, self)) {
            (Some(left), Some(right)) => left.cmp(&right),
            _ => self.to_f64().total_cmp(&other.to_f64()),
        }
    }
}

impl fmt::Display for Rational {
    /// Writes a finite decimal, else a fraction. `1/1024` is easier to recognise than its ten
    /// digits.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mut scaled, mut places) = (*self, 0);
        while scaled.denominator != 1 && places < 18 {
            let Some(next) = scaled.times(Self::integer(10)) else { break };
            (scaled, places) = (next, places + 1);
        }
        if scaled.denominator != 1 || (self.numerator == 1 && places > 6) {
            return write!(formatter, "{}/{}", self.numerator, self.denominator);
        }
        let sign = if self.numerator < 0 { "-" } else { "" };
        let digits = format!("{:0>width$}", scaled.numerator.unsigned_abs(), width = places + 1);
        let (whole, fraction) = digits.split_at(digits.len() - places);
        let point = if places == 0 { "" } else { "." };
        write!(formatter, "{sign}{whole}{point}{fraction}")
    }
}

#[cfg(test)]
mod tests {
    use super::Rational;

    fn parts(text: &str) -> Option<(i128, i128)> {
        Rational::parse(text).map(|number| (number.numerator(), number.denominator()))
    }

    #[test]
    fn decimals_fractions_and_hexadecimals_are_exact() {
        assert_eq!(parts("41.5"), Some((83, 2)));
        assert_eq!(parts("0.02"), Some((1, 50)));
        assert_eq!(parts("1/1024"), Some((1, 1024)));
        assert_eq!(parts("-40"), Some((-40, 1)));
        assert_eq!(parts("0xFD"), Some((253, 1)));
        assert_eq!(parts("0b101"), Some((5, 1)));
        assert_eq!(parts("18446744073709551615"), Some((18_446_744_073_709_551_615, 1)));
    }

    #[test]
    fn whole_numbers_stand_around_a_fraction() {
        let around = |text| Rational::parse(text).map(|number| (number.floor(), number.ceiling()));
        assert_eq!(["7/2", "-7/2", "3", "-3"].map(around), [(3, 4), (-4, -3), (3, 3), (-3, -3)].map(Some));
    }

    #[test]
    fn what_is_no_number_is_refused() {
        let too_long = "9".repeat(45);
        for text in [
            "", "-", "0x", "0X1F", "0x1.5", "0b", "0b2", "0b1.1", "1_000", "1.", ".5", "1/0", "18E5", "+1", "--1",
            "1/-2", &too_long,
        ] {
            assert_eq!(parts(text), None, "{text}");
        }
    }

    #[test]
    fn a_number_is_written_as_a_decimal_where_that_ends() {
        for (text, written) in [
            ("1/8", "0.125"),
            ("-83/2", "-41.5"),
            ("1/3", "1/3"),
            ("0.10", "0.1"),
            ("750", "750"),
            ("1/1024", "1/1024"),
            ("1025/1024", "1.0009765625"),
            ("0.000001", "0.000001"),
        ] {
            assert_eq!(Rational::parse(text).map(|number| number.to_string()), Some(written.to_owned()));
        }
    }
}
