//! Numbers in decimal digits.

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Bcd;
use crate::plumbing::{Integer, Raw};

impl<R: Integer> Serialize for Bcd<R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.number() {
            _ if !serializer.is_human_readable() => serializer.serialize_u64(self.to_bits()),
            Some(number) => serializer.serialize_u64(number),
            None => serializer.collect_str(self),
        }
    }
}

impl<'de, R: Integer> Deserialize<'de> for Bcd<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            return deserializer.deserialize_any(BcdVisitor(PhantomData));
        }
        let bits = u64::deserialize(deserializer)?;
        of_bits(bits).ok_or_else(|| D::Error::invalid_value(Unexpected::Unsigned(bits), &BcdVisitor::<R>(PhantomData)))
    }
}

/// Returns the value of bits, unless there are too many.
fn of_bits<R: Integer>(bits: u64) -> Option<Bcd<R>> {
    let value = Bcd::from_bits(bits);
    (value.to_bits() == bits).then_some(value)
}

struct BcdVisitor<R>(PhantomData<R>);

impl<R: Integer> Visitor<'_> for BcdVisitor<R> {
    type Value = Bcd<R>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a number that fits, or raw bits such as `0x2A`")
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Bcd<R>, E> {
        Bcd::new(number).ok_or_else(|| E::invalid_value(Unexpected::Unsigned(number), &self))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Bcd<R>, E> {
        let bits = text.strip_prefix("0x").and_then(|digits| u64::from_str_radix(digits, 16).ok());
        bits.and_then(of_bits).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}
