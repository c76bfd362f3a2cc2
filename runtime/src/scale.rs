//! Exact scaling between raw and physical values.

use core::num::NonZero;

use crate::Number;

const ONE: NonZero<i64> = NonZero::new(1).expect("1 is not 0");

/// A scale and an offset, both exact fractions: physical = raw × scale + offset.
///
/// ```
/// use canspec_runtime::plumbing::Scale;
///
/// const TENTHS: Scale = Scale::new(1, 10);
/// const HALF_DEGREES: Scale = Scale::new(1, 2).offset(-40, 1);
///
/// assert_eq!(TENTHS.physical(3), 0.3);
/// assert_eq!(TENTHS.raw(0.3), Some(3));
/// assert_eq!(HALF_DEGREES.physical(110), 15.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Scale {
    numerator: i64,
    denominator: i64,
    /// The factor that makes `denominator` a common denominator of scale and offset. It is never 0, so that a signal
    /// without a scale takes no byte more.
    factor: NonZero<i64>,
    /// The offset as numerator over the common denominator.
    offset: i64,
}

impl Scale {
    /// The scale 1: raw and physical value are the same number.
    pub const ONE: Self = Self::new(1, 1);

    /// Returns a scale without offset.
    pub const fn new(numerator: i64, denominator: i64) -> Self {
        let common = greatest_common_divisor(denominator, numerator);
        Self { numerator: numerator / common, denominator: denominator / common, factor: ONE, offset: 0 }
    }

    /// Returns the same scale with an offset in physical units.
    ///
    /// # Panics
    ///
    /// Panics if `denominator` is 0. In a constant this is a compile error.
    #[must_use]
    pub const fn offset(self, numerator: i64, denominator: i64) -> Self {
        let common = greatest_common_divisor(self.denominator, denominator);
        let factor = NonZero::new(denominator / common).expect("a fraction has no denominator 0");
        let offset = numerator.saturating_mul(self.denominator / common);
        Self { factor, offset, ..self }
    }

    /// Tests whether physical values fall while raw values rise.
    pub(crate) const fn is_falling(self) -> bool {
        (self.numerator < 0) != (self.denominator < 0)
    }

    /// Returns the double nearest to the physical value of `raw`.
    ///
    /// Sum and product are exact to 2⁵³, and with the powers of two that they share. Then only the division rounds.
    #[expect(clippy::cast_precision_loss, reason = "the compiler accepts scales that are exact, or below 2^50")]
    #[inline(always)]
    pub const fn physical(self, raw: i64) -> f64 {
        self.sum(raw) as f64 / self.common_denominator() as f64
    }

    /// Returns the raw value nearest to a physical value, with ties away from zero. It is `None` if
    /// 64 bits cannot hold it.
    #[inline(always)]
    pub const fn raw(self, physical: f64) -> Option<i64> {
        nearest(self.exact(physical))
    }

    /// Returns the raw value nearest to a physical value as [`raw`](Self::raw) does, or `None` if `width` bits cannot
    /// hold it.
    #[inline(always)]
    pub(crate) const fn raw_of(self, physical: f64, width: u8, signed: bool) -> Option<i64> {
        let exact = self.exact(physical);
        if width > 32 { nearest(exact) } else { nearest_of(exact, width, signed) }
    }

    /// Returns the same raw value of a physical value between two others that `width` bits hold. It tests nothing that
    /// those tell.
    #[inline(always)]
    pub(crate) const fn raw_held(self, physical: f64, width: u8, signed: bool) -> Option<i64> {
        let exact = self.exact(physical);
        if width > 32 { nearest(exact) } else { Some(rounded(exact, width, signed)) }
    }

    #[expect(clippy::cast_precision_loss, reason = "the compiler accepts scales that are exact, or below 2^50")]
    #[inline(always)]
    const fn exact(self, physical: f64) -> f64 {
        let offset = self.offset as f64 / self.common_denominator() as f64;
        (physical - offset) * self.denominator as f64 / self.numerator as f64
    }

