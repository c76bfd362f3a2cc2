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
    assert_eq!(count, 6);
}
