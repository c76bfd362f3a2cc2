//! Floats of the frame, alone, in arrays, and where they can be missing. Not every one is a number.

use core::fmt;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::array;
use crate::Elements;

/// A float of the frame, or what consists of such floats.
pub trait Floats: Copy {
    /// Serializes each float as [`serialize`] says.
    ///
    /// # Errors
    ///
    /// Passes on errors of the serializer.
    fn to_serializer<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error>;

    /// Deserializes each float as [`deserialize`] says.
    ///
    /// # Errors
    ///
    /// Refuses another number of floats.
    fn from_deserializer<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>;
}

/// Serializes floats. Formats for people get the double of the same value, or the bits as a text if
/// it is not finite.
///
/// # Errors
///
/// Passes on errors of the serializer.
pub fn serialize<V: Floats, S: Serializer>(value: &V, serializer: S) -> Result<S::Ok, S::Error> {
    value.to_serializer(serializer)
}

/// Deserializes floats.
///
/// # Errors
///
/// Refuses anything but numbers and texts of 32 bits, and another number of them.
pub fn deserialize<'de, V: Floats, D: Deserializer<'de>>(deserializer: D) -> Result<V, D::Error> {
    V::from_deserializer(deserializer)
}

impl Floats for f32 {
    fn to_serializer<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (serializer.is_human_readable(), self.is_finite()) {
            (false, _) => serializer.serialize_f32(*self),
            (true, true) => serializer.serialize_f64((*self).into()),
            (true, false) => serializer.collect_str(&format_args!("0x{:08X}", self.to_bits())),
        }
    }

    fn from_deserializer<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(FloatVisitor)
        } else {
            Self::deserialize(deserializer)
        }
    }
}

impl<V: Floats> Floats for Option<V> {
    fn to_serializer<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.map(Float).serialize(serializer)
    }

    fn from_deserializer<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Option::<Float<V>>::deserialize(deserializer).map(|value| value.map(|Float(value)| value))
    }
}

impl<V: Floats, const N: usize> Floats for [V; N] {
    fn to_serializer<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        array::serialize(&self.map(Float), serializer)
    }

    fn from_deserializer<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        array::deserialize::<Float<V>, D, N>(deserializer).map(|values| values.map(|Float(value)| value))
    }
}

impl<V: Floats, const N: usize> Floats for Elements<V, N> {
    fn to_serializer<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter().copied().map(Float))
    }

    fn from_deserializer<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Elements::<Float<V>, N>::deserialize(deserializer).map(|values| values.map(|Float(value)| value))
    }
}

/// What consists of floats, with the traits of `serde`.
#[derive(Clone, Copy)]
struct Float<V>(V);

impl<V: Floats> Serialize for Float<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.to_serializer(serializer)
    }
}

impl<'de, V: Floats> Deserialize<'de> for Float<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        V::from_deserializer(deserializer).map(Self)
    }
}

struct FloatVisitor;

#[expect(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "the nearest float is what is sent")]
impl Visitor<'_> for FloatVisitor {
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
