//! Finds the maps of a spec that give names.

use indexmap::IndexMap;

use crate::report::diagnostic::At;
use crate::report::tree::{Content, Entry, NAMING, Node, Path};

/// Keys of the language whose maps use names that are given elsewhere.
const REFERENCES: [&str; 10] =
    ["match", "request", "reply", "refusal", "report", "one", "each", "coordinator", "answers", "means"];

/// A map from names, or from numbers to names.
pub struct Table<'a> {
    /// The key of the language that it stands under.
    pub kind: &'a str,
    /// Where it is.
    pub path: Path,
    /// What is in it, in the order of the file.
    pub entries: &'a IndexMap<String, Entry>,
}

/// A name that a spec gives to something.
pub struct Name<'a> {
    /// The name.
    pub text: &'a str,
    /// Where it is.
    pub at: At,
    /// What the thing is in words.
    pub title: Option<&'a str>,
}

impl<'a> Table<'a> {
    /// Tests whether the table gives its names.
    pub fn is_definition(&self) -> bool {
        self.kind == "values" || NAMING.contains(&self.kind)
    }

    /// Returns the names that the table gives.
    pub fn names(&self) -> impl Iterator<Item = Name<'a>> {
        let is_of_values = self.kind == "values";
        self.entries.iter().filter_map(move |(key, entry)| {
            let path = self.path.key(key);
            Some(if is_of_values {
                let (text, path) = match entry.value.text() {
                    Some(text) => (text, path),
                    None => (entry.value.text_at("name")?, path.key("name")),
                };
                Name { text, at: path.at_value(), title: None }
            } else {
                Name { text: key, at: path.at_key(), title: entry.value.text_at("title") }
            })
        })
    }
}

/// Finds the maps from names, in the order of the file.
pub fn tables(tree: &Node) -> Vec<Table<'_>> {
    let mut found = Vec::new();
    visit(tree, "", &Path::default(), &mut found);
    found
}

/// Looks for tables in a map with keys of the language, or in a list of such maps. `owner` is the
/// kind of table around it.
fn visit<'a>(node: &'a Node, owner: &str, path: &Path, found: &mut Vec<Table<'a>>) {
    match &node.content {
        Content::Map(entries) => {
            for (key, entry) in entries.iter().filter(|(_, entry)| entry.value.text().is_none()) {
                visit_entry(key, &entry.value, owner, &path.key(key), found);
            }
        }
        Content::List(items) => {
            for (index, item) in items.iter().enumerate() {
                visit(item, "", &path.index(index), found);
            }
        }
        Content::Text(_) | Content::Refused => {}
    }
}

fn visit_entry<'a>(key: &'a str, value: &'a Node, owner: &str, path: &Path, found: &mut Vec<Table<'a>>) {
    let Some(entries) = value.entries() else { return visit(value, "", path, found) };
    if REFERENCES.contains(&key) || (owner, key) == ("models", "types") {
        add_references(entries, path, found);
    } else if key == "values" || NAMING.contains(&key) {
        found.push(Table { kind: key, path: path.clone(), entries });
        for (name, entry) in entries {
            visit(&entry.value, key, &path.key(name), found);
        }
    } else {
        visit(value, "", path, found);
    }
}

fn add_references<'a>(entries: &'a IndexMap<String, Entry>, path: &Path, found: &mut Vec<Table<'a>>) {
    found.push(Table { kind: "", path: path.clone(), entries });
    for (name, entry) in entries {
        if let Some(inner) = entry.value.entries() {
            add_references(inner, &path.key(name), found);
        }
    }
}
