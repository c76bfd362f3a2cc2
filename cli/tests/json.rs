//! No object that a command writes has a name twice: readers of JSON keep one of the two, and not all the same one.

use std::collections::HashSet;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

/// A value of JSON in which no object has a name twice.
struct Unique;

impl<'de> Deserialize<'de> for Unique {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(UniqueVisitor)
    }
}

struct UniqueVisitor;

impl<'de> Visitor<'de> for UniqueVisitor {
    type Value = Unique;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("JSON without a name twice")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Unique, A::Error> {
        let mut names = HashSet::new();
        while let Some((name, Unique)) = map.next_entry::<String, Unique>()? {
            if !names.insert(name.clone()) {
                return Err(A::Error::custom(format_args!("`{name}` stands twice")));
            }
        }
        Ok(Unique)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Unique, A::Error> {
        while let Some(Unique) = list.next_element()? {}
        Ok(Unique)
    }

    fn visit_unit<E: Error>(self) -> Result<Unique, E> {
        Ok(Unique)
    }

    fn visit_bool<E: Error>(self, _: bool) -> Result<Unique, E> {
        Ok(Unique)
    }

    fn visit_i64<E: Error>(self, _: i64) -> Result<Unique, E> {
        Ok(Unique)
    }

    fn visit_u64<E: Error>(self, _: u64) -> Result<Unique, E> {
        Ok(Unique)
    }

    fn visit_f64<E: Error>(self, _: f64) -> Result<Unique, E> {
        Ok(Unique)
    }

    fn visit_str<E: Error>(self, _: &str) -> Result<Unique, E> {
        Ok(Unique)
    }
}

/// Fields of one name in different places: each message has its own `part`.
const PARTS: &str = r#"
canspec: 1
protocol: pump
title: Pumps
document: {title: Made up, version: "1"}
length: 8
identifier: {direction: {bits: 10}, command: {bits: 9..4}, node: {bits: 3..0}}
header: {kind: {bytes: 0}}
types: {pump: {range: 1..9, section: "1"}}
addressing: {single: {request: {direction: 0, node: pump}, one: {direction: 1, node: pump}, section: "1"}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {single: one}, section: "1"}}
messages:
  speed:
    section: "1"
    match: {command: 1, kind: 1}
    access: [read]
    fields: {part: {bytes: 1, const: 1}, value: {bytes: 4..5, unit: rpm}}
  flow:
    section: "1"
    match: {command: 1, kind: 2}
    access: [read]
    fields: {part: {bytes: 2, const: 3}, value: {bytes: 4..5, unit: rpm}}
"#;

/// A reply of each message, and frames that are none.
const LOG: &str = "413#0101000000640000\n413#0200030000640000\n413#0300030000640000\n413#0102030000640000\n\
                   20000413#0000000000000000\n413#R\n413##00102\n";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns the files of an ending, in a folder and those below it.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder).expect("the folder exists").map(|entry| entry.expect("it can be read").path());
    let (folders, files): (Vec<_>, Vec<_>) = paths.partition(|path| path.is_dir());
    let here = files.into_iter().filter(|path| path.extension().is_some_and(|known| known == ending));
    here.chain(folders.iter().flat_map(|folder| self::files(folder, ending))).collect()
}

fn canspec(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_canspec")).args(arguments).output().expect("the command was built")
}

/// Tests each line, and returns how many there are.
#[track_caller]
fn assert_unique(what: &str, lines: &[u8]) -> usize {
    let lines = str::from_utf8(lines).expect("JSON is text").lines();
    let tested = lines.map(|line| {
        if let Err(error) = serde_json::from_str::<Unique>(line) {
            panic!("{what}: {error}: {line}");
        }
    });
    tested.count()
}

#[track_caller]
fn assert_checked(spec: &Path) {
    let name = spec.to_string_lossy();
    let output = canspec(&["check", "--format", "json", "--message-format", "json", &name]);
    assert_eq!(assert_unique(&name, &output.stdout), 1, "{name}");
    assert_unique(&name, &output.stderr);
}

