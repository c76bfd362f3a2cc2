//! Floats that a frame can lack. Not every one is a number.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::float;

/// Serializes a float like [`float::serialize`], and a missing one as none.
///
/// # Errors
///
/// Passes on errors of the serializer.
pub fn serialize<S: Serializer>(value: &Option<f32>, serializer: S) -> Result<S::Ok, S::Error> {
    value.map(Float).serialize(serializer)
}

/// Deserializes a float like [`float::deserialize`], or none.
///
/// # Errors
///
/// Refuses anything but a number, the text of 32 bits, or none.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f32>, D::Error> {
    Option::<Float>::deserialize(deserializer).map(|value| value.map(|Float(value)| value))
}

#[derive(Serialize, Deserialize)]
pub(super) struct Float(#[serde(with = "float")] pub(super) f32);
