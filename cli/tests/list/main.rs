//! `canspec list` shows all that a spec says, in its full form and in JSON.

mod complete;
mod documented;
mod layout;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use canspec_codegen::model::Protocol;
use canspec_codegen::{Bases, compile};
use serde_json::Value;

/// Returns what the command writes about a spec.
fn list(spec: &Path, arguments: &[&str]) -> String {
    canspec(&[&["list", "--spec", spec.to_str().expect("the path is text")], arguments].concat())
}

/// Returns the object of JSON that the command writes about a spec.
fn object(spec: &Path) -> Value {
    serde_json::from_str(&list(spec, &["--format", "json"])).expect("it is one object")
}

fn canspec(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_canspec")).args(arguments).output().expect("canspec runs");
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {complaints}");
    String::from_utf8(output.stdout).expect("it is text")
}

/// Returns the specs of the built-in protocols, of the devices and of the features of the language.
fn specs() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders = ["specs", "tests/specs", "tests/specs/devices", "tests/specs/features"];
    let files = folders.iter().flat_map(|folder| fs::read_dir(root.join(folder)).expect("the folder is there"));
    let files = files.map(|entry| entry.expect("it can be read").path());
    let mut specs: Vec<_> = files.filter(|path| path.extension().is_some_and(|end| end == "yaml")).collect();
    specs.sort();
    assert!(specs.len() > 60, "{} specs", specs.len());
    specs
}

fn protocol(spec: &Path) -> Protocol {
    let bases: Bases = canspec_specs::SPECS.iter().map(|spec| (spec.name, spec.text)).collect();
    let outcome = compile(bases.read(spec).expect("it can be read"));
    outcome.protocol.unwrap_or_else(|| panic!("{}: {}", spec.display(), outcome.diagnostics.concise()))
}

#[test]
fn what_an_output_does_after_silence_is_listed() {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/specs/features/times.yaml");
    let text = list(&spec, &[]);
    assert!(text.contains("AFTER SILENCE") && text.contains("The output goes off, and stays off until"), "{text}");
    assert!(text.contains("note: an erased device is off"), "{text}");
    let listed = object(&spec);
    let [output, section] = ["output", "section"].map(|key| &listed["after_silence"][key]);
    assert_eq!([output, section], ["off", "4"]);
}
