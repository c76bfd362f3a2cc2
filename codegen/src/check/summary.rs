//! Counts what a spec contains.

use std::collections::BTreeSet;

use indexmap::IndexMap;

use crate::check::Counts;
use crate::model::Protocol;
use crate::report::diagnostic::Diagnostics;

/// What a spec contains. These are the fields of `canspec check --format json`, in that order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// The file as it was named.
    pub spec: String,
    /// Name of the protocol, if the spec could be resolved.
    pub protocol: Option<String>,
    /// Messages, registers included.
    pub messages: usize,
    /// The fields that choose messages, and how many values of each are used.
    pub selectors: Vec<(String, usize)>,
    /// Signals of all messages.
    pub signals: usize,
    /// Named bits of status words.
    pub status_bits: usize,
    /// All examples, those of types included.
    pub examples: usize,
    /// Examples with identifier and data that decoded and encoded back.
    pub frames: usize,
    /// Examples printed without data.
    pub identifiers: usize,
    /// Printed forms that fail as stated.
    pub expected_failures: usize,
    /// Values in frames that their examples do not state.
    pub unproven: usize,
    /// Departures from the document.
    pub errata: usize,
    /// Diagnostics that make the spec unusable.
    pub errors: usize,
    /// Diagnostics that only ask somebody to look.
    pub warnings: usize,
}

impl Summary {
    pub(crate) fn new(spec: &str, protocol: Option<&Protocol>, counts: Counts, diagnostics: &Diagnostics) -> Self {
        let count = |of: fn(&Protocol) -> usize| protocol.map_or(0, of);
        Self {
            spec: spec.to_owned(),
            protocol: protocol.map(|protocol| protocol.name.clone()),
            messages: count(|protocol| protocol.messages.len()),
            selectors: protocol.map(selectors).unwrap_or_default(),
            signals: count(|protocol| protocol.contents().map(|message| message.signals.len()).sum()),
            status_bits: count(|protocol| protocol.status_words.iter().map(|word| word.bits.len()).sum()),
            examples: count(|protocol| {
                let long = protocol.long_examples.iter().map(|example| example.frames.len());
                protocol.examples.len() + long.sum::<usize>() + protocol.value_examples.len()
            }),
            frames: counts.frames,
            identifiers: counts.identifiers,
            expected_failures: counts.expected_failures,
            unproven: counts.unproven,
            errata: count(|protocol| protocol.errata.len()),
            errors: diagnostics.errors(),
            warnings: diagnostics.warnings(),
        }
    }
}

/// Counts the values of each selector. Fields with one name in several places count as one.
fn selectors(protocol: &Protocol) -> Vec<(String, usize)> {
    let mut values: IndexMap<&str, BTreeSet<u64>> =
        protocol.selectors.iter().map(|selector| (selector.name.as_str(), BTreeSet::new())).collect();
    for constant in protocol.frames.iter().flat_map(|frame| &frame.constants) {
        values.entry(&protocol[constant.selector].name).or_default().extend(constant.values());
    }
    let used = values.into_iter().filter(|(_, values)| !values.is_empty());
    used.map(|(name, values)| (name.to_owned(), values.len())).collect()
}
