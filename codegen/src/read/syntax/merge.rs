//! Joins a spec with those that it is based on.
//!
//! Maps are joined key by key, in the order of the base. `replaces` names everything else that is
//! in both, and `removes` what is taken away.

mod base;
mod listed;
mod sections;

use std::ops::Range;

use indexmap::IndexMap;

use super::rules::REPLACES;
use crate::read::source::rules::BASED_ON;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::{Content, Entry, Node};
use base::Base;
use listed::Listed;

/// The key that names another spec.
pub(super) const KEY: &str = "based_on";

/// The keys by which a spec changes its base.
const LISTS: [&str; 2] = ["replaces", "removes"];

/// Most errors that are reported of one base.
const REPORTED: usize = 100;

/// Entries of a map, in the order of the file.
type Entries = IndexMap<String, Entry>;

/// Joins the trees of a spec, of its base, of the base of that one, and so on. It returns no tree
/// if one is missing, so that there is no whole spec.
pub(super) fn merge(trees: Vec<Option<Node>>, problems: &mut Vec<Diagnostic>) -> Option<Node> {
    let mut trees: Vec<Node> = trees.into_iter().collect::<Option<_>>()?;
    let mut whole = trees.pop()?;
    if let Some((name, at)) = based_on(&whole) {
        let text = format!("nobody has looked for the spec `{name}`");
        let help = "read this spec by `Bases::read`, or add its base by `Bases::add_to`";
        problems.push(Diagnostic::error(&BASED_ON, at, text).help(help));
        return None;
    }
    problems.extend(stray_lists(&whole));
    while let Some(own) = trees.pop() {
        whole = derived(own, whole, problems);
    }
    Some(whole)
}

/// Returns the name of the spec that a spec is based on, and its place.
pub(super) fn based_on(tree: &Node) -> Option<(String, Range<usize>)> {
    let value = tree.child_at(KEY)?;
    Some((value.text()?.to_owned(), value.span.clone()))
}

/// Finds what only a spec with a base may have.
fn stray_lists(whole: &Node) -> impl Iterator<Item = Diagnostic> {
    let lists = LISTS.into_iter().filter_map(|key| Some((key, whole.entries()?.get(key)?)));
    lists.map(|(key, entry)| {
        let text = format!("`{key}` stands in a spec that takes nothing over");
        Diagnostic::error(&BASED_ON, entry.key.clone(), text).help("name another spec by `based_on`, or take it out")
    })
}

/// Joins a spec with its base.
fn derived(own: Node, base: Node, problems: &mut Vec<Diagnostic>) -> Node {
    let (Some((name, at)), Content::Map(base)) = (based_on(&own), base.content) else { return own };
    let (mut base, flaws) = Base::new(&name, &at, own.text_at("canspec"), base);
    let mut listed = Listed::of(&own);
    listed.look_up(&own, &base.entries);
    let mut unknown = listed.unknown(&name, &base.entries, REPORTED);
    listed.remove_from(&mut base.entries);
    let mut join = Join { base: &name, listed, path: String::new(), problems: flaws };
    if let Content::Map(own) = own.content {
        join.maps(own, &mut base.entries);
    }
    let Join { listed, problems: mut found, .. } = join;
    found.append(&mut unknown);
    found.extend(listed.idle());
    problems.extend(found.into_iter().take(REPORTED));
    Node { span: own.span, content: Content::Map(base.with_allowances()) }
}

/// Adds a spec to its base.
struct Join<'a> {
    /// Name of the base.
    base: &'a str,
    listed: Listed,
    /// Where it is, as in `messages.output`.
    path: String,
    problems: Vec<Diagnostic>,
}

impl Join<'_> {
    fn maps(&mut self, own: Entries, base: &mut Entries) {
        for (key, entry) in own {
            let length = self.path.len();
            step(&mut self.path, &key);
            match base.get_mut(&key) {
                Some(known) => self.entries(entry, known),
                None => _ = base.insert(key, entry),
            }
            self.path.truncate(length);
        }
    }

    fn entries(&mut self, own: Entry, known: &mut Entry) {
        let is_replaced = self.listed.replaces(&self.path);
        let Entry { key, value } = own;
        match (value.content, &mut known.value.content) {
            (Content::Map(entries), Content::Map(base)) if !is_replaced => {
                self.maps(entries, base);
                (known.key, known.value.span) = (key, value.span);
            }
            (content, _) => {
                let own = Entry { key, value: Node { span: value.span, content } };
                if !is_replaced && self.problems.len() < REPORTED {
                    self.problems.push(self.conflict(&own, known));
                }
                *known = own;
            }
        }
    }

    fn conflict(&self, own: &Entry, known: &Entry) -> Diagnostic {
        let Self { path, base, .. } = self;
        let (text, help) = if own.value.content == known.value.content {
            (format!("`{path}` says what `{base}` says already"), "leave it out: it is taken over".to_owned())
        } else {
            let help = format!("add `{path}` to `replaces`, or leave it out and take over that of `{base}`");
            (format!("`{path}` is in `{base}`, too"), help)
        };
        let diagnostic = Diagnostic::error(&REPLACES, own.key.clone(), text).label("given here");
        diagnostic.other(known.key.clone(), format!("`{base}` gives it here")).help(help)
    }
}

/// Goes from the path of a map to that of an entry.
fn step(path: &mut String, key: &str) {
    if !path.is_empty() {
        path.push('.');
    }
    path.push_str(key);
}
