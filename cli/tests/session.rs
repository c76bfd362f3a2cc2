//! The shipped log decodes to what the vendor's document says, and encodes back to the same frames.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn logs(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../tests/logs").join(name)
}

fn canspec(arguments: &[&str], input: &[u8]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let mut child = command
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command was built");
    let mut stdin = child.stdin.take().expect("standard input is a pipe");
    let input = input.to_vec();
    let writer = std::thread::spawn(move || std::io::Write::write_all(&mut stdin, &input));
    let output = child.wait_with_output().expect("the command ends");
    writer.join().expect("the writer ends").expect("the command reads its input");
    output
}

/// Shows a line of output as `session.expected.tsv` does, the signals in the order of their names.
fn shown(line: &Value) -> String {
    let Some(message) = line["message"].as_str() else { return format!("{}\t-\t-", line["line"]) };
    let signals = line["signals"].as_object().expect("signals are an object");
    let signals: Vec<_> = signals.iter().map(|(name, signal)| format!("{name}={}", value(signal))).collect();
    let kind = line["kind"].as_str().expect("a kind");
    format!("{}\t{message}\t{kind}\t{}", line["line"], signals.join("; ")).trim_end().to_owned()
}

/// Puts the signals of an expected line into the order of their names.
fn sorted(expected: &str) -> String {
    let Some((head, signals)) = expected.rsplit_once('\t') else { return expected.to_owned() };
    let mut signals: Vec<_> = signals.split("; ").collect();
    signals.sort_unstable();
    format!("{head}\t{}", signals.join("; ")).trim_end().to_owned()
}

fn value(signal: &Value) -> String {
    if let Some(set) = signal["set"].as_array() {
        let unknown = signal["unknown"].as_u64().unwrap_or_default();
        let unnamed = (0..64).filter(|bit| unknown >> bit & 1 == 1).map(|bit| format!("?{bit}"));
        let named = set.iter().filter_map(Value::as_str).map(str::to_owned);
        return format!("{{{}}}", named.chain(unnamed).collect::<Vec<_>>().join(","));
    }
    let text = match &signal["value"] {
        Value::String(text) => text.clone(),
        Value::Number(number) => number.to_string().trim_end_matches(".0").to_owned(),
        _ => format!("?{}", signal["raw"]),
    };
    signal["unit"].as_str().map_or(text.clone(), |unit| format!("{text} {unit}"))
}

fn decoded() -> Vec<Value> {
    let log = logs("infy-session.log");
    let output = canspec(&["decode", "--protocol", "infy", "--format", "jsonl", &log.to_string_lossy()], b"");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("the output is UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("each line is an object")).collect()
}

#[test]
fn the_session_decodes_to_the_values_of_the_document() {
    let expected = fs::read_to_string(logs("infy-session.expected.tsv")).expect("the file ships");
    let expected = expected.lines().filter(|line| !line.starts_with('#')).map(str::trim_end);
    let lines = decoded();
    for (line, expected) in lines.iter().zip(expected.clone()) {
        assert_eq!(shown(line), sorted(expected));
    }
    assert_eq!(lines.len(), expected.count());
    assert!(lines.len() >= 40);
}

#[test]
fn the_session_uses_every_command() {
    let lines = decoded();
    let commands: BTreeSet<_> = lines.iter().filter_map(|line| line["identifier"]["command"].as_u64()).collect();
    let all = [1, 2, 3, 4, 6, 8, 9, 10, 11, 12, 19, 20, 22, 25, 26, 27, 28, 31];
    assert!(all.iter().all(|command| commands.contains(command)), "{commands:?}");
}

#[test]
fn the_session_encodes_back_to_the_same_frames() {
    let log = fs::read_to_string(logs("infy-session.log")).expect("the file ships");
    let recognised: Vec<_> = decoded().into_iter().filter(|line| !line["message"].is_null()).collect();
    let lines: Vec<_> = recognised.iter().map(Value::to_string).collect();
    let output = canspec(&["encode", "--protocol", "infy", "--from", "jsonl"], lines.join("\n").as_bytes());
    let frame = |line: &str| line.rsplit(' ').next().unwrap_or_default().to_owned();
    let encoded: Vec<_> = String::from_utf8_lossy(&output.stdout).lines().map(frame).collect();
    let numbers = recognised.iter().filter_map(|line| line["line"].as_u64()).collect::<BTreeSet<_>>();
    let printed = log.lines().zip(1..).filter(|(_, number)| numbers.contains(number)).map(|(line, _)| frame(line));
    assert_eq!(encoded, printed.collect::<Vec<_>>(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success());
}

/// Splits the table into the text of each line of the log, with the wrapped parts joined.
fn blocks(table: &str) -> Vec<String> {
    let mut blocks: Vec<String> = Vec::new();
    for row in table.lines().skip(1) {
        let words = row.split_whitespace().collect::<Vec<_>>().join(" ");
        match blocks.last_mut() {
            Some(block) if row.starts_with(' ') => *block = format!("{block} {words}"),
            _ => blocks.push(words),
        }
    }
    blocks
}

/// Returns the ways in which the table may write `name=value unit`: scaled and floating numbers have a decimal point.
fn written(signal: &str) -> [String; 2] {
    let (name, value) = signal.split_once('=').expect("a signal has a value");
    if let Some(raw) = value.strip_prefix('?') {
        let raw: u64 = raw.parse().expect("a raw value");
        return [format!("{name} ? (raw {raw:#X})"), format!("{name} ? (raw {raw})")];
    }
    let (number, unit) =
        value.split_once(' ').map_or((value, String::new()), |(number, unit)| (number, format!(" {unit}")));
    [format!("{name} {number}{unit}"), format!("{name} {number}.0{unit}")]
}

#[test]
fn each_row_of_the_table_shows_the_values_of_the_document() {
    let log = logs("infy-session.log");
    let output = canspec(&["decode", "--protocol", "infy", &log.to_string_lossy()], b"");
    let blocks = blocks(&String::from_utf8(output.stdout).expect("the output is UTF-8"));
    let expected = fs::read_to_string(logs("infy-session.expected.tsv")).expect("the file ships");
    let expected: Vec<_> = expected.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(blocks.len(), expected.len());
    for (block, line) in blocks.iter().zip(expected) {
        let mut columns = line.split('\t').skip(1);
        let message = columns.next().expect("a message");
        assert!(message == "-" || block.contains(&format!(" {message}")), "{message}: {block}");
        let signals = columns.nth(1).unwrap_or_default();
        for signal in signals.split("; ").filter(|signal| signal.contains('=') && !signal.contains('{')) {
            let shown = written(signal);
            let ends = |text: &String| block.contains(&format!("{text} ")) || block.ends_with(text.as_str());
            assert!(shown.iter().any(ends), "{shown:?} is not in {block:?}");
        }
    }
}
