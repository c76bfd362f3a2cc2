//! What is wrong with a spec, and where.

#[cfg(feature = "render")]
mod render;

use std::collections::HashSet;
use std::error::Error;
use std::fmt;
use std::ops::Range;

use serde::Serialize;

use crate::report::lines::Source;
use crate::report::rule::Rule;
pub use crate::report::rule::Severity;
pub use crate::report::tree::At;
use crate::report::tree::{Node, Path};
use crate::words::text::Text;

/// Most errors, and most warnings, that the later stages report of one spec.
const MOST: usize = 1000;

/// One thing that is wrong.
///
/// What it says is clean, however it is made, so that nothing that it repeats of a spec begins a line:
///
/// ```compile_fail
/// # fn of_a_spec(diagnostic: &mut canspec_codegen::diagnostic::Diagnostic, text: String) {
/// diagnostic.help = Some(text);
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The rule that is broken.
    pub rule: &'static Rule,
    /// How bad it is.
    pub severity: Severity,
    /// One sentence in lower case without a full stop.
    pub message: Text,
    /// Where it is.
    pub at: At,
    /// What to say at that place.
    pub label: Option<Text>,
    /// Other places that have to do with it, and what to say there.
    pub others: Vec<(At, Text)>,
    /// What to do about it.
    pub help: Option<Text>,
    /// What to write at the place, where that is certain.
    pub replacement: Option<Text>,
}

impl Diagnostic {
    /// Creates an error.
    pub fn error(rule: &'static Rule, at: impl Into<At>, message: impl Into<String>) -> Self {
        Self::new(rule, Severity::Error, at.into(), &message.into())
    }

    /// Creates a warning.
    pub fn warning(rule: &'static Rule, at: impl Into<At>, message: impl Into<String>) -> Self {
        Self::new(rule, Severity::Warning, at.into(), &message.into())
    }

    /// Sets what to say at the place.
    #[must_use]
    pub fn label(self, text: impl Into<String>) -> Self {
        Self { label: Some(Text::new(&text.into())), ..self }
    }

    /// Adds another place and what to say there.
    #[must_use]
    pub fn other(mut self, at: impl Into<At>, text: impl Into<String>) -> Self {
        self.others.push((at.into(), Text::new(&text.into())));
        self
    }

    /// Sets what to do about it.
    #[must_use]
    pub fn help(self, text: impl Into<String>) -> Self {
        Self { help: Some(Text::new(&text.into())), ..self }
    }

    /// Sets what to do about it, if that is known.
    #[must_use]
    pub fn help_if(self, text: Option<String>) -> Self {
        if let Some(text) = text { self.help(text) } else { self }
    }

    /// Sets what to write at the place.
    #[must_use]
    pub fn replacement(self, text: impl Into<String>) -> Self {
        Self { replacement: Some(Text::new(&text.into())), ..self }
    }

    /// Moves its ranges of bytes, whose text now stands behind another one.
    #[must_use]
    pub(crate) fn moved(mut self, by: usize) -> Self {
        for at in self.places() {
            if let At::Span(span) = at {
                *span = span.start + by..span.end + by;
            }
        }
        self
    }

    fn places(&mut self) -> impl Iterator<Item = &mut At> {
        std::iter::once(&mut self.at).chain(self.others.iter_mut().map(|(at, _)| at))
    }

    fn new(rule: &'static Rule, severity: Severity, at: At, message: &str) -> Self {
        let message = Text::new(message);
        Self { rule, severity, message, at, label: None, others: Vec::new(), help: None, replacement: None }
    }
}

/// All that is wrong with one spec, together with its text and tree.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    source: Box<Source>,
    tree: Option<Box<Node>>,
    items: Vec<Diagnostic>,
    /// Places of errors, and all that they stand in.
    wrong: HashSet<Path>,
}

