//! Turns text into a tree, and the tree into plain structs whose leaves are still texts.

pub mod ast;
mod gate;
mod reader;
pub(crate) mod rules;
pub mod tree;

use crate::diagnostic::Diagnostics;
use crate::source::Source;

/// Reads a spec and reports every mistake in its syntax at once. It returns no spec if there is a
/// mistake.
///
/// The later stages add to the diagnostics, which hold the text and the tree.
pub fn parse(source: Source) -> (Option<ast::Spec>, Diagnostics) {
    let (tree, mut problems) = gate::read(&source);
    let spec = tree.as_ref().and_then(|tree| reader::read(tree, &mut problems));
    (spec, Diagnostics::new(source).in_tree(tree).with(problems))
}
