//! The rules that a spec must keep, by id; each has its document in the folder `rules`.

/// A rule that a spec must keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rule {
    /// Id of the rule, as diagnostics show it.
    pub name: &'static str,
    /// What breaks it, why that matters, an example, and what to write instead, in Markdown.
    pub document: &'static str,
}

impl Rule {
    /// Returns the first sentence of the document: what breaks the rule.
    pub fn summary(&self) -> &'static str {
        self.document.lines().next().unwrap_or_default()
    }
}

macro_rules! rules {
    ($($name:literal)*) => {
        &[$(Rule { name: $name, document: include_str!(concat!("rules/", $name, ".md")) }),*]
    };
}

/// Every rule, in the order of the stages.
pub const RULES: &[Rule] = rules! {
    "file" "encoding" "yaml" "plain_word" "duplicate_key" "unknown_key" "misplaced_key" "missing_key" "wrong_kind"
    "version" "identifier_name" "name" "number" "range" "unit" "place" "identifier_layout" "type" "format" "unused_type"
    "named_value" "value_width" "status_bit" "value" "addressing" "access" "match"
    "outside_frame" "overlap" "grid" "range_width" "read_only_range" "no_unit" "model_range" "special_value" "default_value"
    "set" "direction" "ambiguous" "refusal" "unreachable" "nobody_replies" "rust_name" "erratum" "section"
    "reply" "example" "expected_failure" "no_example" "stale_allowance"
};

/// Finds a rule by its id.
pub fn find(name: &str) -> Option<&'static Rule> {
    RULES.iter().find(|rule| rule.name == name)
}

/// Returns the documents of all rules as one text in Markdown.
pub fn reference() -> String {
    std::iter::once(HEADING.to_owned()).chain(RULES.iter().map(chapter)).collect()
}

fn chapter(rule: &Rule) -> String {
    let Rule { name, document } = rule;
    // The documents leave the name out, because rustdoc takes what has a `=` for an attribute of its own.
    let document = document.replace("```yaml fails\n", &format!("```yaml fails={name}\n"));
    format!("\n## `{name}`\n\n{document}")
}

const HEADING: &str = "\
# The rules

Every complaint about a spec names the rule that is broken, as in `error[overlap]`. `canspec rules overlap` prints what stands
here. A block of YAML is added to the smallest spec of the [language reference](language.md); the one after `fails=` breaks the
rule. A warning can be allowed where it is meant, with a reason: see [`allow`](language.md#allow).

This page is made from the documents in `codegen/src/rules`.
";
