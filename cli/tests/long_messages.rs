//! Messages in parts: the table shows one row for each, JSON lines add an object, and both ways back give the frames.

mod calls;

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::{Value, json};

/// Cells 1 to 5 of battery 1: 10 V, 0.1 V, 0.11 V, 0.12 V and 3.3 V. `cells` says that there are five.
const LOG: &str = "\
(1.0) can0 031#0500000000000000
(1.1) can0 041#0000000000000000
(1.2) can0 051#010201E8030A0000
(1.3) can0 051#020B000C004A0100
";

/// The spec whose parts have other numbers on each model.
const BY_MODEL: &str = "parts_by_model.yaml";

/// The spec of messages that begin with their length, and count.
const PACKETS: &str = "fast_packets.yaml";

/// The spec of a transport.
const TRANSPORT: &str = "transport.yaml";

/// The spec of messages that go in one frame if that is enough.
const OR_FRAME: &str = "transport_or_frame.yaml";

/// The vehicle sends 14 bytes: ACME, 400 V, 180 Ah, 515 cycles, April 2022, and a byte without a name.
const TRANSFER: &str = "\
(1.0) can0 1CEC56F4#100E000201000200
(1.1) can0 1CECF456#110101FFFF000200
(1.2) can0 1CEB56F4#0141434D45A00F08
(1.3) can0 1CECF456#110102FFFF000200
(1.4) can0 1CEB56F4#02070302002504FF
(1.5) can0 1CECF456#130E0002FF000200
";

fn spec(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/specs/features").join(name)
}

fn canspec(arguments: &[&str], input: &str) -> (String, String) {
    canspec_with("parts.yaml", arguments, input)
}

fn canspec_with(name: &str, arguments: &[&str], input: &str) -> (String, String) {
    calls::canspec(&spec(name), arguments, input)
}

fn objects(log: &str) -> Vec<Value> {
    let (out, _) = canspec(&["decode", "--assemble", "--format", "jsonl", "-"], log);
    out.lines().map(|line| serde_json::from_str(line).expect("a line is an object")).collect()
}

#[test]
fn an_object_with_the_joined_values_stands_behind_that_of_the_last_frame() {
    let objects = objects(LOG);
    assert_eq!(objects.len(), 5);
    let whole = &objects[4];
    assert_eq!((&whole["lines"], &whole["time"]), (&json!([3, 4]), &json!(1.3)));
    assert_eq!(whole["data"], "0201E8030A000B000C004A01");
    assert_eq!(whole["signals"]["cycles"]["value"], 258);
    assert_eq!(whole["signals"]["voltage"]["raw"], json!([1000, 10, 11, 12, 330]));
    assert_eq!(whole["signals"]["voltage"]["value"], json!([10.0, 0.1, 0.11, 0.12, 3.3]));
    assert!(whole.get("id").is_none() && whole.get("line").is_none() && whole.get("incomplete").is_none());
    assert_eq!(objects[3]["signals"]["part"]["value"], 2);
    assert_eq!(objects[3]["signals"]["data"]["value"], "0B000C004A01");
}

#[test]
fn a_part_that_is_lost_is_said_and_nothing_of_it_is_shown() {
    let log = LOG.lines().filter(|line| !line.contains("(1.2)")).collect::<Vec<_>>().join("\n");
    let objects = objects(&log);
    let whole = objects.last().expect("there is one");
    assert_eq!(whole["incomplete"], "part 1 is missing");
    assert_eq!((&whole["lines"], &whole["data"]), (&json!([3]), &Value::Null));
    assert_eq!(whole["signals"]["voltage"]["raw"], json!([null, null, 11, 12, 330]));
    assert!(whole["signals"].get("cycles").is_none());
}

#[test]
fn the_table_has_one_row_for_a_message_and_those_of_its_frames_on_demand() {
    let (short, _) = canspec(&["decode", "-"], LOG);
    let values = "cycles 258  voltage [10.00, 0.10, 0.11, 0.12, 3.30] V";
    assert!(short.lines().any(|row| row.starts_with("1.3") && row.contains(values)), "{short}");
    assert!(!short.contains("0B000C004A01") && !short.contains("1.2 "), "{short}");
    let (long, _) = canspec(&["decode", "--frames", "-"], LOG);
    assert!(long.contains("part 1  data 0201E8030A00") && long.contains("part 2  data 0B000C004A01"), "{long}");
    assert!(long.contains(values), "{long}");
}

