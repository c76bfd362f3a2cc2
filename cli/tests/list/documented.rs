//! Each key of the JSON has a row in the documentation.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{canspec, object, specs};

#[test]
fn each_key_of_the_object_is_documented() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/formats.md");
    let page = fs::read_to_string(page).expect("it is there");
    let section = page.split("\n## ").find(|section| section.starts_with("`list --format json`"));
    let section = section.expect("it has the section");
    let rows: Vec<_> = section.lines().filter(|line| line.starts_with('|')).collect();
    let mut keys = BTreeSet::new();
    for spec in specs() {
        collect(&object(&spec), &mut keys);
    }
    collect(&serde_json::from_str(&canspec(&["list", "--format", "json"])).expect("it is a list"), &mut keys);
    assert!(keys.len() > 90, "{keys:?}");
    let missing: Vec<_> = keys.iter().filter(|key| !rows.iter().any(|row| row.contains(&format!("`{key}`")))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

fn collect(value: &Value, keys: &mut BTreeSet<String>) {
    match value {
        Value::Array(items) => items.iter().for_each(|item| collect(item, keys)),
        Value::Object(members) => {
            keys.extend(members.keys().cloned());
            members.values().for_each(|member| collect(member, keys));
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}
