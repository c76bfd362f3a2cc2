#![doc = include_str!("../../docs/rules/stale_allowance.md")]

use crate::read::syntax::ast::Allowance;
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    STALE_ALLOWANCE "stale_allowance" Check WARNING;
}

/// Takes out the allowed warnings. An allowance without a warning is stale, unless an error kept
/// rules from being applied. One of another spec may be about something that was not taken over.
pub fn allow(allowances: &[Allowance], diagnostics: &mut Diagnostics) {
    for (index, Allowance { rule, at, .. }) in allowances.iter().enumerate() {
        let was_needed = diagnostics.allow(rule, at);
        let path = Path::default().key("allow").index(index).key("rule");
        if was_needed || diagnostics.has_errors() || diagnostics.is_taken_over(&path.at_value()) {
            continue;
        }
        let text = format!("there is no warning of the rule `{rule}` in `{at}`");
        let help = "take the allowance out, or correct `rule` and `at`; errors cannot be allowed";
        diagnostics.push(Diagnostic::warning(&STALE_ALLOWANCE, path.at_value(), text).help(help));
    }
}