impl Diagnostics {
    /// Starts without a diagnostic.
    pub fn new(source: Source) -> Self {
        Self { source: Box::new(source), tree: None, items: Vec::new(), wrong: HashSet::new() }
    }

    /// Sets the tree in which paths are looked up.
    #[must_use]
    pub fn in_tree(self, tree: Option<Node>) -> Self {
        Self { tree: tree.map(Box::new), ..self }
    }

    /// Looks all places up and lets the tree go, which takes more memory than the protocol.
    #[must_use]
    pub(crate) fn without_tree(mut self) -> Self {
        let mut items = std::mem::take(&mut self.items);
        for at in items.iter_mut().flat_map(Diagnostic::places) {
            if let Some(span) = self.span(at) {
                *at = At::Span(span);
            }
        }
        Self { items, tree: None, ..self }
    }

    /// Adds diagnostics.
    #[must_use]
    pub fn with(mut self, items: impl IntoIterator<Item = Diagnostic>) -> Self {
        self.items.extend(items);
        self
    }

    /// Adds a diagnostic, once; many fields can take the same mistake from one type. Past a thousand of one severity the others
    /// are left out.
    pub fn push(&mut self, item: Diagnostic) {
        if self.count(item.severity) < MOST && !self.items.contains(&item) {
            if let (Severity::Error, At::Key(path) | At::Value(path)) = (item.severity, &item.at) {
                self.wrong.extend(path.ancestors().cloned());
            }
            self.items.push(item);
        }
    }

    /// Adds a diagnostic, unless its rule is broken at that place already; many fields can break a rule by one key of a type.
    pub fn push_first(&mut self, item: Diagnostic) {
        if !self.items.iter().any(|known| known.rule == item.rule && known.at == item.at) {
            self.push(item);
        }
    }

    /// Takes out the warnings of a rule at a place and below it, such as `messages.output`; tells whether there were any.
    pub fn allow(&mut self, rule: &str, place: &str) -> bool {
        let before = self.items.len();
        let is_inside = |at: &At| match at {
            At::Key(path) | At::Value(path) => path.ancestors().any(|outer| outer.to_string() == place),
            At::File | At::Span(_) => false,
        };
        self.items.retain(|item| item.severity == Severity::Error || item.rule.name != rule || !is_inside(&item.at));
        self.items.len() < before
    }

    /// Tells whether a place stands in a spec that this one is based on.
    pub fn is_taken_over(&self, at: &At) -> bool {
        self.span(at).is_some_and(|span| self.source.file_of(span.start) > 0)
    }

    /// Returns the text of the spec.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Returns the tree of the spec, if it could be read that far.
    pub fn tree(&self) -> Option<&Node> {
        self.tree.as_deref()
    }

    /// Tells whether nothing is wrong.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Tells whether there is an error.
    pub fn has_errors(&self) -> bool {
        self.errors() > 0
    }

    /// Tells whether there is an error at a place of the spec or below it.
    pub fn has_errors_in(&self, path: &Path) -> bool {
        self.wrong.contains(path)
    }

    /// Counts the errors.
    pub fn errors(&self) -> usize {
        self.count(Severity::Error)
    }

    /// Counts the warnings.
    pub fn warnings(&self) -> usize {
        self.count(Severity::Warning)
    }

    /// Returns the diagnostics by place: those of the whole file first, then by first byte, then as they were found.
    pub fn sorted(&self) -> Vec<&Diagnostic> {
        let mut items: Vec<_> = self.items.iter().collect();
        items.sort_by_cached_key(|item| self.span(&item.at).map(|span| span.start));
        items
    }

    /// Returns the bytes of a place; nothing for the file as a whole, or where there is no tree to look a path up in.
    pub fn span(&self, at: &At) -> Option<Range<usize>> {
        match at {
            At::File => None,
            At::Span(span) => Some(span.clone()),
            At::Key(path) => self.tree().map(|tree| tree.key_span(path)),
            At::Value(path) => self.tree().map(|tree| tree.value_span(path)),
        }
    }

