//! Numbers as both codecs by hand pack and round them.
#![expect(clippy::cast_possible_truncation, reason = "the limits are tested first")]

/// Packs two words of 32 bits.
#[inline(always)]
pub fn words(first: u32, second: u32) -> u64 {
    u64::from(first) << 32 | u64::from(second)
}

/// Packs four words of 16 bits.
#[inline(always)]
pub fn halves([a, b, c, d]: [u16; 4]) -> u64 {
    u64::from(a) << 48 | u64::from(b) << 32 | u64::from(c) << 16 | u64::from(d)
}

/// Returns the nearest thousandth that 32 bits hold.
#[inline(always)]
pub fn milli(value: f64) -> Option<u32> {
    let value = value * 1000.0;
    (value > -0.5 && value < f64::from(u32::MAX) + 0.5).then(|| rounded(value))
}

/// Returns the nearest integer that 16 bits hold.
#[inline(always)]
pub fn half(value: f64) -> Option<u16> {
    (value > -0.5 && value < f64::from(u16::MAX) + 0.5).then(|| rounded(value) as u16)
}

/// Returns the nearest integer, with ties away from zero. A whole half would carry the largest number below it up.
#[inline(always)]
#[expect(clippy::cast_sign_loss, reason = "the limits are tested first")]
pub fn rounded(value: f64) -> u32 {
    (value + 0.5_f64.next_down()) as u32
}

/// Returns the nearest integer that 32 bits hold with a sign, with ties away from zero.
#[inline(always)]
pub fn signed(value: f64) -> Option<i32> {
    let is_held = value > f64::from(i32::MIN) - 0.5 && value < f64::from(i32::MAX) + 0.5;
    is_held.then(|| (value + 0.5_f64.next_down().copysign(value)) as i32)
}
