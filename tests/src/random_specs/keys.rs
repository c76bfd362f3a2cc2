//! Which keys of the language specs set, and where: the places come from the schema, the keys of fields from the reference.

use std::collections::{BTreeMap, BTreeSet};

use canspec_codegen::schema::schema;
use canspec_codegen::syntax::ast::Key;
use serde_json::Value as Schema;
use serde_yaml::{Mapping, Value};

const REFERENCE: &str = include_str!("../../../docs/language/reference.md");

/// Places of fields in a message: there the reference's letter M counts.
const OF_MESSAGES: [&str; 2] = ["messages.*.fields.*", "messages.*.value"];

/// Keys of a spec that is based on another one. `tests/tests/families.rs` makes such specs.
const OF_FAMILIES: [&str; 3] = ["based_on", "replaces", "removes"];

/// How often each key is set at each place.
#[derive(Clone, Debug)]
pub struct Keys {
    schema: Schema,
    counts: BTreeMap<(String, String), usize>,
    /// Keys that count at a place, whether a spec sets them or not.
    wanted: BTreeSet<(String, String)>,
}

impl Default for Keys {
    fn default() -> Self {
        let schema: Schema = serde_json::from_str(&schema()).expect("the schema is JSON");
        let mut keys = Self { schema, counts: BTreeMap::new(), wanted: BTreeSet::new() };
        keys.want(&keys.schema.clone(), "");
        keys.want_fields();
        keys
    }
}

impl Keys {
    /// Counts the keys of a spec.
    pub fn add(&mut self, spec: &Value) {
        let addresses = address_types(spec);
        let schema = self.schema.clone();
        self.count(spec, &schema, "", &addresses);
    }

    /// Returns each key that counts at a place, and how often it is set there.
    pub fn rows(&self) -> impl Iterator<Item = (&str, &str, usize)> {
        self.wanted
            .iter()
            .map(|known| (known.0.as_str(), known.1.as_str(), self.counts.get(known).copied().unwrap_or(0)))
    }

    /// Returns a table of all that, and of keys of fields inside fields.
    pub fn table(&self) -> String {
        let mut rows: BTreeMap<_, _> = self.counts.clone();
        self.wanted.iter().for_each(|known| _ = rows.entry(known.clone()).or_insert(0));
        let line = |((place, key), count): (&(String, String), &usize)| format!("| {place} | `{key}` | {count} |\n");
        let lines: String = rows.iter().map(line).collect();
        format!("| place | key | specs set it |\n|---|---|---:|\n{lines}")
    }

    /// Wants each key of each struct of the schema, those of fields aside.
    fn want(&mut self, schema: &Schema, place: &str) {
        let schema = resolved(&self.schema, schema).clone();
        if is_field(&schema) {
            return;
        }
        let keys = schema["properties"].as_object().into_iter().flatten();
        for (key, value) in keys.filter(|(key, _)| !OF_FAMILIES.contains(&key.as_str())) {
            self.wanted.insert((place.to_owned(), key.clone()));
            self.want(value, &joined(place, key));
        }
        for (inner, step) in [("additionalProperties", "*"), ("items", "[]")] {
            if schema[inner].is_object() {
                self.want(&schema[inner], &joined(place, step));
            }
        }
    }

    /// Wants the keys of fields wherever the reference says that they are used, with the keys
    /// inside them. A type can have all keys of fields.
    fn want_fields(&mut self) {
        for key in Key::ALL.iter().copied() {
            let inside = self.schema["definitions"]["Field"]["properties"][key.name()].clone();
            for place in used_in(key).into_iter().flat_map(places) {
                self.wanted.insert((place.to_owned(), key.name().to_owned()));
                self.want(&inside, &joined(place, key.name()));
            }
        }
    }

    fn count(&mut self, value: &Value, schema: &Schema, place: &str, addresses: &BTreeSet<String>) {
        let schema = resolved(&self.schema, schema).clone();
        match value {
            Value::Mapping(entries) => {
                for (key, value) in names(entries) {
                    let (inner, step) = match (&schema["properties"][key], place) {
                        (Schema::Null, "types") if addresses.contains(key) => (None, "address type"),
                        (Schema::Null, _) => (None, "*"),
                        (known, _) => (Some(known), key),
                    };
                    if inner.is_some() {
                        *self.counts.entry((place.to_owned(), key.to_owned())).or_default() += 1;
                    }
                    let inner = inner.unwrap_or(&schema["additionalProperties"]);
                    self.count(value, inner, &around(joined(place, step)), addresses);
                }
            }
            Value::Sequence(items) => {
                for item in items {
                    self.count(item, &schema["items"], &joined(place, "[]"), addresses);
                }
            }
            Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) | Value::Tagged(_) => {}
        }
    }
}

/// Takes a field inside a field for the outer one: the reference knows no other place.
fn around(place: String) -> String {
    let outer = place.strip_suffix(".fields.*").filter(|outer| *outer != "messages.*");
    outer.map(str::to_owned).unwrap_or(place)
}

/// Returns the places that a letter of the reference stands for.
fn places(letter: char) -> Vec<&'static str> {
    match letter {
        'I' => vec!["identifier.*", "types.*"],
        'H' => vec!["header.*", "types.*"],
        'M' => [&OF_MESSAGES[..], &["types.*"]].concat(),
        'A' => vec!["types.address type"],
        'T' => vec!["types.*", "types.address type"],
        _ => panic!("the reference has no place {letter}"),
    }
}

/// Returns the letters in the column "used in" of the reference.
fn used_in(key: Key) -> Vec<char> {
    let name = format!("`{}`", key.name());
    let (_, text) = REFERENCE.split_once("\n## Fields").expect("the reference has fields");
    let rows = text.lines().filter_map(|line| line.strip_prefix('|')).map(|line| line.split('|').collect::<Vec<_>>());
    let row = rows.into_iter().find(|cells| cells[0].contains(&name));
    let row = row.unwrap_or_else(|| panic!("the reference has no {name}"));
    match row[6].trim() {
        "entries of `types`" => vec!['T'],
        letters => letters.chars().filter(|letter| *letter != ' ').collect(),
    }
}

fn joined(place: &str, step: &str) -> String {
    if place.is_empty() { step.to_owned() } else { format!("{place}.{step}") }
}

fn names(entries: &Mapping) -> impl Iterator<Item = (&str, &Value)> {
    entries.iter().filter_map(|(key, value)| Some((key.as_str()?, value)))
}

/// Tells whether a schema is that of a field.
fn is_field(schema: &Schema) -> bool {
    schema["properties"]["continues"].is_object()
}

/// Follows a reference of a schema.
fn resolved<'s>(root: &'s Schema, schema: &'s Schema) -> &'s Schema {
    let only = schema["anyOf"].as_array().filter(|any| any.len() == 1).map(|any| &any[0]);
    let reference = only.unwrap_or(schema)["$ref"].as_str().and_then(|path| path.strip_prefix('#'));
    reference.and_then(|path| root.pointer(path)).unwrap_or(schema)
}

/// Returns the types that addressing names.
fn address_types(spec: &Value) -> BTreeSet<String> {
    let modes = spec["addressing"].as_mapping().into_iter().flat_map(Mapping::values);
    let patterns = modes.filter_map(Value::as_mapping).flat_map(Mapping::values).filter_map(Value::as_mapping);
    patterns.flat_map(Mapping::values).filter_map(Value::as_str).map(str::to_owned).collect()
}
