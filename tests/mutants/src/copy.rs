//! A copy of the sources, in which mistakes are planted.

use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{fs, io};

use super::part::Part;

/// What became of a mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// These tests fail; none of them if the program does not come to its end.
    Found(Vec<String>),
    /// All tests pass.
    Survived,
    /// What it makes is no Rust.
    DoesNotCompile,
}

impl Display for Verdict {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Found(tests) => match tests.as_slice() {
                [] => formatter.write_str("the limit of time or memory"),
                [first, others @ ..] if !others.is_empty() => write!(formatter, "`{first}` and {} more", others.len()),
                tests => write!(formatter, "`{}`", tests.concat()),
            },
            Self::Survived => formatter.write_str("**nothing**"),
            Self::DoesNotCompile => formatter.write_str("the compiler"),
        }
    }
}

/// Seconds of a processor, and kilobytes, that a program may take: a mistake can make it run for ever.
const LIMITS: &str = "ulimit -t 120 -v 8000000; exec cargo test \"$@\"";

/// A copy of the sources and the tests that are run in it.
pub struct Copy {
    sources: PathBuf,
    build: PathBuf,
    /// The part in which mistakes are planted.
    pub part: &'static Part,
}

impl Copy {
    /// Copies the files that git tracks, and those that it would.
    pub fn new(root: &Path, folder: &Path, part: &'static Part) -> io::Result<Self> {
        let (sources, build) = (folder.join("sources"), folder.join("build"));
        if sources.exists() {
            fs::remove_dir_all(&sources)?;
        }
        let listed = Command::new("git")
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .current_dir(root)
            .output()?;
        for file in String::from_utf8_lossy(&listed.stdout).split_terminator('\0') {
            copy(&root.join(file), &sources.join(file))?;
        }
        Ok(Self { sources, build, part })
    }

    /// Writes a file of the copy as it is printed from its syntax.
    pub fn write(&self, file: &Path, syntax: &syn::File) -> io::Result<()> {
        fs::write(self.sources.join(file), prettyplease::unparse(syntax))
    }

    /// Runs the tests on the sources without a mistake.
    pub fn check(&self) -> io::Result<()> {
        let run = self.cargo(&[])?;
        let complaint = || io::Error::other(format!("without a mistake the tests fail\n{}", text(&run)));
        run.status.success().then_some(()).ok_or_else(complaint)
    }

    /// Runs the tests with a mistake.
    pub fn verdict(&self) -> io::Result<Verdict> {
        if !self.cargo(&["--no-run"])?.status.success() {
            return Ok(Verdict::DoesNotCompile);
        }
        let run = self.cargo(&[])?;
        Ok(if run.status.success() { Verdict::Survived } else { Verdict::Found(failed(&text(&run))) })
    }

    /// Builds for speed of building, and runs the tests.
    fn cargo(&self, arguments: &[&str]) -> io::Result<Output> {
        Command::new("bash")
            .args(["-c", LIMITS, "cargo"])
            .args(self.part.tests)
            .args(arguments)
            .arg("--target-dir")
            .arg(&self.build)
            .env("CARGO_PROFILE_DEV_OPT_LEVEL", self.part.optimization)
            .env("CARGO_PROFILE_DEV_DEBUG", "false")
            .env("CARGO_INCREMENTAL", "1")
            .current_dir(&self.sources)
            .output()
    }
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    if from.is_file() {
        fs::create_dir_all(to.parent().unwrap_or(to))?;
        fs::copy(from, to)?;
    }
    Ok(())
}

/// Returns the names of the tests that fail, in order.
fn failed(text: &str) -> Vec<String> {
    let names = text.lines().filter_map(|line| line.strip_prefix("test ")?.strip_suffix(" ... FAILED"));
    let names: BTreeSet<_> = names.map(str::to_owned).collect();
    names.into_iter().collect()
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}
