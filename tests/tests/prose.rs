//! People read plain English: sentences are neither long nor choppy, and lines fit a screen.

use std::fs;
use std::path::Path;
use std::process::Command;

use canspec_tests::prose::{Sentence, sentences, short_runs, wide_lines};

/// Number of words in the longest sentence.
const LONGEST: usize = 40;
/// Number of words up to which a sentence is short.
const SHORT: usize = 8;
/// Number of short sentences in a row, from which on they sound like a drum.
const RUN: usize = 4;
/// Number of characters in the longest line of Markdown.
const WIDEST: usize = 100;
/// Words that have plainer equivalents, and words after which the verb stands before the subject.
const AVOIDED: [&str; 19] = [
    "of which",
    "of whom",
    "so many",
    "in order to",
    "utilise",
    "whoever",
    "the former",
    "the latter",
    "respectively",
    "so is",
    "so are",
    "so do",
    "so does",
    "so has",
    "nor is",
    "nor are",
    "nor do",
    "nor does",
    "nor has",
];

#[test]
fn no_sentence_has_more_words_than_a_reader_keeps() {
    complain(|sentence| {
        let words = sentence.words();
        (words > LONGEST).then(|| format!("has {words} words, more than {LONGEST}"))
    });
}

#[test]
fn no_paragraph_is_cut_into_short_sentences() {
    let runs = files().into_iter().flat_map(|name| {
        let sentences = sentences(&name, &read(&name));
        let long = short_runs(&sentences, SHORT).into_iter().filter(|run| run.len() >= RUN);
        long.flatten().map(|one| format!("{name}:{}: {}", one.line, one.text)).collect::<Vec<_>>()
    });
    let runs: Vec<_> = runs.collect();
    assert!(runs.is_empty(), "sentences to connect:\n{}", runs.join("\n"));
}

#[test]
fn no_sentence_has_words_for_which_there_are_plainer_ones() {
    complain(|sentence| {
        let avoided = AVOIDED.iter().find(|avoided| sentence.says(avoided))?;
        Some(format!("says `{avoided}`"))
    });
}

#[test]
fn no_line_of_markdown_is_wider_than_a_screen() {
    let texts = files().into_iter().filter(|name| Path::new(name).extension().is_some_and(|ending| ending == "md"));
    let wide = texts.flat_map(|name| {
        let lines: Vec<_> = wide_lines(&read(&name), WIDEST).collect();
        lines.into_iter().map(move |line| format!("{name}:{line}"))
    });
    let wide: Vec<_> = wide.collect();
    assert!(wide.is_empty(), "wider than {WIDEST} characters:\n{}", wide.join("\n"));
}

/// Fails with all sentences that have something wrong.
fn complain(wrong: impl Fn(&Sentence) -> Option<String>) {
    let mut complaints = Vec::new();
    for name in files() {
        for sentence in sentences(&name, &read(&name)) {
            complaints
                .extend(wrong(&sentence).map(|why| format!("{name}:{}: {why}: {}", sentence.line, sentence.text)));
        }
    }
    assert!(complaints.is_empty(), "{} sentences to write again:\n{}", complaints.len(), complaints.join("\n"));
}

/// Returns the names of the repository's files without the generated ones and the list of changes.
fn files() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let listed = Command::new("git").current_dir(root).args(["ls-files", "-z"]).output().expect("git runs");
    let names = String::from_utf8(listed.stdout).expect("names of files are texts");
    names
        .split_terminator('\0')
        .filter(|name| !name.contains(".snap") && *name != "CHANGELOG.md")
        .map(str::to_owned)
        .collect()
}

/// Reads a file. A file that is no text counts as empty.
fn read(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    fs::read_to_string(path).unwrap_or_default()
}
