//! The rules on the text of a spec.

use crate::report::rule::{Rule, rules};

rules! {
    YAML "yaml" Syntax ERROR;
    PLAIN_WORD "plain_word" Syntax ERROR;
    DUPLICATE_KEY "duplicate_key" Syntax ERROR;
    UNKNOWN_KEY "unknown_key" Syntax ERROR;
    MISSING_KEY "missing_key" Syntax ERROR;
    WRONG_KIND "wrong_kind" Syntax ERROR;
    REPLACES "replaces" Syntax ERROR;
    REMOVES "removes" Syntax ERROR;
}

/// All rules of the stage, in order.
pub static RULES: &[&Rule] =
    &[&YAML, &PLAIN_WORD, &DUPLICATE_KEY, &UNKNOWN_KEY, &MISSING_KEY, &WRONG_KIND, &REPLACES, &REMOVES];
