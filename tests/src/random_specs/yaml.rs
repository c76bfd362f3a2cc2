//! Maps and lists of a spec, and how they are written: every text in quotes, so that no reader of YAML disagrees.

use serde_yaml::{Mapping, Value};

/// A map of a spec, in the order in which it is written.
#[derive(Clone, Debug, Default)]
pub struct Map(pub Mapping);

impl Map {
    /// Returns a map of some keys.
    pub fn of<V: Into<Value>>(entries: impl IntoIterator<Item = (impl Into<String>, V)>) -> Self {
        let mut map = Self::default();
        entries.into_iter().for_each(|(key, value)| map.put(key, value));
        map
    }

    /// Sets a key.
    pub fn put(&mut self, key: impl Into<String>, value: impl Into<Value>) {
        self.0.insert(Value::String(key.into()), value.into());
    }

    /// Tells whether a key is set.
    pub fn has(&self, key: &str) -> bool {
        self.0.contains_key(key)
    }

    /// Returns the text of a key, or an empty one.
    pub fn text(&self, key: &str) -> String {
        self.0.get(key).and_then(Value::as_str).unwrap_or_default().to_owned()
    }

    /// Returns the maps in the map of a key.
    pub fn maps_in(&mut self, key: &str) -> impl Iterator<Item = &mut Mapping> {
        let inner = self.0.get_mut(key).and_then(Value::as_mapping_mut);
        inner.into_iter().flat_map(|map| map.iter_mut()).filter_map(|(_, value)| value.as_mapping_mut())
    }

    /// Tells whether no key is set.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl From<Map> for Value {
    fn from(map: Map) -> Self {
        Self::Mapping(map.0)
    }
}

/// Returns a list.
pub fn list(items: impl IntoIterator<Item = impl Into<Value>>) -> Value {
    Value::Sequence(items.into_iter().map(Into::into).collect())
}

/// Writes a spec: its maps in lines down to the entries of each key, and what is inside them in flow style.
pub fn written(spec: &Value) -> String {
    let entry = |(key, value): (&Value, &Value)| {
        let name = key.as_str().unwrap_or_default();
        match value {
            Value::Mapping(entries) if !entries.is_empty() => {
                let lines = entries.iter().map(|(key, value)| format!("  {}: {}\n", flow(key), flow(value)));
                format!("{name}:\n{}", lines.collect::<String>())
            }
            _ => format!("{name}: {}\n", flow(value)),
        }
    };
    spec.as_mapping().into_iter().flatten().map(entry).collect()
}

/// Writes a value in one line. JSON is YAML.
fn flow(value: &Value) -> String {
    match value {
        Value::Mapping(entries) => {
            let entries = entries.iter().map(|(key, value)| format!("{}: {}", flow(key), flow(value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
        Value::Sequence(items) => format!("[{}]", items.iter().map(flow).collect::<Vec<_>>().join(", ")),
        Value::String(text) => serde_json::Value::from(text.as_str()).to_string(),
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::Tagged(_) => unreachable!("a spec is made of texts"),
    }
}
