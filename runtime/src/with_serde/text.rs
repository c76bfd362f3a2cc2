//! Texts.

use core::fmt;

use serde::de::{Error, SeqAccess, Unexpected, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Text;

impl<const N: usize, const FILL: u8> Serialize for Text<N, FILL> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.as_str() {
            Some(text) if serializer.is_human_readable() => serializer.serialize_str(text),
            _ => {
                let mut bytes = serializer.serialize_tuple(N)?;
                self.as_bytes().iter().try_for_each(|byte| bytes.serialize_element(byte))?;
                bytes.end()
            }
        }
    }
}

impl<'de, const N: usize, const FILL: u8> Deserialize<'de> for Text<N, FILL> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(TextVisitor)
        } else {
            deserializer.deserialize_tuple(N, TextVisitor)
        }
    }
}

struct TextVisitor<const N: usize, const FILL: u8>;

impl<'de, const N: usize, const FILL: u8> Visitor<'de> for TextVisitor<N, FILL> {
    type Value = Text<N, FILL>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "at most {N} ASCII characters without NUL, or {N} bytes")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Text<N, FILL>, E> {
        Text::new(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut bytes: A) -> Result<Text<N, FILL>, A::Error> {
        let mut text = [0; N];
        for (index, byte) in text.iter_mut().enumerate() {
            *byte = bytes.next_element()?.ok_or_else(|| A::Error::invalid_length(index, &self))?;
        }
        Ok(Text::from_bytes(text))
    }
}
