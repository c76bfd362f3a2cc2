//! What a spec says that it replaces and removes.

use std::ops::Range;

use indexmap::IndexMap;

use super::base::NEVER_TAKEN;
use super::{Entries, LISTS, step};
use crate::read::syntax::rules::{REMOVES, REPLACES};
use crate::report::diagnostic::Diagnostic;
use crate::report::rule::Rule;
use crate::report::tree::{Content, Node};
use crate::words::nearest::nearest;

/// The paths that a spec lists.
pub struct Listed {
    rows: IndexMap<String, Row>,
    /// What is wrong with the lists alone.
    flaws: Vec<Diagnostic>,
}

/// A path that is listed.
struct Row {
    rule: &'static Rule,
    at: Range<usize>,
    /// Where the spec itself has something at the path.
    own: Option<Range<usize>>,
    /// Where the base has something at the path.
    known: Option<Range<usize>>,
    is_done: bool,
}

impl Listed {
    /// Reads the lists. The later stages report what is not a list of texts.
    pub fn of(own: &Node) -> Self {
        let mut listed = Self { rows: IndexMap::new(), flaws: Vec::new() };
        for (key, rule) in LISTS.into_iter().zip([&REPLACES, &REMOVES]) {
            let items = match own.child_at(key) {
                Some(Node { content: Content::List(items), .. }) => items.as_slice(),
                Some(one) => std::slice::from_ref(one),
                None => &[],
            };
            items
                .iter()
                .filter_map(|item| Some((item.text()?, &item.span)))
                .for_each(|(path, at)| listed.add(path, rule, at));
        }
        listed
    }

    fn add(&mut self, path: &str, rule: &'static Rule, at: &Range<usize>) {
        if let Some(first) = self.rows.get(path) {
            let again = Diagnostic::error(rule, at.clone(), format!("`{path}` is listed twice"));
            self.flaws.push(again.other(first.at.clone(), "listed here first").help("take one of the two out"));
        } else {
            let row = Row { rule, at: at.clone(), own: None, known: None, is_done: false };
            self.rows.insert(path.to_owned(), row);
        }
    }

    /// Looks for the paths in the spec and in its base.
    pub fn look_up(&mut self, own: &Node, base: &Entries) {
        if self.rows.is_empty() {
            return;
        }
        let rows = &mut self.rows;
        let mut path = String::new();
        if let Some(own) = own.entries() {
            visit(own, &mut path, &mut |path, key| {
                if let Some(row) = rows.get_mut(path) {
                    row.own = Some(key.clone());
                }
            });
        }
        visit(base, &mut path, &mut |path, key| {
            if let Some(row) = rows.get_mut(path) {
                row.known = Some(key.clone());
            }
        });
    }

    /// Takes out what is removed.
    pub fn remove_from(&mut self, base: &mut Entries) {
        if self.rows.values().any(|row| row.rule == &REMOVES) {
            self.remove(base, &mut String::new());
        }
    }

    fn remove(&mut self, entries: &mut Entries, path: &mut String) {
        entries.retain(|key, entry| {
            let length = path.len();
            step(path, key);
            let is_removed = self.is_done_by(&REMOVES, path);
            if let (false, Content::Map(entries)) = (is_removed, &mut entry.value.content) {
                self.remove(entries, path);
            }
            path.truncate(length);
            !is_removed
        });
    }

    /// Tells whether the value at a path is replaced.
    pub fn replaces(&mut self, path: &str) -> bool {
        self.is_done_by(&REPLACES, path)
    }

    fn is_done_by(&mut self, rule: &Rule, path: &str) -> bool {
        let row = self.rows.get_mut(path).filter(|row| row.rule == rule);
        row.map(|row| row.is_done = true).is_some()
    }

    /// Reports the paths that are listed twice, and the first ones of those that are not in the base.
    pub fn unknown(&mut self, name: &str, base: &Entries, most: usize) -> Vec<Diagnostic> {
        let unknown = self.rows.iter().filter(|(_, row)| row.known.is_none());
        let unknown: Vec<_> = unknown.map(|(path, row)| row.unknown(path, name, base)).take(most).collect();
        [std::mem::take(&mut self.flaws), unknown].concat()
    }

    /// Reports the paths of the base at which nothing is replaced or removed.
    pub fn idle(&self) -> impl Iterator<Item = Diagnostic> {
        self.rows.iter().filter_map(|(path, row)| row.idle(path))
    }
}

impl Row {
    fn unknown(&self, path: &str, name: &str, base: &Entries) -> Diagnostic {
        let found = |text: String| Diagnostic::error(self.rule, self.at.clone(), text);
        if NEVER_TAKEN.contains(&path) {
            return found(format!("`{path}` is never taken over from `{name}`")).help("take it out");
        }
        let found = found(format!("`{name}` has no `{path}`"));
        match &self.own {
            Some(own) if *self.rule == REPLACES => {
                found.other(own.clone(), "this is new").help("take it out of `replaces`")
            }
            _ => found.help(meant(path, base)),
        }
    }

    fn idle(&self, path: &str) -> Option<Diagnostic> {
        let known = self.known.clone()?;
        let found = |text: String| Diagnostic::error(self.rule, self.at.clone(), text);
        match &self.own {
            Some(own) if *self.rule == REMOVES => {
                let help = format!("name `{path}` in `replaces` instead, or do not give it");
                Some(
                    found(format!("`{path}` is removed, and given as well"))
                        .other(own.clone(), "given here")
                        .help(help),
                )
            }
            None if *self.rule == REPLACES => {
                let help = "give it, or name it in `removes` to take it away";
                Some(
                    found(format!("this spec does not give `{path}`"))
                        .other(known, "the base gives it here")
                        .help(help),
                )
            }
            _ if self.is_done => None,
            _ => {
                let help = "take one of the two paths out of the lists";
                Some(found(format!("`{path}` goes with what is around it")).other(known, "it stands here").help(help))
            }
        }
    }
}

/// Says which path could be meant.
fn meant(path: &str, base: &Entries) -> String {
    let (mut entries, mut found, mut rest) = (base, String::new(), path);
    loop {
        let (key, after) = rest.split_once('.').map_or((rest, None), |(key, after)| (key, Some(after)));
        let inner = entries.get(key).and_then(|entry| entry.value.entries());
        let Some(name) = nearest(key, entries.keys().map(String::as_str)) else {
            return "write the keys that lead to an entry, with dots between, as in `messages.output.title`".to_owned();
        };
        step(&mut found, name);
        match (inner, after) {
            (Some(inner), Some(after)) => (entries, rest) = (inner, after),
            (None, Some(after)) if name != key => return format!("did you mean `{found}.{after}`?"),
            _ => return format!("did you mean `{found}`?"),
        }
    }
}

/// Shows each entry of a map and of the maps in it, with its path.
fn visit(entries: &Entries, path: &mut String, show: &mut impl FnMut(&str, &Range<usize>)) {
    for (key, entry) in entries {
        let length = path.len();
        step(path, key);
        show(path, &entry.key);
        if let Some(inner) = entry.value.entries() {
            visit(inner, path, show);
        }
        path.truncate(length);
    }
}
