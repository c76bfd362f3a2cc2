//! The rules on the bytes of a spec.

use crate::report::rule::{Rule, rules};

rules! {
    FILE "file" Source ERROR;
    ENCODING "encoding" Source ERROR;
    BASED_ON "based_on" Source ERROR;
}

/// All rules of the stage, in order.
pub static RULES: &[&Rule] = &[&FILE, &ENCODING, &BASED_ON];
