//! The rules on a spec as it is written. Its names, units and numbers must agree with each other.
//!
//! They apply before names are resolved, so a slip in a definition is shown at the definition.

mod order;
mod quantity;
mod spelling;
mod table;
mod uneven;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rule::Rule;
use crate::syntax::tree::Node;
use table::Table;

/// Looks for breaches of one rule in a spec and its tables.
type Lint = fn(&Node, &[Table]) -> Vec<Diagnostic>;

/// The rules on how a spec is written, in order, each with its test.
pub(crate) const RULES: [(&Rule, Lint); 4] = [
    (&quantity::QUANTITY, quantity::lint),
    (&spelling::SPELLING, spelling::lint),
    (&order::ORDER, order::lint),
    (&uneven::UNEVEN, uneven::lint),
];

/// Applies every rule to a spec that could be read.
pub fn lint(diagnostics: &mut Diagnostics) {
    let Some(tree) = diagnostics.tree() else { return };
    let tables = table::tables(tree);
    let found: Vec<_> = RULES.iter().flat_map(|(_, lint)| lint(tree, &tables)).collect();
    for item in found {
        diagnostics.push(item);
    }
}
