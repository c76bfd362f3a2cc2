//! Reads what can be written in several ways: one name or a list, a place or a field, a value or a
//! map. A number can be one for each model, and a path can have states.

use std::fmt;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};

use super::{
    ByModel, DescribedValue, Elements, Field, IdentifierEntry, Map, Means, NamedValue, Names, Numbers, PartData,
    SignalPath, States, Words,
};

impl<'de> Deserialize<'de> for Words {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        if text.trim().is_empty() {
            return Err(D::Error::invalid_value(Unexpected::Str(&text), &"a text that is not blank"));
        }
        Ok(Self(text))
    }
}

/// Reads one text or a list of texts.
struct OneOrMany(&'static str);

impl<'de> Visitor<'de> for OneOrMany {
    type Value = Vec<String>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "a {0} or a list of {0}s", self.0)
    }

    fn visit_str<E>(self, text: &str) -> Result<Vec<String>, E> {
        Ok(vec![text.to_owned()])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Vec<String>, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(list))
    }
}

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrMany("name")).map(Self)
    }
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrMany("number")).map(Self)
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

impl<'de> Deserialize<'de> for NamedValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ValueVisitor;
        impl<'de> Visitor<'de> for ValueVisitor {
            type Value = NamedValue;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a name, or a map with `name`, `title` and `models`")
            }

            fn visit_str<E>(self, name: &str) -> Result<NamedValue, E> {
                Ok(NamedValue { name: name.to_owned(), title: None, models: Vec::new() })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<NamedValue, A::Error> {
                let value = DescribedValue::deserialize(MapAccessDeserializer::new(map))?;
                let DescribedValue { name, title, models } = value;
                Ok(NamedValue { name, title, models })
            }
        }
        deserializer.deserialize_any(ValueVisitor)
    }
}

impl<'de> Deserialize<'de> for Means {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct MeansVisitor;
        impl<'de> Visitor<'de> for MeansVisitor {
            type Value = Means;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a value, a list of status bits or elements, or a value for each signal")
            }

            fn visit_str<E>(self, value: &str) -> Result<Means, E> {
                Ok(Means::Value(value.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Means, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Means::List)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Means, A::Error> {
                Map::deserialize(MapAccessDeserializer::new(map)).map(Means::Signals)
            }
        }
        deserializer.deserialize_any(MeansVisitor)
    }
}

impl<'de> Deserialize<'de> for ByModel {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ByModelVisitor;
        impl<'de> Visitor<'de> for ByModelVisitor {
            type Value = ByModel;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a number, or a number for each model")
            }

            fn visit_str<E>(self, number: &str) -> Result<ByModel, E> {
                Ok(ByModel::Every(number.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ByModel, A::Error> {
                Map::deserialize(MapAccessDeserializer::new(map)).map(ByModel::Each)
            }
        }
        deserializer.deserialize_any(ByModelVisitor)
    }
}

impl<'de> Deserialize<'de> for PartData {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct DataVisitor;
        impl<'de> Visitor<'de> for DataVisitor {
            type Value = PartData;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a place such as `1..6`, or a map with `bytes` and `repeat`")
            }

            fn visit_str<E>(self, place: &str) -> Result<PartData, E> {
                Ok(PartData::Bytes(place.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<PartData, A::Error> {
                Elements::deserialize(MapAccessDeserializer::new(map)).map(PartData::Elements)
            }
        }
        deserializer.deserialize_any(DataVisitor)
    }
}

impl<'de> Deserialize<'de> for SignalPath {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PathVisitor;
        impl<'de> Visitor<'de> for PathVisitor {
            type Value = SignalPath;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a message and its signal such as `output.voltage`, or a map with `signal`")
            }

            fn visit_str<E>(self, signal: &str) -> Result<SignalPath, E> {
                Ok(SignalPath { signal: signal.to_owned(), states: None, with: Map::new(), is_map: false })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<SignalPath, A::Error> {
                let States { signal, active, inactive, with } = States::deserialize(MapAccessDeserializer::new(map))?;
                let states = (active.is_some() || inactive.is_some()).then_some([inactive, active]);
                Ok(SignalPath { signal, states, with, is_map: true })
            }
        }
        deserializer.deserialize_any(PathVisitor)
    }
}