#[test]
fn an_object_of_a_whole_message_becomes_frames_unless_these_have_objects() {
    let (all, _) = canspec(&["decode", "--assemble", "--format", "jsonl", "-"], LOG);
    let (back, complaints) = canspec(&["encode", "--from", "jsonl"], &all);
    assert_eq!((back.as_str(), complaints.as_str()), (LOG, ""));
    let whole = all.lines().filter(|line| line.contains("\"lines\"")).collect::<Vec<_>>().join("\n");
    let (back, complaints) = canspec(&["encode", "--from", "jsonl"], &whole);
    let frames = "(1.3) can0 051#010201E8030A0000\n(1.3) can0 051#020B000C004A0100\n";
    assert_eq!((back.as_str(), complaints.as_str()), (frames, ""));
}

#[test]
fn an_incomplete_message_without_its_frames_is_refused() {
    let log = LOG.lines().take(3).collect::<Vec<_>>().join("\n");
    let (all, _) = canspec(&["decode", "--assemble", "--format", "jsonl", "-"], &log);
    let whole = all.lines().find(|line| line.contains("\"lines\"")).expect("it ends with the log");
    let (back, complaints) = canspec(&["encode", "--from", "jsonl"], whole);
    assert_eq!(back, "");
    assert!(
        complaints.contains("this message did not come whole, so it is not made again: part 2 is missing"),
        "{complaints}"
    );
}

#[test]
fn values_in_a_call_become_all_frames() {
    let reply = ["encode", "cells", "--kind", "reply", "--source", "1", "cycles=258"];
    let values = ["voltage=10V,0.1V,0.11V,0.12V,3300mV", "group=0,0,0,0,0"];
    let (frames, complaints) = canspec(&[&reply[..], &values].concat(), "");
    assert_eq!((frames.as_str(), complaints.as_str()), ("051#010201E8030A0000\n051#020B000C004A0100\n", ""));
}

#[test]
fn a_model_says_which_number_the_first_part_has() {
    let reply = ["encode", "label", "--kind", "reply", "--source", "1", "serial=AB123456", "hours=1000h"];
    let (_, complaints) = canspec_with(BY_MODEL, &reply, "");
    assert_eq!(complaints, "canspec: label: the first part has another number on each model; choose a model\n");
    let (frames, _) = canspec_with(BY_MODEL, &[&reply[..], &["--model", "B"]].concat(), "");
    assert_eq!(frames, "071#01414231\n071#02323334\n071#03353600\n071#040003E8\n");
    let (new, _) = canspec_with(BY_MODEL, &[&reply[..7], &["--model", "B"]].concat(), "");
    assert_eq!(new.lines().last(), Some("071#04000000"), "hours that are left out are 0");
    let (table, _) = canspec_with(BY_MODEL, &["decode", "--model", "B", "-"], &frames);
    assert!(table.contains("serial AB123456  hours 1000 h"), "{table}");
    let (table, _) = canspec_with(BY_MODEL, &["decode", "-"], &frames);
    assert_eq!(table.matches("! model_dependent").count(), 4, "{table}");
}

#[test]
fn a_message_that_crosses_two_parts_of_a_file_is_the_same_as_from_a_live_bus() {
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join("bus.log");
    let log = LOG.repeat(12_000);
    fs::write(&path, &log).expect("there is room");
    for format in ["text", "jsonl", "csv"] {
        let run = |log: &Path, input: Stdio| {
            let arguments = ["decode", "--assemble", "--format", format, "--spec"];
            let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
            command.args(arguments).arg(spec("parts.yaml")).arg(log).stdin(input).output().expect("canspec runs").stdout
        };
        let file = run(&path, Stdio::null());
        let input = run(Path::new("-"), File::open(&path).expect("it is there").into());
        assert!(file == input && !file.is_empty(), "{format} differs");
    }
}

