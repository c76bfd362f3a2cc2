//! Who waits at a terminal sees how far a long log is read; pipes and files have none of it.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

/// Lines of a log that is long enough.
const LINES: usize = 12_000;

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let line = "(1700000000.000000) can0 0283F000#43FA000040600000\n";
    fs::write(folder.path().join("bus.log"), line.repeat(LINES)).expect("the folder can be written");
    folder
}

/// Runs a shell's call of the command at a terminal, and returns what the terminal shows.
fn at_a_terminal(folder: &Path, arguments: &str) -> String {
    let call = format!("'{}' {arguments}", env!("CARGO_BIN_EXE_canspec"));
    let output =
        Command::new("script").args(["-qec", &call, "/dev/null"]).current_dir(folder).stdin(Stdio::null()).output();
    String::from_utf8(output.expect("every Linux has `script`").stdout).expect("it is text")
}

#[test]
fn progress_is_shown_on_a_terminal_alone() {
    let folder = folder();
    let shown = at_a_terminal(folder.path(), "decode --protocol infy --format jsonl bus.log >/dev/null");
    assert!(shown.contains(" % read\r") && shown.ends_with(" \r"), "{shown:?}");
    let shown = at_a_terminal(folder.path(), "decode --protocol infy --summary bus.log");
    assert!(shown.contains(" % read\r") && shown.contains("12000 frames, 12000 recognised"), "{shown:?}");
    let shown = at_a_terminal(folder.path(), "decode --protocol infy --summary bus.log 2>told");
    assert!(shown.contains("12000 frames") && !shown.contains("% read"), "{shown:?}");
    assert_eq!(fs::read_to_string(folder.path().join("told")).expect("the shell made it"), "");
}

#[test]
fn rows_on_a_terminal_are_not_disturbed() {
    let shown = at_a_terminal(folder().path(), "decode --protocol infy bus.log");
    assert!(shown.lines().count() == LINES + 1 && !shown.contains("% read"));
}
