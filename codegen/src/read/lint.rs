//! The rules on a spec as it is written. Its names, units and numbers must agree with each other.
//!
//! They apply before names are resolved, so a slip in a definition is shown at the definition.

mod binary;
mod comment;
mod order;
mod quantity;
mod spelling;
mod table;
mod uneven;

use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::Rule;
use crate::report::tree::Node;
use table::Table;

/// A spec as it is written.
pub(crate) struct Written<'a> {
    text: &'a str,
    tree: &'a Node,
    tables: Vec<Table<'a>>,
}

/// Looks for breaches of one rule.
type Lint = fn(&Written) -> Vec<Diagnostic>;

/// The rules on how a spec is written, in order, each with its test.
pub(crate) const RULES: [(&Rule, Lint); 6] = [
    (&comment::COMMENT, comment::lint),
    (&quantity::QUANTITY, quantity::lint),
    (&spelling::SPELLING, spelling::lint),
    (&order::ORDER, order::lint),
    (&uneven::UNEVEN, uneven::lint),
    (&binary::BINARY, binary::lint),
];

/// Applies every rule to a spec that could be read. What is taken over from another spec is judged
/// there.
pub fn lint(diagnostics: &mut Diagnostics) {
    let Some(tree) = diagnostics.tree() else { return };
    let written = Written { text: diagnostics.source().text(), tree, tables: table::tables(tree) };
    let found: Vec<_> = RULES.iter().flat_map(|(_, lint)| lint(&written)).collect();
    for item in found {
        if !diagnostics.is_taken_over(&item.at) {
            diagnostics.push(item);
        }
    }
}
