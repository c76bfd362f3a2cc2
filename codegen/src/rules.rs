//! The rules that a spec must keep, by id; each has its document in the folder `rules`.

use std::fmt;

use crate::check;
use crate::diagnostic::{Diagnostics, Severity};
use crate::model::Protocol;

/// A rule that a spec must keep.
#[derive(Debug)]
pub struct Rule {
    /// Id of the rule, as diagnostics show it.
    pub name: &'static str,
    /// The stage of the compiler that applies it.
    pub stage: Stage,
    /// What a breach gives: an error, a warning, or the one or the other.
    pub gives: &'static [Severity],
    /// What breaks it, why that matters, an example, and what to write instead, in Markdown.
    pub document: &'static str,
    /// Looks for breaches in a resolved protocol; `None` of what is tested on the way.
    pub(crate) check: Option<Check>,
}

/// Looks for breaches of one rule.
pub(crate) type Check = fn(&Protocol, &mut Diagnostics);

impl Rule {
    /// Returns the first sentence of the document: what breaks the rule.
    pub fn summary(&self) -> &'static str {
        self.document.lines().next().unwrap_or_default()
    }

    /// Returns what a breach gives: an error, a warning, or one of the two.
    pub fn gives(&self) -> String {
        self.gives.iter().map(Severity::to_string).collect::<Vec<_>>().join(" or ")
    }
}

impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Rule {}

/// A stage of the compiler that applies rules; it begins when the one before it found no error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Bytes to text.
    Source,
    /// Text to a tree, and to what is written.
    Syntax,
    /// How it is written.
    Lint,
    /// What is written to what is meant.
    Resolve,
    /// Whether what is meant is right.
    Check,
}

impl fmt::Display for Stage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Source => "source",
            Self::Syntax => "syntax",
            Self::Lint => "lint",
            Self::Resolve => "resolve",
            Self::Check => "check",
        })
    }
}

const ERROR: &[Severity] = &[Severity::Error];
const WARNING: &[Severity] = &[Severity::Warning];
const EITHER: &[Severity] = &[Severity::Error, Severity::Warning];

macro_rules! rules {
    ($($stage:ident { $($rule:ident $name:literal $gives:ident $($check:path)?;)* })*) => {
        $($(
            #[doc = concat!("The rule `", $name, "`.")]
            pub static $rule: Rule = Rule {
                name: $name,
                stage: Stage::$stage,
                gives: $gives,
                document: include_str!(concat!("rules/", $name, ".md")),
                check: rules!(@check $($check)?),
            };
        )*)*

        /// Every rule, in the order of the stages, and as each stage applies them.
        pub static RULES: &[&Rule] = &[$($(&$rule),*),*];
    };
    (@check $check:path) => { Some($check) };
    (@check) => { None };
}

rules! {
    Source {
        FILE "file" ERROR;
        ENCODING "encoding" ERROR;
    }
    Syntax {
        YAML "yaml" ERROR;
        PLAIN_WORD "plain_word" ERROR;
        DUPLICATE_KEY "duplicate_key" ERROR;
        UNKNOWN_KEY "unknown_key" ERROR;
        MISSING_KEY "missing_key" ERROR;
        WRONG_KIND "wrong_kind" ERROR;
    }
    Lint {
        QUANTITY "quantity" WARNING;
        SPELLING "spelling" WARNING;
        ORDER "order" WARNING;
        UNEVEN "uneven" WARNING;
    }
    Resolve {
        MISPLACED_KEY "misplaced_key" ERROR;
        VERSION "version" ERROR;
        IDENTIFIER_NAME "identifier_name" ERROR;
        NAME "name" ERROR;
        NUMBER "number" ERROR;
        RANGE "range" ERROR;
        UNIT "unit" ERROR;
        PLACE "place" ERROR;
        IDENTIFIER_LAYOUT "identifier_layout" ERROR;
        TYPE "type" ERROR;
        FORMAT "format" ERROR;
        UNUSED_TYPE "unused_type" WARNING;
        NAMED_VALUE "named_value" ERROR;
        VALUE_WIDTH "value_width" ERROR;
        STATUS_BIT "status_bit" ERROR;
        VALUE "value" ERROR;
        ADDRESSING "addressing" EITHER;
        ACCESS "access" ERROR;
        MATCH "match" ERROR;
    }
    Check {
        OUTSIDE_FRAME "outside_frame" ERROR check::outside_frame::check;
        OVERLAP "overlap" ERROR check::overlap::check;
        GRID "grid" ERROR check::grid::check;
        RANGE_WIDTH "range_width" ERROR check::range_width::check;
        READ_ONLY_RANGE "read_only_range" WARNING check::read_only_range::check;
        NO_UNIT "no_unit" WARNING check::no_unit::check;
        MODEL_RANGE "model_range" EITHER check::model_range::check;
        SPECIAL_VALUE "special_value" ERROR check::special_value::check;
        DEFAULT_VALUE "default_value" ERROR check::default_value::check;
        SET "set" ERROR check::set::check;
        DIRECTION "direction" ERROR check::direction::check;
        AMBIGUOUS "ambiguous" ERROR check::ambiguous::check;
        REFUSAL "refusal" ERROR check::refusal::check;
        UNREACHABLE "unreachable" ERROR check::unreachable::check;
        NOBODY_REPLIES "nobody_replies" ERROR check::nobody_replies::check;
        RUST_NAME "rust_name" ERROR check::rust_name::check;
        ERRATUM "erratum" EITHER check::erratum::check;
        SECTION "section" WARNING check::section::check;
        REPLY "reply" ERROR;
        EXAMPLE "example" ERROR;
        EXPECTED_FAILURE "expected_failure" ERROR;
        NO_EXAMPLE "no_example" EITHER;
        STALE_ALLOWANCE "stale_allowance" WARNING;
    }
}

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
