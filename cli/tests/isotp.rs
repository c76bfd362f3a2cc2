//! Messages by ISO-TP: the table shows one row for each, and both ways back give the frames, whatever goes wrong on the bus.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

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
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/specs/isotp.yaml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let command = command.args(arguments).arg("--spec").arg(spec).stdin(Stdio::piped());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("canspec runs");
    let mut stdin = child.stdin.take().expect("it reads");
    // A call that is refused does not read.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().expect("canspec ends");
    let [out, complaints] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("it is text"));
    (out, complaints)
}

/// Decodes frames of unit 0 and of the tester, and returns the joined messages.
fn joined(frames: &[&str]) -> Vec<Value> {
    let log: Vec<_> = frames.iter().map(|frame| format!("(0.0) can0 {frame}")).collect();
    let (out, complaints) = canspec(&["decode", "--assemble", "--format", "jsonl", "-"], &log.join("\n"));
    assert_eq!(complaints, "");
    let objects = out.lines().map(|line| serde_json::from_str::<Value>(line).expect("a line is an object"));
    objects.filter(|object| object.get("lines").is_some()).collect()
}

/// Returns the lines of each joined message, and what is missing of it.
fn told(frames: &[&str]) -> Value {
    let messages = joined(frames);
    messages.iter().map(|whole| json!([whole["lines"], whole["incomplete"]])).collect()
}

/// The reply in three frames, and one in a single frame.
const FIRST: &str = "7E8#100E62F19003E800";
const SECOND: &str = "7E8#2164012C01F40000";
const THIRD: &str = "7E8#2209000000000000";
const SINGLE: &str = "7E8#0562F19103E80000";

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

#[test]
fn a_skipped_or_repeated_frame_ends_a_message_and_belongs_to_nothing_then() {
    let wrong =
        |came, number, wanted| format!("{came} of 14 bytes came; frame number {number} came in place of {wanted}");
    assert_eq!(told(&[FIRST, THIRD, THIRD]), json!([[[1], wrong(6, 2, 1)]]));
    assert_eq!(told(&[FIRST, SECOND, SECOND, THIRD]), json!([[[1, 2], wrong(13, 1, 2)]]));
    assert_eq!(told(&[SECOND, THIRD]), json!([]));
}

#[test]
fn another_message_of_the_same_sender_ends_one() {
    let restarted = |came| format!("{came} of 14 bytes came; another message begins");
    assert_eq!(told(&[FIRST, SECOND, SINGLE]), json!([[[1, 2], restarted(13)], [[3], null]]));
    assert_eq!(told(&[FIRST, FIRST, SECOND, THIRD]), json!([[[1], restarted(6)], [[2, 3, 4], null]]));
    // A message that the spec does not know ends one, too.
    assert_eq!(told(&[FIRST, "7E8#0399000000000000", SECOND]), json!([[[1], restarted(6)]]));
}

#[test]
fn two_senders_at_once_are_never_mixed() {
    let other = ["7E9#100E62F19003E900", "7E9#2164012C01F40000", "7E9#220A000000000000"];
    let messages = joined(&[FIRST, other[0], other[1], SECOND, THIRD, other[2]]);
    let days: Vec<_> = messages.iter().map(|whole| (&whole["lines"], &whole["signals"]["day"]["raw"])).collect();
    assert_eq!(days, [(&json!([1, 4, 5]), &json!(9)), (&json!([2, 3, 6]), &json!(10))]);
}

#[test]
fn a_receiver_without_room_ends_a_message_and_other_answers_do_not() {
    let (wait, overflow, of_unit_1) = ("7E0#3100000000000000", "7E0#3200000000000000", "7E1#3200000000000000");
    assert_eq!(told(&[FIRST, "7E0#310000", of_unit_1, SECOND, THIRD]), json!([[[1, 4, 5], null]]));
    assert_eq!(told(&[FIRST, wait, SECOND, THIRD]), json!([[[1, 3, 4], null]]));
    let no_room = "6 of 14 bytes came; the receiver has no room for it";
    assert_eq!(told(&[FIRST, overflow, SECOND, THIRD]), json!([[[1], no_room]]));
}

#[test]
fn padding_may_be_anything_and_may_be_missing() {
    assert_eq!(told(&[FIRST, SECOND, "7E8#2209"]), json!([[[1, 2, 3], null]]));
    assert_eq!(told(&[FIRST, SECOND, "7E8#2209AA55FF010203"]), json!([[[1, 2, 3], null]]));
    assert_eq!(told(&["7E8#0562F19103E8"]), json!([[[1], null]]));
}

#[test]
fn what_the_standard_tells_receivers_to_ignore_changes_nothing() {
    let ignored = [
        "7E8#0062F19103E80000",
        "7E8#0F62F19103E80000",
        "7E8#0562F191",
        "7E8#100062F19003E800",
        "7E8#100762F19003E800",
        "7E8#2164",
    ];
    for frame in ignored {
        assert_eq!(told(&[FIRST, frame, SECOND, THIRD]), json!([[[1, 3, 4], null]]), "{frame}");
    }
}

#[test]
fn a_wrong_size_is_told() {
    let few = "9 bytes came, which the message never has";
    assert_eq!(told(&["7E8#100962F19003E800", "7E8#2164012C00000000"]), json!([[[1, 2], few]]));
    assert_eq!(told(&["7E8#1FFF62F19003E800"]), json!([[[1], "6 of 4095 bytes came"]]));
    assert_eq!(told(&["7E8#0462F19103E80000"]), json!([[[1], "4 bytes came, which the message never has"]]));
}

#[test]
fn what_cannot_be_made_yet_is_said() {
    let (out, complaints) = canspec(&["export", "wireshark"], "");
    let why = "canspec: a dissector cannot join the messages by `tp` yet, since it is ISO-TP\n";
    assert_eq!((out.as_str(), complaints.as_str()), ("", why));
}
