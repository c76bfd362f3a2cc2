//! The rules of the last stage: a resolved spec must also be right.
//!
//! Each rule is a file with one document, one function that looks for breaches, and one folder of
//! fixtures. [`check`] calls them in the order of its list. They only read the model, and say what
//! is wrong at the place of the spec that the model remembers. `example` has the interpreter decode
//! and encode each example of the document; `summary` counts what a spec contains.

mod ambiguous;
mod default_value;
mod direction;
mod document;
mod erratum;
mod example;
mod grid;
mod model_range;
mod no_example;
mod no_limit;
mod no_match;
mod no_model;
mod no_quantity;
mod no_refusal;
mod no_unit;
mod nobody_replies;
mod outside_frame;
mod overlap;
mod product_limit;
mod quantity_path;
mod range_step;
mod range_width;
mod read_only_range;
mod refusal;
mod reply;
mod role;
pub(crate) mod rust_name;
mod section;
mod set;
mod shared_address;
mod special_value;
mod stale_allowance;
mod starting;
pub(crate) mod summary;
mod transport;
mod unreachable;

pub use example::{Counts, Unproven, unproven};
pub use grid::{fits, has_exact_steps};
pub use stale_allowance::allow;

use crate::model::Protocol;
use crate::report::diagnostic::Diagnostics;
use crate::report::rule::Rule;
use crate::resolve::rules;

/// Looks for breaches of one rule.
pub(crate) type Check = fn(&Protocol, &mut Diagnostics);

/// The rules on what is meant, in order, each with what looks for breaches; `None` of what examples are tested for.
pub(crate) const RULES: [(&Rule, Option<Check>); 36] = [
    (&outside_frame::OUTSIDE_FRAME, Some(outside_frame::check)),
    (&overlap::OVERLAP, Some(overlap::check)),
    (&grid::GRID, Some(grid::check)),
    (&range_width::RANGE_WIDTH, Some(range_width::check)),
    (&range_step::RANGE_STEP, Some(range_step::check)),
    (&read_only_range::READ_ONLY_RANGE, Some(read_only_range::check)),
    (&no_limit::NO_LIMIT, Some(no_limit::check)),
    (&no_unit::NO_UNIT, Some(no_unit::check)),
    (&no_model::NO_MODEL, Some(no_model::check)),
    (&rules::MODEL_RANGE, Some(model_range::check)),
    (&special_value::SPECIAL_VALUE, Some(special_value::check)),
    (&default_value::DEFAULT_VALUE, Some(default_value::check)),
    (&rules::SET, Some(set::check)),
    (&rules::TRANSPORT, Some(transport::check)),
    (&direction::DIRECTION, Some(direction::check)),
    (&shared_address::SHARED_ADDRESS, Some(shared_address::check)),
    (&ambiguous::AMBIGUOUS, Some(ambiguous::check)),
    (&no_match::NO_MATCH, Some(no_match::check)),
    (&refusal::REFUSAL, Some(refusal::check)),
    (&no_refusal::NO_REFUSAL, Some(no_refusal::check)),
    (&starting::STARTING, Some(starting::check)),
    (&role::ROLE, Some(role::check)),
    (&rules::QUANTITY_PATH, Some(quantity_path::check)),
    (&no_quantity::NO_QUANTITY, Some(no_quantity::check)),
    (&rules::PRODUCT_LIMIT, Some(product_limit::check)),
    (&unreachable::UNREACHABLE, Some(unreachable::check)),
    (&nobody_replies::NOBODY_REPLIES, Some(nobody_replies::check)),
    (&rust_name::RUST_NAME, Some(rust_name::check)),
    (&erratum::ERRATUM, Some(erratum::check)),
    (&document::DOCUMENT, Some(document::check)),
    (&section::SECTION, Some(section::check)),
    (&reply::REPLY, None),
    (&rules::EXAMPLE, None),
    (&example::EXPECTED_FAILURE, None),
    (&no_example::NO_EXAMPLE, None),
    (&stale_allowance::STALE_ALLOWANCE, None),
];

/// Applies every rule. It runs the document's examples only if the protocol is otherwise right.
///
/// If `percent` is given, that many of a hundred messages must have an example.
pub fn check(protocol: &Protocol, percent: Option<u8>, diagnostics: &mut Diagnostics) -> Counts {
    for check in RULES.iter().filter_map(|(_, check)| *check) {
        check(protocol, diagnostics);
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
