//! No cell of CSV is taken for a formula by a spreadsheet.

use std::fs;
use std::process::Command;

/// A meter whose unit is a formula.
const METER: &str = r#"canspec: 1
protocol: meter
title: Meters
document: {title: Meter manual, version: "1"}
length: 2
units: {sum: "=1+2"}
identifier: {to_host: {bits: 10}, meter: {bits: 9..0}}
types: {meter: {range: 1..9}}
addressing: {single: {request: {to_host: 0, meter: meter}, one: {to_host: 1, meter: meter}}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {single: one}}}
messages: {heat: {section: "2", access: [read], fields: {heat: {bytes: 0..1, unit: "=1+2"}}}}
"#;

#[test]
fn a_unit_that_looks_like_a_formula_has_an_apostrophe_before_it() {
    let folder = tempfile::tempdir().expect("there is room");
    let [spec, log] = ["meter.yaml", "bus.log"].map(|name| folder.path().join(name));
    fs::write(&spec, METER).expect("there is room");
    fs::write(&log, "(1.0) can0 402#0019\n").expect("there is room");
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let output = command.arg("decode").arg("--spec").arg(&spec).args(["--format", "csv"]).arg(&log).output();
    let out = String::from_utf8(output.expect("canspec runs").stdout).expect("it is text");
    assert!(out.contains(",heat,25,25,'=1+2,"), "{out}");
}
