//! The rules that a spec must keep, by id. Each has its document in the folder `rules`.

use std::sync::LazyLock;

pub use crate::rule::{Rule, Stage};
use crate::{bases, check, lint, resolve, source, syntax};

/// Every rule, in the order of the stages, and within a stage in the order of application.
pub static RULES: LazyLock<Vec<&'static Rule>> = LazyLock::new(|| {
    let read = [source::rules::RULES, bases::RULES, syntax::rules::RULES].concat();
    let lint = lint::RULES.iter().map(|(rule, _)| *rule);
    let resolve = resolve::rules::RULES.iter().copied();
    let check = check::RULES.iter().map(|(rule, _)| *rule);
    read.into_iter().chain(lint).chain(resolve).chain(check).collect()
});

/// Finds a rule by its id.
pub fn find(name: &str) -> Option<&'static Rule> {
    RULES.iter().copied().find(|rule| rule.name == name)
}

/// Returns the documents of all rules as one text in Markdown.
pub fn reference() -> String {
    std::iter::once(contents()).chain(RULES.iter().map(|rule| chapter(rule))).collect()
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

const HEADING: &str = "\
# The rules

Every error and every warning about a spec names the broken rule, as in `error[overlap]`.
`canspec rules overlap` prints the chapter below.

Each block of YAML extends the smallest spec of the [language reference](language.md). The first
block of a rule breaks it, and the block after `Write instead` does not. An intended warning can be
allowed with a reason: see [`allow`](language/reference.md#allow). An error cannot be allowed.

A stage begins if the stage before it found no error. So a corrected spec can show errors that were
there before.

This page is generated from the documents in `codegen/src/rules`.

| rule | stage | gives | what breaks it |
|---|---|---|---|
";
