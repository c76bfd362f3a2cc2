//! Text to tree to plain structs, in which every leaf is still its text.

pub mod ast;
mod gate;
mod reader;
pub(crate) mod rules;
pub mod tree;

use crate::diagnostic::Diagnostics;
use crate::source::Source;

/// Reads a spec, and reports all that is wrong with its syntax at once; there is a spec only if nothing is.
///
/// What is returned as diagnostics goes on to the later stages: it knows the text and the tree.
pub fn parse(source: Source) -> (Option<ast::Spec>, Diagnostics) {
    let (tree, mut problems) = gate::read(&source);
    let spec = tree.as_ref().and_then(|tree| reader::read(tree, &mut problems));
    (spec, Diagnostics::new(source).in_tree(tree).with(problems))
}
