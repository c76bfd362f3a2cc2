//! Which signals the frames of one identifier have, by the values of multiplexors.

use std::collections::{BTreeMap, BTreeSet};

use canspec_runtime::Place;

use super::file::Signal;
use super::names::unique;
use super::signals;
use crate::interpret::coverage;
use crate::model::{Kind, Message, Protocol, SelectorPlace, Shape};

/// One of the frames that share an identifier.
pub type Candidate<'a> = (&'a Message, &'a Shape);

/// The signals of all these frames.
pub struct Tree<'a> {
    pub signals: Vec<Signal>,
    /// Frames that no multiplexor tells from another one, which follows.
    pub lost: Vec<(Candidate<'a>, Candidate<'a>)>,
    kept: Vec<Candidate<'a>>,
}

impl Tree<'_> {
    /// Returns the name of the only message, or the first one of those that look the same.
    pub fn message(&self) -> Option<&str> {
        let name = &self.kept.first()?.0.name;
        let is_only = self.kept.iter().all(|(message, _)| message.name == *name);
        (is_only || self.signals.is_empty()).then_some(name)
    }
}

/// Arranges the signals of frames that share an identifier.
pub fn tree<'a>(protocol: &Protocol, candidates: Vec<Candidate<'a>>) -> Tree<'a> {
    let selectors = 0..protocol.selectors.len();
    let left = selectors.filter(|index| place(protocol, *index).is_some()).collect();
    let mut grower = Grower { protocol, signals: Vec::new(), taken: BTreeSet::new(), lost: Vec::new() };
    grower.grow(&candidates, left, &Branch { under: None, label: String::new() });
    let Grower { signals, lost, .. } = grower;
    let is_lost = |(_, shape): &Candidate| lost.iter().any(|((_, lost), _)| std::ptr::eq(*lost, *shape));
    let kept = candidates.into_iter().filter(|candidate| !is_lost(candidate)).collect();
    Tree { signals, lost, kept }
}

struct Grower<'p, 'a> {
    protocol: &'p Protocol,
    signals: Vec<Signal>,
    taken: BTreeSet<String>,
    lost: Vec<(Candidate<'a>, Candidate<'a>)>,
}

/// Where in the tree a signal stands.
struct Branch {
    /// The multiplexor and its value.
    under: Option<(usize, u64)>,
    /// What the multiplexors' values mean.
    label: String,
}

