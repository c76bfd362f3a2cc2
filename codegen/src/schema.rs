//! The JSON Schema of the language, which editors read; made of the structs that a spec is read into.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

use crate::model::Unit;
use crate::syntax::ast::{Field, IdentifierEntry, Map, Means, Names, Spec};

/// Returns the schema as indented text that ends in a line feed.
pub fn schema() -> String {
    let settings = SchemaSettings::draft07().with_transform(as_written);
    let schema = settings.into_generator().into_root_schema_for::<Spec>();
    format!("{:#}\n", schema.to_value())
}

/// Says what a spec file holds, rather than what Rust makes of it.
fn as_written(schema: &mut Schema) {
    transform_subschemas(&mut as_written, schema);
    schema.remove("default");
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.replace('\n', " ");
    }
    for words in ["type", "anyOf"] {
        if let Some(kinds) = schema.get_mut(words) {
            take_out_null(kinds);
        }
    }
    if let Some(kind) = schema.get_mut("type").filter(|kind| *kind == "string") {
        *kind = json!(["string", "number"]);
    }
    if let Some(unit) =
        schema.get_mut("properties").and_then(|keys| keys.get_mut("unit")).and_then(Value::as_object_mut)
    {
        unit.insert("enum".to_owned(), Unit::ALL.iter().map(|unit| unit.symbol).collect());
    }
}

/// Takes out the kind that stands for an absent key, and the list if one kind is left.
fn take_out_null(kinds: &mut Value) {
    let Some(list) = kinds.as_array_mut() else { return };
    list.retain(|kind| *kind != "null" && *kind != json!({"type": "null"}));
    if let ([Value::String(_)], Some(only)) = (list.as_slice(), list.first().cloned()) {
        *kinds = only;
    }
}

impl JsonSchema for Names {
    fn schema_name() -> Cow<'static, str> {
        "Names".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (name, list) = (generator.subschema_for::<String>(), generator.subschema_for::<Vec<String>>());
        json_schema!({ "anyOf": [name, list] })
    }
}

impl JsonSchema for IdentifierEntry {
    fn schema_name() -> Cow<'static, str> {
        "IdentifierEntry".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (place, field) = (generator.subschema_for::<String>(), generator.subschema_for::<Field>());
        json_schema!({ "description": "A named field, or the place of unnamed `ones` or `zeros`.", "anyOf": [field, place] })
    }
}

impl JsonSchema for Means {
    fn schema_name() -> Cow<'static, str> {
        "Means".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let value = generator.subschema_for::<String>();
        let bits = generator.subschema_for::<Vec<String>>();
        let signals = generator.subschema_for::<Map<Means>>();
        json_schema!({
            "description": "One value, the set bits of a status word, or a value for each signal.",
            "anyOf": [value, bits, signals],
        })
    }
}