#[test]
fn a_transfer_is_one_row_and_its_frames_stay_what_they_were() {
    let (table, _) = canspec_with(TRANSPORT, &["decode", "-"], TRANSFER);
    let rows: Vec<_> = table.lines().filter(|row| row.contains("can0")).collect();
    let [row] = rows.as_slice() else { panic!("one row:\n{table}") };
    assert!(row.contains("180256F4") && row.contains("voltage 400.0 V") && table.contains("year 2022"), "{table}");
    let (lines, _) = canspec_with(TRANSPORT, &["decode", "--assemble", "--format", "jsonl", "-"], TRANSFER);
    let objects: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    assert_eq!(objects[0]["message"], "tp.control");
    assert_eq!(objects[0]["selectors"], json!({"control": 16, "size": 14, "packets": 2, "most": 1, "group": 512}));
    assert_eq!(objects[2]["message"], "tp.data");
    assert_eq!(objects[2]["selectors"], json!({"number": 1}));
    assert_eq!(objects[2]["signals"]["data"]["value"], "41434D45A00F08");
    assert_eq!((&objects[5]["lines"], &objects[5]["message"]), (&json!([1, 3, 5]), &json!("battery")));
    assert_eq!(objects[5]["data"], "41434D45A00F08070302002504FF");
    assert_eq!(objects[6]["selectors"]["control"], 19);
    let (back, complaints) = canspec_with(TRANSPORT, &["encode", "--from", "jsonl"], &lines);
    assert_eq!((back.as_str(), complaints.as_str()), (TRANSFER, ""));
}

#[test]
fn a_long_message_in_a_call_becomes_an_announcement_and_packets() {
    let battery = ["maker=ACME", "voltage=400V", "capacity=180Ah", "cycles=515"];
    let to = |mode| ["encode", "--kind", "report", "--to", mode, "battery"];
    let (frames, _) = canspec_with(TRANSPORT, &[&to("peer")[..], &battery].concat(), "");
    assert_eq!(frames, "1CEC56F4#100B0002FF000200\n1CEB56F4#0141434D45A00F08\n1CEB56F4#0207030200FFFFFF\n");
    let (frames, _) =
        canspec_with(TRANSPORT, &[&to("everybody")[..], &battery, &["year=2022", "month=4"]].concat(), "");
    assert_eq!(frames, "1CECFFF4#200E0002FF000200\n1CEBFFF4#0141434D45A00F08\n1CEBFFF4#02070302002504FF\n");
    let (frames, _) = canspec_with(TRANSPORT, &[&to("everybody")[..], &battery, &["month=4"]].concat(), "");
    assert_eq!(frames.lines().last(), Some("1CEBFFF4#02070302002504FF"), "2022 is the year's default");
    let few = ["encode", "--kind", "report", "--to", "peer", "cells", "voltage=4.01V,4.02V", "group=0,1"];
    assert_eq!(canspec_with(OR_FRAME, &few, "").0, "181556F4#91019211\n");
    let beyond = ["encode", "profile", "current=10A,20A,250.1A,0A,0A"];
    let (frames, complaints) = canspec_with(TRANSPORT, &beyond, "");
    assert_eq!(
        (frames.as_str(), complaints.as_str()),
        ("", "canspec: profile.current_3: 250.1 A is outside 0..250 A\n")
    );
}

