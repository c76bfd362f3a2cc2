//! The JSON Schema for editors: current, complete, and by an independent validator true of every spec.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use canspec_codegen::number::Rational;
use jsonschema::Validator;
use serde_json::{Map, Value, json};

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// What an editor offers inside a signal, among other keys.
const KEYS_OF_A_SIGNAL: [&str; 10] =
    ["bytes", "bits", "type", "scale", "offset", "unit", "range", "values", "fields", "section"];

#[test]
fn the_shipped_schema_is_current() -> Result {
    let path = folder("../specs").join("canspec.schema.json");
    let schema = canspec_codegen::schema::schema();
    if std::env::var_os("CANSPEC_BLESS").is_some() {
        fs::write(&path, &schema)?;
    }
    assert!(fs::read_to_string(&path)? == schema, "CANSPEC_BLESS=1 writes specs/canspec.schema.json anew");
    Ok(())
}

#[test]
fn every_shipped_spec_names_the_schema_in_its_first_line() -> Result {
    for path in specs(&folder("../specs"))? {
        let text = fs::read_to_string(&path)?;
        assert_eq!(
            text.lines().next(),
            Some("# yaml-language-server: $schema=canspec.schema.json"),
            "{}",
            path.display()
        );
    }
    Ok(())
}

#[test]
fn an_independent_validator_accepts_every_good_spec() -> Result {
    let validator = validator()?;
    let mut count = 0;
    for path in good_specs()? {
        let spec = read(&path)?;
        let complaints: Vec<_> =
            validator.iter_errors(&spec).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert!(complaints.is_empty(), "{}:\n{}", path.display(), complaints.join("\n"));
        count += 1;
    }
    assert!(count > 50, "{count} specs");
    Ok(())
}

#[test]
fn the_validator_refuses_wrong_keys_kinds_words_and_forms_at_their_places() -> Result {
    let validator = validator()?;
    for (rule, places) in [
        ("unknown_key", &["", "/messages/temperature/value"][..]),
        ("missing_key", &["", "/timing/pause"]),
        ("wrong_kind", &["/types/heater", "/messages/temperature/access"]),
        ("name", &["/access/read/in/0"]),
        ("number", &["/identifier/command/bits", "/messages/temperature/value"]),
        ("range", &["/messages/temperature/fields/inside/range"]),
    ] {
        let spec = read(&folder("specs/rules").join(rule).join("bad.yaml"))?;
        let found: Vec<_> = validator.iter_errors(&spec).map(|error| error.instance_path().to_string()).collect();
        for place in places {
            assert!(found.iter().any(|found| found == place), "{rule}: {found:?}");
        }
    }
    Ok(())
}

#[test]
fn the_validator_knows_the_form_of_a_number() -> Result {
    let validator = jsonschema::draft7::new(&schema()?["definitions"]["Field"]["properties"]["scale"])?;
    let mut texts = vec![String::new()];
    let mut numbers = 0;
    for _ in 0..5 {
        texts = texts.iter().flat_map(|text| "10Fx./-".chars().map(move |next| format!("{text}{next}"))).collect();
        for text in &texts {
            // The form of a number does not tell that nothing can be divided by zero.
            let is_number = Rational::parse(text).is_some();
            let may_pass = text.contains("/0");
            let passes = validator.is_valid(&json!(text));
            assert!(passes == is_number || passes && may_pass, "{text}");
            numbers += usize::from(is_number);
        }
    }
    assert!(numbers > 250, "{numbers} numbers");
    Ok(())
}

#[test]
fn every_key_of_the_schema_has_a_description() -> Result {
    let schema = schema()?;
    let definitions = definitions(&schema);
    assert!(definitions.len() > 15, "{} definitions", definitions.len());
    for (name, definition) in definitions {
        assert!(is_described(definition), "{name}");
        for (key, property) in properties(definition) {
            assert!(is_described(property), "{name}.{key}");
        }
    }
    Ok(())
}

#[test]
fn nothing_in_the_schema_may_be_null_and_no_key_is_open() -> Result {
    let schema = schema()?;
    assert!(!schema.to_string().contains("\"null\""));
    for (name, definition) in definitions(&schema) {
        let is_struct = definition.get("properties").is_some();
        assert!(!is_struct || definition["additionalProperties"] == json!(false), "{name}");
    }
    Ok(())
}

#[test]
fn a_signal_is_offered_its_keys() -> Result {
    let schema = schema()?;
    let keys = properties(&schema["definitions"]["Field"]);
    for key in KEYS_OF_A_SIGNAL {
        assert!(keys.iter().any(|(known, _)| known.as_str() == key), "{key}");
    }
    Ok(())
}

fn schema() -> Result<Value> {
    Ok(serde_json::from_str(&canspec_codegen::schema::schema())?)
}

fn validator() -> Result<Validator> {
    Ok(jsonschema::draft7::new(&schema()?)?)
}

/// Returns the whole spec and everything that it is made of.
fn definitions(schema: &Value) -> Vec<(&str, &Value)> {
    let parts = schema["definitions"].as_object().into_iter().flatten();
    std::iter::once(("Spec", schema)).chain(parts.map(|(name, part)| (name.as_str(), part))).collect()
}

fn properties(definition: &Value) -> Vec<(&String, &Value)> {
    definition["properties"].as_object().into_iter().flatten().collect()
}

fn is_described(item: &Value) -> bool {
    item["description"].as_str().is_some_and(|text| text.len() > 10)
}

/// Returns the specs that ship, and those of the tests that the compiler accepts.
fn good_specs() -> Result<Vec<PathBuf>> {
    let mut found = specs(&folder("../specs"))?;
    for name in ["specs/features", "specs/devices"] {
        found.extend(specs(&folder(name))?);
    }
    for entry in fs::read_dir(folder("specs/rules"))? {
        let good = specs(&entry?.path())?.into_iter();
        found.extend(
            good.filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("good"))),
        );
    }
    Ok(found)
}

fn specs(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|kind| kind == "yaml") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Reads a spec as an editor does: what looks like a number is one.
fn read(path: &Path) -> Result<Value> {
    as_json(serde_yaml::from_str(&fs::read_to_string(path)?)?)
}

/// Makes texts of the keys, which in JSON are nothing else.
fn as_json(value: serde_yaml::Value) -> Result<Value> {
    Ok(match value {
        serde_yaml::Value::Sequence(items) => Value::Array(items.into_iter().map(as_json).collect::<Result<_>>()?),
        serde_yaml::Value::Mapping(entries) => {
            let mut map = Map::new();
            for (key, value) in entries {
                let key = match as_json(key)? {
                    Value::String(key) => key,
                    other => other.to_string(),
                };
                map.insert(key, as_json(value)?);
            }
            Value::Object(map)
        }
        leaf => serde_json::to_value(leaf)?,
    })
}
