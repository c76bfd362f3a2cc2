//! `decode` shows the fields of a header that choose no message, and in CSV all of them.

use std::fs;
use std::process::Command;

/// Shelves, whose header has the number of a slot beside the function.
const SHELF: &str = r#"canspec: 1
protocol: shelf
title: Shelves of modules
document: {title: Shelf manual, version: "1"}
length: 4
identifier: {to_host: {bits: 10}, shelf: {bits: 9..0}}
header: {function: {bytes: 0}, slot: {bytes: 1}}
types: {shelf: {range: 1..9}}
addressing: {single: {request: {to_host: 0, shelf: shelf}, one: {to_host: 1, shelf: shelf}}}
access: {read: {request: {}, reply: {}, in: [reply], answers: {single: one}}}
messages: {heat: {section: "2", match: {function: 3}, access: [read], fields: {heat: {bytes: 2..3, unit: °C}}}}
"#;

/// What `decode` shows of a heat of 25 °C in slot 7, and of a function that nobody has.
fn decoded(format: &str) -> Vec<String> {
    let folder = tempfile::tempdir().expect("there is room");
    let [spec, log] = ["shelf.yaml", "bus.log"].map(|name| folder.path().join(name));
    fs::write(&spec, SHELF).expect("there is room");
    fs::write(&log, "(1.0) can0 402#03070019\n(2.0) can0 402#04080019\n").expect("there is room");
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let output = command.arg("decode").arg("--spec").arg(&spec).args(["--format", format]).arg(&log).output();
    let out = String::from_utf8(output.expect("canspec runs").stdout).expect("it is text");
    out.lines().map(str::to_owned).collect()
}

#[test]
fn the_table_shows_a_field_of_the_header_that_the_message_leaves_open() {
    let lines = decoded("text");
    let [_, heat, ..] = lines.as_slice() else { panic!("{lines:?}") };
    assert!(heat.ends_with("heat     slot 0x07  heat 25 °C"), "{heat}");
}

#[test]
fn the_last_column_of_csv_has_all_fields_of_the_header() {
    let lines = decoded("csv");
    let cells = |line: &String| line.rsplit(',').next().map(str::to_owned);
    let last: Vec<_> = lines.iter().filter_map(cells).collect();
    assert_eq!(last, ["selectors", "function=3 slot=7", "function=4 slot=8"]);
}
