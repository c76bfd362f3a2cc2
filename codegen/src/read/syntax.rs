//! Turns text into a tree, and the tree into plain structs whose leaves are still texts.

pub mod ast;
mod gate;
mod merge;
mod reader;
pub(crate) mod rules;

use std::ops::Range;

use crate::read::source::Source;
use crate::report::diagnostic::Diagnostics;
pub use crate::report::tree;

/// Reads a spec, joins it with those that it is based on, and reports every mistake in its syntax
/// at once. It returns no spec if there is a mistake.
///
/// The later stages add to the diagnostics, which hold the text and the tree.
pub fn parse(source: Source) -> (Option<ast::Spec>, Diagnostics) {
    let (trees, mut problems) = gate::read(&source);
    let tree = merge::merge(trees, &mut problems);
    let spec = tree.as_ref().and_then(|tree| reader::read(tree, &mut problems));
    (spec, Diagnostics::new(source).in_tree(tree).with(problems))
}

/// Returns the name of the spec that the last file of a source is based on, and its place.
pub(crate) fn based_on(source: &Source) -> Option<(String, Range<usize>)> {
    let names_one = source.text()[source.last_part()].contains(merge::KEY);
    names_one.then(|| gate::read_last(source))?.as_ref().and_then(merge::based_on)
}
