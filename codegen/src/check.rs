//! The rules of the last stage, in order: what is resolved must also be right.

mod ambiguous;
mod default_value;
mod direction;
mod erratum;
mod example;
mod grid;
mod model_range;
mod no_example;
mod no_unit;
mod nobody_replies;
mod outside_frame;
mod overlap;
mod range_width;
mod read_only_range;
mod refusal;
mod reply;
mod rust_name;
mod section;
mod set;
mod special_value;
mod stale_allowance;
mod unreachable;

pub use example::Counts;
pub use grid::{fits, has_exact_steps};
pub use stale_allowance::allow;

use crate::diagnostic::Diagnostics;
use crate::model::Protocol;

/// Looks for breaches of one rule.
type Check = fn(&Protocol, &mut Diagnostics);

/// The rules on what the protocol is, in order.
const RULES: [Check; 18] = [
    outside_frame::check,
    overlap::check,
    grid::check,
    range_width::check,
    read_only_range::check,
    no_unit::check,
    model_range::check,
    special_value::check,
    default_value::check,
    set::check,
    direction::check,
    ambiguous::check,
    refusal::check,
    unreachable::check,
    nobody_replies::check,
    rust_name::check,
    erratum::check,
    section::check,
];

/// Applies every rule; the document's examples are run only by a protocol that is otherwise right.
///
/// Of a hundred messages so many must have an example, where anybody asks for that.
pub fn check(protocol: &Protocol, percent: Option<u8>, diagnostics: &mut Diagnostics) -> Counts {
    for rule in RULES {
        rule(protocol, diagnostics);
    }
    if let Some(percent) = percent {
        no_example::check(protocol, percent, diagnostics);
    }
    if diagnostics.has_errors() {
        example::check_texts(protocol, diagnostics);
        return Counts::default();
    }
    reply::check(protocol, diagnostics);
    example::check(protocol, diagnostics)
}
