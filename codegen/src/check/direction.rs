//! `direction`: an identifier does not show whether it goes to a module or to the controller.
//!
//! Whoever reads the bus must know a request from its reply. Give the controller's address type `outside: refused`, or the two
//! directions different constants in one field.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{FieldTest, Protocol};
use crate::syntax::tree::Path;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let pairs =
        protocol.to_module.any.iter().flat_map(|one| protocol.to_controller.any.iter().map(move |other| (one, other)));
    for (one, other) in pairs {
        if !one.iter().any(|test| other.iter().any(|opposite| excludes(test, opposite) || excludes(opposite, test))) {
            let text = "nothing in the identifier tells a request from a reply".to_owned();
            let help = "give the controller's address type `outside: refused`, \
                        or one field a constant in `request` and another in the replies";
            let at = Path::default().key("addressing").at_key();
            diagnostics.push(Diagnostic::error("direction", at, text).help(help));
            return;
        }
    }
}

/// Tests whether no value passes both tests of one field.
fn excludes(one: &FieldTest, other: &FieldTest) -> bool {
    let apart = |(first, last): &(u32, u32), (start, end): &(u32, u32)| last < start || end < first;
    let contains = |(first, last): &(u32, u32), (start, end): &(u32, u32)| first <= start && end <= last;
    one.field == other.field
        && one.inside
        && one.ranges.iter().all(|range| {
            if other.inside {
                other.ranges.iter().all(|opposite| apart(range, opposite))
            } else {
                other.ranges.iter().any(|opposite| contains(opposite, range))
            }
        })
}
