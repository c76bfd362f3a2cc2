//! Singles as parts of a unit, and back, without floating-point arithmetic.

/// The bits of a single that hold its fraction.
const FRACTION: u32 = 23;
/// The exponent of a single whose last bit is a whole one.
const WHOLE: u32 = 127 + FRACTION;
/// The exponent of what is no finite number.
const NOT_FINITE: u32 = 0xFF;

/// Returns the number of parts nearest to a single, with ties away from zero. It is `None` if it is no finite number,
/// or an `i32` cannot hold it.
pub fn parts_of(value: f32, parts: u16) -> Option<i32> {
    let bits = value.to_bits();
    let exponent = bits.wrapping_shr(FRACTION) & NOT_FINITE;
    let fraction = u64::from(bits & 0x7F_FFFF);
    // Numbers of the least exponent lack the first one, and have the place of the next exponent.
    let digits = if exponent == 0 { fraction } else { fraction | 1 << FRACTION };
    let (product, exponent) = (digits.wrapping_mul(parts.into()), exponent.max(1));
    let size = match exponent.checked_sub(WHOLE) {
        _ if exponent == NOT_FINITE => return None,
        // From this exponent on it is more than 32 bits can hold.
        Some(32..) => return None,
        Some(left) => product.wrapping_shl(left),
        None => rounded(product, WHOLE.wrapping_sub(exponent)),
    };
    let size = i64::try_from(size).ok()?;
    i32::try_from(if bits.wrapping_shr(31) == 1 { size.wrapping_neg() } else { size }).ok()
}

/// Drops the last bits of a number with at most 34 bits, and rounds it to the nearest, with ties up.
const fn rounded(product: u64, bits: u32) -> u64 {
    if bits > 35 { 0 } else { (product.wrapping_shr(bits.wrapping_sub(1))).wrapping_add(1).wrapping_shr(1) }
}

/// Returns the single nearest to a number of parts, with ties to even, as all singles are rounded.
pub fn of_parts(value: i32, parts: u16) -> f32 {
    let size = u64::from(value.unsigned_abs());
    // With the first bit at the top, the quotient has at least 54 bits, and 24 of them are kept.
    let up = size.leading_zeros();
    let top = size.wrapping_shl(up);
    let (Some(quotient), Some(rest)) = (top.checked_div(parts.into()), top.checked_rem(parts.into())) else {
        return 0.0;
    };
    let Some(dropped) = (u64::BITS - FRACTION - 1).checked_sub(quotient.leading_zeros()).filter(|_| size != 0) else {
        return 0.0;
    };
    let digits = quotient.wrapping_shr(dropped);
    let (half, lost) = (1_u64.wrapping_shl(dropped - 1), quotient & 1_u64.wrapping_shl(dropped).wrapping_sub(1));
    let is_up = lost > half || (lost == half && (rest != 0 || digits & 1 == 1));
    let exponent = u64::from(WHOLE.wrapping_add(dropped).wrapping_sub(up));
    // A carry out of the digits is the next exponent.
    let bits = exponent.wrapping_sub(1).wrapping_shl(FRACTION).wrapping_add(digits).wrapping_add(is_up.into());
    let sign = if value < 0 { 1 << 31 } else { 0 };
    f32::from_bits(u32::try_from(bits).unwrap_or_default() | sign)
}
