//! The specs of the workspace, and the words of their language.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use canspec_codegen::Bases;
use canspec_codegen::schema::schema;
use serde_json::Value;

use crate::specs;

/// Folders with specs, beside those with a folder for each rule.
const FOLDERS: [&str; 6] =
    ["specs", "tests/specs", "tests/specs/features", "tests/specs/devices", "tests/specs/stages", "tests/peers"];

/// The specs of the workspace, right and wrong.
pub static SPECS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let folders = FOLDERS.into_iter().map(str::to_owned).chain(rule_folders());
    let paths = folders.flat_map(|folder| specs(&folder));
    paths.filter_map(|path| fs::read_to_string(path).ok()).collect()
});

/// The right specs, on which others can be based.
pub static BASES: LazyLock<Bases> = LazyLock::new(|| {
    let paths = ["specs", "tests/specs/features"].into_iter().flat_map(specs);
    let named =
        paths.filter_map(|path| Some((path.file_stem()?.to_str()?.to_owned(), fs::read_to_string(&path).ok()?)));
    named.collect()
});

/// The words of the language.
pub static WORDS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let mut words = BTreeSet::new();
    collect(&serde_json::from_str(&schema()).expect("the schema is JSON"), &mut words);
    words.into_iter().collect()
});

/// Returns the specs as inputs.
pub fn seeds() -> Vec<Vec<u8>> {
    SPECS.iter().map(|text| text.clone().into_bytes()).collect()
}

fn rule_folders() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("specs/rules");
    let entries = fs::read_dir(folder).expect("the folder exists").flatten();
    let mut folders: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| path.is_dir()).collect();
    folders.sort();
    folders.iter().map(|folder| folder.to_string_lossy().into_owned()).collect()
}

/// Collects the keys and the words that a schema names.
fn collect(schema: &Value, words: &mut BTreeSet<String>) {
    if let Some(properties) = schema["properties"].as_object() {
        words.extend(properties.keys().cloned());
    }
    if let Some(choices) = schema["enum"].as_array() {
        words.extend(choices.iter().filter_map(Value::as_str).map(str::to_owned));
    }
    match schema {
        Value::Object(entries) => entries.values().for_each(|entry| collect(entry, words)),
        Value::Array(items) => items.iter().for_each(|item| collect(item, words)),
        _ => {}
    }
}
