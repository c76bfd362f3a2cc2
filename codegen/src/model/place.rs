//! How a place in the data bytes is stored: whether its word is big endian, and its highest and lowest bit.

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

type Stored = (bool, u8, u8);

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
pub fn serialize<S: Serializer>(place: &Place, serializer: S) -> Result<S::Ok, S::Error> {
    let (is_big, bits) = (place.order() == ByteOrder::Big, place.bits_of_payload());
    let stored: Stored = (is_big, bits.shift() + bits.width() - 1, bits.shift());
    stored.serialize(serializer)
}

pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Place, D::Error> {
    let (is_big, high, low) = Stored::deserialize(deserializer)?;
    let word = if is_big { Place::bytes(0, 7) } else { Place::bytes(7, 0) };
    if low <= high && high < 64 { Ok(word.bits(high, low)) } else { Err(D::Error::custom("no such bits")) }
}
