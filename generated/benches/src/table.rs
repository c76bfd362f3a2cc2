//! Prints what `cargo bench` measured, with the instructions that valgrind counts, as a Markdown table.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use canspec_benches::dbc::Dbc;
use canspec_benches::frames;
use canspec_benches::generated::Generated;
use canspec_benches::hand::Hand;
use canspec_benches::{Codec, decode, encode, received, request, requests};

/// How many distinct frames valgrind sees.
const COUNTED: usize = 20_000;
const CODECS: [&str; 3] = [Generated::NAME, Hand::NAME, Dbc::NAME];

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => table(),
        [codec, work, passes] => {
            let passes = passes.parse().expect("a number of passes");
            match codec {
                Generated::NAME => run::<Generated>(work, passes),
                Hand::NAME => run::<Hand>(work, passes),
                _ => run::<Dbc>(work, passes),
            }
        }
        _ => eprintln!("usage: table [CODEC WORK PASSES]"),
    }
}

/// Works `passes` times through the frames, so that valgrind can count.
fn run<C: Codec>(work: &str, passes: usize) {
    let frames = frames::distinct(COUNTED);
    let (received, requests) = (received::<C>(&frames), requests::<C>(&frames));
    for _ in 0..passes {
        match work {
            "decode" => decode::<C>(&frames),
            "encode" => encode::<C>(&received),
            _ => request::<C>(&requests),
        }
    }
}

fn table() {
    println!("| time and instructions a frame | {} |", CODECS.join(" | "));
    println!("|---|{}", "--:|".repeat(CODECS.len()));
    for work in ["decode", "encode", "request"] {
        row(&format!("{work} distinct"), |codec| {
            let instructions =
                instructions(codec, work).map_or_else(|| "no valgrind".into(), |count| format!("{count:.0}"));
            format!("{}, {instructions}", time(&format!("{work} distinct"), codec))
        });
        row(&format!("{work} loop"), |codec| time(&format!("{work} loop"), codec));
    }
}

fn row(name: &str, cell: impl Fn(&str) -> String) {
    println!("| {name} | {} |", CODECS.map(cell).join(" | "));
}

/// Returns what criterion measured.
fn time(group: &str, codec: &str) -> String {
    let folder = target().join("criterion").join(group).join(codec).join("new");
    match (
        number(&folder, "estimates.json", "/median/point_estimate"),
        number(&folder, "benchmark.json", "/throughput/Elements"),
    ) {
        (Some(nanoseconds), Some(frames)) => format!("{:.1} ns", nanoseconds / frames),
        _ => "not measured".into(),
    }
}

fn number(folder: &Path, file: &str, pointer: &str) -> Option<f64> {
    let json: serde_json::Value = serde_json::from_str(&fs::read_to_string(folder.join(file)).ok()?).ok()?;
    json.pointer(pointer)?.as_f64()
}

/// Returns the target folder: this program stands in a folder of it.
fn target() -> PathBuf {
    let program = env::current_exe().expect("a program has a path");
    program.ancestors().nth(2).expect("it stands in target/release").into()
}

/// Counts the instructions a frame: what three passes take more than one.
#[expect(clippy::cast_precision_loss, reason = "it is no exact number anyway")]
fn instructions(codec: &str, work: &str) -> Option<f64> {
    let frames = frames::distinct(COUNTED);
    let frames = if work == "request" { requests::<Hand>(&frames).len() } else { frames.len() };
    Some((valgrind(codec, work, 3)? - valgrind(codec, work, 1)?) / (2 * frames) as f64)
}

/// Returns how many instructions this program takes for its passes.
fn valgrind(codec: &str, work: &str, passes: usize) -> Option<f64> {
    let program = env::current_exe().ok()?;
    let output = Command::new("valgrind")
        .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
        .arg(program)
        .args([codec, work, &passes.to_string()])
        .output()
        .ok()?;
    let text = String::from_utf8(output.stderr).ok()?;
    let line = text.lines().find(|line| line.contains("refs:"))?;
    line.rsplit(' ').next()?.replace(',', "").parse().ok()
}
