//! The JSON Schema of the language, for editors. It is made from the structs that a spec is read
//! into.

mod values;
mod whole;

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

use crate::read::syntax::ast::{
    ByModel, DescribedValue, Elements, Field, Map, Means, NamedValue, Names, Numbers, PartData, SignalPath, Spec,
    States, Words,
};

/// Returns the schema as indented text that ends in a line feed.
pub fn schema() -> String {
    let settings = SchemaSettings::draft07().with_transform(as_written);
    let mut schema = settings.into_generator().into_root_schema_for::<Spec>().to_value();
    values::restrict(&mut schema);
    whole::demand_keys(&mut schema);
    format!("{schema:#}\n")
}

/// Describes what a spec file holds, not what Rust makes of it.
fn as_written(schema: &mut Schema) {
    transform_subschemas(&mut as_written, schema);
    schema.remove("default");
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.replace('\n', " ");
        // Editors would show the backquotes of a `description`.
        let text = text.clone();
        schema.insert("markdownDescription".to_owned(), text.into());
    }
    for words in ["type", "anyOf"] {
        if let Some(kinds) = schema.get_mut(words) {
            take_out_null(kinds);
        }
    }
    // Editors show a description beside `anyOf`, but not one beside `allOf`.
    if let Some(only) = schema.remove("allOf") {
        schema.insert("anyOf".to_owned(), only);
    }
    if let Some(kind) = schema.get_mut("type").filter(|kind| *kind == "string") {
        *kind = json!(["string", "number"]);
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

/// Returns the schema of the identifier: fields by name, and the places of bits without a name.
pub(crate) fn identifier(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": "object",
        "properties": {
            "ones": bits("Bits that must be 1, from the most to the least significant: `6..1`; none if absent."),
            "zeros": bits("Bits that must be 0, from the most to the least significant: `25`; none if absent."),
        },
        "additionalProperties": generator.subschema_for::<Field>(),
    })
}

fn bits(description: &str) -> Schema {
    let mut place = json_schema!({ "description": description, "type": "string" });
    values::PLACE.demand(place.ensure_object());
    place
}

impl JsonSchema for Words {
    fn schema_name() -> Cow<'static, str> {
        "Words".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        String::json_schema(generator)
    }
}

impl JsonSchema for Numbers {
    fn schema_name() -> Cow<'static, str> {
        "Numbers".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Names::json_schema(generator)
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

impl JsonSchema for Means {
    fn schema_name() -> Cow<'static, str> {
        "Means".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let value = generator.subschema_for::<String>();
        let list = generator.subschema_for::<Vec<Means>>();
        let signals = generator.subschema_for::<Map<Means>>();
        json_schema!({
            "description": "One value, a list of status bits or elements, or a value for each signal.",
            "anyOf": [value, list, signals],
        })
    }
}

impl JsonSchema for NamedValue {
    fn schema_name() -> Cow<'static, str> {
        "NamedValue".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (name, described) = (generator.subschema_for::<String>(), generator.subschema_for::<DescribedValue>());
        json_schema!({ "anyOf": [name, described] })
    }
}

impl JsonSchema for ByModel {
    fn schema_name() -> Cow<'static, str> {
        "ByModel".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (number, each) = (generator.subschema_for::<String>(), generator.subschema_for::<Map<String>>());
        json_schema!({ "anyOf": [number, each] })
    }
}

impl JsonSchema for PartData {
    fn schema_name() -> Cow<'static, str> {
        "PartData".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (place, elements) = (generator.subschema_for::<String>(), generator.subschema_for::<Elements>());
        json_schema!({ "anyOf": [place, elements] })
    }
}

impl JsonSchema for SignalPath {
    fn schema_name() -> Cow<'static, str> {
        "SignalPath".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (path, states) = (generator.subschema_for::<String>(), generator.subschema_for::<States>());
        json_schema!({ "anyOf": [path, states] })
    }
}
