//! Floats of the frame. Not every one is a number.

use core::fmt;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serializer};

/// Serializes a float. Formats for people get the double of the same value, or the bits as a text
/// if it is not finite.
///
/// # Errors
///
/// Passes on errors of the serializer.
pub fn serialize<S: Serializer>(value: &f32, serializer: S) -> Result<S::Ok, S::Error> {
    match (serializer.is_human_readable(), value.is_finite()) {
        (false, _) => serializer.serialize_f32(*value),
        (true, true) => serializer.serialize_f64((*value).into()),
        (true, false) => serializer.collect_str(&format_args!("0x{:08X}", value.to_bits())),
    }
}

/// Deserializes a float.
///
/// # Errors
///
/// Refuses anything but a number or the text of 32 bits.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    if deserializer.is_human_readable() { deserializer.deserialize_any(Float) } else { f32::deserialize(deserializer) }
}

struct Float;

#[expect(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "the nearest float is what is sent")]
impl Visitor<'_> for Float {
    type Value = f32;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a number, or the bits of a float such as `0x7FC00000`")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f32, E> {
        Ok(value as f32)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f32, E> {
        Ok(value as f32)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f32, E> {
        Ok(value as f32)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<f32, E> {
        let digits = text.strip_prefix("0x").filter(|digits| digits.len() == 8);
        let bits = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        bits.map(f32::from_bits).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}
