//! A spec as a tree of texts, and paths in it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// Keys of the language whose maps give names to items.
pub const NAMING: [&str; 16] = [
    "identifier",
    "header",
    "types",
    "addressing",
    "access",
    "foreign",
    "transports",
    "messages",
    "models",
    "timing",
    "procedures",
    "examples",
    "errata",
    "fields",
    "status",
    "facts",
];

/// A value in the file and where it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// The bytes of a text, or of the first line of a map or list.
    pub span: Range<usize>,
    /// What it is.
    pub content: Content,
}

/// What a value is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// A text, without its quotes.
    Text(String),
    /// A list, in the order of the file.
    List(Vec<Node>),
    /// A map, in the order of the file.
    Map(IndexMap<String, Entry>),
    /// A value that was refused; such a tree comes with an error.
    Refused,
}

/// An entry of a map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Bytes of the key.
    pub key: Range<usize>,
    /// The value.
    pub value: Node,
}

impl Node {
    /// Returns what is at a path.
    pub fn get(&self, path: &Path) -> Option<&Node> {
        self.find(path).map(|found| found.value)
    }

    /// Returns a text; nothing for anything else.
    pub fn text(&self) -> Option<&str> {
        match &self.content {
            Content::Text(text) => Some(text),
            Content::List(_) | Content::Map(_) | Content::Refused => None,
        }
    }

    /// Tells whether it is a list.
    pub fn is_list(&self) -> bool {
        matches!(self.content, Content::List(_))
    }

    /// Returns the entries of a map; nothing for anything else.
    pub fn entries(&self) -> Option<&IndexMap<String, Entry>> {
        match &self.content {
            Content::Map(entries) => Some(entries),
            Content::Text(_) | Content::List(_) | Content::Refused => None,
        }
    }

    /// Tells whether it is a map or a list without entries.
    pub fn is_empty(&self) -> bool {
        match &self.content {
            Content::List(items) => items.is_empty(),
            Content::Map(entries) => entries.is_empty(),
            Content::Text(_) | Content::Refused => false,
        }
    }

    /// Returns the value of a key of a map.
    pub fn child_at(&self, key: &str) -> Option<&Node> {
        Some(&self.entries()?.get(key)?.value)
    }

    /// Returns the text that a map has as the value of a key.
    pub fn text_at(&self, key: &str) -> Option<&str> {
        self.child_at(key)?.text()
    }

    /// Returns the bytes of the key. An item without a key gives its own bytes, and a missing one
    /// those of its nearest parent.
    pub fn key_span(&self, path: &Path) -> Range<usize> {
        let found = self.find_nearest(path);
        found.key.unwrap_or(&found.value.span).clone()
    }

    /// Returns the bytes of a text. Anything else gives [`Node::key_span`].
    pub fn value_span(&self, path: &Path) -> Range<usize> {
        match self.get(path) {
            Some(Node { span, content: Content::Text(_) | Content::Refused }) => span.clone(),
            _ => self.key_span(path),
        }
    }

    /// Says what it is, with the start of a text.
    pub(crate) fn describe(&self) -> String {
        match &self.content {
            Content::Text(text) if text.is_empty() => "an empty text".to_owned(),
            Content::Text(text) => format!("the text `{}`", shortened(text)),
            Content::List(_) => "a list".to_owned(),
            Content::Map(_) => "a map".to_owned(),
            Content::Refused => "nothing that can be used".to_owned(),
        }
    }

    fn find_nearest(&self, path: &Path) -> Found<'_> {
        let missing = Found { key: None, value: self };
        path.ancestors().find_map(|path| self.find(path)).unwrap_or(missing)
    }

    fn find(&self, path: &Path) -> Option<Found<'_>> {
        match path.split() {
            None => Some(Found { key: None, value: self }),
            Some((parent, step)) => self.find(parent)?.value.child(step),
        }
    }

    fn child(&self, step: &Step) -> Option<Found<'_>> {
        match (&self.content, step) {
            (Content::Map(entries), Step::Key(key)) => {
                entries.get(key).map(|entry| Found { key: Some(&entry.key), value: &entry.value })
            }
            (Content::List(items), Step::Index(index)) => items.get(*index).map(|value| Found { key: None, value }),
            _ => None,
        }
    }
}

struct Found<'a> {
    key: Option<&'a Range<usize>>,
    value: &'a Node,
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(40) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}...", &text[..end]),
    }
}

/// A place in a spec.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum At {
    /// The file as a whole.
    File,
    /// A range of bytes of the text.
    Span(Range<usize>),
    /// The key of an entry. If the entry is missing, it is the key of the map around it.
    Key(Path),
    /// The text after a key. For a map or a list it is the key, or the first line if there is no
    /// key.
    Value(Path),
}

impl From<Range<usize>> for At {
    fn from(span: Range<usize>) -> Self {
        Self::Span(span)
    }
}

/// Keys and list positions from the root of a spec to a value. The default is the root.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(from = "Vec<Step>", into = "Vec<Step>")]
pub struct Path(Option<Arc<Link>>);

#[derive(Debug, PartialEq, Eq, Hash)]
struct Link {
    parent: Path,
    step: Step,
}

/// One step of a path.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Step {
    /// To the value of a key.
    Key(String),
    /// To an item of a list, counted from 0.
    Index(usize),
}

impl Path {
    /// Returns the path to the value of a key.
    #[must_use]
    pub fn key(&self, key: impl Into<String>) -> Self {
        self.step(Step::Key(key.into()))
    }

    /// Returns the path to an item of a list, counted from 0.
    #[must_use]
    pub fn index(&self, index: usize) -> Self {
        self.step(Step::Index(index))
    }

    /// Returns the path without its last step, and that step; nothing at the root.
    pub fn split(&self) -> Option<(&Path, &Step)> {
        self.0.as_deref().map(|link| (&link.parent, &link.step))
    }

    /// Returns the place of the key.
    pub fn at_key(&self) -> At {
        At::Key(self.clone())
    }

    /// Returns the place of the value.
    pub fn at_value(&self) -> At {
        At::Value(self.clone())
    }

    /// Returns the path, its parent, and so on up to the root.
    pub fn ancestors(&self) -> impl Iterator<Item = &Path> {
        std::iter::successors(Some(self), |path| path.split().map(|(parent, _)| parent))
    }

    pub(crate) fn step(&self, step: Step) -> Self {
        Self(Some(Arc::new(Link { parent: self.clone(), step })))
    }
}

impl From<Vec<Step>> for Path {
    fn from(steps: Vec<Step>) -> Self {
        steps.into_iter().fold(Self::default(), |path, step| path.step(step))
    }
}

impl From<Path> for Vec<Step> {
    fn from(path: Path) -> Self {
        let mut steps: Self = path.ancestors().filter_map(|path| Some(path.split()?.1.clone())).collect();
        steps.reverse();
        steps
    }
}

/// Writes `messages.output.examples[2]`, and nothing for the root.
impl fmt::Display for Path {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.split() {
            None => Ok(()),
            Some((parent, Step::Index(index))) => write!(formatter, "{parent}[{index}]"),
            Some((Path(None), Step::Key(key))) => formatter.write_str(key),
            Some((parent, Step::Key(key))) => write!(formatter, "{parent}.{key}"),
        }
    }
}
