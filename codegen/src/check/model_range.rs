#![doc = include_str!("../rules/model_range.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Protocol;
use crate::resolve::rules;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in protocol.contents() {
        for signal in &message.signals {
            let Some(range) = signal.range else { continue };
            for own in &signal.model_ranges {
                if range.minimum <= own.value.minimum && own.value.maximum <= range.maximum {
                    continue;
                }
                let text = format!(
                    "the range {}..{} of `{}` exceeds the general {}..{} of `{}.{}`",
                    own.value.minimum,
                    own.value.maximum,
                    protocol.models[own.model].name,
                    range.minimum,
                    range.maximum,
                    message.name,
                    signal.name
                );
                let help = "widen the general range, or take it out and give each model its own";
                let diagnostic = Diagnostic::error(&rules::MODEL_RANGE, own.path.at_value(), text).help(help);
                diagnostics.push_first(diagnostic.other(signal.range_path.at_value(), "the general range"));
            }
        }
    }
}
