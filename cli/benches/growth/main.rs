//! Prints what the command costs for specs of 10 to 10,000 messages, and for other things that grow, as Markdown tables.
#![expect(clippy::print_stdout, reason = "the table is what people call it for")]

#[path = "../cost/mod.rs"]
mod cost;
mod specs;

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use cost::{Cost, instructions};

/// How many messages of four signals a spec has.
const MESSAGES: [u32; 5] = [10, 100, 1_000, 4_000, 10_000];

/// How many messages, each with an enum of its own, a crate has.
const BUILT: [u32; 3] = [10, 100, 1_000];

/// Lines of the logs that are decoded as a whole.
const LENGTHS: [u32; 4] = [10_000, 100_000, 1_000_000, 10_000_000];

/// Lines of the logs whose difference shows what a line costs.
const LINES: [u32; 2] = [2_000, 12_000];

/// Lines of the logs whose difference shows how long a line takes.
const TIMED: [u32; 2] = [1_000, 101_000];

/// What grows in a spec, and to how much: the last is near the cap.
struct Axis {
    name: &'static str,
    sizes: [u32; 3],
    spec: fn(u32) -> String,
}

const AXES: [Axis; 5] = [
    Axis { name: "messages with an enum", sizes: [625, 2_500, 10_000], spec: specs::enums },
    Axis { name: "sets of 64 members", sizes: [128, 512, 2_048], spec: specs::sets },
    Axis { name: "device models", sizes: [16, 64, 256], spec: specs::models },
    Axis { name: "named values of a field", sizes: [4_096, 16_384, 65_536], spec: specs::values },
    Axis { name: "messages with two errors", sizes: [250, 1_000, 4_000], spec: specs::errors },
];

/// Lines of a log that have a channel each.
const CHANNELS: [u32; 3] = [4_000, 16_000, 64_000];

/// Files of specs in one call.
const FILES: [u32; 3] = [16, 64, 256];

/// Lines of the log that goes through decoder and encoder of each spec.
const LOGGED: u32 = 4_000;

fn main() -> io::Result<()> {
    let folder = tempfile::tempdir()?;
    of_messages(folder.path())?;
    of_builds(folder.path())?;
    of_lines(folder.path())?;
    println!(
        "\n| what grows | how many | `check` | `compile` | `export dbc` | `import dbc` | `export wireshark` | `list` \
         | `decode` | `encode` |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|"
    );
    for axis in AXES {
        of_axis(folder.path(), &axis)?;
    }
    of_channels(folder.path())?;
    of_files(folder.path())
}

/// Writes time and memory as two cells.
fn cells(cost: &Cost) -> String {
    format!("{:.2} s | {} MiB", cost.time.as_secs_f64(), cost.memory >> 20)
}

/// Prints what specs of more and more messages cost.
fn of_messages(folder: &Path) -> io::Result<()> {
    println!(
        "| messages | `check` | memory | `compile` | memory | lines of Rust a message | `decode` a line \
         | instructions a line |\n|--:|--:|--:|--:|--:|--:|--:|--:|"
    );
    for count in MESSAGES {
        let spec = write(folder, "synthetic.yaml", &specs::messages(count))?;
        let out = folder.join("out");
        let check = cells(&cost(&[Path::new("check"), &spec])?);
        let compile = cells(&cost(&[Path::new("compile"), &spec, Path::new("--out"), &out])?);
        let rust = fs::read_to_string(out.join("synthetic.rs"))?.lines().count() / usize::try_from(count).unwrap_or(1);
        let line = time_a_line(folder, &spec, count)?.as_nanos();
        let instructions = instructions_a_line(folder, &spec, count)?;
        let instructions = instructions.map_or_else(|| "no valgrind".to_owned(), |count| count.to_string());
        println!("| {count} | {check} | {compile} | {rust} | {line} ns | {instructions} |");
    }
    Ok(())
}

/// Prints what a release build of generated code costs, once its dependencies are built.
fn of_builds(folder: &Path) -> io::Result<()> {
    println!("\n| messages with an enum | release build | memory |\n|--:|--:|--:|");
    let root = folder.join("built");
    write_crate(&root)?;
    build(&root)?;
    write(&root, "src/lib.rs", "pub mod synthetic;\n")?;
    for count in BUILT {
        let spec = write(folder, "synthetic.yaml", &specs::enums(count))?;
        cost(&[Path::new("compile"), &spec, Path::new("--out"), &root.join("src")])?;
        println!("| {count} | {} |", cells(&build(&root)?));
    }
    Ok(())
}

