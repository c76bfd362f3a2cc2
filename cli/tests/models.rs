//! Fields that only some device models have: they are hidden on the others, and asked for where a model has them.

mod calls;

use std::fs;
use std::path::Path;

/// Three bytes reach `warmth`, which `V1_2` does not have.
const LOG: &str = "\
(1.0) can0 007#540000
(1.1) can0 007#540060
(1.2) can0 007#54
";

fn canspec(arguments: &[&str], input: &str) -> (String, String) {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/specs/features/revisions.yaml");
    calls::canspec(&spec, arguments, input)
}

#[test]
fn a_field_that_the_model_does_not_have_is_shown_only_where_its_bits_are_set() {
    let (table, _) = canspec(&["decode", "--model", "V1_2", "-"], LOG);
    assert!(!table.contains("warmth 0 W") && table.contains("warmth 96 W"), "{table}");
    assert!(table.contains("V1_2 has no `warmth`, for which the message is long enough"), "{table}");
    let (table, _) = canspec(&["decode", "--model", "V1_3", "-"], LOG);
    assert!(table.contains("warmth 0 W") && !table.contains("model_dependent"), "{table}");
}

#[test]
fn frames_come_back_with_their_lengths_though_a_field_is_hidden() {
    for model in ["V1_2", "V1_3"] {
        let (lines, _) = canspec(&["decode", "--model", model, "--format", "jsonl", "-"], LOG);
        let has_reserved: Vec<_> = lines.lines().map(|line| line.contains("\"reserved\"")).collect();
        assert_eq!(has_reserved, [model == "V1_2", false, false], "{lines}");
        let (log, complaints) = canspec(&["encode", "--model", model, "--from", "jsonl", "-"], &lines);
        assert_eq!((log.as_str(), complaints.as_str()), (LOG, ""), "{lines}");
    }
}

#[test]
fn a_request_asks_for_what_the_model_has() {
    let set = |arguments: &[&str]| {
        let (frame, complaints) =
            canspec(&[&["encode", "set_charge", "--to", "battery", "charge=84%"], arguments].concat(), "");
        if complaints.is_empty() { frame } else { complaints }
    };
    assert_eq!(set(&["--model", "V1_2"]), "006#54\n");
    assert_eq!(set(&["--model", "V1_3", "warmth=96W"]), "006#540060\n");
    assert_eq!(set(&["--model", "V1_3"]), "canspec: set_charge: the signal `warmth` is missing\n");
    assert_eq!(set(&[]), "006#54\n");
}

/// A frame and messages of two frames, of one length and of several. Model B alone has what stands last.
const BATTERY: &str = r#"
canspec: 1
protocol: battery
title: A battery
document: {title: Made up, version: "1"}
length: 8
identifier: {command: {bits: 10..1}, sender: {bits: 0}}
addressing: {battery: {request: {sender: 0}, one: {sender: 1}}}
access: {set: {request: {}, reply: {}, answers: {battery: one}}}
messages:
  state:
    section: "1"
    match: {command: 2}
    access: [set]
    length: [4, 6]
    fields: {soc: {bytes: 0..1}, soh: {bytes: 2..3}, warmth: {bytes: 4..5, models: [B]}}
  multi:
    section: "1"
    match: {command: 3}
    access: [set]
    parts: {number: {bytes: 0, bits: 4..0}, counter: {bytes: 0, bits: 7..5}, first: 0, data: 1..7, length: {bytes: 1}}
    length: [2, 8]
    fields: {a: {bytes: 0..1}, b: {bytes: 2..7, models: [B]}}
  fixed:
    section: "1"
    match: {command: 4}
    access: [set]
    parts: {number: {bytes: 0}, first: 0, data: 1..7}
    fields: {a: {bytes: 0..1}, b: {bytes: 8..13, models: [B]}}
models: {A: {section: "1"}, B: {section: "1"}}
"#;

/// What model A sends, with zeros where only B has something, then with something there.
const MESSAGES: &str = "\
(1.0) can0 005#005400600000
(1.1) can0 005#005400600001
(1.2) can0 007#0008000100000000
(1.3) can0 007#0100000000000000
(1.4) can0 007#2008000100000000
(1.5) can0 007#2100010000000000
(1.6) can0 007#4002000100000000
(1.7) can0 009#0000010000000000
(1.8) can0 009#0100000000000000
";

fn battery(arguments: &[&str], input: &str) -> (String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("battery.yaml");
    fs::write(&spec, BATTERY).expect("the folder can be written");
    calls::canspec(&spec, arguments, input)
}

#[test]
fn what_another_model_alone_has_is_not_shown_however_many_frames_carry_it() {
    let last = |model: &str| {
        let (table, _) = battery(&["decode", "--model", model, "--assemble", "-"], MESSAGES);
        let last = |row: &str| row.rsplit("  ").next().unwrap_or_default().trim().to_owned();
        table.lines().skip(1).map(last).collect::<Vec<_>>()
    };
    let lacks = |name: &str| format!("! model_dependent: A has no `{name}`");
    let longer = |name: &str| format!("{}, for which the message is long enough", lacks(name));
    let [warmth, b] = ["warmth", "b"].map(|name| (longer(name), lacks(name)));
    let of_a = ["soh 96", &warmth.0, "warmth 1", &warmth.1, "a 1", &b.0, "b 1", &b.1, "a 1", "a 1"];
    assert_eq!(last("A"), of_a);
    assert_eq!(last("B"), ["warmth 0", "warmth 1", "b 0", "b 1", "a 1", "b 0"]);
}

#[test]
fn long_messages_come_back_with_their_lengths_though_a_field_is_hidden() {
    for model in ["A", "B"] {
        let (lines, _) = battery(&["decode", "--model", model, "--assemble", "--format", "jsonl", "-"], MESSAGES);
        // Whole messages say all that their frames do.
        let is_whole = |line: &&str| line.starts_with("{\"lines\"") || line.contains("\"message\":\"state\"");
        let lines = lines.lines().filter(is_whole).collect::<Vec<_>>().join("\n");
        let (log, complaints) = battery(&["encode", "--model", model, "--from", "jsonl", "-"], &lines);
        let data =
            |text: &str| text.lines().map(|line| line.split(' ').next_back().map(str::to_owned)).collect::<Vec<_>>();
        assert_eq!((data(&log), complaints.as_str()), (data(MESSAGES), ""), "{lines}");
    }
}

#[test]
fn a_request_of_several_frames_asks_for_what_the_model_has() {
    let set = |model: &str, arguments: &[&str]| {
        let (frames, complaints) = battery(&[&["encode", "--to", "battery", "--model", model], arguments].concat(), "");
        if complaints.is_empty() { frames } else { complaints }
    };
    let state = ["state", "soc=84", "soh=96"];
    assert_eq!(set("A", &state), "004#00540060\n");
    assert_eq!(set("B", &state), "canspec: state: the signal `warmth` is missing\n");
    assert_eq!(set("A", &["multi", "a=1"]), "006#0002000100000000\n");
    assert_eq!(set("B", &["multi", "a=1"]), "canspec: multi: the signal `b` is missing\n");
    assert_eq!(set("B", &["multi", "a=1", "b=2"]), "006#0008000100000000\n006#0100020000000000\n");
    assert_eq!(set("A", &["fixed", "a=1"]), "008#0000010000000000\n008#0100000000000000\n");
    assert_eq!(set("B", &["fixed", "a=1"]), "canspec: fixed: the signal `b` is missing\n");
    assert_eq!(set("A", &["fixed", "a=1", "b=2"]), "canspec: fixed.b: A has no `b`\n");
}
