//! Turns the tree into plain structs, and finds every error on the way.

mod complaint;

use std::collections::HashSet;
use std::time::{Duration, Instant};

use serde_path_to_error::Segment;
use serde_yaml::{Mapping, Value};

use self::complaint::{Complaint, Kind};
use super::ast::Spec;
use super::rules::{PLAIN_WORD, UNKNOWN_KEY};
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::tree::{Content, Entry, Node, Path, Step};

/// A spec is read this number of times at most.
const ROUNDS: usize = 200;

/// A text that may stand wherever one may.
const PLACEHOLDER: &str = "mended";

/// Most errors that are reported of one spec.
const REPORTED: usize = 100;

/// A spec with errors is not read again after this time.
const PATIENCE: Duration = Duration::from_secs(1);

/// Reads a spec, or adds what is wrong with it to the known problems.
pub(super) fn read(tree: &Node, problems: &mut Vec<Diagnostic>) -> Option<Spec> {
    match attempts(tree) {
        Ok(spec) if problems.is_empty() => Some(spec),
        Ok(_) => None,
        Err(found) => {
            for item in found {
                add(item, tree, problems);
            }
            None
        }
    }
}

/// Adds what the reader found.
///
/// The gate may have refused the value of an unknown key. If it was a plain word, the key is the mistake. Anything else
/// that was refused explains the key.
fn add(item: Diagnostic, tree: &Node, problems: &mut Vec<Diagnostic>) {
    let refused = match &item.at {
        At::Key(path) if *item.rule == UNKNOWN_KEY => tree.get(path),
        At::File | At::Span(_) | At::Key(_) | At::Value(_) => None,
    };
    match refused.filter(|value| value.content == Content::Refused) {
        None => problems.push(item),
        Some(value) => {
            let at = At::Span(value.span.clone());
            let word = problems.iter().position(|known| *known.rule == PLAIN_WORD && known.at == at);
            if let Some(word) = word {
                problems[word] = item;
            }
        }
    }
}

/// Reads a spec as often as it takes to find every error.
///
/// The reading stops at the first error. To find the others, a copy of the tree is mended at that place and read again.
fn attempts(tree: &Node) -> Result<Spec, Vec<Diagnostic>> {
    let started = Instant::now();
    let mut reader = Reader::new(tree);
    for _ in 0..ROUNDS {
        match serde_path_to_error::deserialize(&reader.copy) {
            Ok(spec) if reader.mended.is_empty() => return Ok(spec),
            Ok(_) => break,
            Err(error) => reader.mend(&path_of(error.path()), &error.inner().to_string()),
        }
        if reader.problems.len() == REPORTED || started.elapsed() > PATIENCE {
            break;
        }
    }
    Err(reader.problems)
}

struct Reader<'a> {
    tree: &'a Node,
    copy: Value,
    mended: HashSet<Path>,
    problems: Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    fn new(tree: &'a Node) -> Self {
        let mut mended = HashSet::new();
        let copy = to_value(tree, &Path::default(), &mut mended);
        Self { tree, copy, mended, problems: Vec::new() }
    }

    fn mend(&mut self, path: &Path, error: &str) {
        let complaint = Complaint::of(path, error);
        let reported = match (&complaint, path.split()) {
            (Complaint::UnknownKey { .. }, Some((parent, _))) => parent,
            _ => path,
        };
        if !self.is_mended(reported) {
            self.problems.push(complaint.report(path, self.tree));
        }
        match complaint {
            Complaint::UnknownKey { .. } => self.remove(path),
            Complaint::MissingKey(key) => self.replace(&path.key(key), Kind::Text),
            Complaint::WrongKind { expected, .. } => self.replace(path, expected),
        }
    }

    fn is_mended(&self, path: &Path) -> bool {
        path.ancestors().any(|path| self.mended.contains(path))
    }

    fn remove(&mut self, path: &Path) {
        let Some((parent, Step::Key(key))) = path.split() else { return };
        if let Some(Value::Mapping(entries)) = value_at(&mut self.copy, parent) {
            entries.shift_remove(key);
        }
        self.mended.insert(path.clone());
    }

    fn replace(&mut self, path: &Path, kind: Kind) {
        let empty = match kind {
            Kind::Text => Value::String(PLACEHOLDER.to_owned()),
            Kind::List => Value::Sequence(Vec::new()),
            Kind::Map => Value::Mapping(Mapping::new()),
        };
        match path.split() {
            Some((parent, Step::Key(key))) => {
                if let Some(Value::Mapping(entries)) = value_at(&mut self.copy, parent) {
                    entries.insert(Value::String(key.clone()), empty);
                }
            }
            _ => {
                if let Some(value) = value_at(&mut self.copy, path) {
                    *value = empty;
                }
            }
        }
        self.mended.insert(path.clone());
    }
}

/// Copies a tree in which every leaf is text; what the gate refused becomes a text that counts as mended.
fn to_value(node: &Node, path: &Path, mended: &mut HashSet<Path>) -> Value {
    match &node.content {
        Content::Text(text) => Value::String(text.clone()),
        Content::List(items) => {
            let items = items.iter().enumerate();
            Value::Sequence(items.map(|(index, item)| to_value(item, &path.index(index), mended)).collect())
        }
        Content::Map(entries) => {
            let mut pair = |(key, entry): (&String, &Entry)| {
                (Value::String(key.clone()), to_value(&entry.value, &path.key(key), mended))
            };
            Value::Mapping(entries.iter().map(&mut pair).collect())
        }
        Content::Refused => {
            mended.insert(path.clone());
            Value::String(PLACEHOLDER.to_owned())
        }
    }
}

fn value_at<'a>(root: &'a mut Value, path: &Path) -> Option<&'a mut Value> {
    match path.split() {
        None => Some(root),
        Some((parent, Step::Key(key))) => value_at(root, parent)?.get_mut(key),
        Some((parent, Step::Index(index))) => value_at(root, parent)?.get_mut(*index),
    }
}

fn path_of(path: &serde_path_to_error::Path) -> Path {
    path.iter().fold(Path::default(), |path, segment| match segment {
        Segment::Seq { index } => path.index(*index),
        Segment::Map { key } => path.key(key),
        Segment::Enum { .. } | Segment::Unknown => path,
    })
}
