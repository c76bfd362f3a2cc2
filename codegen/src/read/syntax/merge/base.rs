//! What a spec takes over from another one.

use std::ops::Range;

use super::{Entries, sections};
use crate::read::source::rules::BASED_ON;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::{Content, Entry, Node};

/// Keys that say something about the other spec alone.
pub const NEVER_TAKEN: [&str; 8] =
    ["canspec", "protocol", "title", "document", "based_on", "replaces", "removes", "allow"];

pub struct Base {
    /// The entries of its top level.
    pub entries: Entries,
    /// Its allowances, which hold for what is taken over.
    allow: Option<Entry>,
}

impl Base {
    /// Takes out what is never taken over, and reports what keeps a spec from being a base.
    ///
    /// Its document becomes one that has the name of the base, and begins its sections.
    pub fn new(name: &str, at: &Range<usize>, version: Option<&str>, mut entries: Entries) -> (Self, Vec<Diagnostic>) {
        let mut flaws = Vec::new();
        let known = entries.get("canspec").and_then(|entry| entry.value.text());
        if known != version {
            let text = format!("`{name}` is not written in the same version of the language");
            let diagnostic = Diagnostic::error(&BASED_ON, at.clone(), text);
            let place = entries.get("canspec").map(|entry| (entry.key.clone(), "its version"));
            let help = "give both the same `canspec`";
            flaws.push(place.into_iter().fold(diagnostic, |flaw, (at, text)| flaw.other(at, text)).help(help));
        }
        if let Some(document) = entries.shift_remove("document") {
            flaws.extend(put_document(name, at, document, &mut entries));
        }
        let allow = entries.shift_remove("allow");
        entries.retain(|key, _| !NEVER_TAKEN.contains(&key.as_str()));
        (Self { entries, allow }, flaws)
    }

    /// Returns the entries, to which the spec's own ones have been added, with the allowances of both.
    pub fn with_allowances(mut self) -> Entries {
        let Some(allow) = self.allow else { return self.entries };
        match self.entries.get_mut("allow").map(|own| &mut own.value.content) {
            None => _ = self.entries.insert("allow".to_owned(), allow),
            Some(own) => {
                if let (Content::List(own), Content::List(mut taken)) = (own, allow.value.content) {
                    own.append(&mut taken);
                }
            }
        }
        self.entries
    }
}

/// Names a document.
fn put_document(name: &str, at: &Range<usize>, document: Entry, entries: &mut Entries) -> Option<Diagnostic> {
    let empty = Node { span: document.key.clone(), content: Content::Map(Entries::new()) };
    let documents = Entry { key: document.key.clone(), value: empty };
    let documents = &mut entries.entry("documents".to_owned()).or_insert(documents).value.content;
    let Content::Map(documents) = documents else { return None };
    let names: Vec<_> = documents.keys().cloned().collect();
    if let Some(known) = documents.get(name) {
        let text = format!("two documents would be called `{name}`: the one of that spec, and one of its `documents`");
        let help = "give that entry or that file another name";
        return Some(Diagnostic::error(&BASED_ON, at.clone(), text).other(known.key.clone(), "this one").help(help));
    }
    documents.shift_insert(0, name.to_owned(), document);
    sections::name(entries, name, &names);
    None
}