#[test]
fn a_name_that_stands_twice_is_found() {
    assert!(serde_json::from_str::<Unique>(r#"{"a":[1,-1,0.5,null,true,"a",{"a":{}}],"b":{"a":1}}"#).is_ok());
    for json in [r#"{"a":1,"b":2,"a":1}"#, r#"[{"a":{"b":1,"b":1}}]"#] {
        assert!(serde_json::from_str::<Unique>(json).is_err(), "{json}");
    }
}

#[test]
fn no_summary_or_complaint_has_a_name_twice() {
    let root = root();
    let folders = [root.join("specs"), root.join("tests/specs"), root.join("tests/peers")];
    let specs: Vec<_> = folders.iter().flat_map(|folder| files(folder, "yaml")).collect();
    assert!(specs.len() > 100, "{}", specs.len());
    for spec in &specs {
        assert_checked(spec);
    }
}

#[test]
fn no_example_has_a_name_twice() {
    for spec in files(&root().join("specs"), "yaml") {
        let spec = spec.to_string_lossy();
        let output = canspec(&["examples", "--format", "jsonl", "--spec", &spec]);
        assert!(assert_unique(&spec, &output.stdout) > 0, "{spec}");
    }
}

#[test]
fn no_frame_has_a_name_twice() {
    let logs = root().join("tests/logs");
    for name in ["daly", "gbt27930", "gcp", "huawei", "infy", "megmeet", "mxr", "trio"] {
        let log = logs.join(format!("{name}-session.log"));
        let output = canspec(&["decode", "--format", "jsonl", "--protocol", name, &log.to_string_lossy()]);
        assert!(assert_unique(name, &output.stdout) > 0, "{name}");
    }
}

#[test]
fn fields_of_one_name_in_different_places_give_one_name() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let [spec, log] = ["pump.yaml", "pump.log"].map(|name| folder.path().join(name));
    fs::write(&spec, PARTS).expect("the folder can be written");
    fs::write(&log, LOG).expect("the folder can be written");
    assert_checked(&spec);
    let [spec, log] = [spec.to_string_lossy(), log.to_string_lossy()];
    let summary = canspec(&["check", "--format", "json", &spec]).stdout;
    let summary = String::from_utf8(summary).expect("JSON is text");
    assert!(summary.contains(r#""messages":2,"selectors":{"kind":2,"command":1,"part":2},"#), "{summary}");
    let output = canspec(&["decode", "--format", "jsonl", "--spec", &spec, &log]);
    assert_eq!(assert_unique(&spec, &output.stdout), LOG.lines().count());
    let decoded = String::from_utf8(output.stdout).expect("JSON is text");
    for selectors in
        [r#"{"kind":1,"part":1},"signals":"#, r#"{"kind":2,"part":3},"signals":"#, r#"{"kind":3,"part":0}}"#]
    {
        assert!(decoded.contains(selectors), "{selectors} in {decoded}");
    }
    let schema = canspec(&["schema"]).stdout;
    assert!(serde_json::from_slice::<Unique>(&schema).is_ok());
}

#[test]
fn a_constant_field_is_not_called_like_a_field_of_the_header_elsewhere() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let spec = folder.path().join("pump.yaml");
    let check = |text: &str| {
        fs::write(&spec, text).expect("the folder can be written");
        let output = canspec(&["check", "--message-format", "short", &spec.to_string_lossy()]);
        String::from_utf8(output.stderr).expect("complaints are text")
    };
    let refused = check(&PARTS.replace("header: {kind: {bytes: 0}}", "header: {kind: {bytes: 0}, part: {bytes: 7}}"));
    let text = ": error[match]: a frame would have two values called `part`, since the header has a field of that name";
    assert_eq!(refused.lines().count(), 2, "{refused}");
    assert!(refused.lines().all(|line| line.ends_with(text)), "{refused}");
    assert_eq!(check(&PARTS.replace("{part: {bytes: 1,", "{kind: {bytes: 0,")), "");
}
