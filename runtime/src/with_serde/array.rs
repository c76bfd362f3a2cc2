//! Arrays of any length. `serde` knows those of up to 32 elements.

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Elements;

/// Serializes each element.
///
/// # Errors
///
/// Passes on errors of the serializer.
pub fn serialize<T: Serialize, S: Serializer, const N: usize>(
    values: &[T; N],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut elements = serializer.serialize_tuple(N)?;
    values.iter().try_for_each(|value| elements.serialize_element(value))?;
    elements.end()
}

/// Deserializes each element.
///
/// # Errors
///
/// Refuses another number of elements.
pub fn deserialize<'de, T: Deserialize<'de> + Copy, D: Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<[T; N], D::Error> {
    let elements = deserializer.deserialize_tuple(N, ElementsVisitor::<T, N>(PhantomData))?;
    elements.whole().ok_or_else(|| D::Error::invalid_length(elements.len(), &ElementsVisitor::<T, N>(PhantomData)))
}

impl<T: Serialize, const N: usize> Serialize for Elements<T, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(&**self)
    }
}

impl<'de, T: Deserialize<'de> + Copy, const N: usize> Deserialize<'de> for Elements<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(ElementsVisitor(PhantomData))
    }
}

struct ElementsVisitor<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de> + Copy, const N: usize> Visitor<'de> for ElementsVisitor<T, N> {
    type Value = Elements<T, N>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "1 to {N} elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Elements<T, N>, A::Error> {
        let first = sequence.next_element()?.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let (mut values, mut length) = ([first; N], 1);
        for value in values.iter_mut().skip(1) {
            let Some(next) = sequence.next_element()? else { break };
            (*value, length) = (next, length + 1);
        }
        if length == N && sequence.next_element::<T>()?.is_some() {
            return Err(A::Error::invalid_length(N + 1, &self));
        }
        Ok(Elements::from_fn(length, |index| values.get(index).copied().unwrap_or(first)))
    }
}
