//! Numbers in decimal digits.

use core::fmt;

use crate::raw::{Integer, Raw};
use crate::{Meaning, Number};

/// A number whose decimal digits have four bits each, the first digit highest (BCD). `R` has as
/// many bits.
///
/// ```
/// use canspec_runtime::Bcd;
///
/// let year = Bcd::<u16>::new(2024).expect("four digits");
/// assert_eq!((year.number(), year.raw()), (Some(2024), 0x2024));
/// assert_eq!(Bcd::from_raw(0x20A4_u16).number(), None);
/// assert_eq!(Bcd::<u16>::new(10_000), None);
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Bcd<R>(R);

impl<R: Integer> Bcd<R> {
    /// Takes a number, or returns `None` if it has too many digits.
    pub fn new(number: u64) -> Option<Self> {
        let bits = bits(number)?;
        let raw = R::from_bits(bits);
        (raw.to_bits() == bits).then_some(Self(raw))
    }

    /// Returns the number, or `None` if a digit is above 9.
    pub fn number(self) -> Option<u64> {
        number(self.0.to_bits())
    }
}

impl<R> Bcd<R> {
    /// Takes any raw bits.
    pub const fn from_raw(raw: R) -> Self {
        Self(raw)
    }

    /// Returns the raw bits.
    pub fn raw(self) -> R {
        self.0
    }
}

impl<R: Integer> fmt::Display for Bcd<R> {
    /// Writes the number, or the bits in hexadecimal if a digit is above 9.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.number() {
            Some(number) => number.fmt(formatter),
            None => write!(formatter, "{:#X}", self.0.to_bits()),
        }
    }
}

impl<R: Integer> fmt::Debug for Bcd<R> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

impl<R: Integer> Integer for Bcd<R> {}

impl<R: Integer> Raw for Bcd<R> {
    const IS_DECIMAL: bool = true;
    const IS_NUMBER: bool = true;

    fn from_bits(bits: u64) -> Self {
        Self(R::from_bits(bits))
    }

    fn to_bits(self) -> u64 {
        self.0.to_bits()
    }

    fn meaning(&self) -> Meaning<'_> {
        if self.is_finite() { Meaning::Number(Raw::number(*self)) } else { Meaning::None }
    }

    fn from_meaning(meaning: Meaning<'_>) -> Option<Self> {
        u64::from_meaning(meaning).and_then(Self::new)
    }

    fn bits_of(integer: i64) -> Option<u64> {
        bits(integer.try_into().ok()?)
    }

    fn ends(all: u64) -> [u64; 2] {
        [0, (all / 0xF).wrapping_mul(9)]
    }

    fn number(self) -> Number {
        self.number().map_or(Number::Float(f64::NAN), Number::Unsigned)
    }

    fn is_finite(self) -> bool {
        self.number().is_some()
    }

    fn is_within(self, minimum: Self, maximum: Self) -> bool {
        self.is_finite() && (minimum.to_bits()..=maximum.to_bits()).contains(&self.to_bits())
    }
}

/// Returns the number that the digits stand for.
pub(crate) fn number(bits: u64) -> Option<u64> {
    let digits = (0..64).step_by(4).rev().map(|shift| bits.wrapping_shr(shift) & 0xF);
    digits
        .into_iter()
        .try_fold(0_u64, |number, digit| (digit <= 9).then(|| number.wrapping_mul(10).wrapping_add(digit)))
}

/// Returns the bits of a number, or `None` if it has more than 16 digits.
pub(crate) fn bits(number: u64) -> Option<u64> {
    let (mut bits, mut rest) = (0, number);
    for shift in (0..64).step_by(4) {
        bits |= (rest % 10).wrapping_shl(shift);
        rest /= 10;
    }
    (rest == 0).then_some(bits)
}

#[cfg(test)]
mod tests {
    use std::string::ToString;
    use std::vec;

    use super::*;
    use crate::plumbing::{Legend, Piece, Word};
    use crate::{AnySignal, Payload, Place, Reason, Signal, WriteSignal};

    #[test]
    fn every_number_of_four_digits_comes_back_and_no_other_bits_are_one() {
        let numbers: std::vec::Vec<_> = (0..=u16::MAX).filter_map(|raw| Bcd::from_raw(raw).number()).collect();
        assert_eq!(numbers, (0..10_000).collect::<std::vec::Vec<_>>());
        for number in 0..10_000 {
            let written = std::format!("{number:04}");
            assert_eq!(Bcd::<u16>::new(number).map(Bcd::raw), u16::from_str_radix(&written, 16).ok());
        }
        assert_eq!(Bcd::<u16>::new(10_000), None);
        assert_eq!(Bcd::<u64>::new(9_999_999_999_999_999).map(Bcd::raw), Some(0x9999_9999_9999_9999));
        assert_eq!(Bcd::<u64>::new(10_000_000_000_000_000), None);
    }