    /// Returns the single nearest to the physical value of `raw`, without arithmetic in double precision.
    ///
    /// Sum and product are exact while their size stays below 2²⁴. Then only the division rounds.
    #[expect(clippy::cast_precision_loss, reason = "the compiler keeps these numbers below 2^22")]
    #[inline(always)]
    pub const fn physical_f32(self, raw: i64) -> f32 {
        self.sum(raw) as f32 / self.common_denominator() as f32
    }

    /// Returns the raw value nearest to a physical value as [`raw`](Self::raw) does, without arithmetic in double
    /// precision.
    ///
    /// It first recovers the sum, and then subtracts the offset. That rounds once less than the
    /// other order. So every raw value whose sum stays below 2²² comes back unchanged.
    #[inline(always)]
    pub const fn raw_f32(self, physical: f32) -> Option<i64> {
        nearest_f32(self.exact_f32(physical))
    }

    /// Returns the raw value nearest to a physical value as [`raw_f32`](Self::raw_f32) does, or `None` if `width` bits
    /// cannot hold it.
    #[inline(always)]
    pub(crate) const fn raw_of_f32(self, physical: f32, width: u8, signed: bool) -> Option<i64> {
        let exact = self.exact_f32(physical);
        if width > 22 { nearest_f32(exact) } else { nearest_of_f32(exact, width, signed) }
    }

    /// Returns the same raw value as [`raw_held`](Self::raw_held) does, without arithmetic in double precision.
    #[inline(always)]
    pub(crate) const fn raw_held_f32(self, physical: f32, width: u8, signed: bool) -> Option<i64> {
        let exact = self.exact_f32(physical);
        if width > 22 { nearest_f32(exact) } else { Some(rounded_f32(exact, width, signed)) }
    }

    #[expect(clippy::cast_precision_loss, reason = "the compiler keeps these numbers below 2^22")]
    #[inline(always)]
    const fn exact_f32(self, physical: f32) -> f32 {
        let sum = physical * self.common_denominator() as f32;
        (sum - self.offset as f32) / self.numerator.saturating_mul(self.factor.get()) as f32
    }

    /// Returns the physical value of `raw` without floating-point arithmetic. All types of signals
    /// share the code, which is small because generated scales never overflow.
    #[inline(never)]
    pub(crate) const fn fraction(&self, raw: i64) -> Number {
        Number::Fraction { numerator: self.sum(raw), denominator: self.common_denominator() }
    }

    /// Returns the number of parts nearest to the physical value of `raw`, with ties away from zero. A unit has `parts`
    /// of them. It is `None` if 64 bits cannot hold what is calculated.
    pub(crate) const fn parts_of(&self, raw: i64, parts: i64) -> Option<i64> {
        match self.sum(raw).checked_mul(parts) {
            Some(sum) => match divided(sum, self.common_denominator()) {
                Some([_, nearest, _]) => Some(nearest),
                None => None,
            },
            None => None,
        }
    }

    /// Returns the raw values around a number of parts: the greatest below, the nearest, with ties away from zero, and
    /// the least above. They are equal if a raw value meets it.
    pub(crate) const fn raws_around(&self, count: i64, parts: i64) -> Option<[i64; 3]> {
        let (Some(sum), Some(offset)) = (count.checked_mul(self.common_denominator()), self.offset.checked_mul(parts))
        else {
            return None;
        };
        match (sum.checked_sub(offset), self.step().checked_mul(parts)) {
            (Some(steps), Some(step)) => divided(steps, step),
            _ => None,
        }
    }

    /// Returns the physical value of `raw` as numerator over the common denominator.
    #[inline(always)]
    const fn sum(self, raw: i64) -> i64 {
        raw.wrapping_mul(self.step()).wrapping_add(self.offset)
    }

    /// Returns what a step of the raw value adds to the numerator over the common denominator.
    #[inline(always)]
    const fn step(self) -> i64 {
        self.numerator.wrapping_mul(self.factor.get())
    }

    #[inline(always)]
    const fn common_denominator(self) -> i64 {
        self.denominator.wrapping_mul(self.factor.get())
    }
}