/// Writes a crate without code that depends on the runtime.
fn write_crate(root: &Path) -> io::Result<()> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let manifest = format!(
        "[package]\nname = \"built\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         canspec-runtime = {{ path = '{}' }}\n",
        workspace.join("runtime").display()
    );
    fs::create_dir_all(root.join("src"))?;
    fs::copy(workspace.join("Cargo.lock"), root.join("Cargo.lock"))?;
    write(root, "Cargo.toml", &manifest)?;
    write(root, "src/lib.rs", "").map(|_| ())
}

/// Builds a crate for release, and returns what that takes.
fn build(root: &Path) -> io::Result<Cost> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--release", "--offline", "--quiet"]).current_dir(root);
    cargo.env("CARGO_INCREMENTAL", "0").env("CARGO_TARGET_DIR", root.join("target"));
    match Cost::of(&mut cargo)? {
        (cost, true) => Ok(cost),
        (_, false) => Err(io::Error::other("generated code is not built")),
    }
}

/// Prints what logs of more and more lines cost, each decoded as a table, as JSON and as CSV.
fn of_lines(folder: &Path) -> io::Result<()> {
    println!(
        "\n| lines of a log | table | memory | lines a second | JSON | memory | lines a second \
         | CSV | memory | lines a second |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"
    );
    let spec = write(folder, "synthetic.yaml", &specs::messages(100))?;
    for count in LENGTHS {
        let log = log(folder, "long.log", 100, count)?;
        let [table, json, csv] = ["text", "jsonl", "csv"].map(|format| cost(&decode_as(format, &spec, &log)));
        let row =
            |cost: Cost| format!("{} | {:.1} million", cells(&cost), f64::from(count) / cost.wait.as_secs_f64() / 1e6);
        println!("| {count} | {} | {} | {} |", row(table?), row(json?), row(csv?));
    }
    Ok(())
}

/// Prints what specs cost in which one thing grows. Specs with errors are only checked.
fn of_axis(folder: &Path, axis: &Axis) -> io::Result<()> {
    for count in axis.sizes {
        let spec = &write(folder, "growing.yaml", &(axis.spec)(count))?;
        let log = &log(folder, "growing.log", count.min(1 << 16), LOGGED)?;
        let [out, dbc, jsonl] = &["growing", "growing.dbc", "growing.jsonl"].map(|name| folder.join(name));
        let mut times = vec![run(&["check".as_ref(), spec], None)?];
        if times[0].1 {
            let [compile, export, import, list, encode] =
                ["compile", "export", "import", "list", "encode"].map(Path::new);
            let [option, to, from, kind, shark] = ["--spec", "--out", "--from", "dbc", "wireshark"].map(Path::new);
            times.push(run(&[compile, spec, to, out], None)?);
            times.push(run(&[export, kind, option, spec], Some(dbc))?);
            times.push(run(&[import, kind, dbc], None)?);
            times.push(run(&[export, shark, option, spec], None)?);
            times.push(run(&[list, option, spec], None)?);
            times.push(run(&decode(spec, log), Some(jsonl))?);
            times.push(run(&[encode, option, spec, from, Path::new("jsonl"), jsonl], None)?);
        }
        print_row(axis.name, count, times.into_iter().map(|(cost, _)| Some(cost.time)));
    }
    Ok(())
}

/// Prints what a log costs whose lines have a channel each.
fn of_channels(folder: &Path) -> io::Result<()> {
    for count in CHANNELS {
        let lines = (0..count).fold(String::new(), |mut log, line| {
            let _ = writeln!(log, "({line}) c{line} 00000000#0000000000000000");
            log
        });
        let spec = write(folder, "growing.yaml", &specs::messages(1))?;
        let log = write(folder, "growing.log", &lines)?;
        let capture =
            [Path::new("decode"), Path::new("--to"), Path::new("pcapng"), &folder.join("growing.pcapng"), &log];
        let [lines, capture] = [time(&decode(&spec, &log))?, time(&capture)?];
        let none = [None; 6];
        print_row("channels of a log, decoded", count, none.into_iter().chain([Some(lines)]));
        print_row("channels of a log, to pcapng", count, none.into_iter().chain([Some(capture)]));
    }
    Ok(())
}

