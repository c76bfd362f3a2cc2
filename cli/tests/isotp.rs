//! Messages by ISO-TP: the table shows one row for each, and both ways back give the frames.

mod calls;

use std::path::Path;

use serde_json::{Value, json};

/// A tester reads a calibration from unit 0: 1000 rpm, 10, 30, 50 and 0 A, day 9.
const READING: &str = "\
(0.0) can0 7E0#0322F19000000000
(0.1) can0 7E8#100E62F19003E800
(0.2) can0 7E0#3000000000000000
(0.3) can0 7E8#2164012C01F40000
(0.4) can0 7E8#2209000000000000
";

fn canspec(arguments: &[&str], input: &str) -> (String, String) {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/specs/devices/units.yaml");
    calls::canspec(&spec, arguments, input)
}

/// Decodes frames of unit 0 and of the tester, and returns the joined messages.
fn joined(frames: &[&str]) -> Vec<Value> {
    let log: Vec<_> = frames.iter().map(|frame| format!("(0.0) can0 {frame}")).collect();
    let (out, complaints) = canspec(&["decode", "--assemble", "--format", "jsonl", "-"], &log.join("\n"));
    assert_eq!(complaints, "");
    let objects = out.lines().map(|line| serde_json::from_str::<Value>(line).expect("a line is an object"));
    objects.filter(|object| object.get("lines").is_some()).collect()
}

/// The reply in three frames.
const FIRST: &str = "7E8#100E62F19003E800";
const SECOND: &str = "7E8#2164012C01F40000";
const THIRD: &str = "7E8#2209000000000000";

#[test]
fn the_table_shows_one_row_for_each_message() {
    let (out, _) = canspec(&["decode", "-"], READING);
    let rows: Vec<&str> = out.lines().skip(1).collect();
    assert_eq!(rows.len(), 2, "{out}");
    assert!(rows[0].contains("→ unit 0  read") && rows[0].ends_with("calibration"), "{out}");
    assert!(rows[1].contains("speed 1000 rpm  current [10.0, 30.0, 50.0, 0.0] A  day 9"), "{out}");
    let (out, _) = canspec(&["decode", "--frames", "-"], READING);
    assert_eq!(out.lines().count(), 1 + 5 + 2, "{out}");
}

#[test]
fn an_object_has_the_joined_data_and_their_selectors() {
    let whole = &joined(&[FIRST, SECOND, THIRD])[0];
    assert_eq!((&whole["lines"], &whole["data"]), (&json!([1, 2, 3]), &json!("62F19003E80064012C01F4000009")));
    assert_eq!(whole["selectors"], json!({"service": 0x62, "data": 0xF190}));
    assert_eq!(whole["signals"]["current"]["raw"], json!([100, 300, 500, 0]));
    assert_eq!((&whole["message"], &whole["kind"]), (&json!("calibration"), &json!("reply")));
}

#[test]
fn both_ways_back_give_the_frames() {
    let (objects, _) = canspec(&["decode", "--assemble", "--format", "jsonl", "-"], READING);
    let (log, complaints) = canspec(&["encode", "--from", "jsonl", "-"], &objects);
    assert_eq!((log.as_str(), complaints.as_str()), (READING, ""));
    let whole: Vec<_> = objects.lines().filter(|line| line.contains("\"lines\"")).collect();
    let (log, _) = canspec(&["encode", "--from", "jsonl", "-"], &whole.join("\n"));
    let frames: Vec<_> = log.lines().filter_map(|line| line.split(' ').nth(2)).collect();
    assert_eq!(frames, ["7E0#0322F19000000000", FIRST, SECOND, THIRD]);
}

#[test]
fn a_call_makes_the_frames_of_the_sender_and_keeps_limits() {
    let write = ["encode", "write", "calibration", "--to", "unit:1", "current=1A,2A,3A,25A"];
    let (out, _) = canspec(&[&write[..], &["speed=900rpm"]].concat(), "");
    // 900 is 0x384. The day takes its default 1.
    assert_eq!(out, "7E1#100E2EF190038400\n7E1#210A0014001E00FA\n7E1#2201000000000000\n");
    let (out, complaints) = canspec(&[&write[..], &["speed=2001rpm"]].concat(), "");
    assert_eq!(
        (out.as_str(), complaints.as_str()),
        ("", "canspec: calibration.speed: 2001 rpm is outside 500..2000 rpm\n")
    );
    let (out, _) = canspec(&["encode", "read", "idle_speed", "--to", "unit:1"], "");
    assert_eq!(out, "7E1#0322F19100000000\n");
    let reply = ["encode", "refused", "--kind", "reply", "--source", "3", "refused=write", "reason=locked"];
    assert_eq!(canspec(&reply, "").0, "7EB#037F2E3300000000\n");
}
