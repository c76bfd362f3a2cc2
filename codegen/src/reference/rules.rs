//! The rules that a spec must keep, by id. Each has its document in the folder `docs/rules`.

use std::sync::LazyLock;

use crate::model::NoteRule;
use crate::read::{lint, source, syntax};
pub use crate::report::rule::{Rule, Stage};
use crate::{check, resolve};

/// Every rule, in the order of the stages, and within a stage in the order of application.
pub static RULES: LazyLock<Vec<&'static Rule>> = LazyLock::new(|| {
    let read = [source::rules::RULES, syntax::rules::RULES].concat();
    let lint = lint::RULES.iter().map(|(rule, _)| *rule);
    let resolve = resolve::rules::RULES.iter().copied();
    let check = check::RULES.iter().map(|(rule, _)| *rule);
    read.into_iter().chain(lint).chain(resolve).chain(check).collect()
});

/// Finds a rule by its id.
pub fn find(name: &str) -> Option<&'static Rule> {
    RULES.iter().copied().find(|rule| rule.name == name)
}

/// Returns the documents of all rules, and of all notes on frames, as one text in Markdown.
pub fn reference() -> String {
    let rules = RULES.iter().map(|rule| chapter(rule));
    let notes = NoteRule::ALL.into_iter().map(|(note, name)| chapter_of_note(note, name));
    std::iter::once(contents()).chain(rules).chain([contents_of_notes()]).chain(notes).collect()
}

fn contents() -> String {
    let rows = RULES.iter().map(|rule| {
        let Rule { name, stage, .. } = rule;
        format!("| [`{name}`](#{name}) | {stage} | {} | {} |\n", rule.gives(), rule.summary())
    });
    std::iter::once(HEADING.to_owned()).chain(rows).collect()
}

fn chapter(rule: &Rule) -> String {
    let Rule { name, document, .. } = rule;
    // The documents leave the name out, because rustdoc reads a word with `=` as an attribute of
    // its own.
    let document = document.replace("```yaml fails\n", &format!("```yaml fails={name}\n"));
    format!("\n## `{name}`\n\n{document}")
}

fn contents_of_notes() -> String {
    let rows = NoteRule::ALL.into_iter().map(|(note, name)| {
        let summary = note.document().lines().next().unwrap_or_default();
        format!("| [`{name}`](#the-note-{name}) | {} |\n", summary.trim_start_matches("A note: "))
    });
    std::iter::once(HEADING_OF_NOTES.to_owned()).chain(rows).collect()
}

/// Returns the document of a note. Its heading differs from that of a rule with the same name.
fn chapter_of_note(note: NoteRule, name: &str) -> String {
    format!("\n### The note `{name}`\n\n{}", note.document())
}

const HEADING: &str = "\
# The rules

Every error and every warning about a spec names the broken rule, as in `error[overlap]`.
`canspec rules overlap` prints the chapter below. The [notes on frames](#notes-on-frames) stand
behind the rules.

Each block of YAML extends [the smallest spec](language.md#a-whole-spec). The first block of a rule
breaks it, and the block after `Write instead` does not. An intended warning can be allowed with a
reason, as [`allow`](language/reference.md#allow) says, but an error cannot.

A stage begins only if the stage before it found no error, so a corrected spec can show errors that
were there before.

This page is generated from the documents in `codegen/docs/rules` and `codegen/docs/notes`.

| rule | stage | gives | what breaks it |
|---|---|---|---|
";

const HEADING_OF_NOTES: &str = "
## Notes on frames

A decoded frame has a note for each thing that the document does not foresee. A note is no error of
a spec, and its frame is shown whole. `canspec rules reserved_bit` prints the chapter below.

| note | what it says |
|---|---|
";