#[test]
fn a_fast_packet_is_whole_where_its_length_says_and_never_joined_to_another_one() {
    // Two parts of four cells, a length of no message, a part that is lost, and a part of the next message.
    let log = "\
        (1.0) can0 19FF0123#200901E40CE50CE6\n\
        (1.1) can0 19FF0123#210CE70CFFFFFFFF\n\
        (1.2) can0 19FF0123#400401E40CE50CE6\n\
        (1.3) can0 19FF0123#600901E40CE50CE6\n\
        (1.4) can0 19FF0123#8101E40CE50CE6FF\n";
    let (out, _) = canspec_with(PACKETS, &["decode", "--assemble", "--format", "jsonl", "-"], log);
    let objects = out.lines().map(|line| serde_json::from_str(line).expect("a line is an object"));
    let wholes: Vec<Value> = objects.filter(|line: &Value| line.get("lines").is_some()).collect();
    let said: Vec<_> = wholes.iter().map(|whole| (&whole["lines"], &whole["incomplete"])).collect();
    let never = "4 bytes announced, but the message has 3, 5, ... 33";
    assert_eq!(
        said,
        [
            (&json!([1, 2]), &Value::Null),
            (&json!([3]), &json!(never)),
            (&json!([4]), &json!("part 1 is missing")),
            (&json!([5]), &json!("part 0 is missing")),
        ]
    );
    assert_eq!((&wholes[0]["data"], &wholes[0]["selectors"]), (&json!("01E40CE50CE60CE70C"), &json!({"counter": 1})));
    assert_eq!(wholes[0]["signals"]["voltage"]["raw"], json!([3300, 3301, 3302, 3303]));
    let (frames, _) = canspec_with(PACKETS, &["encode", "--from", "jsonl"], &wholes[0].to_string());
    assert_eq!(frames, "(1.1) can0 19FF0123#200901E40CE50CE6\n(1.1) can0 19FF0123#210CE70CFFFFFFFF\n");
}

#[test]
fn what_fills_up_a_fast_packet_is_noted_unless_it_is_as_it_is_sent() {
    // Behind the last cell the document wants FF.
    let log = "(1.0) can0 19FF0123#000501E40CE50C00\n(1.1) can0 19FF0123#200501E40CE50CFF\n";
    let (out, _) = canspec_with(PACKETS, &["decode", "--assemble", "--format", "jsonl", "-"], log);
    let objects = out.lines().map(|line| serde_json::from_str(line).expect("a line is an object"));
    let wholes: Vec<Value> = objects.filter(|line: &Value| line.get("lines").is_some()).collect();
    let notes: Vec<_> = wholes.iter().map(|whole| &whole["notes"]).collect();
    let text = "bytes behind the end of the message are not all 0xFF";
    assert_eq!(notes, [&json!([{"rule": "reserved_bit", "text": text}]), &json!([])]);
}

#[test]
fn silence_by_the_stamps_of_a_log_ends_messages_the_oldest_first() {
    // Four motors, whose pause is 50 ms. The first one goes on in time, and another one speaks a second later.
    let log = "\
        (1.000) can0 211#010005000A000F00\n\
        (1.010) can0 212#010005000A000F00\n\
        (1.020) can0 213#010005000A000F00\n\
        (1.030) can0 214#010005000A000F00\n\
        (1.040) can0 211#0200140019001E00\n\
        (2.000) can0 215#010005000A000F00\n\
        (2.049) can0 215#0200140019001E00\n\
        (2.099) can0 215#010005000A000F00\n";
    let (out, _) = canspec_with("parts_until_silence.yaml", &["decode", "--assemble", "--format", "jsonl", "-"], log);
    let objects = out.lines().map(|line| serde_json::from_str(line).expect("a line is an object"));
    let wholes: Vec<Value> = objects.filter(|line: &Value| line.get("lines").is_some()).collect();
    let said: Vec<_> = wholes.iter().map(|whole| (&whole["lines"], &whole["incomplete"])).collect();
    let lines = [json!([1, 5]), json!([2]), json!([3]), json!([4]), json!([6, 7]), json!([8])];
    assert_eq!(said, lines.each_ref().map(|lines| (lines, &Value::Null)));
    assert_eq!(wholes[4]["signals"]["trip"]["value"], json!([5, 10, 15, 20, 25, 30]));
}

#[test]
fn fast_packets_are_not_joined_beyond_their_silence() {
    // 3000 is 0x0BB8, so this is what an engine prints in the feature. The silence is 750 ms.
    let log = |pause: &str| {
        format!(
            "(1.000) can0 19F20123#A00E00B80BE78B8C\n\
             (1.010) can0 19F20123#A10580EE3600FF2D\n\
             ({pause}) can0 19F20123#A27FFFFFFFFFFFFF\n"
        )
    };
    let wholes = |pause| {
        let call = ["decode", "--assemble", "--format", "jsonl", "-"];
        let (out, _) = canspec_with("fast_packets.yaml", &call, &log(pause));
        let objects = out.lines().map(|line| serde_json::from_str(line).expect("a line is an object"));
        let wholes = objects.filter(|line: &Value| line.get("lines").is_some());
        wholes.map(|whole| (whole["lines"].clone(), whole["incomplete"].clone())).collect::<Vec<_>>()
    };
    assert_eq!(wholes("1.759"), [(json!([1, 2, 3]), Value::Null)]);
    let late = [(json!([1, 2]), json!("part 2 is missing")), (json!([3]), json!("the parts 0, 1 are missing"))];
    assert_eq!(wholes("1.760"), late);
    assert_eq!(wholes("3601.010"), late);
}

