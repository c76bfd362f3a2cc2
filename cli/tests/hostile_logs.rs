//! Logs and DBC files that nobody meant well: nothing is lost without a word, and nothing grows beyond its input.
#![cfg(unix)]

use std::fs;
use std::io::Write;
use std::os::unix::ffi::OsStringExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use tempfile::TempDir;
use wait4::Wait4;

const FRAME: &str = "0283F000#43FA000040600000";

fn folder() -> TempDir {
    tempfile::tempdir().expect("there is a folder for temporary files")
}

fn canspec(folder: &Path, arguments: &[&str]) -> Output {
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    canspec.args(arguments).current_dir(folder).output().expect("the command starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("it is text")
}

/// Decodes a log to a table, and returns the output and the complaints.
fn decoded(log: &str) -> (String, String) {
    let folder = folder();
    fs::write(folder.path().join("bus.log"), log).expect("the folder can be written");
    let output = canspec(folder.path(), &["decode", "--protocol", "infy", "bus.log"]);
    (text(&output.stdout), text(&output.stderr))
}

/// Returns the processor time of a call, without that of the system, which hands out memory when it likes.
fn time(folder: &Path, arguments: &[&str]) -> Duration {
    let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
    canspec.args(arguments).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
    let used = canspec.spawn().and_then(|mut child| child.wait4()).expect("the command starts");
    used.rusage.utime
}

/// Tests that eight times as much takes less than 32 times as long: what is linear takes 8 times, and what is
/// quadratic 64 times. A busy machine has a second chance.
fn is_linear(write: impl Fn(&mut dyn Write, usize), file: &str, few: usize, arguments: &[&str]) {
    let times = || {
        [few, few * 8].map(|count| {
            let folder = folder();
            let mut out = Vec::new();
            write(&mut out, count);
            fs::write(folder.path().join(file), out).expect("the folder can be written");
            time(folder.path(), arguments)
        })
    };
    let is_linear = |[short, long]: [Duration; 2]| long < short * 32;
    let first = times();
    assert!(is_linear(first) || is_linear(times()), "{first:?}");
}

#[test]
fn a_long_channel_costs_its_line_alone() {
    let long = "x".repeat(60_000);
    let rows = format!("(2.0) can0 {FRAME}\n").repeat(1_000);
    let (shown, told) = decoded(&format!("(1.0) {long} {FRAME}\n{rows}"));
    assert!(shown.len() < 500_000, "{} bytes", shown.len());
    assert_eq!(shown.lines().count(), 1_001);
    let shown = "x".repeat(40);
    assert_eq!(told, format!("bus.log:1: the channel `{shown}...` has 60000 characters, more than 64\n"));
}

#[test]
fn a_long_stamp_costs_its_line_alone() {
    let (shown, told) = decoded(&format!("(1.{}) can0 {FRAME}\n(2) can0 {FRAME}\n", "0".repeat(60_000)));
    assert_eq!(shown.lines().count(), 2);
    let zeros = "0".repeat(37);
    assert_eq!(told, format!("bus.log:1: the stamp `(1.{zeros}...` has 60004 characters, more than 66\n"));
}

#[test]
fn an_input_without_decoded_lines_is_refused_once_and_a_bad_line_among_them_alone() {
    let encoded = |lines: &str| {
        let folder = folder();
        fs::write(folder.path().join("frames.jsonl"), lines).expect("the folder can be written");
        let output = canspec(folder.path(), &["encode", "--protocol", "infy", "--from", "jsonl", "frames.jsonl"]);
        assert_eq!(output.status.code(), Some(1));
        (text(&output.stdout), text(&output.stderr))
    };
    let (out, told) = encoded(&"(1.0) can0 0283F000#43FA000040600000\n".repeat(30_000));
    let why = "canspec: frames.jsonl: 100 lines cannot be read, and none before them can; the first: the line is no JSON \
               object: expected value (column 1); `--from jsonl` reads what `canspec decode --format jsonl` writes\n";
    assert_eq!((out.as_str(), told.as_str()), ("", why));
    let foreign = r#"{"message":null,"problem":{"kind":"foreign","text":"t"},"id":"123","data":"00"}"#;
    let (out, told) = encoded(&format!("{foreign}\n{}", "junk\n".repeat(300)));
    assert_eq!(out, "123#00\n");
    assert_eq!((told.lines().count(), told.starts_with("frames.jsonl:2: the line is no JSON object")), (300, true));
    // These lines can be read, and no message can be made of them.
    let unknown = foreign.replace("null", "\"x\",\"identifier\":{},\"selectors\":{},\"signals\":{}");
    let (_, told) = encoded(&format!("{unknown}\n").repeat(300));
    assert_eq!(told.lines().count(), 300, "{told}");
}

#[test]
fn a_byte_order_mark_costs_no_frame() {
    let (shown, told) = decoded(&format!("\u{FEFF}(1.0) can0 {FRAME}\n"));
    assert!(shown.contains("module_output"), "{shown}");
    assert_eq!(told, "");
}

#[test]
fn a_stamp_that_readers_of_json_take_for_infinite_is_refused() {
    let (_, told) = decoded(&format!("(1e400) can0 {FRAME}\n"));
    assert_eq!(told, "bus.log:1: the stamp `(1e400)` is larger than any number of JSON\n");
}

#[test]
fn a_channel_holds_no_characters_that_nobody_sees() {
    let (_, told) = decoded(&format!("(1) can\u{200B}\u{202E}0 {FRAME}\n"));
    assert!(told.starts_with("bus.log:1: the channel `can\\u{200b}\\u{202e}0` is no name; a name has"), "{told}");
}

#[test]
fn a_capture_of_many_channels_is_written_in_linear_time() {
    let write = |out: &mut dyn Write, count: usize| {
        for number in 0..count {
            writeln!(out, "(1) c{number} {FRAME}").expect("a vector takes everything");
        }
    };
    is_linear(write, "bus.log", 8_000, &["decode", "--to", "pcapng", "bus.pcapng", "bus.log"]);
}

#[test]
fn messages_of_many_senders_are_joined_in_linear_time() {
    let spec = "canspec: 1\nprotocol: p\ntitle: T\ndocument: {title: T, version: V}\nlength: 8\n\
                identifier: {node: {bits: 28..1}, direction: {bits: 0}}\ntypes: {node: {range: 0..0xFFFFFFF}}\n\
                addressing: {one: {request: {node: node, direction: 1}, one: {node: node, direction: 0}}}\n\
                transports: {tp: {kind: isotp, section: \"1\"}}\n\
                access: {write: {request: {}, answers: {one: nobody}}}\n\
                messages: {m: {section: \"2\", access: [write], via: tp, length: 8..30, \
                fields: {item: {bytes: 0, const: 0x2E}, text: {bytes: 1.., as: text}}}}\n";
    let folder = folder();
    let path = folder.path().join("p.yaml");
    fs::write(&path, spec).expect("the folder can be written");
    let path = path.to_str().expect("it is text");
    let write = |out: &mut dyn Write, count: usize| {
        for number in 0..count {
            writeln!(out, "(1) can0 {:08X}#101E2E4142434445", 2 * number + 1).expect("a vector takes everything");
        }
    };
    let mut log = Vec::new();
    write(&mut log, 1);
    fs::write(folder.path().join("bus.log"), log).expect("the folder can be written");
    let shown = text(&canspec(folder.path(), &["decode", "--spec", path, "bus.log"]).stdout);
    assert!(shown.contains("6 of 30 bytes came"), "{shown}");
    is_linear(write, "bus.log", 4_000, &["decode", "--spec", path, "bus.log"]);
}

#[test]
fn names_of_the_values_of_one_signal_are_imported_in_linear_time() {
    let write = |out: &mut dyn Write, count: usize| {
        let names: String = (0..count).fold(String::new(), |names, raw| names + &format!("{raw} \"n{raw}\" "));
        let signal = " SG_ s : 7|16@0+ (1,0) [0|0] \"\" N";
        writeln!(out, "VERSION \"\"\n\nBU_: N\n\nBO_ 2147483649 M: 8 N\n{signal}\n\nVAL_ 2147483649 s {names};")
            .expect("a vector takes everything");
    };
    is_linear(write, "bus.dbc", 8_000, &["import", "dbc", "bus.dbc"]);
}

#[test]
fn names_of_the_values_of_one_field_are_checked_in_linear_time() {
    let write = |out: &mut dyn Write, count: usize| {
        let names: String = (0..count).fold(String::new(), |names, raw| names + &format!("{raw}: n{raw}, "));
        let spec = "canspec: 1\nprotocol: p\ntitle: T\ndocument: {title: T, version: V}\nlength: 8\n\
                    identifier: {direction: {bits: 10}, command: {bits: 9..0}}\n\
                    addressing: {one: {request: {direction: 0}, one: {direction: 1}}}\n\
                    access: {set: {request: {}, reply: {}, answers: {one: one}}}\nmessages:\n";
        let message = "section: \"1\", match: {command: 1}, access: [set]";
        writeln!(out, "{spec}  m: {{{message}, value: {{bytes: 0..1, values: {{{names}}}}}}}")
            .expect("a vector takes everything");
    };
    is_linear(write, "p.yaml", 8_000, &["check", "p.yaml"]);
}

#[test]
fn names_of_values_and_comments_are_imported_in_linear_time() {
    let write = |out: &mut dyn Write, count: usize| {
        let mut below = Vec::new();
        for number in 0..count {
            let id = 0x8000_0000_u32 + u32::try_from(number).expect("it is small");
            writeln!(out, "BO_ {id} m{number}: 8 x\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" y\n").expect("a vector takes it");
            writeln!(below, "VAL_ {id} s 0 \"a\";\nCM_ SG_ {id} s \"c\";").expect("a vector takes everything");
        }
        out.write_all(&below).expect("a vector takes everything");
    };
    is_linear(write, "a.dbc", 4_000, &["import", "dbc", "a.dbc"]);
}

#[test]
fn signals_of_one_message_and_what_is_left_out_are_imported_in_linear_time() {
    let write = |out: &mut dyn Write, count: usize| {
        writeln!(out, "BO_ 1 m: 8 x").expect("a vector takes everything");
        for number in 0..count {
            writeln!(out, " SG_ s{number} m1 : 0|8@1+ (1,0) [0|0] \"\" y").expect("a vector takes everything");
        }
        writeln!(out, " SG_ q M : 8|8@1+ (1,0) [0|0] \"\" y").expect("a vector takes everything");
    };
    is_linear(write, "a.dbc", 1_500, &["import", "dbc", "a.dbc"]);
}

#[test]
fn an_identifier_is_read_as_the_reader_of_the_dbc_reads_it() {
    let lines = [
        "BO_\t65537 m: 8 x",
        "BO_65537 m: 8 x",
        "  BO_ \t 65537 m: 8 x",
        "BO_ 1 m: 8 x\nCM_ BO_ 65537 \"c\";",
        "BO_ 1 m: 8 x\nVAL_ 65537 s 1 \"a\";",
    ];
    for line in lines {
        let folder = folder();
        fs::write(folder.path().join("a.dbc"), format!("{line}\n")).expect("the folder can be written");
        let output = canspec(folder.path(), &["import", "dbc", "a.dbc"]);
        assert_eq!(output.status.code(), Some(1), "{line}");
        assert_eq!(text(&output.stdout), "", "{line}");
        let number = line.lines().count();
        let why = "one of 29 bits has bit 31 set beside it, one of 11 bits is below 2048";
        assert_eq!(text(&output.stderr), format!("canspec: a.dbc:{number}: 65537 is no identifier: {why}\n"));
    }
}

#[test]
fn what_belongs_to_no_message_is_told() {
    let dbc = "BO_ 1 m: 8 x\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" y\n\nVAL_ 2 s 1 \"a\";\nVAL_ 1 t 1 \"a\";\nCM_ SG_ 1 t \"c\";\n\
        CM_ BO_ 3 \"d\";\nSIG_VALTYPE_ 1 u : 1;\nSG_MUL_VAL_ 1 v q 1-1;\nBO_TX_BU_ 1 : x,z;\n";
    let folder = folder();
    fs::write(folder.path().join("a.dbc"), dbc).expect("the folder can be written");
    let output = canspec(folder.path(), &["import", "dbc", "a.dbc"]);
    let shown = text(&output.stdout);
    let told: Vec<_> = shown.lines().filter_map(|line| line.strip_prefix("# - ")).collect();
    let expected = [
        "a comment on `t` of 0x1, which is no signal of the file: c",
        "names of the values of `t` of 0x1, which is no signal of the file",
        "the type of `u` of 0x1, which is no signal of the file",
        "the multiplexor of `v` of 0x1, which is no signal of the file",
        "names of the values of `s` of 0x2, which is no signal of the file",
        "a comment on 0x3, which is no message of the file: d",
        "further senders of 0x1: x, z",
    ];
    assert_eq!(told, expected);
    assert!(text(&output.stderr).ends_with("7 remarks at the top say what is left out\n"));
}

#[test]
fn a_summary_counts_ten_thousand_identifiers_one_by_one_and_the_others_together() {
    let folder = folder();
    // Frames without data, of 10,002 identifiers that the protocol does not have. The first one and the last come again.
    let numbers = (0..10_002).chain([0, 10_001]);
    let lines = numbers.fold(String::new(), |lines, number| lines + &format!("(1) can0 {number:08X}#\n"));
    fs::write(folder.path().join("noise.log"), lines).expect("the folder can be written");
    let summary = |arguments: &[&str]| {
        let call = ["decode", "--protocol", "infy", "--summary", "noise.log"];
        text(&canspec(folder.path(), &[&call, arguments].concat()).stdout)
    };
    let shown = summary(&["--format", "jsonl"]);
    let of = |kind: &str| shown.lines().filter(|line| line.contains(kind)).collect::<Vec<_>>();
    assert_eq!(of(r#"{"summary":"unrecognised""#).len(), 10_000);
    assert_eq!(of(r#"{"summary":"unrecognised","id":"00000000""#).len(), 1);
    assert!(of(r#""id":"00000000""#)[0].contains(r#""frames":2,"line":1,"#), "{}", of(r#""id":"00000000""#)[0]);
    let others = of(r#"{"summary":"others""#);
    assert_eq!(others.len(), 1, "{others:?}");
    assert!(others[0].ends_with(r#""frames":3,"line":10001}"#), "{others:?}");
    let table = summary(&[]);
    let last: Vec<_> = table.lines().last().unwrap_or_default().split_whitespace().collect();
    assert_eq!((last[0], last[2], last[3]), ("others", "3", "10001"), "{last:?}");
    assert!(table.ends_with("only the first 10000 are counted one by one\n"), "{last:?}");
}

#[test]
fn a_standard_output_that_is_closed_is_an_error() {
    for call in ["list", "decode --protocol infy /dev/null", "--help", "schema"] {
        let call = format!("'{}' {call} >&-", env!("CARGO_BIN_EXE_canspec"));
        let output = Command::new("sh").args(["-c", &call]).output().expect("there is a shell");
        assert_eq!(output.status.code(), Some(1), "{call}");
        assert_eq!(text(&output.stderr), "canspec: standard output: it is closed\n", "{call}");
    }
}

#[test]
fn a_standard_output_that_nobody_reads_or_wants_is_none() {
    for end in ["| head -1 >/dev/null", ">/dev/null", "1<>/dev/null"] {
        let call = format!("set -e; '{}' schema {end}", env!("CARGO_BIN_EXE_canspec"));
        let output = Command::new("sh").args(["-c", &call]).output().expect("there is a shell");
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()), "{call}");
    }
}

#[test]
fn a_file_name_neither_begins_a_line_nor_steers_the_terminal() {
    let name = std::ffi::OsString::from_vec(b"a\nb\x1b[2J\xC2\x9B.yaml".to_vec());
    let calls: [&[&str]; 8] = [
        &["check"],
        &["compile"],
        &["decode", "--protocol", "infy"],
        &["decode", "--spec"],
        &["import", "dbc"],
        &["export", "wireshark", "--spec"],
        &["encode", "--protocol", "infy", "--from", "jsonl"],
        &["decode", "--to", "pcapng", "out", "in", "much", "more"],
    ];
    for call in calls {
        let folder = folder();
        let run = || {
            let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
            canspec.args(call).arg(&name).current_dir(folder.path()).stdin(Stdio::null());
            canspec.output().expect("the command starts")
        };
        let missing = run();
        fs::write(folder.path().join(&name), "BO_ \x1b[2J x").expect("the folder can be written");
        for output in [missing, run()] {
            let said = text(&output.stdout) + &text(&output.stderr);
            assert!(!said.contains(|letter: char| letter.is_control() && letter != '\n'), "{call:?}: {said:?}");
            assert!(!said.lines().any(|line| line.starts_with('b')), "{call:?}: {said:?}");
        }
    }
}