/// Divides whole numbers: the greatest below, the nearest, with ties away from zero, and the least above.
const fn divided(numerator: i64, denominator: i64) -> Option<[i64; 3]> {
    let (Some(cut), Some(rest)) = (numerator.checked_div(denominator), numerator.checked_rem(denominator)) else {
        return None;
    };
    if rest == 0 {
        return Some([cut; 3]);
    }
    let is_below_zero = (numerator < 0) != (denominator < 0);
    let beyond = if is_below_zero { cut.wrapping_sub(1) } else { cut.wrapping_add(1) };
    let left = denominator.unsigned_abs().wrapping_sub(rest.unsigned_abs());
    let nearest = if rest.unsigned_abs() >= left { beyond } else { cut };
    Some(if is_below_zero { [beyond, nearest, cut] } else { [cut, nearest, beyond] })
}

/// The largest number below a half.
const BELOW_HALF: f64 = 0.499_999_999_999_999_94;
/// The largest single below a half.
const BELOW_HALF_F32: f32 = 0.499_999_97;

/// Returns the integer nearest to `value`, with ties away from zero. It is `None` if 64 bits cannot
/// hold it.
///
/// The largest number below a half is added, and the fraction is cut off. The sum reaches the next integer from a
/// half on, because it is rounded to even there.
#[expect(clippy::cast_possible_truncation, reason = "the limits are tested first")]
#[inline(always)]
pub const fn nearest(value: f64) -> Option<i64> {
    const LIMIT: f64 = 9_223_372_036_854_775_808.0;
    let is_whole = value >= -LIMIT && value < LIMIT;
    if is_whole { Some((value + BELOW_HALF.copysign(value)) as i64) } else { None }
}

/// Returns the integer nearest to `value` as [`nearest`] does, or `None` if `width` bits, at most 32, cannot hold it.
#[expect(clippy::cast_precision_loss, reason = "32 bits are exact")]
#[inline(always)]
const fn nearest_of(value: f64, width: u8, signed: bool) -> Option<i64> {
    let count = 1_u64.wrapping_shl(width as u32) as f64;
    let (least, end) = if signed { (-count / 2.0, count / 2.0) } else { (0.0, count) };
    if value > least - 0.5 && value < end - 0.5 { Some(rounded(value, width, signed)) } else { None }
}

/// Returns the integer nearest to `value`, which `width` bits, at most 32, hold.
///
/// Processors convert to 32 bits at less cost than to 64.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the limits are tested first")]
#[inline(always)]
const fn rounded(value: f64, width: u8, signed: bool) -> i64 {
    if signed {
        return (value + BELOW_HALF.copysign(value)) as i32 as i64;
    }
    // The mask tells the compiler what was tested.
    (value + BELOW_HALF) as u32 as i64 & (1_i64.wrapping_shl(width as u32) - 1)
}

/// Returns the integer nearest to `value`, as [`nearest_of`] does with at most 22 bits.
#[expect(clippy::cast_precision_loss, reason = "22 bits are exact")]
#[inline(always)]
const fn nearest_of_f32(value: f32, width: u8, signed: bool) -> Option<i64> {
    let count = 1_u64.wrapping_shl(width as u32) as f32;
    let (least, end) = if signed { (-count / 2.0, count / 2.0) } else { (0.0, count) };
    if value > least - 0.5 && value < end - 0.5 { Some(rounded_f32(value, width, signed)) } else { None }
}

/// Returns the integer nearest to `value`, as [`rounded`] does with at most 22 bits.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the limits are tested first")]
#[inline(always)]
const fn rounded_f32(value: f32, width: u8, signed: bool) -> i64 {
    if signed {
        return (value + BELOW_HALF_F32.copysign(value)) as i32 as i64;
    }
    // The mask tells the compiler what was tested.
    (value + BELOW_HALF_F32) as u32 as i64 & (1_i64.wrapping_shl(width as u32) - 1)
}