#[test]
fn fields_that_are_called_like_those_of_a_part_are_given_by_name() {
    let call = ["encode", "label", "part=1", "data=22 °C", "text=Oven ready", "counter=2"];
    let (out, _) = canspec_with("parts_of_controller.yaml", &call, "");
    assert_eq!(out, "0EF#400D0100DC4F7665\n0EF#416E207265616479\n");
}

/// Decodes frames of a battery of Daly, and returns the objects of whole messages.
fn daly(model: &str, log: &[&str]) -> Vec<Value> {
    let call = ["decode", "--assemble", "--model", model, "--format", "jsonl", "-"];
    let (out, _) = canspec_with("../../../specs/daly.yaml", &call, &log.join("\n"));
    let objects = out.lines().map(|line| serde_json::from_str(line).expect("a line is an object"));
    objects.filter(|line: &Value| line.get("lines").is_some()).collect()
}

#[test]
fn the_cells_of_a_battery_are_one_list_as_its_model_numbers_the_frames() {
    // The blocks M2 and M3 of the document, with the numbers of cells that it says.
    let thirteen = [
        "18944001#0D00000000000000",
        "18954001#000CE50CE30CE900",
        "18954001#010CE20CEE0CEB00",
        "18954001#020CE00CE60CE800",
        "18954001#030CE40CDF0CEC00",
        "18954001#040CE70000000000",
    ];
    let [whole] = &daly("FRAMES_FROM_0", &thirteen)[..] else { panic!("one message") };
    let cells = json!([3.301, 3.299, 3.305, 3.298, 3.31, 3.307, 3.296, 3.302, 3.304, 3.3, 3.295, 3.308, 3.303]);
    assert_eq!((&whole["signals"]["voltage"]["value"], &whole["notes"]), (&cells, &json!([])));
    let seven = [
        "18944001#0700000000000000",
        "18954001#0110061002100900",
        "18954001#0210031005100100",
        "18954001#0310040000000000",
    ];
    let [whole] = &daly("FRAMES_FROM_1", &seven)[..] else { panic!("one message") };
    assert_eq!(whole["signals"]["voltage"]["value"], json!([4.102, 4.098, 4.105, 4.099, 4.101, 4.097, 4.1]));
    // A battery that counts from 0 would send frame 0 before frame 1.
    assert_eq!(daly("FRAMES_FROM_0", &seven)[0]["incomplete"], "part 0 is missing");
    // Block M4: ten temperatures, the second one of 0x41 less 40.
    let ten = ["18944001#000A000000000000", "18964001#0040413F26284742", "18964001#01433E0000000000"];
    let [whole] = &daly("FRAMES_FROM_0", &ten)[..] else { panic!("one message") };
    assert_eq!(
        whole["signals"]["temperature"]["value"],
        json!([24.0, 25.0, 23.0, -2.0, 0.0, 31.0, 26.0, 27.0, 22.0, -40.0])
    );
}

#[test]
fn cells_that_nobody_has_counted_are_shown_with_the_last_frame_that_there_can_be() {
    let frames: Vec<_> = (0..16).map(|part| format!("18954001#{part:02X}0CF00CFD0D1300")).collect();
    let frames: Vec<_> = frames.iter().map(String::as_str).collect();
    let [whole] = &daly("FRAMES_FROM_0", &frames)[..] else { panic!("one message") };
    assert_eq!(whole["signals"]["voltage"]["raw"].as_array().map(Vec::len), Some(48));
    assert_eq!(whole["notes"][0]["rule"], "count");
    assert_eq!(whole["lines"].as_array().map(Vec::len), Some(16));
}