/// Prints what files of ten messages cost in one call.
fn of_files(folder: &Path) -> io::Result<()> {
    for count in FILES {
        let text = |number| specs::messages(10).replace("synthetic", &format!("synthetic_{number}"));
        let files = (0..count).map(|number| write(folder, &format!("file_{number}.yaml"), &text(number)));
        let files = files.collect::<io::Result<Vec<_>>>()?;
        let files: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
        let check = time(&[&[Path::new("check")], files.as_slice()].concat())?;
        let out = folder.join("files");
        let compile = time(&[&[Path::new("compile"), Path::new("--out"), &out], files.as_slice()].concat())?;
        print_row("files of ten messages", count, [Some(check), Some(compile)].into_iter());
    }
    Ok(())
}

fn print_row(what: &str, count: u32, times: impl Iterator<Item = Option<Duration>>) {
    let shown =
        |time: Option<Duration>| time.map_or_else(|| "-".to_owned(), |time| format!("{:.2} s", time.as_secs_f64()));
    let times: Vec<_> = times.chain([None; 8]).take(8).map(shown).collect();
    println!("| {what} | {count} | {} |", times.join(" | "));
}

/// Writes a log of replies that go through all messages, line by line.
///
/// The system counts the memory of this program in that of a command that it calls.
fn log(folder: &Path, name: &str, messages: u32, lines: u32) -> io::Result<PathBuf> {
    let path = folder.join(name);
    let mut log = BufWriter::new(File::create(&path)?);
    for line in 0..lines {
        // A step without a common divisor goes through all messages in no order that a cache likes.
        let (command, node, mixed) = (line.wrapping_mul(7_919) % messages, line % 64, line.wrapping_mul(2_654_435_761));
        let (seconds, id) = (line / 1_000, command << 10 | node << 3);
        writeln!(log, "({seconds}.{:06}) can0 {id:08X}#{mixed:08X}{line:06X}00", line % 1_000 * 1_000)?;
    }
    log.flush()?;
    Ok(path)
}

fn write(folder: &Path, name: &str, text: &str) -> io::Result<PathBuf> {
    let path = folder.join(name);
    fs::File::create(&path)?.write_all(text.as_bytes())?;
    Ok(path)
}

fn decode<'a>(spec: &'a Path, log: &'a Path) -> [&'a Path; 6] {
    decode_as("jsonl", spec, log)
}

fn decode_as<'a>(format: &'a str, spec: &'a Path, log: &'a Path) -> [&'a Path; 6] {
    let [command, option, format, from] = ["decode", "--format", format, "--spec"].map(Path::new);
    [command, option, format, from, spec, log]
}

/// Returns the processor time that the command takes.
fn time(arguments: &[&Path]) -> io::Result<Duration> {
    cost(arguments).map(|cost| cost.time)
}

/// Returns what the command takes.
fn cost(arguments: &[&Path]) -> io::Result<Cost> {
    match run(arguments, None)? {
        (cost, true) => Ok(cost),
        (_, false) => Err(io::Error::other(format!("canspec {arguments:?} fails"))),
    }
}

/// Returns what the command takes, and whether it finds no error.
fn run(arguments: &[&Path], out: Option<&Path>) -> io::Result<(Cost, bool)> {
    let out = out.map_or_else(|| Ok(Stdio::null()), |path| File::create(path).map(Stdio::from))?;
    Cost::of(command(arguments).stdout(out))
}

fn command(arguments: &[&Path]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    command.args(arguments);
    command
}

/// Returns how long a further line of a log takes.
fn time_a_line(folder: &Path, spec: &Path, messages: u32) -> io::Result<Duration> {
    let [few, many] = TIMED;
    let [least, most] = TIMED.map(|lines| {
        let log = log(folder, "timed.log", messages, lines)?;
        time(&decode(spec, &log))
    });
    Ok(most?.saturating_sub(least?) / (many - few))
}

/// Returns what a further line of a log costs, unless there is no valgrind.
fn instructions_a_line(folder: &Path, spec: &Path, messages: u32) -> io::Result<Option<u64>> {
    let [few, many] = LINES;
    let mut counts = Vec::new();
    for lines in [few, many] {
        let log = log(folder, "counted.log", messages, lines)?;
        counts.extend(instructions(&command(&decode(spec, &log))));
    }
    let [least, most] = counts.as_slice() else { return Ok(None) };
    Ok(Some((most - least) / u64::from(many - few)))
}
