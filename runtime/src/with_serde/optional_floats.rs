//! Arrays of floats that a frame can lack. Not every one is a number.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::optional_float::Float;

/// Serializes each float like [`float::serialize`](super::float::serialize), and a missing one as
/// none.
///
/// # Errors
///
/// Passes on errors of the serializer.
pub fn serialize<S: Serializer>(values: &[Option<f32>; 2], serializer: S) -> Result<S::Ok, S::Error> {
    values.map(|value| value.map(Float)).serialize(serializer)
}

/// Deserializes each float like [`float::deserialize`](super::float::deserialize), or none.
///
/// # Errors
///
/// Refuses anything but two items, each a number, the text of 32 bits, or none.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[Option<f32>; 2], D::Error> {
    let values = <[Option<Float>; 2]>::deserialize(deserializer)?;
    Ok(values.map(|value| value.map(|Float(value)| value)))
}