/// Returns the integer nearest to `value`, as [`nearest`] does.
#[expect(clippy::cast_possible_truncation, reason = "the limits are tested first")]
#[inline(always)]
const fn nearest_f32(value: f32) -> Option<i64> {
    const LIMIT: f32 = 9_223_372_036_854_775_808.0;
    let is_whole = value >= -LIMIT && value < LIMIT;
    if is_whole { Some((value + BELOW_HALF_F32.copysign(value)) as i64) } else { None }
}

/// Euclid's algorithm. Two zeros give 1, so the result can always divide.
const fn greatest_common_divisor(mut a: i64, mut b: i64) -> i64 {
    while b != 0 {
        (a, b) = (b, a.wrapping_rem(b));
    }
    if a == 0 { 1 } else { a.saturating_abs() }
}

#[cfg(test)]
#[expect(clippy::float_cmp, clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "scaling is exact")]
mod tests {
    use core::mem::size_of;

    use super::*;

    #[test]
    fn a_signal_without_a_scale_takes_no_byte_more() {
        assert_eq!(size_of::<Option<Scale>>(), size_of::<Scale>());
    }

    #[test]
    fn ties_go_away_from_zero() {
        let rounded = [0.5, 1.5, 2.5, -0.5, -1.5, -2.5, 0.499_999_999_999_999_94, -0.499_999_999_999_999_94];
        assert_eq!(rounded.map(nearest), [1, 2, 3, -1, -2, -3, 0, 0].map(Some));
    }

    #[test]
    fn what_few_bits_hold_is_rounded_as_any_number_and_the_rest_is_refused() {
        let some = [-1e9, -32_768.5, -2.0, -0.5, 0.0, 254.5, 255.5, 32_767.5, 65_535.5, 4_294_967_295.5, f64::NAN];
        let ends = [(8, 0, 255), (8, -128, 127), (16, 0, 65_535), (16, -32_768, 32_767), (32, 0, 4_294_967_295)];
        let near = |(_, least, most): &(u8, i64, i64)| [*least, *most].map(|end| end as f64);
        for half in some.into_iter().chain(ends.iter().flat_map(near)).flat_map(|end| [end - 0.5, end, end + 0.5]) {
            for value in [half.next_down(), half, half.next_up()] {
                for (width, least, most) in ends {
                    let held = |raw: &i64| (least..=most).contains(raw);
                    let raw = Scale::ONE.raw_of(value, width, least < 0);
                    assert_eq!(raw, nearest(value).filter(held), "{value:?}");
                    assert!(raw.is_none() || Scale::ONE.raw_held(value, width, least < 0) == raw, "{value:?}");
                    let single = value as f32;
                    let nearest = nearest_f32(single).filter(|raw| width > 22 || held(raw));
                    assert_eq!(Scale::ONE.raw_of_f32(single, width, least < 0), nearest, "{single:?}");
                    let raw = nearest.filter(|raw| held(raw));
                    assert!(raw.is_none() || Scale::ONE.raw_held_f32(single, width, least < 0) == raw, "{single:?}");
                }
            }
        }
    }

    /// Compares a number with its whole part and its rest, without any sum that rounds.
    fn nearest_by_rest(value: f64) -> i64 {
        let (whole, rest) = (value.trunc(), value.fract());
        (whole + if rest.abs() >= 0.5 { 1.0_f64.copysign(value) } else { 0.0 }) as i64
    }

    #[test]
    fn numbers_around_each_half_go_to_the_nearest_integer() {
        let powers = (0..=53).map(|power| 2.0_f64.powi(power));
        let wholes = powers.flat_map(|power| [power - 1.0, power, power + 1.0]).chain([0.0, 5.0, 1e6, 1e15]);
        for near in wholes.flat_map(|whole| [whole, whole + 0.5, whole - 0.5, whole + 0.25, whole - 0.25]) {
            for value in [near.next_down(), near, near.next_up()].into_iter().flat_map(|value| [value, -value]) {
                assert_eq!(nearest(value), Some(nearest_by_rest(value)), "{value:?}");
                let single = value as f32;
                assert_eq!(nearest_f32(single), Some(nearest_by_rest(single.into())), "{single:?}");
            }
        }
    }

