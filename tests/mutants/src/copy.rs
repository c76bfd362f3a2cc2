//! A copy of the sources, in which mistakes are planted.

use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{fs, io};

use super::list::Mutant;

/// What became of a mistake.
#[derive(Clone)]
pub enum Verdict {
    /// These tests fail.
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
                [first, others @ ..] if !others.is_empty() => write!(formatter, "`{first}` and {} more", others.len()),
                tests => write!(formatter, "`{}`", tests.concat()),
            },
            Self::Survived => formatter.write_str("**nothing**"),
            Self::DoesNotCompile => formatter.write_str("**the compiler**"),
        }
    }
}

/// A copy of the sources and the tests that are run in it.
pub struct Copy {
    sources: PathBuf,
    build: PathBuf,
    tests: &'static [&'static str],
}

impl Copy {
    /// Copies the files that git tracks, and those that it would.
    pub fn new(root: &Path, folder: &Path, tests: &'static [&'static str]) -> io::Result<Self> {
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
        Ok(Self { sources, build, tests })
    }

    /// Runs the tests on the sources as they are.
    pub fn check(&self) -> io::Result<()> {
        let run = self.cargo(&[])?;
        let complaint = || io::Error::other(format!("without a mistake the tests fail\n{}", text(&run)));
        run.status.success().then_some(()).ok_or_else(complaint)
    }

    /// Runs the tests with a mistake, and takes it out again.
    pub fn verdict(&self, mutant: &Mutant) -> io::Result<Verdict> {
        let path = self.sources.join(&mutant.file);
        let right = fs::read_to_string(&path)?;
        fs::write(&path, mutant.planted(&self.sources)?)?;
        let verdict = self.tested();
        fs::write(&path, right)?;
        verdict
    }

    fn tested(&self) -> io::Result<Verdict> {
        if !self.cargo(&["--no-run"])?.status.success() {
            return Ok(Verdict::DoesNotCompile);
        }
        let run = self.cargo(&["--no-fail-fast"])?;
        let failed = failed(&text(&run));
        match (run.status.success(), failed.is_empty()) {
            (true, _) => Ok(Verdict::Survived),
            (false, false) => Ok(Verdict::Found(failed)),
            (false, true) => Err(io::Error::other(format!("no test fails, but the call does\n{}", text(&run)))),
        }
    }

    /// Builds for speed of building, and runs the tests.
    fn cargo(&self, arguments: &[&str]) -> io::Result<Output> {
        Command::new("cargo")
            .arg("test")
            .args(self.tests)
            .args(arguments)
            .arg("--target-dir")
            .arg(&self.build)
            .env("CARGO_PROFILE_DEV_OPT_LEVEL", "0")
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
