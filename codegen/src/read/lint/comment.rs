#![doc = include_str!("../../../docs/rules/comment.md")]

use super::Written;
use crate::report::diagnostic::Diagnostic;
use crate::report::rule::rules;
use crate::report::tree::{Content, Node, Path};

rules! {
    COMMENT "comment" Lint WARNING;
}

/// Keys of texts that people read.
const TEXTS: [&str; 15] = [
    "title",
    "note",
    "section",
    "version",
    "date",
    "file",
    "set_when",
    "clear_when",
    "effect",
    "led",
    "items",
    "steps",
    "prints",
    "uses",
    "because",
];

pub fn lint(Written { text, tree, .. }: &Written) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    visit(tree, "", &Path::default(), &mut |node, path| found.extend(cut(text, node, path)));
    found
}

/// Shows each text that people read. `key` is the key that a value stands under.
fn visit(node: &Node, key: &str, path: &Path, show: &mut impl FnMut(&Node, &Path)) {
    match &node.content {
        Content::Text(_) if TEXTS.contains(&key) => show(node, path),
        Content::List(items) => {
            items.iter().enumerate().for_each(|(index, item)| visit(item, key, &path.index(index), show));
        }
        Content::Map(entries) => {
            entries.iter().for_each(|(key, entry)| visit(&entry.value, key, &path.key(key), show));
        }
        Content::Text(_) | Content::Refused => {}
    }
}

/// Finds the sign of a comment behind one blank. A number has no words that a comment could take.
fn cut(source: &str, node: &Node, path: &Path) -> Option<Diagnostic> {
    let text = node.text().filter(|text| text.contains(char::is_alphabetic))?;
    let is_quoted = !source[node.span.clone()].starts_with(text.chars().next()?);
    let sign = node.span.end + 1;
    if is_quoted || !source[node.span.end..].starts_with(" #") {
        return None;
    }
    let diagnostic = Diagnostic::warning(&COMMENT, path.at_value(), "the text ends where ` #` begins a comment");
    let help = "quote the text if what follows belongs to it; else write two blanks before the comment";
    Some(diagnostic.other(sign..sign + 1, "the comment").help(help))
}