    #[test]
    fn bits_that_are_no_number_are_kept_and_shown_but_not_sent_in_a_request() {
        const DAY: Signal<Bcd<u8>> = Signal::new("day", Place::byte(0));
        const LIMITED: Signal<Bcd<u8>> = DAY.limits(Bcd::from_raw(0x01), Bcd::from_raw(0x31));
        let odd = DAY.get(&[0x2A, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(odd.to_string(), "0x2A");
        assert_eq!(odd.meaning(), Meaning::None);
        let mut reply = Payload::new("date", [0; 8]);
        assert_eq!(DAY.put(odd, &mut reply), Ok(()));
        assert_eq!(reply.data()[0], 0x2A);
        for day in [&DAY, &LIMITED] {
            let refused = day.put(odd, &mut Payload::within_limits("date", [0; 8])).map_err(|error| error.reason());
            assert_eq!(refused, Err(Some(Reason::NotFinite)));
        }
    }

    #[test]
    fn a_scale_applies_to_the_number_that_the_digits_write() {
        const LEVEL: Signal<Bcd<u16>> = Signal::new("level", Place::bytes(0, 1))
            .scale(1, 10)
            .offset(-40, 1)
            .limits(Bcd::from_raw(0x0000), Bcd::from_raw(0x1250));
        let shown = |data| {
            let mut shown = None;
            LEVEL.read(&data, &mut |reading| shown = Some(reading.meaning.to_string()));
            shown.expect("it is read once")
        };
        assert_eq!(shown([0x06, 0x50, 0, 0, 0, 0, 0, 0]), "25");
        assert_eq!(shown([0x06, 0x5A, 0, 0, 0, 0, 0, 0]), "?");
        let sent = |level| {
            let mut payload = Payload::within_limits("meter", [0; 8]);
            LEVEL.write(Meaning::Number(Number::Float(level)), &mut payload).map(|()| payload.data()[..2].to_vec())
        };
        assert_eq!(sent(-39.0), Ok(vec![0x00, 0x10]));
        assert_eq!(sent(84.96), Ok(vec![0x12, 0x50]));
        let error = sent(85.1).expect_err("the limit is 85");
        assert!(error.to_string().ends_with("is 85.1, but its limits are -40 and 85"), "{error}");
    }

    #[test]
    fn a_part_of_a_text_takes_no_more_digits_than_it_has_room_for() {
        #[derive(Clone, Copy, Debug, PartialEq)]
        struct Week(Bcd<u8>);

        impl Word for Week {
            type Raw = u64;
            const LEGEND: Legend<u64> = Legend::Text(1, &[Piece::number::<Bcd<u8>>(Place::byte(0))]);
            const FROM_RAW: fn(u64) -> Self = |raw| Self(Raw::from_bits(raw));
            const RAW: fn(Self) -> u64 = |week| week.0.to_bits();
        }

        let parsed = ["9", "53", "99", "100", "5A"].map(<Week as Word>::parse);
        let weeks = [Some(0x09), Some(0x53), Some(0x99), None, None];
        assert_eq!(parsed, weeks.map(|raw| raw.map(|raw| Week(Bcd::from_raw(raw)))));
    }

    #[test]
    fn limits_are_those_of_the_number_and_of_its_digits() {
        const TOTAL: Signal<Bcd<u16>, f64> = Signal::new("total", Place::bytes(1, 0).bits(11, 0)).limits(10.0, 998.0);
        let sent = |number| {
            let mut payload = Payload::within_limits("meter", [0; 8]);
            TOTAL.write(Meaning::Number(Number::Unsigned(number)), &mut payload).map(|()| *payload.data())
        };
        assert_eq!(sent(998), Ok([0x98, 0x09, 0, 0, 0, 0, 0, 0]));
        for number in [9, 999] {
            let error = sent(number).expect_err("a number outside the limits");
            assert_eq!(
                error.to_string(),
                std::format!("`total` of `meter` is {number}, but its limits are 10 and 998")
            );
        }
        let error = TOTAL.put(Bcd::from_raw(0x1000), &mut Payload::new("meter", [0; 8])).expect_err("four digits");
        assert!(error.to_string().ends_with("0 and 999"), "{error}");
    }
}
