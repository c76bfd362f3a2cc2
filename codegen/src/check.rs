//! The rules of the last stage: what is resolved must also be right.

pub(crate) mod ambiguous;
pub(crate) mod default_value;
pub(crate) mod direction;
pub(crate) mod erratum;
mod example;
pub(crate) mod grid;
pub(crate) mod model_range;
mod no_example;
pub(crate) mod no_unit;
pub(crate) mod nobody_replies;
pub(crate) mod outside_frame;
pub(crate) mod overlap;
pub(crate) mod range_width;
pub(crate) mod read_only_range;
pub(crate) mod refusal;
mod reply;
pub(crate) mod rust_name;
pub(crate) mod section;
pub(crate) mod set;
pub(crate) mod special_value;
mod stale_allowance;
pub(crate) mod unreachable;

pub use example::Counts;
pub use grid::{fits, has_exact_steps};
pub use stale_allowance::allow;

use crate::diagnostic::Diagnostics;
use crate::model::Protocol;
use crate::rules::RULES;

/// Applies every rule; the document's examples are run only by a protocol that is otherwise right.
///
/// Of a hundred messages so many must have an example, where anybody asks for that.
pub fn check(protocol: &Protocol, percent: Option<u8>, diagnostics: &mut Diagnostics) -> Counts {
    for check in RULES.iter().filter_map(|rule| rule.check) {
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
