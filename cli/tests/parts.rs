//! A long file is decoded in parts, on all cores. Standard input is decoded line by line, and must give the same.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Bytes of a part, and how many parts a log has at least.
const PART: usize = 1 << 18;
const PARTS: usize = 3;
/// Lines of such a log, which have at least 30 bytes.
const LINES: usize = PARTS * PART / 30;

fn run(format: &str, log: &Path, input: Stdio) -> Output {
    let arguments = ["decode", "--protocol", "infy", "--format", format];
    let command = Command::new(env!("CARGO_BIN_EXE_canspec")).args(arguments).arg(log).stdin(input).output();
    command.expect("canspec runs")
}

/// Decodes a log as a file and as standard input, and compares.
fn compare(lines: &[String]) {
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join("bus.log");
    let log = lines.join("\n");
    assert!(log.len() > PARTS * PART, "{} bytes", log.len());
    fs::write(&path, log).expect("there is room");
    for format in ["text", "jsonl", "csv"] {
        let file = run(format, &path, Stdio::null());
        let input = run(format, Path::new("-"), File::open(&path).expect("it is there").into());
        assert_eq!(file.status.code(), input.status.code(), "{format}");
        assert!(file.stdout == input.stdout, "{format} differs");
        let complaints = String::from_utf8(input.stderr).expect("it is text");
        let complaints = complaints.replace("<stdin>", &path.display().to_string());
        assert_eq!(String::from_utf8(file.stderr).as_ref(), Ok(&complaints), "{format}");
        assert!(!input.stdout.is_empty(), "{format}");
    }
}

/// Returns lines of a log with a frame each.
fn lines(line: impl Fn(usize, &str, u8) -> String) -> Vec<String> {
    let frame = |index: usize| (format!("0283F0{:02X}", index % 0x3C), u8::try_from(index % 256).unwrap_or(0));
    (0..LINES).map(|index| (index, frame(index))).map(|(index, (id, byte))| line(index, &id, byte)).collect()
}

fn compact(index: usize, id: &str, byte: u8) -> String {
    format!("({}.{:06}) can0 {id}#43{byte:02X}000041200000", index / 1000, index % 1000)
}

#[test]
fn a_long_log_gives_the_same_from_a_file_as_from_standard_input() {
    compare(&lines(compact));
}

#[test]
fn unreadable_lines_and_cells_that_widen_columns_change_nothing() {
    let mut lines = lines(compact);
    for place in [LINES / 2, LINES / 3, LINES - 5] {
        lines[place] = "(1.5) can0 nonsense".to_owned();
        lines[place + 2] = String::new();
        lines[place + 3] = format!("(1.5) a_wider_channel_{place} 0283F001#4380000041200000");
    }
    compare(&lines);
}

#[test]
fn the_format_may_change_within_a_long_log() {
    let mut lines = lines(|index, id, byte| match index * 4 / LINES {
        0 => compact(index, id, byte),
        1 => format!("  can0  {id}   [8]  43 {byte:02X} 00 00 41 20 00 00"),
        2 => format!("T{id}843{byte:02X}000041200000"),
        _ => format!("{index},{id},true,43{byte:02X}000041200000"),
    });
    let heading = lines.iter().position(|line| line.contains(',')).expect("the last quarter is a table");
    lines.insert(heading, "time,id,extended,data".to_owned());
    compare(&lines);
}

#[test]
fn a_long_table_in_csv_is_read_by_its_heading() {
    let mut lines = lines(|index, id, byte| format!("43{byte:02X}000041200000,0x{id},can0,{index}"));
    lines.insert(0, "data,id,channel,time".to_owned());
    compare(&lines);
}
