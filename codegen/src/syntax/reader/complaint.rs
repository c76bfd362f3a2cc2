//! What serde complains about, in words for people.

use crate::diagnostic::Diagnostic;
use crate::syntax::tree::{Content, Node, Path, Step};

/// An error of the reading.
pub(super) enum Complaint {
    /// A key that may not stand there, and the keys that may.
    UnknownKey { key: String, allowed: Vec<String> },
    /// A key that has to stand there.
    MissingKey(String),
    /// A value of another kind, what is allowed in words, and a kind that fits.
    WrongKind { allowed: String, expected: Kind },
}

/// What a value can be.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Text,
    List,
    Map,
}

impl Complaint {
    /// Reads the text of an error; serde gives nothing else.
    pub(super) fn of(path: &Path, error: &str) -> Self {
        if let Some(rest) = error.strip_prefix("missing field `") {
            return Self::MissingKey(rest.trim_end_matches('`').to_owned());
        }
        if let Some((_, Step::Key(key))) = path.split()
            && let Some(rest) = error.strip_prefix(&format!("unknown field `{key}`"))
        {
            let allowed = rest.split('`').skip(1).step_by(2).map(str::to_owned).collect();
            return Self::UnknownKey { key: key.clone(), allowed };
        }
        let (allowed, expected) = match error.rsplit_once(", expected ").map_or(error, |(_, expected)| expected) {
            "a string" => ("a text", Kind::Text),
            "a sequence" => ("a list", Kind::List),
            "a map" => ("a map", Kind::Map),
            other if other.starts_with("struct ") => ("a map", Kind::Map),
            other => (other, Kind::Text),
        };
        Self::WrongKind { allowed: allowed.to_owned(), expected }
    }

    /// Says it with its place.
    pub(super) fn report(&self, path: &Path, tree: &Node) -> Diagnostic {
        match self {
            Self::UnknownKey { key, allowed } => unknown_key(path, key, allowed),
            Self::MissingKey(key) => missing_key(path, key),
            Self::WrongKind { allowed, expected } => wrong_kind(path, allowed, *expected, tree),
        }
    }
}

fn unknown_key(path: &Path, key: &str, allowed: &[String]) -> Diagnostic {
    let listed = allowed.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
    let help = match nearest(key, allowed) {
        Some(nearest) => format!("did you mean `{nearest}`? allowed here: {listed}"),
        None => format!("allowed here: {listed}"),
    };
    Diagnostic::error("unknown_key", path.at_key(), format!("unknown key `{key}`")).help(help)
}

fn nearest<'a>(key: &str, allowed: &'a [String]) -> Option<&'a str> {
    let near = |other: &&String| strsim::damerau_levenshtein(key, other) <= key.chars().count().max(3) / 3;
    let nearest = allowed.iter().filter(near).min_by_key(|other| strsim::damerau_levenshtein(key, other));
    nearest.map(String::as_str)
}

fn missing_key(path: &Path, key: &str) -> Diagnostic {
    let message = match path.split() {
        None => format!("missing key `{key}`"),
        Some(_) => format!("missing key `{key}` in `{path}`"),
    };
    Diagnostic::error("missing_key", path.at_key(), message).help(format!("add `{key}`"))
}

fn wrong_kind(path: &Path, allowed: &str, expected: Kind, tree: &Node) -> Diagnostic {
    let found = tree.get(path);
    let found_text = found.map_or_else(|| "nothing".to_owned(), Node::describe);
    let whose = match path.split() {
        None => "the spec".to_owned(),
        Some((_, Step::Key(key))) => format!("`{key}`"),
        Some((list, Step::Index(_))) => format!("an item of `{list}`"),
    };
    let message = format!("expected {allowed} for {whose}, found {found_text}");
    let help = found.and_then(|found| in_brackets(found, expected));
    Diagnostic { help, ..Diagnostic::error("wrong_kind", path.at_value(), message) }
}

/// Says how a text becomes a list of one item.
fn in_brackets(found: &Node, expected: Kind) -> Option<String> {
    match (&found.content, expected) {
        (Content::Text(text), Kind::List) if !text.is_empty() => Some(format!("write `[{text}]`")),
        _ => None,
    }
}
