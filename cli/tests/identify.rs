//! The logs of known devices are told by their frames.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

#[test]
fn each_session_is_known_by_its_own_protocol() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/logs");
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("the folder exists").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        // That protocol is not built in.
        let Some((protocol, _)) = name.split_once('-').filter(|(protocol, _)| *protocol != "sixth") else { continue };
        if entry.path().extension().is_none_or(|ending| ending != "log") {
            continue;
        }
        let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
        let output = canspec.args(["identify", "--format", "jsonl"]).arg(entry.path()).output().expect("it starts");
        let text = String::from_utf8(output.stdout).expect("JSON is text");
        let found: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("it is JSON")).collect();
        assert_eq!(found[0]["protocol"], protocol, "{text}");
        assert!(found[0]["share"].as_f64().is_some_and(|share| share > 0.8), "{text}");
        count += 1;
    }
    assert_eq!(count, 10);
}

#[test]
fn frames_that_two_protocols_share_count_as_alone_for_neither() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/logs");
    let session = |name: &str| fs::read(folder.join(format!("{name}-session.log"))).expect("the log can be read");
    let joined = tempfile::tempdir().expect("there is a folder for temporary files");
    let log = joined.path().join("bus.log");
    fs::write(&log, ["infy", "mxr", "megmeet"].map(session).concat()).expect("the folder can be written");
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let output = canspec.args(["identify", "--format", "jsonl"]).arg(&log).output().expect("it starts");
    let text = String::from_utf8(output.stdout).expect("JSON is text");
    let counts = |name: &str| {
        let objects = text.lines().map(|line| serde_json::from_str::<Value>(line).expect("it is JSON"));
        let object = objects.into_iter().find(|object| object["protocol"] == name).expect("it recognises frames");
        ["recognised", "alone"].map(|member| object[member].as_u64().expect("a number"))
    };
    let ([infy, infy_alone], [gcp, gcp_alone], [mxr, mxr_alone]) = (counts("infy"), counts("gcp"), counts("mxr"));
    // GCP is INFY's protocol with other commands, and no frame of the log is one of those.
    assert_eq!((infy_alone, gcp_alone, mxr_alone), (infy - gcp, 0, mxr));
    assert!(infy_alone > 0 && gcp > 0 && mxr > 0, "{text}");
}

#[test]
fn protocols_that_fit_equally_well_are_told_apart_by_what_they_read() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let log = folder.path().join("bus.log");
    let said = |frames: &[&str]| {
        fs::write(&log, frames.join("\n")).expect("the folder can be written");
        let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
        let output = canspec.arg("identify").arg(&log).output().expect("it starts");
        String::from_utf8(output.stdout).expect("it is text")
    };
    let shared = "0283F000#43FA000040600000";
    let equal = said(&[shared, shared]);
    assert!(equal.contains("infy reads the same messages, values and addresses as gcp in this log"), "{equal}");
    // PHOENIX CONTACT's document has an interval beside the switch for walk-in mode, INFY's has none.
    let different = said(&[shared, "029300F0#0000000000000000", shared, "02933FF0#0100000000000000"]);
    assert!(
        different.contains("infy reads 2 frames unlike gcp, the first in line 2, with other values"),
        "{different}"
    );
    assert!(!different.contains("same messages"), "{different}");
}

#[test]
fn protocols_that_differ_in_addresses_alone_are_told_apart_by_them() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    // The second one counts its shelves from 0.
    for (name, offset) in [("shelf", 0), ("rack", -1)] {
        let spec = format!(
            "canspec: 1\nprotocol: {name}\ntitle: Modules\ndocument: {{title: Made up, version: \"1\"}}\nlength: 2\n\
             identifier: {{to_host: {{bits: 10}}, place: {{bits: 9..0}}}}\n\
             types: {{{name}: {{range: {}..9, offset: {offset}}}}}\n\
             addressing: {{single: {{request: {{to_host: 0, place: {name}}}, one: {{to_host: 1, place: {name}}}}}}}\n\
             access: {{read: {{request: {{}}, reply: {{}}, in: [reply], answers: {{single: one}}}}}}\n\
             messages: {{heat: {{section: \"2\", access: [read], fields: {{heat: {{bytes: 0..1, unit: V}}}}}}}}\n",
            1 + offset
        );
        fs::write(folder.path().join(format!("{name}.yaml")), spec).expect("the folder can be written");
    }
    fs::write(folder.path().join("bus.log"), "402#0019\n403#0019\n").expect("the folder can be written");
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let call = ["identify", "--spec", "shelf.yaml", "--spec", "rack.yaml", "bus.log"];
    let output = canspec.args(call).current_dir(folder.path()).output().expect("it starts");
    let text = String::from_utf8(output.stdout).expect("it is text");
    assert!(text.contains("rack reads 2 frames unlike shelf, the first in line 1, with other addresses"), "{text}");
}
