//! Says for people what serde complains about.

use crate::read::syntax::rules;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::{Content, Node, Path, Step};
use crate::words::nearest::nearest;

/// An error of the reading.
pub(super) enum Complaint {
    /// A key that may not stand there, and the keys that may.
    UnknownKey { key: String, allowed: Vec<String> },
    /// A key that has to stand there.
    MissingKey(String),
    /// A value of a wrong kind, with the allowed kinds in words, and one kind that fits.
    WrongKind { allowed: String, expected: Kind },
}

/// Keys of other description formats, our key for the same, and what to write.
const ELSEWHERE: [(&str, &str, &str); 12] = [
    ("signed", "as", "write `as: signed`;"),
    ("factor", "scale", "did you mean `scale`?"),
    ("resolution", "scale", "did you mean `scale`?"),
    ("endian", "bytes", "write `bytes: 1..0` for the low byte first;"),
    ("endianness", "bytes", "write `bytes: 1..0` for the low byte first;"),
    ("byte_order", "bytes", "write `bytes: 1..0` for the low byte first;"),
    ("min", "range", "write both limits, as in `range: 0..100`;"),
    ("max", "range", "write both limits, as in `range: 0..100`;"),
    ("choices", "values", "did you mean `values`?"),
    ("enum", "values", "did you mean `values`?"),
    ("description", "note", "did you mean `note`?"),
    ("description", "title", "did you mean `title`?"),
];

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

    /// Makes a diagnostic with a place.
    pub(super) fn report(&self, path: &Path, tree: &Node) -> Diagnostic {
        match self {
            Self::UnknownKey { key, allowed } => unknown_key(path, key, allowed, tree),
            Self::MissingKey(key) => missing_key(path, key),
            Self::WrongKind { allowed, expected } => wrong_kind(path, allowed, *expected, tree),
        }
    }
}

fn unknown_key(path: &Path, key: &str, allowed: &[String], tree: &Node) -> Diagnostic {
    let listed = allowed.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
    let nearest = nearest(key, allowed.iter().map(String::as_str)).map(|nearest| format!("did you mean `{nearest}`?"));
    let help = match nearest
        .or_else(|| said_otherwise(key, allowed))
        .or_else(|| indented(path, allowed, tree))
        .or_else(|| outdented(path, allowed, tree))
    {
        Some(what) => format!("{what} allowed here: {listed}"),
        None => format!("allowed here: {listed}"),
    };
    Diagnostic::error(&rules::UNKNOWN_KEY, path.at_key(), format!("unknown key `{key}`")).help(help)
}

/// Says where a map belongs that stands beside the map above it.
fn outdented(path: &Path, allowed: &[String], tree: &Node) -> Option<String> {
    let (parent, Step::Key(key)) = path.split()? else { return None };
    let entries = tree.get(parent)?.entries()?;
    entries.get(key)?.value.entries()?;
    let before = entries.iter().take_while(|(name, _)| *name != key);
    let (above, entry) = before.filter(|(name, _)| allowed.contains(name)).last()?;
    entry.value.entries()?;
    Some(format!("if it belongs to `{above}`, indent it and what stands below it;"))
}

/// Says where a map belongs that stands inside the map above it, whose keys it has.
fn indented(path: &Path, allowed: &[String], tree: &Node) -> Option<String> {
    let (parent, Step::Key(_)) = path.split()? else { return None };
    let (_, Step::Key(above)) = parent.split()? else { return None };
    let entries = tree.get(path)?.entries().filter(|entries| !entries.is_empty())?;
    let is_alike = entries.keys().all(|key| allowed.contains(key));
    is_alike.then(|| format!("if it belongs beside `{above}`, indent it and what stands below it less;"))
}

/// Says how to write a key of another description format. Each has a meaning in fields, if nowhere
/// else.
fn said_otherwise(key: &str, allowed: &[String]) -> Option<String> {
    let mut known = ELSEWHERE.iter().filter(|(word, ..)| *word == key);
    let here = known.clone().find(|(_, of, _)| allowed.iter().any(|key| key == of));
    let (of_field, found) = (here.is_none(), here.or_else(|| known.next()));
    found.map(
        |(_, _, help)| if of_field { format!("each field says this for itself: {help}") } else { (*help).to_owned() },
    )
}

fn missing_key(path: &Path, key: &str) -> Diagnostic {
    let message = match path.split() {
        None => format!("missing key `{key}`"),
        Some(_) => format!("missing key `{key}` in `{path}`"),
    };
    Diagnostic::error(&rules::MISSING_KEY, path.at_key(), message).help(format!("add `{key}`"))
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
    let help = found.and_then(|found| range_of(path, found).or_else(|| how_to_write(found, expected)));
    Diagnostic::error(&rules::WRONG_KIND, path.at_value(), message).help_if(help)
}

/// Says how to write a range whose ends stand in a list.
fn range_of(path: &Path, found: &Node) -> Option<String> {
    let (Some((_, Step::Key(key))), Content::List(items)) = (path.split(), &found.content) else { return None };
    let [first, last] = &items[..] else { return None };
    let is_range = ["range", "bytes", "bits"].contains(&key.as_str());
    is_range.then(|| Some(format!("write `{key}: {}..{}`", first.text()?, last.text()?)))?
}

/// Says how to write a list as a map.
fn without_dash(items: &[Node]) -> String {
    let mut entries = items.iter().filter_map(Node::entries).flatten();
    match entries.next() {
        Some((name, entry)) if entry.value.text().is_none() => {
            format!("write `{name}:` without `-`, indent it like its siblings, and its entries deeper")
        }
        _ => "write `name: value` for each entry, without `-`".to_owned(),
    }
}

/// Says how to write the kind that is expected.
fn how_to_write(found: &Node, expected: Kind) -> Option<String> {
    match (&found.content, expected) {
        (Content::Text(_), Kind::Text) => Some("write it, or remove the line".to_owned()),
        (Content::Text(text), Kind::List) if !text.is_empty() => {
            Some(format!("write `[{}]`", text.trim_matches(['[', ']'])))
        }
        (Content::Text(_), Kind::Map) => Some("write its entries below it, or in braces: `{name: value}`".to_owned()),
        (Content::Text(_), Kind::List) => Some("write its items in brackets: `[first, second]`".to_owned()),
        (Content::List(items), Kind::Map) => Some(without_dash(items)),
        (Content::Map(_), Kind::List) => {
            Some("write each item after a `-`, or all in brackets: `[first, second]`".to_owned())
        }
        (Content::List(_) | Content::Map(_), Kind::Text) => {
            Some("write one value, without brackets and entries of its own".to_owned())
        }
        _ => None,
    }
}
