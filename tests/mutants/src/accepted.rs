//! The mistakes that no test finds, each with the reason for which it may stay so.
//!
//! A line names their function and kind, and says after the colon why nobody needs to find them. Most of them leave what
//! the program does as it is. A `*` stands for any part of a function's name, or for any kind.

use std::{fs, io, path::Path};

use super::mistake::{Kind, Mistake};
use super::source::Place;

/// The list of a part.
pub struct Accepted(Vec<Entry>);

/// A line of the list.
struct Entry {
    function: String,
    kind: String,
    /// The line, as it is written.
    line: String,
}

impl Accepted {
    /// Reads a list.
    pub fn read(path: &Path) -> io::Result<Self> {
        let text = fs::read_to_string(path)?;
        let lines = text.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        lines.map(entry).collect::<io::Result<_>>().map(Self)
    }

    /// Tells whether nobody needs to find a mistake.
    pub fn has(&self, mistake: &Mistake) -> bool {
        self.0.iter().any(|entry| entry.is_about(mistake))
    }

    /// Returns the lines that are about none of these mistakes.
    pub fn needless(&self, survivors: &[&Place<'_>]) -> impl Iterator<Item = &str> {
        let is_needed = |entry: &&Entry| survivors.iter().any(|place| entry.is_about(place.mistake));
        self.0.iter().filter(move |entry| !is_needed(entry)).map(|entry| entry.line.as_str())
    }
}

impl Entry {
    fn is_about(&self, mistake: &Mistake) -> bool {
        fits(&self.function, &mistake.function) && fits(&self.kind, mistake.kind.name())
    }
}

fn entry(line: &str) -> io::Result<Entry> {
    let unreadable = || io::Error::other(format!("this line is not `function kind: reason`: {line}"));
    let (what, reason) = line.split_once(": ").ok_or_else(unreadable)?;
    let (function, kind) = what.split_once(' ').ok_or_else(unreadable)?;
    let is_kind = kind == "*" || Kind::ALL.iter().any(|(_, name)| *name == kind);
    if !is_kind || reason.trim().is_empty() {
        return Err(unreadable());
    }
    Ok(Entry { function: function.to_owned(), kind: kind.to_owned(), line: line.to_owned() })
}

/// Tells whether a text is like a pattern, in which `*` stands for anything.
fn fits(pattern: &str, text: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == text,
        Some((start, "")) => text.starts_with(start),
        Some((start, rest)) => text
            .strip_prefix(start)
            .is_some_and(|text| (0..=text.len()).any(|at| text.get(at..).is_some_and(|text| fits(rest, text)))),
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, Mistake, entry};

    #[test]
    fn a_line_is_about_a_function_and_a_kind() {
        let mistake = Mistake {
            function: "Scale::exact".to_owned(),
            kind: Kind::Number,
            whole: String::new(),
            right: String::new(),
            wrong: String::new(),
        };
        let is_about = |line: &str| entry(line).expect("the line can be read").is_about(&mistake);
        for line in ["Scale::exact number: why", "Scale::* number: why", "*::ex*t *: why", "* *: why"] {
            assert!(is_about(line), "{line}");
        }
        for line in ["Scale::exact bits: why", "exact number: why", "Scale::*s number: why", "Scale *: why"] {
            assert!(!is_about(line), "{line}");
        }
    }

    #[test]
    fn a_line_has_a_kind_that_there_is_and_a_reason() {
        for line in ["Scale::exact number", "Scale::exact: why", "Scale::exact numbers: why", "Scale::exact number:  "]
        {
            assert!(entry(line).is_err(), "{line}");
        }
    }
}
