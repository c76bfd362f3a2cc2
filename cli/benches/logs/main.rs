//! Prints what it costs to decode a log of INFY, beside a program by hand and cantools, as a Markdown table.
#![expect(clippy::print_stdout, reason = "the table is what people call it for")]

mod by_hand;
mod cantools;
#[path = "../cost/mod.rs"]
mod cost;
mod log;

use std::env;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};

use cost::{Cost, instructions};

/// Lines of the log that is timed.
const LINES: u32 = 1_000_000;

/// Lines of the logs whose difference shows what a line costs, once most of the identifiers were there.
const COUNTED: [u32; 2] = [100_000, 200_000];

/// Runs of a program. The fastest counts, since the machine may have other work, too.
const RUNS: usize = 5;

fn main() -> io::Result<()> {
    let words: Vec<_> = env::args().skip(1).collect();
    if let [mode, format, log] = &words[..]
        && mode == "by-hand"
    {
        return by_hand::run(format, Path::new(log));
    }
    let folder = tempfile::tempdir()?;
    let [log, few, many] = &["infy.log", "few.log", "many.log"].map(|name| folder.path().join(name));
    for (log, lines) in [(log, LINES), (few, COUNTED[0]), (many, COUNTED[1])] {
        log::write(log, lines)?;
    }
    println!("| | time | of the processors | instructions a line | memory |\n|---|--:|--:|--:|--:|");
    for (format, name) in [("text", "table"), ("jsonl", "JSON")] {
        check(programs(format, log)?, folder.path())?;
        let [few, many] = [programs(format, few)?, programs(format, many)?];
        for (((by, mut program), (_, few)), (_, many)) in programs(format, log)?.into_iter().zip(few).zip(many) {
            let costs = (0..RUNS).map(|_| cost(&mut program)).collect::<io::Result<Vec<_>>>()?;
            if let Some(fastest) = costs.iter().min_by_key(|cost| cost.wait) {
                row(&format!("{name}, {by}"), fastest, a_line(&few, &many));
            }
        }
    }
    match cantools::command(&folder.path().join("venv"), log) {
        Some(mut command) => row("cantools", &cost(&mut command)?, None),
        None => println!("\ncantools is missing. It needs python3 with venv, and PyPI."),
    }
    Ok(())
}

/// Returns the programs that write the same of a log. The one by hand is a part of this program.
fn programs(format: &str, log: &Path) -> io::Result<[(&'static str, Command); 2]> {
    let (mut canspec, mut by_hand) = (Command::new(env!("CARGO_BIN_EXE_canspec")), Command::new(env::current_exe()?));
    canspec.args(["decode", "--protocol", "infy", "--format", format]).arg(log);
    by_hand.args(["by-hand", format]).arg(log);
    Ok([("canspec", canspec), ("by hand", by_hand)])
}

/// Compares what both programs write.
fn check(programs: [(&str, Command); 2], folder: &Path) -> io::Result<()> {
    let paths = ["one", "other"].map(|name| folder.join(name));
    for ((name, mut program), path) in programs.into_iter().zip(&paths) {
        let (_, is_good) = Cost::of(program.stdout(File::create(path)?))?;
        is_good.then_some(()).ok_or_else(|| io::Error::other(format!("{name} fails")))?;
    }
    let [one, other] = paths.map(|path| File::open(path).map(|file| BufReader::new(file).bytes().map(Result::ok)));
    let is_same = one?.eq(other?);
    is_same.then_some(()).ok_or_else(|| io::Error::other("the program by hand writes something else than canspec"))
}

fn cost(program: &mut Command) -> io::Result<Cost> {
    Cost::of(program.stdout(Stdio::null())).map(|(cost, _)| cost)
}

/// Returns how many instructions a further line takes, unless there is no valgrind.
fn a_line(few: &Command, many: &Command) -> Option<u64> {
    let [least, most] = COUNTED.map(u64::from);
    Some((instructions(many)? - instructions(few)?) / (most - least))
}

/// Prints what a program takes.
fn row(name: &str, cost: &Cost, line: Option<u64>) {
    let [time, wait] = [cost.time, cost.wait].map(|time| time.as_secs_f64());
    let line = line.map_or_else(|| "-".to_owned(), |line| line.to_string());
    println!("| {name} | {wait:.2} s | {time:.2} s | {line} | {} MiB |", cost.memory >> 20);
}
