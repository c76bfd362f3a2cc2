//! A spec as it is written: every leaf is still its text.

use std::fmt;

use indexmap::IndexMap;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// Names to entries, in the order of the file.
pub type Map<V> = IndexMap<String, V>;

/// `{field: what it must be}`: a number, a range or the name of an address type.
pub type Pattern = Map<String>;

/// A whole spec file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spec {
    pub canspec: String,
    pub protocol: String,
    pub title: String,
    pub document: Document,
    pub length: String,
    #[serde(default)]
    pub bit_rates: Vec<String>,
    pub identifier: Map<IdentifierEntry>,
    #[serde(default)]
    pub header: Map<Field>,
    #[serde(default)]
    pub types: Map<Field>,
    #[serde(default)]
    pub addressing: Map<Mode>,
    pub access: Map<Access>,
    #[serde(default)]
    pub foreign: Map<Foreign>,
    #[serde(default)]
    pub messages: Map<Message>,
    #[serde(default)]
    pub models: Map<DeviceModel>,
    #[serde(default)]
    pub timing: Map<Timing>,
    #[serde(default)]
    pub procedures: Map<Procedure>,
    #[serde(default)]
    pub examples: Map<Sequence>,
    #[serde(default)]
    pub errata: Map<Erratum>,
}

/// The vendor document that the spec follows.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    pub title: String,
    pub version: String,
    pub date: Option<String>,
    pub file: Option<String>,
}

/// One entry of `identifier`: a named field, or the place of unnamed `ones` or `zeros`.
#[derive(Clone, Debug)]
pub enum IdentifierEntry {
    Place(String),
    Field(Box<Field>),
}

/// A named bit range with a meaning: in the identifier, the header, a message, a word, or a type to take keys from.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Field {
    pub bytes: Option<String>,
    pub bits: Option<String>,
    #[serde(rename = "type", default)]
    pub types: Names,
    #[serde(rename = "as")]
    pub format_of_number: Option<String>,
    pub scale: Option<String>,
    pub offset: Option<String>,
    pub unit: Option<String>,
    pub range: Option<String>,
    #[serde(default)]
    pub values: Map<String>,
    #[serde(default)]
    pub fields: Map<Field>,
    #[serde(default)]
    pub status: Map<StatusBit>,
    pub format: Option<String>,
    #[serde(rename = "const")]
    pub constant: Option<String>,
    pub send: Option<String>,
    pub normal: Option<String>,
    pub default: Option<String>,
    pub outside: Option<String>,
    #[serde(rename = "in", default)]
    pub kinds: Vec<String>,
    #[serde(default)]
    pub examples: Vec<ValueExample>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// One bit of a status word.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatusBit {
    pub bit: String,
    pub severity: Option<String>,
    pub set_when: Option<String>,
    pub clear_when: Option<String>,
    pub effect: Option<String>,
    pub led: Option<String>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// Bytes of a type and the value they mean.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ValueExample {
    pub bytes: String,
    pub means: String,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// An addressing mode: the request's addresses, and the reply's by who answers.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    pub request: Option<Pattern>,
    pub one: Option<Pattern>,
    pub each: Option<Pattern>,
    pub coordinator: Option<Pattern>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// How a message travels.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Access {
    pub request: Option<Pattern>,
    pub reply: Option<Pattern>,
    pub report: Option<Pattern>,
    #[serde(rename = "in", default)]
    pub kinds: Vec<String>,
    #[serde(default)]
    pub answers: Map<String>,
    pub every: Option<String>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// Identifiers that belong to somebody else on the bus.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Foreign {
    #[serde(rename = "match")]
    pub pattern: Pattern,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// A message: what chooses it, how it travels, what it carries.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Message {
    #[serde(rename = "match", default)]
    pub pattern: Pattern,
    pub access: Vec<String>,
    #[serde(default)]
    pub answers: Map<String>,
    pub length: Option<String>,
    pub every: Option<String>,
    #[serde(default)]
    pub fields: Map<Field>,
    pub value: Option<Field>,
    #[serde(default)]
    pub examples: Vec<Example>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// One frame of the document and what it means.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Example {
    pub request: Option<String>,
    pub reply: Option<String>,
    pub report: Option<String>,
    pub message: Option<String>,
    pub means: Option<Means>,
    #[serde(default)]
    pub notes: Vec<String>,
    pub fails: Option<String>,
    pub origin: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// What an example means: one value, the set bits of a status word, or a value for each signal.
#[derive(Clone, Debug)]
pub enum Means {
    Value(String),
    Bits(Vec<String>),
    Signals(Map<Means>),
}

/// A device model and what differs with it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceModel {
    pub title: Option<String>,
    #[serde(default)]
    pub items: Vec<String>,
    pub max_parallel: Option<String>,
    #[serde(default)]
    pub bit_rates: Vec<String>,
    #[serde(default)]
    pub facts: Map<String>,
    #[serde(default)]
    pub types: Map<Field>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// A time that the document states.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    pub time: String,
    pub minimum: Option<String>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// Steps in order.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Procedure {
    pub steps: Vec<String>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// Example frames in the order in which the document shows them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sequence {
    pub frames: Vec<Example>,
    pub title: Option<String>,
    pub note: Option<String>,
    pub section: Option<String>,
    #[serde(default)]
    pub erratum: Names,
}

/// Where the spec departs from the document.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Erratum {
    pub kind: String,
    pub prints: String,
    pub uses: String,
    pub because: String,
    pub section: Option<String>,
}

/// One name, or a list of names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names(pub Vec<String>);

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamesVisitor;
        impl<'de> Visitor<'de> for NamesVisitor {
            type Value = Names;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a name or a list of names")
            }

            fn visit_str<E>(self, name: &str) -> Result<Names, E> {
                Ok(Names(vec![name.to_owned()]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Names, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Names)
            }
        }
        deserializer.deserialize_any(NamesVisitor)
    }
}

impl<'de> Deserialize<'de> for IdentifierEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EntryVisitor;
        impl<'de> Visitor<'de> for EntryVisitor {
            type Value = IdentifierEntry;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a field, or a place such as `6..1` after `ones` or `zeros`")
            }

            fn visit_str<E>(self, place: &str) -> Result<IdentifierEntry, E> {
                Ok(IdentifierEntry::Place(place.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<IdentifierEntry, A::Error> {
                Field::deserialize(MapAccessDeserializer::new(map)).map(|field| IdentifierEntry::Field(Box::new(field)))
            }
        }
        deserializer.deserialize_any(EntryVisitor)
    }
}

impl<'de> Deserialize<'de> for Means {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct MeansVisitor;
        impl<'de> Visitor<'de> for MeansVisitor {
            type Value = Means;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a value, a list of status bits, or a value for each signal")
            }

            fn visit_str<E>(self, value: &str) -> Result<Means, E> {
                Ok(Means::Value(value.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Means, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Means::Bits)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Means, A::Error> {
                Map::deserialize(MapAccessDeserializer::new(map)).map(Means::Signals)
            }
        }
        deserializer.deserialize_any(MeansVisitor)
    }
}
