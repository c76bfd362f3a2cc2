//! The first screen of the README: its spec gives its Rust, and its calls answer as they stand there. So do those of the
//! page on logs.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

/// The log that the README decodes: the request and the reply of its set-point.
const LOG: &str = "(0.0) can0 123#070C01\n(0.1) can0 523#070C01\n";

#[test]
fn the_readme_begins_with_a_spec_and_its_rust() {
    let folder = folder_with_spec();
    let call = ["compile", "oven.yaml", "--out", "."];
    assert_eq!(call_in(folder.path(), &call.join(" ")), "");
    let generated = fs::read_to_string(folder.path().join("oven.rs")).expect("the Rust is there");
    let shown = block("rs");
    assert!(generated.contains(&shown), "the Rust of the spec has nowhere\n{shown}");
}

#[test]
fn the_calls_of_the_first_screen_answer_as_it_shows() {
    let folder = folder_with_spec();
    let screens = blocks("console");
    assert_eq!(screens.len(), 2, "there are calls, and a mistake");
    assert_answers(folder.path(), &screens);
}

#[test]
fn the_calls_of_the_page_on_logs_answer_as_it_shows() {
    let screens = blocks_of("docs/how-to/logs.md", "console");
    assert_eq!(screens.len(), 4, "it identifies, decodes twice, and explains a note");
    assert_answers(&root(), &screens);
}

/// Makes the calls of some screens, and compares their answers.
fn assert_answers(folder: &Path, screens: &[String]) {
    for call in screens.iter().flat_map(|screen| screen.split("$ canspec ").skip(1)) {
        let (arguments, answer) = call.split_once('\n').expect("a call has an answer");
        assert_eq!(call_in(folder, arguments), answer, "{arguments}");
    }
}

/// Returns a folder with the README's spec, a copy with a mistake, and a log.
fn folder_with_spec() -> TempDir {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let spec = block("yaml");
    let mistyped = spec.replace("means: {temperature: 180 °C", "means: {temperature: 18 °C");
    for (name, text) in [("oven.yaml", spec.as_str()), ("mistyped.yaml", &mistyped), ("bus.log", LOG)] {
        fs::write(folder.path().join(name), text).expect("the folder can be written");
    }
    folder
}

/// Returns what a call writes, errors first.
fn call_in(folder: &Path, arguments: &str) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let done = command.args(arguments.split(' ')).current_dir(folder).output().expect("the command was built");
    [done.stderr, done.stdout].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat()
}

fn block(language: &str) -> String {
    blocks(language).into_iter().next().expect("the README has such a block")
}

/// Returns the blocks of the README that have a language.
fn blocks(language: &str) -> Vec<String> {
    blocks_of("README.md", language)
}

fn blocks_of(page: &str, language: &str) -> Vec<String> {
    let page = fs::read_to_string(root().join(page)).expect("the page is there");
    let fenced = page.split("```").skip(1).step_by(2).filter_map(|block| block.split_once('\n'));
    fenced.filter(|(of, _)| *of == language).map(|(_, text)| text.to_owned()).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}
