//! `canspec examples` says whether each example holds, and what its errata say.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const HEATER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/commands/examples.in/heater.yaml");

fn examples(spec: &Path, format: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    command.args(["examples", "--format", format, "--spec"]).arg(spec).output().expect("canspec runs")
}

#[test]
fn an_example_that_contradicts_the_spec_is_listed_as_such() {
    let spec = fs::read_to_string(HEATER).expect("it is there");
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join("heater.yaml");
    fs::write(&path, spec.replace("411#00C8, means: {inside: 20 °C}", "411#00C8, means: {inside: 21 °C}"))
        .expect("there is room");
    let output = examples(&path, "jsonl");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("error[example]"));
    let lines = String::from_utf8(output.stdout).expect("it is text");
    let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).expect("it is JSON")).collect();
    let held: Vec<_> = lines.iter().map(|line| (line["data"].as_str(), line["holds"].as_bool())).collect();
    let expected = [(Some("0000"), true), (Some("00C8"), false), (Some("00C9"), true), (None, true)];
    assert_eq!(held, expected.map(|(data, holds)| (data, Some(holds))));
}

#[test]
fn an_erratum_is_shown_with_its_words() {
    let output = examples(Path::new(HEATER), "text");
    assert!(output.status.success());
    let table = String::from_utf8(output.stdout).expect("it is text");
    let words: Vec<_> = table.split_whitespace().collect();
    let sentence = "E1 prints: 00 C9; uses: 00 C8; because: the text says 20 °C";
    assert_eq!(words.join(" ").matches(sentence).count(), 2, "{table}");
}
