#![doc = include_str!("../../docs/rules/model_range.md")]

use crate::model::{Message, OfModel, Protocol, Range, Signal};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::resolve::rules;

/// What to do about a range that exceeds the general one.
const HELP: &str = "widen the general range, or take it out and give each model its own";

/// Most fields, bits and named values that device models lack, each counted for each model.
const MOST_LACKS: usize = 1 << 16;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    check_lacks(protocol, diagnostics);
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

/// Refuses a spec whose models lack very much, since every output lists it.
fn check_lacks(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let signals = protocol.contents().flat_map(|message| message.signals.iter().map(move |signal| (message, signal)));
    let partial = signals.filter(|(_, signal)| is_partial(protocol, signal));
    let mut lacks = partial.flat_map(|(message, signal)| lacks(protocol, message, signal));
    let Some(signal) = lacks.nth(MOST_LACKS) else { return };
    let text = format!("device models lack more than {MOST_LACKS} fields, bits and named values from here on");
    let help = "each counts once for each model that does not have it; write a spec for some of the models";
    diagnostics.push(Diagnostic::error(&rules::MODEL_RANGE, signal.doc.path.at_key(), text).help(help));
}

/// Tests whether only some device models have a signal, a bit of it, or one of its named values.
fn is_partial(protocol: &Protocol, signal: &Signal) -> bool {
    let mut bits = signal.encoding.status_word().into_iter().flat_map(|word| &protocol[word].bits);
    !signal.models.is_empty()
        || bits.any(|bit| !bit.models.is_empty())
        || protocol.named_values(signal).iter().any(|value| !value.models.is_empty())
}

/// Returns a signal as often as outputs list what device models do not have of it.
fn lacks<'a>(protocol: &Protocol, message: &Message, signal: &'a Signal) -> impl Iterator<Item = &'a Signal> {
    let lacking = protocol.models_of(message).filter_map(move |model| protocol.lacking(message, signal, model));
    lacking.flat_map(move |known| vec![signal; usize::from(known.mask != 0) + known.values.len()])
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
