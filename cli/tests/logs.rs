//! Logs of other programs: whichever program wrote a log, its frames are the same.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/logs")
}

fn canspec(arguments: &[&str]) -> Output {
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    canspec.args(arguments).current_dir(folder()).stdin(Stdio::null()).output().expect("the command starts")
}

/// A frame of a log: seconds since the first one, identifier, data, form.
type Frame = (u64, String, String, String);

/// Returns microseconds as whole numbers, which do not depend on how a program rounds.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the logs begin at 0 or in 2023")]
fn microseconds(seconds: f64) -> u64 {
    (seconds * 1e6).round() as u64
}

/// Returns the frames that python-can reads, but for those of one form.
fn expected(without: &str) -> Vec<Frame> {
    let table = fs::read_to_string(folder().join("bus.expected.tsv")).expect("the table can be read");
    let rows = table.lines().filter(|line| !line.starts_with('#'));
    let frames = rows.map(|row| {
        let cells: Vec<&str> = row.split('\t').collect();
        let text = |index: usize| cells[index].replace('-', "");
        (microseconds(cells[0].parse().expect("a number")), text(1), text(2), text(3))
    });
    frames.filter(|(.., form)| form != without).collect()
}

/// Returns the frames that the command finds.
fn found(log: &str) -> Vec<Frame> {
    let output = canspec(&["decode", "--protocol", "infy", "--format", "jsonl", log]);
    assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{log}");
    let text = String::from_utf8(output.stdout).expect("JSON is text");
    let objects: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("it is JSON")).collect();
    let time = |object: &Value| microseconds(object["time"].as_f64().expect("every line has a stamp"));
    let start = time(&objects[0]);
    objects
        .iter()
        .map(|object| {
            let text = |name: &str| object[name].as_str().unwrap_or_default().to_owned();
            let form = form(object["problem"]["text"].as_str().unwrap_or_default());
            // The programs do not agree on what an error frame holds.
            let [id, data] = if form == "error" { Default::default() } else { [text("id"), text("data")] };
            (time(object) - start, id, data, form.to_owned())
        })
        .collect()
}

fn form(problem: &str) -> &'static str {
    match problem {
        "a remote frame carries no data" => "remote",
        "an error frame" => "error",
        "a CAN FD frame" => "fd",
        _ => "data",
    }
}

#[test]
fn logs_that_python_can_wrote_have_the_frames_that_python_can_reads() {
    assert_eq!(found("bus.asc"), expected(""));
    assert_eq!(found("bus.log"), expected(""));
    assert_eq!(found("bus.csv"), expected("fd"));
}

#[test]
fn a_trace_that_python_can_wrote_has_the_data_frames() {
    let expected: Vec<Frame> = expected("fd").into_iter().filter(|(.., form)| form == "data").collect();
    assert_eq!(found("bus.trc"), expected);
}

#[test]
fn plain_lines_of_candump_have_the_frames_of_its_logs() {
    assert_eq!(found("bus.plain"), expected(""));
}

#[test]
fn lines_of_slcan_have_the_frames_that_it_can_say() {
    let expected: Vec<Frame> = expected("fd").into_iter().filter(|(.., form)| form != "error").collect();
    // The stamps are whole milliseconds.
    let expected = expected.into_iter().map(|(time, id, data, form)| (time / 1000 * 1000, id, data, form));
    assert_eq!(found("bus.slcan"), expected.collect::<Vec<_>>());
}

#[test]
fn frames_as_cansend_takes_them_and_people_write_them_are_read() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let log = folder.path().join("frames");
    let forms = ["0x0283F000#43FA000040600000", "0283F000#43.FA.00.00.40.60.00.00", "0283F000#43 FA 00 00 40 60 00 00"];
    fs::write(&log, forms.join("\n")).expect("the folder can be written");
    let output = canspec(&["decode", "--protocol", "infy", &log.to_string_lossy()]);
    let table = String::from_utf8(output.stdout).expect("the table is text");
    // 0x43FA0000 and 0x40600000 are 500 and 3.5 in IEEE 754.
    let shown = table.lines().filter(|line| line.contains("voltage 500.0 V  current 3.5 A")).count();
    assert_eq!((shown, output.status.code()), (3, Some(0)), "{table}");
}

