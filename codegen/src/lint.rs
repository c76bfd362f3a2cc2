//! The rules on a spec as it is written, in order: its names, units and numbers must bear each other out.
//!
//! They come before names are resolved, so that a slip in a definition is shown there, whatever refers to it.

mod order;
mod quantity;
mod spelling;
mod table;
mod uneven;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::syntax::tree::Node;
use table::Table;

/// Looks for breaches of one rule in a spec, of which the maps with names are found already.
type Lint = fn(&Node, &[Table]) -> Vec<Diagnostic>;

/// The rules on what is written, in order.
const RULES: [Lint; 4] = [quantity::lint, spelling::lint, order::lint, uneven::lint];

/// Applies every rule to a spec that could be read.
pub fn lint(diagnostics: &mut Diagnostics) {
    let Some(tree) = diagnostics.tree() else { return };
    let tables = table::tables(tree);
    let found: Vec<_> = RULES.iter().flat_map(|rule| rule(tree, &tables)).collect();
    for item in found {
        diagnostics.push(item);
    }
}