#[test]
fn limits_of_fields_hold_before_the_first_part_is_printed() {
    let call = |values: &[&str]| {
        let call = [&["encode", "set", "program", "--to", "oven:3", "hold=10"], values].concat();
        canspec_with("parts_to_modules.yaml", &call, "")
    };
    assert_eq!(call(&["temperature=180,200,210"]).0, "0A3#010A070807D00800\n0A3#0234000000000000\n");
    let (out, refused) = call(&["temperature=180,200,301"]);
    assert!(out.is_empty() && refused.contains("temperature_3: 301 °C is outside 20..300 °C"), "{refused}");
    let (out, refused) = call(&["temperature=180,200,251", "--model", "OV1"]);
    assert!(out.is_empty() && refused.contains("251 °C is outside 30..250 °C"), "{refused}");
    let (out, refused) = call(&["part=1", "data=0A070807D008"]);
    assert!(out.is_empty() && refused.contains("there is no signal"), "{refused}");
}

#[test]
fn what_fills_up_the_last_part_of_a_request_is_made_again_although_it_is_outside_the_limits() {
    let request = ["0A3#010A070807D00800", "0A3#0234000000000000"];
    let whole = |log: &str| {
        let call = ["decode", "--assemble", "--format", "jsonl", "-"];
        let (out, _) = canspec_with("parts_to_modules.yaml", &call, log);
        out.lines().filter(|line| line.contains("\"lines\"")).map(str::to_owned).collect::<String>()
    };
    let again = |line: &str| canspec_with("parts_to_modules.yaml", &["encode", "--from", "jsonl", "-"], line);
    let line = whole(&request.join("\n"));
    let object: Value = serde_json::from_str(&line).expect("a line is an object");
    assert_eq!(object["signals"]["temperature"]["raw"], json!([1800, 2000, 2100, 0, 0]));
    assert_eq!(again(&line).0.split_whitespace().collect::<Vec<_>>(), request);
    // A temperature before others is none that fills up, and neither is one that has some bits.
    for cold in ["0A3#0234000007080000", "0A3#0234000100000000"] {
        let (out, refused) = again(&whole(&[request[0], cold].join("\n")));
        assert!(out.is_empty() && refused.contains("outside 20..300 °C"), "{out}{refused}");
    }
}

#[test]
fn the_lines_of_a_message_whose_packets_came_again_are_in_their_order() {
    // The second packet comes first. The receiver lets both come from the first one on.
    let lines: Vec<_> = TRANSFER.lines().collect();
    let log = [lines[0], lines[4], lines[1], "(1.6) can0 1CEB56F4#0141434D45A00F08"].join("\n");
    let (out, _) = canspec_with(TRANSPORT, &["decode", "--assemble", "--format", "jsonl", "-"], &log);
    let whole: Value = serde_json::from_str(out.lines().last().expect("a message")).expect("a line is an object");
    assert_eq!((&whole["lines"], &whole["time"]), (&json!([1, 2, 4]), &json!(1.6)));
}

#[test]
fn a_summary_counts_the_messages_that_came_whole_and_those_that_did_not() {
    let cut = LOG.lines().take(3).collect::<Vec<_>>().join("\n");
    let log = format!("{LOG}{cut}\n");
    let (out, _) = canspec(&["decode", "--summary", "--assemble", "--format", "jsonl", "-"], &log);
    let objects: Vec<Value> = out.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    let wholes: Vec<_> = objects.iter().filter(|object| object["summary"] == "whole").collect();
    let [whole] = wholes.as_slice() else { panic!("one kind of message: {out}") };
    assert_eq!((&whole["messages"], &whole["incomplete"]), (&json!(1), &json!(1)), "{whole}");
    assert_eq!(objects[0]["frames"], 7, "they are no frames");
    let (out, _) = canspec(&["decode", "--summary", "--format", "jsonl", "-"], &log);
    assert!(!out.contains("whole"), "{out}");
    let (out, _) = canspec(&["decode", "--summary", "-"], &log);
    assert!(out.contains("LONG MESSAGE"), "{out}");
}