#[test]
fn a_capture_is_the_same_whichever_program_wrote_the_log() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let capture = |log: &str| {
        // Plain lines do not say what the flags of an FD frame are. One error frame is not in both logs.
        let text = fs::read_to_string(self::folder().join(log)).expect("the log can be read");
        let lines =
            text.lines().filter(|line| !["20000004", "20000080", "18FF50E5"].iter().any(|id| line.contains(id)));
        // The log of python-can does not say how many bytes a remote frame asks for.
        let lines = lines.map(|line| line.replace("[5]  remote", "[0]  remote") + "\n");
        let (lines, out) = (lines.collect::<String>(), folder.path().join("out"));
        fs::write(folder.path().join(log), lines).expect("the folder can be written");
        let log = folder.path().join(log);
        let output = canspec(&["decode", "--to", "pcapng", &out.to_string_lossy(), &log.to_string_lossy()]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(out).expect("the capture can be read")
    };
    assert_eq!(capture("bus.plain"), capture("bus.log"));
}

#[test]
fn a_log_of_no_known_format_is_answered_with_the_known_ones() {
    let output = canspec(&["decode", "--protocol", "infy", "../logs.rs"]);
    let told = String::from_utf8(output.stderr).expect("it is text");
    assert_eq!(output.status.code(), Some(1));
    let first = told.lines().next().unwrap_or_default();
    let start = "canspec: ../logs.rs: 100 lines cannot be read, and no frame comes before them; the first: \
                 `//! Logs of other programs: whichever pr...` is of no known log; known are candump (";
    assert!(first.starts_with(start), "{first}");
    assert_eq!(told.lines().count(), 1, "{told}");
    for name in ["SLCAN", "Vector ASC", "TRC", "CSV"] {
        assert!(first.contains(name), "{name} in {first}");
    }
}

#[test]
fn a_file_without_lines_is_refused_once_with_what_makes_lines_of_it() {
    // From RFC 1952, RFC 8878, the format of xz, APPNOTE 6.3, python-can, ASAM MDF, draft-ietf-opsawg-pcap and -pcapng.
    let kinds: [(&[u8], &str, &str); 13] = [
        (b"SQLite format 3\0", "SQLite", "can_logconvert"),
        (b"***BUSMASTER Ver 3.2.2***", "BUSMASTER", "SavvyCAN"),
        (b"\x1f\x8b\x08", "gzip", "zcat"),
        (b"\x28\xb5\x2f\xfd", "zstd", "zstdcat"),
        (b"\xfd7zXZ\x00", "xz", "xzcat"),
        (b"BZh9", "bzip2", "bzcat"),
        (b"PK\x03\x04", "ZIP", "unzip"),
        (b"LOGG", "BLF", "can_logconvert"),
        (b"MDF     4.10", "MDF", "can_logconvert"),
        (b"\x0a\x0d\x0d\x0a", "pcapng", "tshark"),
        (b"\xd4\xc3\xb2\xa1", "pcap", "tshark"),
        (b"\xa1\xb2\x3c\x4d", "pcap", "tshark"),
        (b"\xff\xfe(\x001\x00", "UTF-16", "iconv"),
    ];
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let path = folder.path().join("bus");
    let file = path.to_string_lossy();
    let calls: [&[&str]; 4] = [
        &["decode", "--protocol", "infy", &file],
        &["decode", "--to", "pcapng", "/dev/null", &file],
        &["identify", &file],
        &["encode", "--protocol", "infy", "--from", "jsonl", &file],
    ];
    for (start, name, program) in kinds {
        // The second file is one of several parts.
        for length in [9, 300_000] {
            fs::write(&path, [start, &b"\n\x80\x00"[..].repeat(length)].concat()).expect("the folder can be written");
            for call in calls {
                let output = canspec(call);
                let said = String::from_utf8_lossy(&output.stderr);
                assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{name}: {said}");
                assert!(said.contains("bus: the file is ") && said.contains(name) && said.contains(program), "{said}");
                assert!(output.stdout.is_empty(), "{name}");
                // What is said holds for each command.
                assert!(!said.contains("canspec decode --protocol"), "{said}");
            }
        }
    }
}

/// Calls canspec with a text on standard input, and returns its status, output and complaints.
fn canspec_of(arguments: &[&str], input: &str) -> (Option<i32>, String, String) {
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let canspec = canspec.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = canspec.spawn().expect("the command starts");
    let mut stdin = child.stdin.take().expect("standard input is a pipe");
    // What refuses the input does not read all of it.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().expect("the command ends");
    let [out, told] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("it is text"));
    (output.status.code(), out, told)
}

