//! Arrays are one cell of a table and one member of an object, and such objects encode again.

mod calls;

const SPEC: &str = r#"
canspec: 1
protocol: pack
title: A pack of cells
document: {title: Made up, version: "1"}
length: 8
identifier: {direction: {bits: 10}, command: {bits: 9..4}, node: {bits: 3..0}}
types: {pack: {range: 1..9}}
addressing: {single: {request: {direction: 0, node: pack}, one: {direction: 1, node: pack}}}
access: {set: {request: {}, reply: {}, answers: {single: one}}}
messages:
  cells:
    section: "1"
    match: {command: 1}
    access: [set]
    length: [6, 8]
    fields:
      heat:  {bytes: 0, repeat: 2, as: signed, unit: °C}
      alarm: {bytes: 2, repeat: 2, status: {hot: {bit: 0, severity: fault}}}
      mode:  {bytes: 4, repeat: 3, values: {0: "off", 1: "on"}}
      last:  {bytes: 7}
"#;

/// Calls canspec with the spec and an input; returns both outputs.
fn canspec(arguments: &[&str], input: &str) -> (String, String) {
    let folder = tempfile::tempdir().expect("there is room");
    let spec = folder.path().join("pack.yaml");
    std::fs::write(&spec, SPEC).expect("there is room");
    calls::canspec(&spec, arguments, input)
}

/// Returns the signals of the only object.
fn signals(arguments: &[&str], frame: &str) -> String {
    let (out, _) = canspec(&[&["decode", "--format", "jsonl", "-"], arguments].concat(), frame);
    let (_, signals) = out.split_once(r#""signals":"#).expect("it is recognised");
    signals.split_once(r#","notes""#).map(|(signals, _)| signals.to_owned()).expect("notes follow")
}

#[test]
fn a_row_shows_all_values_of_an_array_in_one_cell() {
    let (out, _) = canspec(&["decode", "-"], "411#19FE010000010203\n411#19FE01000002\n");
    let cells = |line: &str| line.split_once("cells").map(|(_, cells)| cells.trim().to_owned());
    let rows: Vec<_> = out.lines().filter_map(cells).collect();
    let same = "heat [25, -2] °C  alarm [{hot}, {}]";
    let (long, short) = ("mode [off, on, ? (raw 0x2)]  last 3", "mode [off, ? (raw 0x2)]");
    assert_eq!(rows, [long, short].map(|rest| format!("{same}  {rest}")));
}

#[test]
fn an_object_has_a_list_for_each_array() {
    let status = r#""alarm":{"raw":[1,0],"set":[["hot"],[]],"unknown":[0,0],"severity":[{"fault":["hot"]},{}]}"#;
    let expected = [
        r#"{"heat":{"raw":[25,-2],"value":[25,-2],"unit":"°C"},"#,
        status,
        r#","mode":{"raw":[0,1,2],"value":["off","on",null]},"last":{"raw":3,"value":3}}"#,
    ];
    assert_eq!(signals(&[], "411#19FE010000010203"), expected.concat());
    let short = r#","mode":{"raw":[0,2],"value":["off",null]}}"#;
    assert!(signals(&[], "411#19FE01000002").ends_with(short));
    assert!(signals(&[], "411#19FE000000020000").contains(r#""set":[[],[]],"unknown":[0,0]},"mode""#));
}

#[test]
fn one_element_or_a_whole_array_can_be_chosen() {
    let frame = "411#19FE010000010203";
    assert_eq!(signals(&["--signal", "heat"], frame), r#"{"heat":{"raw":[25,-2],"value":[25,-2],"unit":"°C"}}"#);
    assert_eq!(signals(&["--signal", "heat_2"], frame), r#"{"heat":{"raw":[null,-2],"value":[null,-2],"unit":"°C"}}"#);
}

#[test]
fn what_was_decoded_is_encoded_again() {
    let log = "(1) can0 411#19FE010000010203\n(2) can0 411#19FE01800002\n(3) can0 011#7F80000101010000\n";
    let (objects, _) = canspec(&["decode", "--format", "jsonl", "-"], log);
    assert_eq!(canspec(&["encode", "--from", "jsonl"], &objects), (log.to_owned(), String::new()));
    let (_, complaints) = canspec(&["encode", "--from", "jsonl"], &objects.replace("°C", "K"));
    let refusal = r#"cells.heat: the unit is °C, not "K""#;
    assert_eq!(complaints.lines().filter(|line| line.ends_with(refusal)).count(), 3, "{complaints}");
}

#[test]
fn a_request_takes_a_list_and_single_elements() {
    let values = ["heat=25,-2", "alarm=[hot],[]", "mode_1=off", "mode_2=on"];
    let encode = |more: &[&str]| canspec(&[&["encode", "cells", "--to", "pack:1"], &values[..], more].concat(), "");
    assert_eq!(encode(&[]).0, "011#19FE01000001\n");
    assert_eq!(encode(&["mode_3=on", "last=3"]).0, "011#19FE010000010103\n");
    assert_eq!(encode(&["mode=off"]).1, "canspec: cells: the signal `mode_1` is given twice\n");
}
