//! What a rule is. Each rule stands beside its test: in a file of its own, or in the file of its
//! stage.

use std::fmt;

use serde::Serialize;

/// How severe a breach is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The spec cannot be used.
    Error,
    /// The spec can be used, but somebody should look at it.
    Warning,
}

impl fmt::Display for Severity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Error => "error",
            Self::Warning => "warning",
        })
    }
}

/// A rule that a spec must keep.
#[derive(Debug)]
pub struct Rule {
    /// Id of the rule, as diagnostics show it.
    pub name: &'static str,
    /// The stage of the compiler that applies it.
    pub stage: Stage,
    /// The possible results of a breach: an error, a warning, or either.
    pub gives: &'static [Severity],
    /// The rule's document in Markdown: what breaks it, why that matters, an example, and what to
    /// write instead.
    pub document: &'static str,
}

impl Rule {
    /// Returns the first sentence of the document: what breaks the rule.
    pub fn summary(&self) -> &'static str {
        self.document.lines().next().unwrap_or_default()
    }

    /// Returns the result of a breach in words: an error, a warning, or either.
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

/// A stage of the compiler that applies rules. It begins if the stage before it found no error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Turns bytes into text.
    Source,
    /// Turns text into a tree, and the tree into structs.
    Syntax,
    /// Looks at how the spec is written.
    Lint,
    /// Turns what is written into what is meant.
    Resolve,
    /// Tests whether what is meant is right.
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

/// Breaches are errors.
pub(crate) const ERROR: &[Severity] = &[Severity::Error];

/// Breaches are warnings.
pub(crate) const WARNING: &[Severity] = &[Severity::Warning];

/// Breaches are errors or warnings.
pub(crate) const EITHER: &[Severity] = &[Severity::Error, Severity::Warning];

/// Makes rules of rows `NAME "name" Stage GIVES;`, each with its document.
macro_rules! rules {
    ($($rule:ident $name:literal $stage:ident $gives:ident;)*) => {
        $(
            #[doc = concat!("The rule `", $name, "`.")]
            pub static $rule: $crate::report::rule::Rule = $crate::report::rule::Rule {
                name: $name,
                stage: $crate::report::rule::Stage::$stage,
                gives: $crate::report::rule::$gives,
                document: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/rules/", $name, ".md")),
            };
        )*
    };
}
pub(crate) use rules;