#[test]
fn what_is_no_log_is_refused_once_however_long_it_is() {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let crtd = "1542473901.020305 1R29 0283F000 43 FA 00 00 40 60 00 00\n";
    for (line, name) in [("hello\n", "100 lines cannot be read"), (crtd, "the file is a log in CRTD; SavvyCAN")] {
        let text = line.repeat(300_000);
        let path = folder.path().join("bus.log");
        fs::write(&path, &text).expect("the folder can be written");
        let file = path.to_string_lossy();
        let calls: [&[&str]; 4] = [
            &["decode", "--protocol", "infy"],
            &["decode", "--protocol", "infy", "--summary"],
            &["decode", "--to", "pcapng", "/dev/null"],
            &["identify"],
        ];
        for call in calls {
            let output = canspec(&[call, &[&file]].concat());
            let of_file = (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned());
            let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
            let (status, out, told) = canspec_of(&[call, &["-"]].concat(), &text);
            for (status, out, told) in [(of_file.0, of_file.1, complaint), (status, out, told)] {
                assert_eq!((status, told.lines().count(), out.as_str()), (Some(1), 1, ""), "{call:?}: {told}");
                assert!(told.contains(name), "{told}");
            }
        }
    }
}

#[test]
fn each_unreadable_line_of_a_log_is_reported() {
    let log = format!("{}(1.0) can0 0283F000#43FA000040600000\n{}", "hello\n".repeat(99), "hello\n".repeat(1000));
    let (status, out, told) = canspec_of(&["decode", "--protocol", "infy", "--format", "jsonl", "-"], &log);
    assert_eq!((status, out.lines().count(), told.lines().count()), (Some(1), 1, 1099));
}

#[test]
fn a_live_log_shows_each_line_as_it_comes() {
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let canspec = canspec.args(["decode", "--protocol", "infy", "--format", "jsonl"]).stdin(Stdio::piped());
    let mut child = canspec.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts");
    let mut stdin = child.stdin.take().expect("standard input is a pipe");
    let mut stdout = BufReader::new(child.stdout.take().expect("standard output is a pipe"));
    let mut stderr = BufReader::new(child.stderr.take().expect("standard error is a pipe"));
    // Whatever is read has been written while the input is open.
    for number in [1, 3, 5] {
        let mut line = String::new();
        stdin.write_all(b"hello\n").expect("the command reads");
        stderr.read_line(&mut line).expect("it is text");
        assert!(line.starts_with(&format!("<stdin>:{number}: ")), "{line}");
        line.clear();
        stdin.write_all(b"(1.0) can0 0283F000#43FA000040600000\n").expect("the command reads");
        stdout.read_line(&mut line).expect("it is text");
        assert!(line.starts_with(&format!("{{\"line\":{},", number + 1)), "{line}");
    }
    drop(stdin);
    assert_eq!(child.wait().expect("the command ends").code(), Some(1));
}

#[test]
fn comments_and_lost_frames_are_no_errors_and_a_summary_counts_them() {
    // As candump prints lost frames.
    let dropped = "DROPCOUNT: dropped 5 CAN frames on 'can0' socket (total drops 12)";
    let log = format!("# a comment\n{dropped}\n(1.0) can0 0283F000#43FA000040600000\n{dropped}\n#another\n");
    let (status, out, told) = canspec_of(&["decode", "--protocol", "infy", "--format", "jsonl", "-"], &log);
    assert_eq!((status, out.lines().count(), told.as_str()), (Some(0), 1, ""));
    let summary = ["decode", "--protocol", "infy", "--summary", "-"];
    let (status, out, told) = canspec_of(&[&summary[..], &["--format", "jsonl"]].concat(), &log);
    assert_eq!((status, told.as_str()), (Some(0), ""));
    let counts = ["{\"summary\":\"dropped\",\"frames\":10,\"lines\":2}", "{\"summary\":\"comments\",\"lines\":2}"];
    assert_eq!(out.lines().skip(2).collect::<Vec<_>>(), counts, "{out}");
    let (_, out, _) = canspec_of(&summary, &log);
    assert!(out.contains("\n10 frames lost by candump, in 2 lines\n2 comments\n"), "{out}");
}

#[test]
fn rows_stand_below_one_another_however_wide_their_stamps_and_channels_are() {
    let frame = "0283F000#43FA000040600000";
    let log =
        format!("(1.5) a {frame}\n(123456.25) can0 {frame}\n(7) a_longer_channel {frame}\n(8.123456) a {frame}\n");
    let (_, table, _) = canspec_of(&["decode", "--protocol", "infy", "-"], &log);
    let places: Vec<_> = table.lines().skip(1).map(|row| row.find("0283F000")).collect();
    assert_eq!(places, [Some("123456.25  a_longer_channel  ".len()); 4], "{table}");
}
