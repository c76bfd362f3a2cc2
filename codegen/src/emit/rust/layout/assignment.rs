//! Values that are assigned.

use syn::Expr;

use super::flat::flat;
use super::shape::{Shape, breaks, first_line, is_broken, line_break, width};

/// Lays out a value after `before`, on the same line or the next one. `after` columns follow.
pub fn assigned(before: &str, value: &Expr, line: Shape, after: usize) -> Option<String> {
    let same = Shape { column: width(before) + 1, ..line }.keeping(after).rewrite(value);
    if let Some(same) = same.as_ref().filter(|same| !is_broken(same)) {
        return Some(format!("{before} {same}"));
    }
    let below = line.nested().keeping(after);
    let next = below.rewrite(value);
    let fits = |next: &str| width(first_line(next)) <= below.width();
    match (same, next) {
        (Some(same), Some(next)) if !fits(&next) || !is_better_below(&same, &next) => Some(format!("{before} {same}")),
        (_, Some(next)) => Some(format!("{before}{}{next}", line_break(below.indent))),
        (Some(same), None) => Some(format!("{before} {same}")),
        (None, None) => Some(format!("{before} {}", flat(value)?)),
    }
}

/// Tests whether a broken text looks better if it begins on a line of its own.
pub fn is_better_below(same: &str, below: &str) -> bool {
    let opens = |text: &str, bracket| first_line(text).ends_with(bracket);
    !is_broken(below)
        || breaks(same) > breaks(below) + 1
        || ['(', '{', '['].into_iter().any(|bracket| opens(same, bracket) && !opens(below, bracket))
}
