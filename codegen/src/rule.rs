//! What a rule is. Each stands where it is tested: in a file of its own, or in the file of its stage.

use std::fmt;

use serde::Serialize;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The spec cannot be used.
    Error,
    /// The spec can be used, but somebody should look.
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
    /// What a breach gives: an error, a warning, or the one or the other.
    pub gives: &'static [Severity],
    /// What breaks it, why that matters, an example, and what to write instead, in Markdown.
    pub document: &'static str,
}

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

/// Breaches are errors.
pub(crate) const ERROR: &[Severity] = &[Severity::Error];

/// Breaches are warnings.
pub(crate) const WARNING: &[Severity] = &[Severity::Warning];

/// Breaches are the one or the other.
pub(crate) const EITHER: &[Severity] = &[Severity::Error, Severity::Warning];

/// Makes rules of rows `NAME "name" Stage GIVES;`, each with its document.
macro_rules! rules {
    ($($rule:ident $name:literal $stage:ident $gives:ident;)*) => {
        $(
            #[doc = concat!("The rule `", $name, "`.")]
            pub static $rule: $crate::rule::Rule = $crate::rule::Rule {
                name: $name,
                stage: $crate::rule::Stage::$stage,
                gives: $crate::rule::$gives,
                document: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/rules/", $name, ".md")),
            };
        )*
    };
}
pub(crate) use rules;
