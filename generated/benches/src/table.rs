//! Prints the instructions that valgrind counts and the times that `cargo bench` measured, as Markdown tables.

mod cantools;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use canspec_benches::Codec;
use canspec_benches::by_hand::Hand;
use canspec_benches::dbc::Dbc;
use canspec_benches::frames;
use canspec_benches::generated::Generated;
use canspec_benches::work::Work;

/// The codecs, with the words by which `count` is compiled for them.
const CODECS: [(&str, &str); 3] = [(Generated::NAME, "canspec"), (Hand::NAME, "by_hand"), (Dbc::NAME, "dbc")];
/// The profiles of cargo, with the names that people know.
const PROFILES: [(&str, &str); 2] = [("lto", "LTO"), ("release", "release")];

fn main() {
    instructions();
    println!();
    times();
}

fn instructions() {
    let names = CODECS.iter().map(|(name, _)| *name);
    let cantools = cantools::programs(&target().join("cantools"), &frames::distinct(frames::COUNTED));
    if let Err(missing) = &cantools {
        println!("SKIPPED: cantools' C, which needs {missing}\n");
    }
    let columns: Vec<_> = names.chain(cantools.is_ok().then_some("cantools' C")).collect();
    let headings = columns.iter().flat_map(|codec| PROFILES.map(|(_, name)| format!("{codec}, {name}")));
    println!("| instructions | {} |", headings.collect::<Vec<_>>().join(" | "));
    println!("|---|{}", "--:|".repeat(columns.len() * PROFILES.len()));
    for work in Work::ALL {
        let ours = CODECS.iter().flat_map(|(_, codec)| PROFILES.map(|(profile, _)| vec![built(profile, codec, work)]));
        let commands = ours.chain(cantools.iter().flatten().cloned());
        let cells: Vec<_> = commands.map(|command| counted(&command, work)).collect();
        println!("| {} | {} |", work.name(), cells.join(" | "));
    }
}

/// Compiles `count` for a work of a codec in a profile, and returns its path.
fn built(profile: &str, codec: &str, work: Work) -> PathBuf {
    let status = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["rustc", "--quiet", "--bin", "count", "--profile", profile, "--target-dir"])
        .arg(target())
        .args(["--", "--cfg", &format!("codec=\"{codec}\""), "--cfg", &format!("work=\"{}\"", work.word())])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .status();
    assert!(status.is_ok_and(|status| status.success()), "`count` is built in the profile `{profile}`");
    target().join(profile).join("count")
}

/// Returns the instructions of one work: what three passes take more than one.
#[expect(clippy::cast_precision_loss, reason = "it is no exact number anyway")]
fn counted(command: &[PathBuf], work: Work) -> String {
    let passes = [1, 3].map(|passes| valgrind(command, work, passes));
    match passes {
        [Some((_, 0)), _] => "-".into(),
        [Some((one, count)), Some((three, _))] => format!("{:.0}", (three - one) / (2 * count) as f64),
        _ => "not counted".into(),
    }
}

/// Returns how many instructions a command takes for its passes, and how often a pass does the work.
fn valgrind(command: &[PathBuf], work: Work, passes: usize) -> Option<(f64, usize)> {
    let output = Command::new("valgrind")
        .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
        .args(command)
        .args([work.name(), &passes.to_string()])
        .output()
        .ok()?;
    let [text, count] = [output.stderr, output.stdout].map(|text| String::from_utf8_lossy(&text).into_owned());
    let line = text.lines().find(|line| line.contains("refs:"))?;
    Some((line.rsplit(' ').next()?.replace(',', "").parse().ok()?, count.trim().parse().ok()?))
}

fn times() {
    let groups =
        Work::ALL.iter().flat_map(|work| ["distinct", "loop"].map(|frames| format!("{} {frames}", work.name())));
    let rows: Vec<_> = groups.map(|group| (CODECS.map(|(codec, _)| time(&group, codec)), group)).collect();
    if rows.iter().flat_map(|(times, _)| times).all(Option::is_none) {
        return println!("Processor time: not measured; `cargo bench` measures it.");
    }
    println!("| processor time | {} |", CODECS.map(|(codec, _)| codec).join(" | "));
    println!("|---|{}", "--:|".repeat(CODECS.len()));
    for (times, group) in rows {
        println!("| {group} | {} |", times.map(|time| time.unwrap_or_else(|| "-".into())).join(" | "));
    }
}

/// Returns what criterion measured.
fn time(group: &str, codec: &str) -> Option<String> {
    let folder = target().join("criterion").join(group).join(codec).join("new");
    let nanoseconds = number(&folder, "estimates.json", "/median/point_estimate")?;
    let count = number(&folder, "benchmark.json", "/throughput/Elements")?;
    Some(format!("{:.1} ns", nanoseconds / count))
}

fn number(folder: &Path, file: &str, pointer: &str) -> Option<f64> {
    let json: serde_json::Value = serde_json::from_str(&fs::read_to_string(folder.join(file)).ok()?).ok()?;
    json.pointer(pointer)?.as_f64()
}

/// Returns the target folder: this program stands in a folder of it.
fn target() -> PathBuf {
    let program = env::current_exe().expect("a program has a path");
    program.ancestors().nth(2).expect("it stands in a profile's folder").into()
}
