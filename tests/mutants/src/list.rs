//! The mistakes as they are written down.
//!
//! An entry says what is wrong and in which file; then come the lines of the file that `-` marks, and those that `+` marks
//! in their place. A line can leave out what stands around the mistake. Entries are separated by blank lines.

use std::path::Path;
use std::{fs, io};

/// A mistake that can be planted.
#[derive(Debug)]
pub struct Mutant {
    /// What is wrong, in a few words.
    pub mistake: String,
    /// File in the workspace.
    pub file: String,
    /// What stands there exactly once.
    pub right: String,
    /// What stands there instead.
    pub wrong: String,
}

impl Mutant {
    /// Returns the file of these sources with the mistake in it.
    pub fn planted(&self, sources: &Path) -> io::Result<String> {
        let Self { mistake, file, right, wrong } = self;
        let text = fs::read_to_string(sources.join(file))?;
        match text.matches(right.as_str()).count() {
            1 => Ok(text.replace(right, wrong)),
            count => Err(io::Error::other(format!("{mistake}: {file} has {count} times, not once,\n{right}"))),
        }
    }
}

/// Reads a list.
pub fn parse(list: &str) -> io::Result<Vec<Mutant>> {
    list.split("\n\n").map(str::trim_end).filter(|entry| !entry.is_empty()).map(entry).collect()
}

fn entry(entry: &str) -> io::Result<Mutant> {
    let mut lines = entry.lines();
    let (Some(mistake), Some(file)) = (lines.next(), lines.next()) else { return Err(unreadable(entry)) };
    let (right, wrong): (Vec<_>, Vec<_>) = lines.partition(|line| line.starts_with("- "));
    match (text(&right, "- "), text(&wrong, "+ ")) {
        (Some(right), Some(wrong)) => Ok(Mutant { mistake: mistake.to_owned(), file: file.to_owned(), right, wrong }),
        _ => Err(unreadable(entry)),
    }
}

/// Joins lines of which each has the mark, at least one.
fn text(lines: &[&str], mark: &str) -> Option<String> {
    let lines: Option<Vec<_>> = lines.iter().map(|line| line.strip_prefix(mark)).collect();
    lines.filter(|lines| !lines.is_empty()).map(|lines| lines.join("\n"))
}

fn unreadable(entry: &str) -> io::Error {
    io::Error::other(format!("this entry is not a title, a file, lines with `- ` and lines with `+ `:\n{entry}"))
}
