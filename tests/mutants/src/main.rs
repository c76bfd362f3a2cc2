//! Plants one mistake after the other in a copy of the sources, and proves that the tests find each.
//!
//! With words as arguments, only the mistakes whose parts and titles have them all.
#![expect(clippy::print_stdout, reason = "the table is what people call it for")]

mod copy;
mod list;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, io, thread};

use copy::{Copy, Verdict};
use list::Mutant;

/// A part of the sources, and the cheapest tests that find mistakes in it.
struct Group {
    name: &'static str,
    mutants: &'static str,
    tests: &'static [&'static str],
}

const GROUPS: [Group; 3] = [
    Group {
        name: "runtime",
        mutants: include_str!("../lists/runtime.txt"),
        tests: &["--package", "canspec-runtime", "--lib"],
    },
    Group {
        name: "interpreter",
        mutants: include_str!("../lists/interpreter.txt"),
        tests: &["--package", "canspec-codegen", "--test", "interpreter"],
    },
    Group {
        name: "emitter",
        mutants: include_str!("../lists/emitter.txt"),
        tests: &["--manifest-path", "tests/downstream/Cargo.toml", "--test", "*"],
    },
];

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
    let folder = env::current_exe()?.with_file_name("mutated");
    println!("| part | mistake | found by |\n|---|---|---|");
    let verdicts = thread::scope(|scope| {
        let groups = GROUPS.each_ref().map(|group| scope.spawn(|| verdicts(group, &folder.join(group.name))));
        groups.map(|group| group.join().expect("a group does not panic")).into_iter().collect::<io::Result<Vec<_>>>()
    })?;
    let verdicts = verdicts.concat();
    let unfound = verdicts.iter().filter(|verdict| !matches!(verdict, Verdict::Found(_))).count();
    println!("\n{} mistakes, {unfound} of them not found.", verdicts.len());
    Ok(unfound == 0)
}

/// Plants the mistakes of a group, and prints a row for each.
fn verdicts(group: &Group, folder: &Path) -> io::Result<Vec<Verdict>> {
    let is_wanted =
        |mutant: &Mutant| env::args().skip(1).all(|word| group.name.contains(&word) || mutant.mistake.contains(&word));
    let mutants: Vec<_> = list::parse(group.mutants)?.into_iter().filter(is_wanted).collect();
    if mutants.is_empty() {
        return Ok(Vec::new());
    }
    let copy = Copy::new(&root(), folder, group.tests)?;
    copy.check()?;
    let verdict = |mutant: &Mutant| {
        let verdict = copy.verdict(mutant)?;
        println!("| {} | {} | {verdict} |", group.name, mutant.mistake);
        Ok(verdict)
    };
    mutants.iter().map(verdict).collect()
}

/// Returns the folder of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[cfg(test)]
mod tests {
    use super::{GROUPS, list, root};

    #[test]
    fn each_mistake_has_its_place_in_the_sources() {
        for group in GROUPS {
            for mutant in list::parse(group.mutants).expect("the list can be read") {
                if let Err(error) = mutant.planted(&root()) {
                    panic!("{error}");
                }
            }
        }
    }
}
