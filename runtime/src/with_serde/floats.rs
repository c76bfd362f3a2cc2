//! Arrays of floats. A frame has room for two of them. Not every one is a number.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::optional_float::Float;

/// Serializes each float like [`float::serialize`](super::float::serialize).
///
/// # Errors
///
/// Passes on errors of the serializer.
pub fn serialize<S: Serializer>(values: &[f32; 2], serializer: S) -> Result<S::Ok, S::Error> {
    values.map(Float).serialize(serializer)
}

/// Deserializes each float like [`float::deserialize`](super::float::deserialize).
///
/// # Errors
///
/// Refuses anything but two numbers or texts of 32 bits.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f32; 2], D::Error> {
    <[Float; 2]>::deserialize(deserializer).map(|values| values.map(|Float(value)| value))
}
