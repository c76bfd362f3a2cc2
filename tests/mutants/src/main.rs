//! Plants one mistake after the other in a copy of the sources, and proves that the tests find each.
//!
//! The mistakes are made from the syntax of the sources. Arguments choose among them:
//! - words: those whose part, file and line of output have them all;
//! - `--since REVISION`: those in functions that have changed;
//! - `--at-most NUMBER`: no more than this of each part;
//! - `--list`: all are listed, and none is planted.
#![expect(clippy::print_stdout, reason = "the table is what people call it for")]

mod accepted;
mod before;
mod choice;
mod copy;
mod mistake;
mod part;
mod plant;
mod source;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, io, thread};

use accepted::Accepted;
use choice::Choice;
use copy::{Copy, Verdict};
use part::{PARTS, Part};
use source::{Place, Source};

/// What became of the mistakes of a part.
#[derive(Default)]
struct Counts {
    planted: usize,
    no_rust: usize,
    accepted: usize,
    survived: usize,
    /// Lines of the list of accepted survivors that no survivor needs.
    needless: usize,
}

fn main() -> ExitCode {
    match all_are_found() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn all_are_found() -> io::Result<bool> {
    let choice = Choice::from_arguments()?;
    let folder = env::current_exe()?.with_file_name("mutated");
    let counts = thread::scope(|scope| {
        let counts = PARTS.each_ref().map(|part| scope.spawn(|| counts(part, &choice, &folder.join(part.name))));
        counts.map(|counts| counts.join().expect("a part does not panic")).into_iter().collect::<io::Result<Vec<_>>>()
    })?;
    match &choice.since {
        _ if choice.is_list => {}
        Some(since) if counts.iter().all(|counts| counts.planted == 0) => {
            println!("no function in which mistakes are planted has changed since {since}");
        }
        _ => print(&counts),
    }
    Ok(counts.iter().all(|counts| counts.survived == 0 && counts.needless == 0))
}

fn print(counts: &[Counts]) {
    println!("\n| part | planted | no Rust | found | accepted | survived |\n|---|---:|---:|---:|---:|---:|");
    for (part, Counts { planted, no_rust, accepted, survived, .. }) in PARTS.iter().zip(counts) {
        let found = planted - no_rust - accepted - survived;
        println!("| {} | {planted} | {no_rust} | {found} | {accepted} | {survived} |", part.name);
    }
}

/// Plants the mistakes of a part, and prints a line for each.
fn counts(part: &'static Part, choice: &Choice, folder: &Path) -> io::Result<Counts> {
    let accepted = Accepted::read(&root().join("tests/mutants/accepted").join(part.name).with_extension("txt"))?;
    let sources = Source::all(part, &root())?;
    let wanted = choice.of(part, &root(), &sources, &accepted)?;
    if choice.is_list {
        wanted.iter().map(|place| place.mistake).for_each(|mistake| println!("{}: {mistake}", part.name));
        return Ok(Counts::default());
    }
    let mut counts = Counts::default();
    if !wanted.is_empty() {
        let copy = Copy::new(&root(), folder, part)?;
        sources.iter().try_for_each(|source| source.print(&copy))?;
        copy.check()?;
        let survivors = survivors(&wanted, &copy, &accepted, &mut counts)?;
        if choice.is_everything() {
            counts.needless = needless(part, &accepted, &survivors);
        }
    }
    Ok(counts)
}

fn survivors<'a>(
    wanted: &'a [Place<'a>],
    copy: &Copy,
    accepted: &Accepted,
    counts: &mut Counts,
) -> io::Result<Vec<&'a Place<'a>>> {
    let mut survivors = Vec::new();
    for place in wanted {
        let verdict = place.verdict(copy)?;
        let is_accepted = accepted.has(place.mistake);
        println!("{}: {}: {verdict}", copy.part.name, place.mistake);
        counts.add(&verdict, is_accepted);
        if verdict == Verdict::Survived {
            survivors.push(place);
        }
    }
    Ok(survivors)
}

impl Counts {
    fn add(&mut self, verdict: &Verdict, is_accepted: bool) {
        self.planted += 1;
        match verdict {
            Verdict::Found(_) => {}
            Verdict::DoesNotCompile => self.no_rust += 1,
            Verdict::Survived if is_accepted => self.accepted += 1,
            Verdict::Survived => self.survived += 1,
        }
    }
}

/// Prints the accepted survivors that do not survive, and counts them.
fn needless(part: &Part, accepted: &Accepted, survivors: &[&Place<'_>]) -> usize {
    let lines = accepted.needless(survivors);
    lines.map(|line| println!("{}: no mistake needs this line: {line}", part.name)).count()
}

/// Returns the folder of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