    #[test]
    fn what_is_no_number_of_64_bits_has_no_raw_value() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 9_223_372_036_854_775_808.0, -1e19] {
            assert_eq!(nearest(value), None);
        }
        assert_eq!(nearest(-9_223_372_036_854_775_808.0), Some(i64::MIN));
        assert_eq!(nearest(9_223_372_036_854_774_784.0), Some(9_223_372_036_854_774_784));
        assert_eq!(nearest(4_503_599_627_370_497.0), Some(4_503_599_627_370_497));
    }

    #[test]
    fn thousandths_hit_the_double_that_is_nearest() {
        let thousandths = Scale::new(1, 1000);
        assert_eq!(thousandths.physical(299_977), 299.977);
        assert_eq!(thousandths.physical(199_985), 199.985);
        assert_eq!(thousandths.raw(299.977), Some(299_977));
        assert_eq!(thousandths.raw(0.0005), Some(1));
        assert_eq!(thousandths.raw(0.000_499), Some(0));
    }

    #[test]
    fn every_millivolt_to_a_thousand_volts_encodes_to_its_own_raw_value() {
        let thousandths = Scale::new(1, 1000);
        for millivolt in 0..=1_000_000 {
            let written: f64 = std::format!("{}.{:03}", millivolt / 1000, millivolt % 1000).parse().expect("a number");
            assert_eq!(thousandths.physical(millivolt), written);
            assert_eq!(thousandths.raw(written), Some(millivolt));
        }
    }

    #[test]
    fn scales_above_one_round_to_the_nearest_step() {
        let tens = Scale::new(10, 1);
        assert_eq!(tens.physical(1500), 15_000.0);
        assert_eq!(
            [14_994.9, 14_995.0, 15_004.9, 15_005.0].map(|power| tens.raw(power)),
            [1499, 1500, 1500, 1501].map(Some)
        );
    }

    #[test]
    fn offsets_are_exact_fractions_too() {
        let half_degrees = Scale::new(1, 2).offset(-40, 1);
        assert_eq!(half_degrees.physical(0), -40.0);
        assert_eq!(half_degrees.raw(15.0), Some(110));
        // 7/3 + 1/10 = 73/30 = 2.4333333333333331..., by fractions.
        let thirds = Scale::new(1, 3).offset(1, 10);
        assert_eq!(thirds.physical(7), 2.433_333_333_333_333);
        assert_eq!(thirds.raw(2.433_333_333_333_333), Some(7));
    }

    #[test]
    fn negative_scales_count_down() {
        let extended_group = Scale::new(-1, 1).offset(0xFD, 1);
        assert_eq!(extended_group.physical(0xF8), 5.0);
        assert_eq!(extended_group.raw(5.0), Some(0xF8));
    }

    #[test]
    fn single_precision_rounds_the_same_way() {
        let thousandths = Scale::new(1, 1000);
        assert_eq!(
            [0.0625, 0.1875, -0.0625, 0.0624].map(|volts| thousandths.raw_f32(volts)),
            [63, 188, -63, 62].map(Some)
        );
        assert_eq!((thousandths.physical_f32(299_977), thousandths.raw_f32(299.977)), (299.977, Some(299_977)));
        assert_eq!(thousandths.raw_f32(f32::NAN), None);
        assert_eq!(Scale::ONE.raw_f32(9_223_372_036_854_775_808.0), None);
        let half_degrees = Scale::new(1, 2).offset(-40, 1);
        assert_eq!((half_degrees.physical_f32(110), half_degrees.raw_f32(15.0)), (15.0, Some(110)));
    }

    #[test]
    fn fractions_are_taken_in_lowest_terms() {
        assert_eq!(Scale::new(2, 100), Scale::new(1, 50));
        assert_eq!(Scale::new(1, 10).offset(83, 2), Scale::new(1, 10).offset(415, 10));
        assert!(Scale::new(0, 0).physical(1).is_nan());
    }
}
