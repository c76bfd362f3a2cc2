#![doc = include_str!("../rules/model_range.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{OfModel, Protocol, Range, Signal};
use crate::resolve::rules;

/// What to do about a range that exceeds the general one.
const HELP: &str = "widen the general range, or take it out and give each model its own";

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in protocol.contents() {
        for signal in &message.signals {
            let Some(range) = signal.range else { continue };
            let is_inside =
                |own: &&OfModel<Range>| range.minimum <= own.value.minimum && own.value.maximum <= range.maximum;
            let exceeding: Vec<_> = signal.model_ranges.iter().filter(|own| !is_inside(own)).collect();
            let general =
                format!("the general {}..{} of `{}.{}`", range.minimum, range.maximum, message.name, signal.name);
            match exceeding.as_slice() {
                [] => {}
                [own] => diagnostics.push_first(one(protocol, signal, own, &general)),
                several => diagnostics.push_first(all(protocol, signal, several, &general)),
            }
        }
    }
}

/// Blames the range of the only model that exceeds the general one.
fn one(protocol: &Protocol, signal: &Signal, own: &OfModel<Range>, general: &str) -> Diagnostic {
    let Range { minimum, maximum } = own.value;
    let text = format!("the range {minimum}..{maximum} of `{}` exceeds {general}", protocol[own.model].name);
    let diagnostic = Diagnostic::error(&rules::MODEL_RANGE, own.path.at_value(), text).help(HELP);
    diagnostic.other(signal.range_path.at_value(), "the general range")
}

/// Blames the general range, since several models exceed it.
fn all(protocol: &Protocol, signal: &Signal, several: &[&OfModel<Range>], general: &str) -> Diagnostic {
    let names: Vec<_> = several.iter().map(|own| format!("`{}`", protocol[own.model].name)).collect();
    let text = format!("the ranges of {} exceed {general}", names.join(", "));
    let diagnostic = Diagnostic::error(&rules::MODEL_RANGE, signal.range_path.at_value(), text).help(HELP);
    several.iter().fold(diagnostic, |known, own| known.other(own.path.at_value(), "the range of a model"))
}
