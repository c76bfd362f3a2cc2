//! Prints how many bytes generated code takes, as a Markdown table. Words choose among its rows.
#![expect(clippy::print_stdout, reason = "the table is what people call it for")]

use std::env::consts::ARCH;
use std::path::Path;
use std::{env, io, thread};

use canspec_codegen::emit::{Goal, Scaled};
use canspec_tests::bare::{Codec, Program, Settings, Size, is_installed};

/// The targets: this machine, and the processors of small devices if the toolchain has them.
const TARGETS: [(&str, Option<&str>); 2] = [(ARCH, None), ("Cortex-M4F", Some("thumbv7em-none-eabihf"))];
/// The optimizations, with their profiles and goals.
const PROFILES: [(&str, &str, Goal); 2] = [("z", "z", Goal::Size), ("3", "three", Goal::Speed)];

/// A way to compile.
struct Column {
    heading: String,
    settings: Settings<'static>,
    goal: Goal,
    empty: Size,
}

fn main() -> io::Result<()> {
    let folder = env::current_exe()?.with_file_name("bare");
    let columns = columns(&folder)?;
    let headings: Vec<_> = columns.iter().map(|column| column.heading.as_str()).collect();
    println!("Bytes of code + constants, beyond those of an empty program.\n");
    for (name, target) in missing() {
        println!(
            "SKIPPED: {name}, for which the toolchain has no {target}; `rustup target add {target}` installs it\n"
        );
    }
    println!("| | {} |\n|---|{}", headings.join(" | "), "---:|".repeat(headings.len()));
    let words: Vec<_> = env::args().skip(1).collect();
    for ((name, small), (_, fast)) in programs(Goal::Size).into_iter().zip(programs(Goal::Speed)) {
        if words.iter().all(|word| name.contains(word)) {
            println!("| {name} | {} |", cells(&small, &fast, &folder, &columns)?.join(" | "));
        }
    }
    Ok(())
}

fn columns(folder: &Path) -> io::Result<Vec<Column>> {
    let targets = TARGETS.into_iter().filter(|(_, target)| target.is_none_or(is_installed));
    let columns = targets.flat_map(|(name, target)| {
        PROFILES.map(|(level, profile, goal)| {
            let settings = Settings { profile, target };
            let empty = size(&Program::empty(), folder, settings)?;
            Ok(Column { heading: format!("{name}, {level}"), settings, goal, empty })
        })
    });
    columns.collect()
}

/// Returns the targets that the toolchain lacks, each with its name.
fn missing() -> impl Iterator<Item = (&'static str, &'static str)> {
    TARGETS.into_iter().filter_map(|(name, target)| Some((name, target.filter(|target| !is_installed(target))?)))
}

/// Returns the programs to measure, each with its name, of codecs with a goal.
fn programs(goal: Goal) -> Vec<(String, Program)> {
    let of_scaled = |(what, scaled): (&str, Scaled)| {
        let codecs = Codec::all("specs", scaled, goal);
        codecs.iter().flat_map(|codec| of_codec(codec, what)).collect::<Vec<_>>()
    };
    let by_hand = [
        ("`infy` by hand: decode".to_owned(), Program::decode_by_hand()),
        ("`infy` by hand: encode".to_owned(), Program::encode_by_hand()),
    ];
    [("", Scaled::F64), (" in whole steps", Scaled::Steps)].into_iter().flat_map(of_scaled).chain(by_hand).collect()
}

/// Returns the programs of a codec, each with its name.
fn of_codec(codec: &Codec, what: &str) -> Vec<(String, Program)> {
    let name = codec.name();
    let mut programs = vec![
        (format!("`{name}`{what}: decode"), Program::decode(codec)),
        (format!("`{name}`{what}: visit"), Program::visit(codec)),
        (format!("`{name}`{what}: encode"), Program::encode(codec)),
    ];
    let message = codec.one_message();
    programs.extend(message.map(|message| (format!("`{name}`{what}: `{message}` alone"), Program::one_message(codec))));
    programs
}

/// Compiles a program in each way, side by side: the one that is small, or the one that is fast.
fn cells(small: &Program, fast: &Program, folder: &Path, columns: &[Column]) -> io::Result<Vec<String>> {
    let program = |column: &Column| if column.goal == Goal::Size { small } else { fast };
    thread::scope(|scope| {
        let cell = |column| scope.spawn(move || cell(program(column), folder, column));
        let cells: Vec<_> = columns.iter().map(cell).collect();
        cells.into_iter().map(|cell| cell.join().expect("no cell panics")).collect()
    })
}

/// Returns by how much a program is larger than the empty one.
fn cell(program: &Program, folder: &Path, column: &Column) -> io::Result<String> {
    let Size { code, constants } = size(program, folder, column.settings)? - column.empty;
    Ok(format!("{code} + {constants}"))
}

fn size(program: &Program, folder: &Path, settings: Settings<'_>) -> io::Result<Size> {
    program.link(folder, settings)?.map(|binary| binary.size()).map_err(io::Error::other)
}
