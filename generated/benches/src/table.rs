//! Prints the instructions that valgrind counts and the times that `cargo bench` measured, as Markdown tables.
//!
//! Words choose among the workloads.

mod cantools;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use canspec_benches::workload::{Kind, Measured, Workload};

/// The profiles of cargo, with the names that people know.
const PROFILES: [(&str, &str); 2] = [("lto", "LTO"), ("release", "release")];

fn main() {
    let words: Vec<_> = env::args().skip(1).collect();
    let is_wanted = |number: &usize| words.iter().all(|word| Workload::ALL[*number].name.contains(word));
    (0..Workload::ALL.len()).filter(is_wanted).for_each(instructions);
    times();
}

/// Prints the instructions of a workload.
fn instructions(number: usize) {
    let workload = &Workload::ALL[number];
    let cantools = cantools(workload);
    let codecs = workload.codecs.iter().map(|Measured { codec, .. }| *codec);
    let columns: Vec<_> = codecs.chain((!cantools.is_empty()).then_some("cantools' C")).collect();
    let headings = columns.iter().flat_map(|codec| PROFILES.map(|(_, name)| format!("{codec}, {name}")));
    println!("| {} | {} |", workload.name, headings.collect::<Vec<_>>().join(" | "));
    println!("|---|{}", "--:|".repeat(columns.len() * PROFILES.len()));
    for (work, name) in workload.works().enumerate() {
        let programs = programs(workload, |codec| [number, codec, work]);
        let cells = |kind: usize| {
            let ours = programs.iter().map(|program| vec![program.into(), kind.to_string().into()]);
            let cantools = cantools.get(kind).into_iter().flatten();
            let cantools = cantools.map(|command| command.iter().cloned().chain([name.into()]).collect());
            ours.chain(cantools).map(|command: Vec<_>| counted(&command, workload.counted)).collect()
        };
        rows(name, workload.kinds, &(0..workload.kinds.len()).map(cells).collect::<Vec<_>>());
    }
    println!();
}

/// Prints a row for each kind, and their average if there are several.
#[expect(clippy::cast_precision_loss, reason = "there are few kinds")]
fn rows(work: &str, kinds: &[Kind], rows: &[Vec<Option<f64>>]) {
    let [(_, first), others @ ..] = &kinds.iter().zip(rows).collect::<Vec<_>>()[..] else { return };
    if others.is_empty() {
        return row(work, first);
    }
    kinds.iter().zip(rows).for_each(|(kind, cells)| row(&format!("{work}: {}", kind.name), cells));
    let sum = |column: usize| rows.iter().map(|cells| cells[column]).sum::<Option<f64>>();
    let average = (0..first.len()).map(|column| Some(sum(column)? / rows.len() as f64));
    row(&format!("{work}: average"), &average.collect::<Vec<_>>());
}

fn row(heading: &str, cells: &[Option<f64>]) {
    let cells: Vec<_> = cells.iter().map(|cell| cell.map_or("-".into(), |cell| format!("{cell:.0}"))).collect();
    println!("| {heading} | {} |", cells.join(" | "));
}

/// Builds the C of cantools. Returns a command for each kind of frames and each profile, or none.
fn cantools(workload: &Workload) -> Vec<[Vec<OsString>; 2]> {
    let kinds: Vec<_> = workload.kinds.iter().map(|kind| (kind.frames)(Workload::COUNTED)).collect();
    cantools::programs(&target().join("cantools"), workload.name, &kinds).unwrap_or_else(|missing| {
        println!("SKIPPED: cantools' C, which needs {missing}\n");
        Vec::new()
    })
}

/// Compiles `count` for a work of each codec in each profile, and returns where they stand.
fn programs(workload: &Workload, work: impl Fn(usize) -> [usize; 3]) -> Vec<PathBuf> {
    let codecs = 0..workload.codecs.len();
    codecs.flat_map(|codec| PROFILES.map(|(profile, _)| program(profile, work(codec)))).collect()
}

/// Compiles `count` for a work in a profile, and returns where it stands.
fn program(profile: &str, work: [usize; 3]) -> PathBuf {
    let digits = work.map(|number| number.to_string()).concat();
    let status = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["build", "--quiet", "--bin", "count", "--profile", profile, "--target-dir"])
        .arg(target())
        .env("CANSPEC_WORK", &digits)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .status();
    assert!(status.is_ok_and(|status| status.success()), "`count` is built in the profile `{profile}`");
    let (built, kept) = (target().join(profile).join("count"), target().join(profile).join(format!("count_{digits}")));
    fs::copy(built, &kept).expect("the target folder can be written");
    kept
}

/// Returns the instructions of one work: what three passes take more than one. A codec that does not have it has none.
#[expect(clippy::cast_precision_loss, reason = "it is no exact number anyway")]
fn counted(command: &[OsString], functions: Option<&str>) -> Option<f64> {
    let [(one, count), (three, _)] = [1, 3].map(|passes| valgrind(command, functions, passes));
    (count > 0).then(|| (three - one) / (2 * count) as f64)
}

/// Returns how many instructions a command takes for its passes, perhaps in some functions alone, and how often a pass
/// does the work.
fn valgrind(command: &[OsString], functions: Option<&str>, passes: usize) -> (f64, usize) {
    let tool: &[_] = match functions {
        None => &["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"].map(String::from),
        Some(functions) => &[
            "--tool=callgrind".into(),
            "--callgrind-out-file=/dev/null".into(),
            format!("--toggle-collect={functions}"),
        ],
    };
    let output = Command::new("valgrind")
        .args(tool)
        .args(command)
        .arg(passes.to_string())
        .output()
        .expect("valgrind is installed");
    let [text, count] = [output.stderr, output.stdout].map(|text| String::from_utf8_lossy(&text).into_owned());
    // Cachegrind counts all `refs`, and callgrind says what it `Collected`.
    let line = text
        .lines()
        .find(|line| line.contains("refs:") && functions.is_none() || line.contains("Collected"))
        .expect("valgrind counts");
    let instructions = line.rsplit(' ').next().and_then(|number| number.replace(',', "").parse().ok());
    (instructions.expect("a number"), count.trim().parse().expect("the program says how often it works"))
}

/// Prints what criterion measured.
fn times() {
    let measured: Vec<_> = Workload::timed().map(workload_times).collect();
    if !measured.contains(&true) {
        println!("Processor time: not measured; `cargo bench` measures it.");
    }
}

/// Prints what criterion measured of a workload, if it did.
fn workload_times(workload: &Workload) -> bool {
    let names: Vec<_> = workload.codecs.iter().map(|Measured { codec, .. }| *codec).collect();
    let times = |group: &String| names.iter().map(|codec| time(group, codec)).collect::<Vec<_>>();
    let rows: Vec<_> = workload.groups().map(|group| (times(&group), group)).collect();
    let is_measured = rows.iter().flat_map(|(times, _)| times).any(Option::is_some);
    if is_measured {
        println!("| processor time | {} |", names.join(" | "));
        println!("|---|{}", "--:|".repeat(names.len()));
        for (times, group) in rows {
            let cells: Vec<_> = times.into_iter().map(|time| time.unwrap_or_else(|| "-".into())).collect();
            println!("| {group} | {} |", cells.join(" | "));
        }
        println!();
    }
    is_measured
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