impl<'a> Grower<'_, 'a> {
    /// Adds the signals of frames of which the multiplexors so far have told all others apart.
    fn grow(&mut self, candidates: &[Candidate<'a>], left: Vec<usize>, branch: &Branch) {
        if is_uniform(candidates) {
            return self.leaf(candidates, &left, branch);
        }
        let Some(chosen) = choose(candidates, &left) else {
            let (kept, lost): (Vec<_>, Vec<_>) =
                candidates.iter().copied().partition(|other| has_same_signals(&candidates[0], other));
            self.lose(&lost, candidates[0]);
            return self.leaf(&kept, &left, branch);
        };
        let (branches, lost) = split(candidates, chosen);
        self.lose(&lost, candidates[0]);
        let is_last = branches.values().all(|of| is_uniform(of));
        let is_shared = |index: &usize| all_have(candidates, *index) && (is_last || has_one_value(candidates, *index));
        let (shared, left): (Vec<_>, Vec<_>) = left.into_iter().filter(|index| *index != chosen).partition(is_shared);
        self.selectors(candidates, &shared, branch);
        let labels = self.labels(chosen, &branches);
        let multiplexor = self.multiplexor(candidates[0], chosen, &labels, branch);
        for ((value, label), of) in labels.into_iter().zip(branches.values()) {
            self.grow(of, left.clone(), &Branch { under: Some((multiplexor, value)), label });
        }
    }

    fn lose(&mut self, lost: &[Candidate<'a>], kept: Candidate<'a>) {
        self.lost.extend(lost.iter().map(|lost| (*lost, kept)));
    }

    /// Adds what all these frames carry alike.
    fn leaf(&mut self, candidates: &[Candidate<'a>], left: &[usize], branch: &Branch) {
        let count = self.signals.len();
        self.selectors(candidates, left, branch);
        let (message, shape) = candidates[0];
        for index in &shape.signals {
            let signal = &message.signals[*index];
            let name = match (branch.under.is_some(), message.signals.len(), signal.name.as_str()) {
                (false, _, name) => name.to_owned(),
                (true, 1, "value") => message.name.clone(),
                (true, _, name) => format!("{}_{name}", message.name),
            };
            for signal in signals::signals(self.protocol, signal, &name) {
                self.add(signal, branch);
            }
        }
        if branch.under.is_some() && self.signals.len() == count {
            self.reserved(candidates[0], branch);
        }
    }

    /// Adds a reserved byte, since programs know a value of a multiplexor only by a signal that depends on it.
    fn reserved(&mut self, (message, shape): Candidate<'a>, branch: &Branch) {
        let covered = coverage(self.protocol, message, shape).to_be_bytes();
        let free = covered.iter().take(message.length.into()).rposition(|byte| *byte == 0);
        if let Some(byte) = free.and_then(|byte| u8::try_from(byte).ok()) {
            let plain = Signal::new(format!("{}_reserved", branch.label), Place::byte(byte));
            let comment = "Reserved, and sent as 0".to_owned();
            self.add(Signal { comment, start: Some(0), ..plain }, branch);
        }
    }

    /// Adds those selectors that all frames have.
    fn selectors(&mut self, candidates: &[Candidate], selectors: &[usize], branch: &Branch) {
        for index in selectors.iter().filter(|index| all_have(candidates, **index)) {
            let mut values: Vec<_> = candidates.iter().map(|candidate| constant(*candidate, *index)).collect();
            values.dedup();
            let only = if let [only] = values[..] { only } else { None };
            let mut signal = self.selector(*index, only, candidates[0], branch);
            if signal.named.is_empty() && values.len() > 1 {
                let labels = self.labels(*index, &split(candidates, *index).0);
                signal.named = labels.into_iter().map(|(value, label)| (value.into(), label)).collect();
            }
            self.add(signal, branch);
        }
    }

    fn multiplexor(&mut self, of: Candidate, index: usize, labels: &[(u64, String)], branch: &Branch) -> usize {
        let mut signal = Signal { multiplexor: true, ..self.selector(index, None, of, branch) };
        if signal.named.is_empty() {
            signal.named = labels.iter().map(|(value, label)| (i128::from(*value), label.clone())).collect();
        }
        self.add(signal, branch);
        self.signals.len() - 1
    }

    fn selector(&self, index: usize, only: Option<u64>, (_, shape): Candidate, branch: &Branch) -> Signal {
        let selector = &self.protocol.selectors[index];
        let space = if branch.label.is_empty() { "" } else { "_" };
        let name = format!("{}{space}{}", branch.label, selector.name);
        let place = place(self.protocol, index).unwrap_or(Place::byte(0));
        let start = only.or(selector.normal.filter(|_| shape.kind != Kind::Request));
        Signal { start: start.map(i128::from), ..signals::selector(self.protocol, selector, place, only, name) }
    }

    /// Names the values of a selector: as the spec does, or else by messages or accesses where these are all different.
    fn labels(&self, selector: usize, branches: &Branches) -> Vec<(u64, String)> {
        let selector = &self.protocol.selectors[selector];
        let messages = distinct(branches, |(message, _)| message.name.clone());
        let accesses = distinct(branches, |(message, shape)| {
            self.protocol.accesses[message.accesses[shape.access].access].name.clone()
        });
        let numbers = || branches.keys().map(|value| format!("{}_{value:X}", selector.name)).collect();
        let labels: Vec<String> = messages.or(accesses).unwrap_or_else(numbers);
        let known = selector.enumeration.map(|index| &self.protocol.enumerations[index].values);
        let named = |value: u64| known?.iter().find(|named| named.raw == value.into()).map(|named| named.name.clone());
        branches.keys().zip(labels).map(|(value, label)| (*value, named(*value).unwrap_or(label))).collect()
    }

    fn add(&mut self, signal: Signal, branch: &Branch) {
        let name = unique(&signal.name, &mut self.taken);
        self.signals.push(Signal { name, under: branch.under, ..signal });
    }
}

/// Returns where in the data bytes a selector stands.
fn place(protocol: &Protocol, selector: usize) -> Option<Place> {
    match protocol.selectors[selector].place {
        SelectorPlace::Payload(place) => Some(place),
        SelectorPlace::Identifier(_) => None,
    }
}

fn constant((_, shape): Candidate, selector: usize) -> Option<u64> {
    shape.constants.iter().find(|(index, _)| *index == selector).map(|(_, value)| *value)
}

fn all_have(candidates: &[Candidate], selector: usize) -> bool {
    candidates.iter().all(|(_, shape)| shape.selectors.contains(&selector))
}

fn has_one_value(candidates: &[Candidate], selector: usize) -> bool {
    candidates.iter().all(|candidate| constant(*candidate, selector) == constant(candidates[0], selector))
}

/// Tests whether two frames carry the same signals.
fn has_same_signals((one, shape): &Candidate, (other, its): &Candidate) -> bool {
    let is_same = std::ptr::eq(*one, *other) || shape.signals.is_empty();
    is_same && shape.signals == its.signals
}

/// Tests whether all frames carry the same.
fn is_uniform(candidates: &[Candidate]) -> bool {
    let selectors = |candidate: &Candidate| candidate.1.selectors.clone();
    let is_same =
        |other: &Candidate| has_same_signals(&candidates[0], other) && selectors(&candidates[0]) == selectors(other);
    candidates.iter().all(is_same)
}

/// Returns a name for each branch, if all frames of a branch have the same one and no other branch has it.
fn distinct(branches: &Branches, of: impl Fn(&Candidate) -> String) -> Option<Vec<String>> {
    let names: Vec<BTreeSet<String>> = branches.values().map(|frames| frames.iter().map(&of).collect()).collect();
    let all: BTreeSet<&String> = names.iter().flatten().collect();
    let are_single = names.iter().all(|names| names.len() == 1);
    (are_single && all.len() == names.len()).then(|| names.into_iter().flatten().collect())
}

/// Frames by the value of a selector.
type Branches<'a> = BTreeMap<u64, Vec<Candidate<'a>>>;

/// Splits frames by a selector's value; those without one are left over.
fn split<'a>(candidates: &[Candidate<'a>], selector: usize) -> (Branches<'a>, Vec<Candidate<'a>>) {
    let mut branches = Branches::new();
    let mut lost = Vec::new();
    for candidate in candidates {
        match constant(*candidate, selector) {
            Some(value) => branches.entry(value).or_default().push(*candidate),
            None => lost.push(*candidate),
        }
    }
    (branches, lost)
}

/// Chooses the selector that loses the fewest frames, leaves the least to be told apart and has the fewest values.
fn choose(candidates: &[Candidate], left: &[usize]) -> Option<usize> {
    let splits = left.iter().map(|index| (*index, split(candidates, *index)));
    let telling = splits.filter(|(_, (branches, _))| branches.len() > 1);
    let chosen = telling.min_by_key(|(_, (branches, lost))| {
        let mixed = branches.values().filter(|of| !is_uniform(of)).count();
        (lost.len(), mixed, branches.len())
    });
    chosen.map(|(index, _)| index)
}
