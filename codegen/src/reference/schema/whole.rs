//! Demands keys of a spec that takes nothing over. One that is based on another spec says only what
//! it changes.

use std::collections::HashSet;

use serde_json::{Map, Value, json};

/// What references to structs begin with.
const DEFINITIONS: &str = "#/definitions/";

/// Keys that every spec has.
const ALWAYS: [&str; 3] = ["canspec", "protocol", "title"];

/// Moves the demands for keys to where no `based_on` stands.
pub fn demand_keys(schema: &mut Value) {
    let (mut demanded, items) = (Map::new(), items(schema));
    let definitions = schema["definitions"].as_object_mut().into_iter().flatten();
    for (name, definition) in definitions.filter(|(name, _)| !items.contains(*name)) {
        if let Some(keys) = definition.as_object_mut().and_then(|definition| definition.remove("required")) {
            demanded.insert(name.clone(), keys);
        }
    }
    let mut whole = Demands { schema, demanded: &demanded, around: Vec::new() }.inside(schema);
    whole.insert("required".to_owned(), schema["required"].take());
    schema["required"] = json!(ALWAYS);
    schema["if"] = json!({ "required": ["based_on"] });
    // Without a `then`, some editors take the `if` for a demand.
    schema["then"] = json!({});
    schema["else"] = whole.into();
}

/// Returns the structs that are items of lists. A list is never joined with another one.
fn items(schema: &Value) -> HashSet<String> {
    let kind = &schema["type"];
    let is_list = kind == "array" || kind.as_array().is_some_and(|kinds| kinds.iter().any(|kind| kind == "array"));
    let item = is_list.then(|| &schema["items"]);
    let forms =
        item.into_iter().flat_map(|item| item["anyOf"].as_array().map_or(std::slice::from_ref(item), Vec::as_slice));
    let own = forms.filter_map(|form| form["$ref"].as_str()?.strip_prefix(DEFINITIONS).map(str::to_owned));
    let inside = schema.as_object().into_iter().flat_map(Map::values).chain(schema.as_array().into_iter().flatten());
    own.chain(inside.flat_map(items)).collect()
}

struct Demands<'a> {
    schema: &'a Value,
    /// The keys that each struct demands.
    demanded: &'a Map<String, Value>,
    /// The structs around a value. One that holds itself is described once.
    around: Vec<&'a str>,
}

impl<'a> Demands<'a> {
    /// Returns what the keys of a map demand.
    fn inside(&mut self, map: &'a Value) -> Map<String, Value> {
        let mut found = Map::new();
        let keys = map["properties"].as_object().into_iter().flatten();
        let mut keys: Map<_, _> = keys.filter_map(|(key, value)| Some((key.clone(), self.of(value)?))).collect();
        for demand in keys.values_mut() {
            // An editor offers the key already.
            demand["doNotSuggest"] = json!(true);
        }
        if !keys.is_empty() {
            found.insert("properties".to_owned(), keys.into());
        }
        if let Some(entries) = map.get("additionalProperties").and_then(|entries| self.of(entries)) {
            found.insert("additionalProperties".to_owned(), entries);
        }
        found
    }

    /// Returns what a value demands, if it demands anything.
    fn of(&mut self, value: &'a Value) -> Option<Value> {
        let value = value["anyOf"].as_array().filter(|kinds| kinds.len() == 1).map_or(value, |kinds| &kinds[0]);
        let found = match value["$ref"].as_str().and_then(|place| place.strip_prefix(DEFINITIONS)) {
            None => self.inside(value),
            Some(name) if self.around.contains(&name) => return None,
            Some(name) => {
                self.around.push(name);
                let mut found = self.inside(&self.schema["definitions"][name]);
                self.around.pop();
                found.extend(self.demanded.get(name).map(|keys| ("required".to_owned(), keys.clone())));
                found
            }
        };
        (!found.is_empty()).then(|| found.into())
    }
}
