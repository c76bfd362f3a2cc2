//! What cargo is told is made of directives of ours alone, whatever names and texts say.

use std::fs;

use super::super::cargo;
use super::{Crate, HEATER};
use crate::read::source::Source;
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};

/// Tests that each text is one directive of ours, in whatever way its lines are counted.
#[track_caller]
fn assert_directives(lines: &[String]) {
    let ours = ["cargo::rerun-if-changed=", "cargo::warning=", "cargo::error="];
    for line in lines {
        assert!(ours.iter().any(|known| line.starts_with(known)), "{line:?}");
        assert!(is_one_line(line), "{line:?}");
    }
}

/// Tests that nothing ends a line or acts on a terminal.
fn is_one_line(text: &str) -> bool {
    !text.contains(|letter: char| letter.is_control() || "\u{2028}\u{2029}".contains(letter))
}

/// Returns the text with each of its words, one after the other, in double quotes and with something behind it.
fn with_each_word_extended<'a>(text: &'a str, behind: &'a str) -> impl Iterator<Item = String> + 'a {
    let is_inside = |letter: char| letter.is_ascii_alphanumeric() || "_./#".contains(letter);
    let starts = text.char_indices().filter(move |(at, letter)| {
        is_inside(*letter) && !text[..*at].ends_with(|before: char| is_inside(before) || before == '"')
    });
    starts.map(move |(start, _)| {
        let (before, word) = text.split_at(start);
        let (word, after) = word.split_at(word.find(|letter| !is_inside(letter)).unwrap_or(word.len()));
        format!("{before}\"{word}{behind}\"{after}")
    })
}

/// Returns all that is said of a spec: messages, helps, names of the file, labels, those of other places, replacements.
fn said(refused: &[Diagnostics]) -> [Vec<String>; 6] {
    let mut said: [Vec<String>; 6] = Default::default();
    for found in refused.iter().flat_map(Diagnostics::located) {
        said[0].push(found.message.to_owned());
        said[1].extend(found.help.map(str::to_owned));
        said[2].push(found.file.to_owned());
        said[3].extend(found.label.map(str::to_owned));
        said[4].extend(found.others.iter().map(|other| other.text.to_owned()));
        said[5].extend(found.replacement.map(str::to_owned));
    }
    said
}

#[test]
fn no_text_of_a_spec_begins_a_line_that_cargo_reads() {
    let name = "specs/\ncargo::rustc-env=EVIL=1.yaml";
    let root = Crate::new(&[]);
    let builder = root.builder().spec(root.path(name));
    let mut repeated = [0; 6];
    for escape in [r"\n", r"\r", r"\r\n", r"\L", r"\P", r"\N", r"\e[2J"] {
        for spec in with_each_word_extended(HEATER, &format!("{escape}cargo::rustc-env=EVIL=1")) {
            root.put(name, &spec);
            assert_directives(&root.lines(&builder));
            let said = said(&builder.compile().err().unwrap_or_default());
            for (texts, repeated) in said.iter().zip(&mut repeated) {
                assert!(texts.iter().all(|text| is_one_line(text)), "{texts:?}");
                *repeated += texts.iter().filter(|text| text.contains("EVIL")).count();
            }
        }
    }
    let [messages, helps, names, ..] = repeated;
    assert!(messages > 0 && helps > 0 && names > 0, "{repeated:?}");
}

#[test]
fn nothing_that_a_diagnostic_says_begins_a_line() {
    for end in ["\n", "\r", "\r\n", "\u{2028}", "\u{85}", "\u{1b}[2J"] {
        let text = || format!("a{end}cargo::rustc-env=EVIL=1{end}");
        let source = Source::new(text(), Vec::new()).expect("it is empty");
        let found = Diagnostic::error(&crate::read::source::rules::FILE, At::File, text());
        let found = found.label(text()).other(At::File, text()).help(text()).replacement(text());
        let found = Diagnostics::new(source).with([found]);
        assert_directives(&cargo::diagnostics(&found));
        for texts in said(&[found]) {
            assert!(texts.len() == 1 && is_one_line(&texts[0]), "{texts:?}");
        }
    }
}

#[cfg(unix)]
#[test]
fn no_name_of_a_file_begins_a_line_that_cargo_reads() {
    for hostile in ["\n", "\r", "\r\n", "\u{2028}", "\u{85}", "\u{1b}[2J"] {
        let name = |ending: &str| format!("specs/{hostile}cargo::rustc-env=EVIL=1{hostile}.{ending}");
        for (name, text) in [(name("yaml"), HEATER), (name("yaml"), "a: ["), (name("yml"), HEATER)] {
            assert_directives(&Crate::new(&[(&name, text)]).build());
        }
        let root = Crate::new(&[("a.yaml", HEATER), ("specs/b.yaml", HEATER)]);
        let (folder, missing) = (root.path(&name("d")), root.path(&name("none")));
        fs::create_dir(&folder).expect("the folder is new");
        fs::rename(root.path("a.yaml"), folder.join("a.yaml")).expect("the folder is there");
        assert_directives(&root.builder().folder(&folder).spec(root.path("specs/b.yaml")).run());
        assert_directives(&root.builder().folder(&missing).run());
        fs::write(root.path("out"), "").expect("nothing is there");
        assert_directives(&root.builder().folder(&folder).out_dir(root.path("out").join(hostile)).run());
    }
}

#[cfg(unix)]
#[test]
fn the_name_of_a_spec_begins_no_line_of_the_code() {
    for separator in ["\n", "\r", "\u{2028}"] {
        let root = Crate::new(&[(&format!("specs/a{separator}compile_error!();.yaml"), HEATER)]);
        root.build();
        let first = "// @generated by canspec-codegen from a\u{FFFD}compile_error!();.yaml; do not edit.\n\n";
        assert!(root.written()["heater.rs"].starts_with(first), "{separator:?}");
    }
}
