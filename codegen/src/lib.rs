//! Compiles a CAN device protocol, written once in YAML, into Rust codecs.
//!
//! [`compile`] runs the stages in order: source, syntax, lint, resolve, check. Each stage reports
//! all its errors before the next one starts. [`compile`] returns a [`model::Protocol`], which the
//! interpreter ([`interpret`]) and the emitters ([`emit`]) read.

#![forbid(unsafe_code)]
#![warn(clippy::wildcard_enum_match_arm)]

mod build;
pub mod check;
pub mod emit;
mod encoding;
pub mod interpret;
pub mod model;
mod read;
mod reference;
mod report;
mod resolve;
mod words;

pub use build::{Builder, Generated, files, generate};
pub use check::summary::Summary;
use model::Protocol;
pub use read::bases::Bases;
use read::lint;
use read::source::Source;
pub use read::{source, syntax};
pub use reference::rules;
#[cfg(feature = "schema")]
pub use reference::schema;
pub use report::diagnostic;
use report::diagnostic::Diagnostics;
pub use words::nearest::nearest;
use words::text::Text;
pub use words::{number, text};

/// The README's Rust compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// What became of a spec.
#[derive(Debug)]
pub struct Outcome {
    /// The protocol, if the spec has no errors.
    pub protocol: Option<Protocol>,
    /// All errors and warnings about the spec.
    pub diagnostics: Diagnostics,
    /// What the spec contains, as far as it could be resolved.
    pub summary: Summary,
}

/// Compiles a spec.
pub fn compile(source: Source) -> Outcome {
    compile_with_examples(source, None)
}

/// Compiles a spec that [`compile`] is known to accept, without the stages that only look for
/// mistakes: lint and check.
///
/// # Errors
///
/// Says why the spec cannot be read or resolved.
pub fn compile_proven(source: Source) -> Result<Protocol, Diagnostics> {
    let file = file_name(&source);
    let (spec, mut diagnostics) = syntax::parse(source);
    let resolved = spec.and_then(|spec| resolve::resolve(&spec, file, &rules::RULES, &mut diagnostics));
    resolved.filter(|_| !diagnostics.has_errors()).ok_or(diagnostics)
}

/// Compiles a spec. At least `percent` of a hundred messages must have an example.
pub fn compile_with_examples(source: Source, percent: Option<u8>) -> Outcome {
    let (name, file) = (source.name().to_owned(), file_name(&source));
    let (spec, mut diagnostics) = syntax::parse(source);
    let usable = spec.filter(|_| !diagnostics.has_errors());
    if usable.is_some() {
        lint::lint(&mut diagnostics);
    }
    let resolved = usable.as_ref().and_then(|spec| resolve::resolve(spec, file, &rules::RULES, &mut diagnostics));
    let counts = match &resolved {
        Some(protocol) if !diagnostics.has_errors() => check::check(protocol, percent, &mut diagnostics),
        _ => check::Counts::default(),
    };
    check::allow(&usable.map(|spec| spec.allow).unwrap_or_default(), &mut diagnostics);
    let summary = Summary::new(&name, resolved.as_ref(), counts, &diagnostics);
    let protocol = resolved.filter(|_| !diagnostics.has_errors());
    Outcome { protocol, diagnostics, summary }
}

/// Returns the name of a spec's file without folders.
fn file_name(source: &Source) -> Text {
    let name = source.name();
    Text::new(name.rsplit(['/', '\\']).next().unwrap_or(name))
}
