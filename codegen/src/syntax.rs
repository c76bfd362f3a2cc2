//! Text to tree to plain structs, in which every leaf is still its text.

pub mod ast;
mod gate;
mod reader;
pub(crate) mod rules;
pub mod tree;

use crate::diagnostic::{At, Diagnostic, Diagnostics};
use crate::source::Source;

/// Reads a spec, and reports all that is wrong with its syntax at once; there is a spec only if nothing is.
///
/// What is returned as diagnostics goes on to the later stages: it knows the text and the tree.
pub fn parse(source: Source) -> (Option<ast::Spec>, Diagnostics) {
    let (tree, mut problems) = gate::read(&source);
    let spec = tree.as_ref().and_then(|tree| read_tree(tree, &mut problems));
    (spec, Diagnostics::new(source).in_tree(tree).with(problems))
}

fn read_tree(tree: &tree::Node, problems: &mut Vec<Diagnostic>) -> Option<ast::Spec> {
    match reader::read(tree) {
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

/// Adds what the reader found. Where the gate refused the value of an unknown key as a plain word, the key is the mistake;
/// where it refused something else, that explains the key.
fn add(item: Diagnostic, tree: &tree::Node, problems: &mut Vec<Diagnostic>) {
    let refused = match &item.at {
        At::Key(path) if *item.rule == rules::UNKNOWN_KEY => tree.get(path),
        At::File | At::Span(_) | At::Key(_) | At::Value(_) => None,
    };
    match refused.filter(|value| value.content == tree::Content::Refused) {
        None => problems.push(item),
        Some(value) => {
            let at = At::Span(value.span.clone());
            let word = problems.iter().position(|known| *known.rule == rules::PLAIN_WORD && known.at == at);
            if let Some(word) = word {
                problems[word] = item;
            }
        }
    }
}
