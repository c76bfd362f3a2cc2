//! The rules that a spec must keep, by id; each has its document in the folder `rules`.

/// A rule that a spec must keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Id of the rule, as diagnostics show it.
    pub name: &'static str,
    /// The stage of the compiler that applies it; a stage begins when the one before it found no error.
    pub stage: &'static str,
    /// What breaks it, why that matters, an example, and what to write instead, in Markdown.
    pub document: &'static str,
}

impl Rule {
    /// Returns the first sentence of the document: what breaks the rule.
    pub fn summary(&self) -> &'static str {
        self.document.lines().next().unwrap_or_default()
    }

    /// Returns what a breach gives: an error, a warning, or one of the two.
    pub fn gives(&self) -> &'static str {
        match self.name {
            name if OF_WARNINGS.contains(&name) => "warning",
            name if OF_BOTH.contains(&name) => "error or warning",
            _ => "error",
        }
    }
}

macro_rules! rules {
    ($($stage:literal: $($name:literal)*;)*) => {
        &[$($(Rule { name: $name, stage: $stage, document: include_str!(concat!("rules/", $name, ".md")) }),*),*]
    };
}

/// Every rule, in the order of the stages.
pub const RULES: &[Rule] = rules! {
    "source": "file" "encoding";
    "syntax": "yaml" "plain_word" "duplicate_key" "unknown_key" "missing_key" "wrong_kind";
    "lint": "quantity" "spelling" "order" "uneven";
    "resolve": "misplaced_key" "version" "identifier_name" "name" "number" "range" "unit" "place" "identifier_layout" "type"
        "format" "unused_type" "named_value" "value_width" "status_bit" "value" "addressing" "access" "match";
    "check": "outside_frame" "overlap" "grid" "range_width" "read_only_range" "no_unit" "model_range" "special_value"
        "default_value" "set" "direction" "ambiguous" "refusal" "unreachable" "nobody_replies" "rust_name" "erratum" "section"
        "reply" "example" "expected_failure" "no_example" "stale_allowance";
};

/// Rules that give warnings alone.
const OF_WARNINGS: [&str; 9] = [
    "quantity",
    "spelling",
    "order",
    "uneven",
    "unused_type",
    "read_only_range",
    "no_unit",
    "section",
    "stale_allowance",
];

/// Rules that give errors and warnings.
const OF_BOTH: [&str; 4] = ["addressing", "model_range", "erratum", "no_example"];

/// Finds a rule by its id.
pub fn find(name: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.name == name)
}

/// Returns the documents of all rules as one text in Markdown.
pub fn reference() -> String {
    std::iter::once(contents()).chain(RULES.iter().map(chapter)).collect()
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
    // The documents leave the name out, because rustdoc takes what has a `=` for an attribute of its own.
    let document = document.replace("```yaml fails\n", &format!("```yaml fails={name}\n"));
    format!("\n## `{name}`\n\n{document}")
}

const HEADING: &str = "\
# The rules

Every error and every warning about a spec names the rule that is broken, as in `error[overlap]`. `canspec rules overlap` prints what
stands here. A block of YAML is added to the smallest spec of the [language reference](language.md); the first block of a rule breaks
it, the one after `Write instead` does not. A warning can be allowed where it is meant, with a reason: see
[`allow`](language.md#allow). An error cannot.

A stage begins when the one before it found no error. So a mended spec can have errors that were there all along.

This page is made from the documents in `codegen/src/rules`.

| rule | stage | gives | what breaks it |
|---|---|---|---|
";
