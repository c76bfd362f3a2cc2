//! Who presses Ctrl-C on a live bus sees what was counted by then.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Command, Stdio};

/// Two frames, a line that is complained about at once, and the beginning of a third frame.
const LINES: &str = "(1.0) can0 0283F000#43FA000040600000\n(2.0) can0 028300F0#0000000000000000\n\
                     (2.5) can0\n(3.0) can0 0283F000#43FA00";

/// Sends the lines and then Ctrl-C, and returns what the command writes.
fn interrupted(arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let command = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the command starts");
    // Its input stays open.
    let mut stdin = child.stdin.take().expect("standard input is a pipe");
    stdin.write_all(LINES.as_bytes()).expect("the command reads");
    let (mut complaint, mut shown) = (String::new(), String::new());
    let mut stderr = BufReader::new(child.stderr.take().expect("standard error is a pipe"));
    stderr.read_line(&mut complaint).expect("the command complains");
    assert!(complaint.starts_with("<stdin>:3: "), "{complaint}");
    let sent = Command::new("kill").args(["-s", "INT", &child.id().to_string()]).status();
    assert!(sent.expect("every Unix has it").success());
    let stdout = child.stdout.as_mut().expect("standard output is a pipe");
    stdout.read_to_string(&mut shown).expect("the output is UTF-8");
    (child.wait().expect("it was started").code(), shown)
}

#[test]
fn a_summary_shows_the_whole_lines_so_far() {
    let (status, shown) = interrupted(&["decode", "--protocol", "infy", "--summary"]);
    assert_eq!(status, Some(1), "the third line is unreadable");
    assert!(shown.starts_with("2 frames, 2 recognised, 2.00 a second in 1.000 s from 1.0 to 2.0\n"), "{shown}");
}

#[test]
fn the_counts_are_shown_if_the_input_ends_at_the_same_time() {
    for _ in 0..30 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
        let command = command.args(["decode", "--protocol", "infy", "--summary"]).stdin(Stdio::piped());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts");
        let mut stdin = child.stdin.take().expect("standard input is a pipe");
        stdin.write_all(LINES.as_bytes()).expect("the command reads");
        let mut stderr = BufReader::new(child.stderr.take().expect("standard error is a pipe"));
        stderr.read_line(&mut String::new()).expect("the command complains");
        let number = child.id().to_string();
        let kill = Command::new("kill").args(["-s", "INT", &number]).spawn();
        drop(stdin);
        let mut shown = String::new();
        child.stdout.as_mut().expect("a pipe").read_to_string(&mut shown).expect("the output is UTF-8");
        assert_eq!(child.wait().expect("it was started").code(), Some(1), "the third line is unreadable");
        assert!(kill.and_then(|mut kill| kill.wait()).is_ok(), "every Unix has it");
        // The end of the input ends its last line, too.
        assert!(shown.contains(" frames, 2 recognised, "), "{shown}");
    }
}

#[test]
fn identify_shows_the_protocols_so_far() {
    let (status, shown) = interrupted(&["identify", "--format", "jsonl", "-"]);
    assert_eq!(status, Some(1), "the third line is unreadable");
    let expected = r#"{"protocol":"infy","recognised":2,"share":1.0,"contradicted":0,"alone":0}"#;
    assert!(shown.lines().any(|line| line == expected), "{shown}");
}
