//! `serde` for words and floats, behind the feature `serde`. Generated code calls it. Formats for
//! people get the values as the `canspec` command writes them. Other formats get them as they stand
//! in the frame.
//!
//! | value | in formats for people |
//! |---|---|
//! | named value | its name in the spec, or its raw number if it has none |
//! | status word | `{"set": NAMES, "unknown": MASK}`: the set bits that have a name, and those that have none |
//! | packed value | its text, or its raw number if that text would not give the same value |
//! | [`Text`](crate::Text) | the text, or its bytes if they are no ASCII characters |
//! | [`Bytes`](crate::Bytes) | two hexadecimal digits a byte, such as `"0A1B2C"` |
//! | [`Bcd`](crate::Bcd) | the number, or its bits such as `"0x2A"` if a digit is above 9 |
//! | `f32` of the frame | the number, or its bits such as `"0x7FC00000"` if it is not finite |
//! | [`Frame`](crate::Frame) | as in a log: `"029C03F0#000B71B000003A98"` |
//!
//! A format for people must be self-describing, as JSON is.

pub mod array;
mod bcd;
mod bytes;
pub mod float;
mod frame;
mod text;

use core::fmt;
use core::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Error as _, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::plumbing::{Legend, Raw, Word};
use crate::{Meaning, status};

/// Serializes a named value, a status word or a packed value.
///
/// # Errors
///
/// Refuses a packed value whose parts do not fit their places, and passes on errors of the
/// serializer.
pub fn serialize<W: Word, S: Serializer>(word: W, serializer: S) -> Result<S::Ok, S::Error> {
    if !word.is_whole() {
        return Err(S::Error::custom("a part of the packed value does not fit its place"));
    }
    match word.meaning() {
        Meaning::Name(name) if serializer.is_human_readable() => serializer.serialize_str(name),
        Meaning::Packed(text) if serializer.is_human_readable() => serializer.collect_str(&text),
        Meaning::Status(raw, bits) if serializer.is_human_readable() => {
            let unknown = status::unknown(raw, bits);
            StatusParts { set: Set::<W>(raw & !unknown, PhantomData), unknown }.serialize(serializer)
        }
        Meaning::Number(_)
        | Meaning::Name(_)
        | Meaning::Text(_)
        | Meaning::Bytes(_)
        | Meaning::Packed(_)
        | Meaning::Status(..)
        | Meaning::None => serializer.serialize_u64(word.to_bits()),
    }
}

/// Deserializes a named value, a status word or a packed value.
///
/// # Errors
///
/// Refuses names and texts that the word does not have, and values that its bits cannot hold.
pub fn deserialize<'de, W: Word, D: Deserializer<'de>>(deserializer: D) -> Result<W, D::Error> {
    if deserializer.is_human_readable() {
        deserializer.deserialize_any(WordVisitor(PhantomData))
    } else {
        deserializer.deserialize_u64(WordVisitor(PhantomData))
    }
}

/// A status word as people read it.
#[derive(Serialize, Deserialize)]
#[serde(rename = "status word", deny_unknown_fields, bound = "W: Word")]
struct StatusParts<W> {
    set: Set<W>,
    #[serde(default)]
    unknown: u64,
}

/// Bits that have a name.
struct Set<W>(u64, PhantomData<W>);

impl<W: Word> Serialize for Set<W> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Legend::Bits(bits) = W::LEGEND else { return serializer.collect_seq([""; 0]) };
        serializer.collect_seq(status::set_bits(self.0, bits).map(|bit| bit.name))
    }
}

impl<'de, W: Word> Deserialize<'de> for Set<W> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(SetVisitor(PhantomData))
    }
}

struct SetVisitor<W>(PhantomData<W>);

impl<'de, W: Word> Visitor<'de> for SetVisitor<W> {
    type Value = Set<W>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the names of set bits")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut names: A) -> Result<Set<W>, A::Error> {
        let mut set = 0;
        while let Some(Bit::<W>(mask, _)) = names.next_element()? {
            set |= mask;
        }
        Ok(Set(set, PhantomData))
    }
}

/// The bit of a name.
struct Bit<W>(u64, PhantomData<W>);

impl<'de, W: Word> Deserialize<'de> for Bit<W> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_str(BitVisitor(PhantomData))
    }
}

struct BitVisitor<W>(PhantomData<W>);

impl<W: Word> Visitor<'_> for BitVisitor<W> {
    type Value = Bit<W>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the name of a bit")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Bit<W>, E> {
        let bits = if let Legend::Bits(bits) = W::LEGEND { bits } else { &[] };
        let bit = bits.iter().find(|bit| bit.name == name);
        bit.map(|bit| Bit(bit.mask(), PhantomData)).ok_or_else(|| E::invalid_value(Unexpected::Str(name), &self))
    }
}

struct WordVisitor<W>(PhantomData<W>);

impl<'de, W: Word> Visitor<'de> for WordVisitor<W> {
    type Value = W;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match W::LEGEND {
            Legend::Names(_) => "the name of a value, or its raw number",
            Legend::Bits(_) => "`set` and `unknown` bits, or the raw number",
            Legend::Text(..) => "the text of a packed value, or its raw number",
        })
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<W, E> {
        let meaning = if let Legend::Names(_) = W::LEGEND { Meaning::Name(text) } else { Meaning::Text(text) };
        W::from_meaning(meaning).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }

    fn visit_u64<E: serde::de::Error>(self, raw: u64) -> Result<W, E> {
        let word = W::from_bits(raw);
        if word.to_bits() == raw { Ok(word) } else { Err(E::invalid_value(Unexpected::Unsigned(raw), &self)) }
    }

    fn visit_i64<E: serde::de::Error>(self, raw: i64) -> Result<W, E> {
        match u64::try_from(raw) {
            Ok(raw) => self.visit_u64(raw),
            Err(_) => Err(E::invalid_value(Unexpected::Signed(raw), &self)),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<W, A::Error> {
        if let Legend::Bits(_) = W::LEGEND {
            let StatusParts { set: Set::<W>(set, _), unknown } =
                Deserialize::deserialize(MapAccessDeserializer::new(map))?;
            self.visit_u64(set | unknown)
        } else {
            Err(A::Error::invalid_type(Unexpected::Map, &self))
        }
    }
}