    /// Tells whether something stands at a place of the spec.
    pub fn has(&self, path: &Path) -> bool {
        self.tree().is_some_and(|tree| tree.get(path).is_some())
    }

    /// Returns the place of the first of these keys that an item has, or else that of its own key.
    pub fn written(&self, item: &Path, keys: &[&str]) -> At {
        let mut paths = keys.iter().map(|key| item.key(*key));
        paths.find(|path| self.has(path)).map_or_else(|| item.at_key(), |path| path.at_value())
    }

    /// Writes one line for each diagnostic: `FILE:LINE:COLUMN: SEVERITY[RULE]: MESSAGE`.
    pub fn concise(&self) -> String {
        self.located().map(|item| item.to_string()).collect::<Vec<_>>().join("\n")
    }

    /// Returns each diagnostic with its places as lines and columns, by place.
    pub fn located(&self) -> impl Iterator<Item = Located<'_>> {
        self.sorted().into_iter().map(|item| self.locate(item))
    }

    fn count(&self, severity: Severity) -> usize {
        self.items.iter().filter(|item| item.severity == severity).count()
    }

    fn locate<'a>(&'a self, item: &'a Diagnostic) -> Located<'a> {
        Located {
            rule: item.rule.name,
            severity: item.severity,
            message: item.message.for_people(),
            file: self.file(&item.at),
            place: self.place(&item.at),
            label: item.label.as_ref().map(Text::for_people),
            others: item.others.iter().map(|(at, text)| self.other(at, text, self.file(&item.at))).collect(),
            help: item.help.as_ref().map(Text::for_people),
            replacement: item.replacement.as_ref().map(Text::for_people),
        }
    }

    fn other<'a>(&'a self, at: &At, text: &'a Text, primary: &str) -> Other<'a> {
        let file = Some(self.file(at)).filter(|file| *file != primary);
        Other { file, place: self.place(at), text: text.for_people() }
    }

    /// Returns the name of the file in which a place is.
    fn file(&self, at: &At) -> &str {
        self.source.file_name(self.span(at).map_or(0, |span| span.start))
    }

    fn place(&self, at: &At) -> Option<Position> {
        let span = self.span(at)?;
        let (line, column) = self.source.line_column(span.start);
        let (end_line, end_column) = self.source.line_column(span.end);
        Some(Position { line, column, end_line, end_column })
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.concise())
    }
}

impl Error for Diagnostics {}

/// A diagnostic with its places as lines and columns, for other programs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Located<'a> {
    /// Id of the rule that is broken.
    pub rule: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// One sentence in lower case without a full stop.
    pub message: &'a str,
    /// Name of the file.
    pub file: &'a str,
    /// Where it is; absent for the file as a whole.
    #[serde(flatten)]
    pub place: Option<Position>,
    /// What to say at that place.
    pub label: Option<&'a str>,
    /// Other places that have to do with it.
    pub others: Vec<Other<'a>>,
    /// What to do about it.
    pub help: Option<&'a str>,
    /// What to write at the place, where that is certain.
    pub replacement: Option<&'a str>,
}

impl fmt::Display for Located<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.file)?;
        if let Some(place) = &self.place {
            write!(formatter, ":{}:{}", place.line, place.column)?;
        }
        write!(formatter, ": {}[{}]: {}", self.severity, self.rule, self.message)
    }
}

/// Lines and columns of a range of text, counted from 1, columns in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Position {
    /// Line of the first character.
    pub line: usize,
    /// Column of the first character.
    pub column: usize,
    /// Line of the end.
    pub end_line: usize,
    /// Column after the last character.
    pub end_column: usize,
}

/// Another place that has to do with a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Other<'a> {
    /// Name of the file, if it is another one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<&'a str>,
    /// Where it is; absent for the file as a whole.
    #[serde(flatten)]
    pub place: Option<Position>,
    /// What to say there.
    pub text: &'a str,
}
