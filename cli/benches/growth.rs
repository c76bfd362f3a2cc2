//! Prints what the command costs for specs of 10 to 4,000 messages, as a Markdown table.
#![expect(clippy::print_stdout, reason = "the table is what people call it for")]

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use wait4::Wait4;

/// How many messages of four signals a spec has.
const MESSAGES: [u32; 4] = [10, 100, 1_000, 4_000];

/// Lines of the logs whose difference shows what a line costs.
const LINES: [u32; 2] = [2_000, 12_000];

/// Lines of the logs whose difference shows how long a line takes.
const TIMED: [u32; 2] = [1_000, 101_000];

/// The head of each spec.
const HEAD: &str = "\
canspec: 1
protocol: synthetic
title: Synthetic devices
document: {title: Synthetic, version: V1}
length: 8
identifier: {error: {bits: 28..26, normal: 0}, command: {bits: 25..10}, direction: {bits: 9}, node: {bits: 8..3}, more: {bits: 2..0, const: 0}}
types:
  device: {range: 0..0x3F}
  voltage: {scale: 0.1, unit: V}
  current: {scale: 0.01, unit: A}
  temperature: {as: signed, unit: °C}
addressing:
  one: {request: {direction: 1, node: device}, one: {direction: 0, node: device}}
access:
  read: {request: {}, reply: {}, in: [reply], answers: {one: one}}
messages:
";

fn main() -> io::Result<()> {
    println!("| messages | `check` | `compile` | `decode` a line | instructions a line |\n|--:|--:|--:|--:|--:|");
    let folder = tempfile::tempdir()?;
    for count in MESSAGES {
        let spec = write(folder.path(), "synthetic.yaml", &spec(count))?;
        let out = folder.path().join("out");
        let check = time(&[Path::new("check"), &spec])?;
        let compile = time(&[Path::new("compile"), &spec, Path::new("--out"), &out])?;
        let [check, compile] = [check, compile].map(|time| format!("{:.2} s", time.as_secs_f64()));
        let line = time_a_line(folder.path(), &spec, count)?.as_nanos();
        let instructions = instructions_a_line(folder.path(), &spec, count)?;
        let instructions = instructions.map_or_else(|| "no valgrind".to_owned(), |count| count.to_string());
        println!("| {count} | {check} | {compile} | {line} ns | {instructions} |");
    }
    Ok(())
}

/// Returns a spec with `count` messages.
fn spec(count: u32) -> String {
    (0..count).fold(HEAD.to_owned(), |mut spec, number| {
        let _ = write!(
            spec,
            "  message_{number}:\n    section: \"1\"\n    match: {{command: {number}}}\n    access: [read]\n    fields:\n      \
             voltage: {{bytes: 0..1, type: voltage}}\n      current: {{bytes: 2..3, type: current}}\n      \
             temperature: {{bytes: 4, type: temperature}}\n      count: {{bytes: 5..6}}\n"
        );
        spec
    })
}

/// Returns a log of replies that go through all messages.
fn log(messages: u32, lines: u32) -> String {
    (0..lines).fold(String::new(), |mut log, line| {
        // A step without a common divisor goes through all messages in no order that a cache likes.
        let (command, node, mixed) = (line.wrapping_mul(7_919) % messages, line % 64, line.wrapping_mul(2_654_435_761));
        let (seconds, id) = (line / 1_000, command << 10 | node << 3);
        let _ = writeln!(log, "({seconds}.{:06}) can0 {id:08X}#{mixed:08X}{line:06X}00", line % 1_000 * 1_000);
        log
    })
}

fn write(folder: &Path, name: &str, text: &str) -> io::Result<PathBuf> {
    let path = folder.join(name);
    fs::File::create(&path)?.write_all(text.as_bytes())?;
    Ok(path)
}

fn decode<'a>(spec: &'a Path, log: &'a Path) -> [&'a Path; 6] {
    let [command, format, jsonl, option] = ["decode", "--format", "jsonl", "--spec"].map(Path::new);
    [command, format, jsonl, option, spec, log]
}

/// Returns the processor time that the command takes.
fn time(arguments: &[&Path]) -> io::Result<Duration> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let used = command.args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?.wait4()?;
    if !used.status.success() {
        return Err(io::Error::other(format!("canspec {arguments:?}: {}", used.status)));
    }
    Ok(used.rusage.utime)
}

/// Returns how long a further line of a log takes.
fn time_a_line(folder: &Path, spec: &Path, messages: u32) -> io::Result<Duration> {
    let [few, many] = TIMED;
    let [least, most] = TIMED.map(|lines| {
        let log = write(folder, "timed.log", &log(messages, lines))?;
        time(&decode(spec, &log))
    });
    Ok(most?.saturating_sub(least?) / (many - few))
}

/// Returns what a further line of a log costs, unless there is no valgrind.
fn instructions_a_line(folder: &Path, spec: &Path, messages: u32) -> io::Result<Option<u64>> {
    let [few, many] = LINES;
    let mut counts = Vec::new();
    for lines in [few, many] {
        let log = write(folder, "counted.log", &log(messages, lines))?;
        counts.extend(instructions(&decode(spec, &log)));
    }
    let [least, most] = counts.as_slice() else { return Ok(None) };
    Ok(Some((most - least) / u64::from(many - few)))
}

fn instructions(arguments: &[&Path]) -> Option<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
        .arg(env!("CARGO_BIN_EXE_canspec"))
        .args(arguments)
        .stdout(Stdio::null())
        .output()
        .ok()?;
    let text = String::from_utf8(output.stderr).ok()?;
    let line = text.lines().find(|line| line.contains("refs:"))?;
    line.rsplit(' ').next()?.replace(',', "").parse().ok()
}
