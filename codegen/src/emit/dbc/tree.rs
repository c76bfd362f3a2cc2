//! Arranges the signals of the frames with one identifier by the values of multiplexors.

use std::collections::{BTreeMap, BTreeSet};

use canspec_runtime::Place;

use super::file::Signal;
use super::names::unique;
use super::signals;
use crate::model::{FrameId, FrameLayout, Message, Protocol, SelectorId, SelectorPlace};

/// One of the frames that share an identifier.
#[derive(Clone, Copy)]
pub struct Candidate<'a> {
    pub id: FrameId,
    pub message: &'a Message,
    pub layout: &'a FrameLayout,
}

/// The signals of all these frames.
pub struct Tree<'a> {
    pub signals: Vec<Signal>,
    /// Frames that no multiplexor tells from another frame, each with that frame.
    pub lost: Vec<(Candidate<'a>, Candidate<'a>)>,
    kept: Vec<Candidate<'a>>,
}

impl Tree<'_> {
    /// Tests whether a frame is in the tree: neither lost nor of another length.
    pub fn has(&self, id: FrameId) -> bool {
        self.kept.iter().any(|kept| kept.id == id)
    }

    /// Returns the name of the only message, or of the first one if several look the same.
    pub fn message(&self) -> Option<&str> {
        let name = &self.kept.first()?.message.name;
        let is_only = self.kept.iter().all(|kept| kept.message.name == *name);
        (is_only || self.signals.is_empty()).then_some(name)
    }
}

/// Arranges the signals of frames that share an identifier.
pub fn tree<'a>(protocol: &Protocol, candidates: Vec<Candidate<'a>>) -> Tree<'a> {
    let left = protocol.selectors.ids().filter(|id| place(protocol, *id).is_some()).collect();
    let mut grower = Grower { protocol, signals: Vec::new(), taken: BTreeSet::new(), lost: Vec::new() };
    grower.grow(&candidates, left, &Branch { under: None, label: String::new() });
    let Grower { signals, lost, .. } = grower;
    let is_lost = |candidate: &Candidate| lost.iter().any(|(lost, _)| lost.id == candidate.id);
    let kept = candidates.into_iter().filter(|candidate| !is_lost(candidate)).collect();
    Tree { signals, lost, kept }
}

struct Grower<'p, 'a> {
    protocol: &'p Protocol,
    signals: Vec<Signal>,
    taken: BTreeSet<String>,
    lost: Vec<(Candidate<'a>, Candidate<'a>)>,
}

/// The place of a signal in the tree.
struct Branch {
    /// The multiplexor and its value.
    under: Option<(String, u64)>,
    /// What the multiplexors' values mean.
    label: String,
}

impl<'a> Grower<'_, 'a> {
    /// Adds the signals of frames that share the values of all multiplexors so far.
    fn grow(&mut self, candidates: &[Candidate<'a>], left: Vec<SelectorId>, branch: &Branch) {
        if is_uniform(candidates) {
            return self.leaf(candidates, &left, branch);
        }
        let chosen = choose(candidates, &left);
        let lost = lost(candidates, chosen);
        let (empty, full): (Vec<_>, Vec<_>) = candidates.iter().copied().partition(is_empty);
        if !empty.is_empty() && !lost.iter().all(is_empty) {
            self.lose(&empty, full[0]);
            return self.grow(&full, left, branch);
        }
        self.lose(&lost, candidates[0]);
        let Some(chosen) = chosen else {
            let kept: Vec<_> =
                candidates.iter().copied().filter(|other| has_same_signals(&candidates[0], other)).collect();
            return self.leaf(&kept, &left, branch);
        };
        let (branches, _) = split(candidates, chosen);
        let is_last = branches.values().all(|of| is_uniform(of));
        let is_shared = |id: &SelectorId| all_have(candidates, *id) && (is_last || has_one_value(candidates, *id));
        let (shared, left): (Vec<_>, Vec<_>) = left.into_iter().filter(|id| *id != chosen).partition(is_shared);
        self.selectors(candidates, &shared, branch);
        let labels = self.labels(chosen, &branches);
        let multiplexor = self.multiplexor(candidates[0], chosen, &labels, branch);
        for ((value, label), of) in labels.into_iter().zip(branches.values()) {
            self.grow(of, left.clone(), &Branch { under: Some((multiplexor.clone(), value)), label });
        }
    }

    fn lose(&mut self, lost: &[Candidate<'a>], kept: Candidate<'a>) {
        self.lost.extend(lost.iter().map(|lost| (*lost, kept)));
    }

    /// Adds the signals that all these frames share.
    fn leaf(&mut self, candidates: &[Candidate<'a>], left: &[SelectorId], branch: &Branch) {
        let count = self.signals.len();
        self.selectors(candidates, left, branch);
        let Candidate { message, layout, .. } = candidates[0];
        for id in &layout.signals {
            let signal = &message[*id];
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

    /// Adds a reserved byte. Programs only know a multiplexor's value if a signal depends on it.
    fn reserved(&mut self, Candidate { layout, .. }: Candidate<'a>, branch: &Branch) {
        let covered = layout.covered.to_be_bytes();
        let free = covered.iter().take(layout.longest().into()).rposition(|byte| *byte == 0);
        if let Some(byte) = free.and_then(|byte| u8::try_from(byte).ok()) {
            let plain = Signal::new(format!("{}_reserved", branch.label), Place::byte(byte));
            let comment = "Reserved, and sent as 0".to_owned();
            self.add(Signal { comment, start: Some(0), ..plain }, branch);
        }
    }

    /// Adds the selectors that all frames have.
    fn selectors(&mut self, candidates: &[Candidate], selectors: &[SelectorId], branch: &Branch) {
        for id in selectors.iter().filter(|id| all_have(candidates, **id)) {
            let mut values: Vec<_> = candidates.iter().map(|candidate| constant(*candidate, *id)).collect();
            values.dedup();
            let only = if let [only] = values[..] { only } else { None };
            let mut signal = self.selector(*id, only, candidates[0], branch);
            if signal.named.is_empty() && values.len() > 1 {
                let labels = self.labels(*id, &split(candidates, *id).0);
                signal.named = labels.into_iter().map(|(value, label)| (value.into(), label)).collect();
            }
            self.add(signal, branch);
        }
    }

    fn multiplexor(&mut self, of: Candidate, id: SelectorId, labels: &[(u64, String)], branch: &Branch) -> String {
        let mut signal = Signal { multiplexor: true, ..self.selector(id, None, of, branch) };
        if signal.named.is_empty() {
            signal.named = labels.iter().map(|(value, label)| (i128::from(*value), label.clone())).collect();
        }
        self.add(signal, branch)
    }

    fn selector(&self, id: SelectorId, only: Option<u64>, of: Candidate, branch: &Branch) -> Signal {
        let selector = &self.protocol[id];
        let space = if branch.label.is_empty() { "" } else { "_" };
        let name = format!("{}{space}{}", branch.label, selector.name);
        let place = place(self.protocol, id).unwrap_or(Place::byte(0));
        let start = only.or(selector.normal.filter(|_| !of.layout.is_to_module()));
        Signal { start: start.map(i128::from), ..signals::selector(self.protocol, selector, place, only, name) }
    }

    /// Names the values of a selector as the spec does. Otherwise it names them by messages or
    /// accesses, if these are all different.
    fn labels(&self, selector: SelectorId, branches: &Branches) -> Vec<(u64, String)> {
        let selector = &self.protocol[selector];
        let messages = distinct(branches, |candidate| candidate.message.name.clone());
        let accesses = distinct(branches, |candidate| self.protocol[candidate.layout.access].name.clone());
        let numbers = || branches.keys().map(|value| format!("{}_{value:X}", selector.name)).collect();
        let labels: Vec<String> = messages.or(accesses).unwrap_or_else(numbers);
        let known = selector.enumeration.map(|id| &self.protocol[id].values);
        let named = |value: u64| known?.iter().find(|named| named.raw == value.into()).map(|named| named.name.clone());
        branches.keys().zip(labels).map(|(value, label)| (*value, named(*value).unwrap_or(label))).collect()
    }

    /// Adds a signal, and returns the name that it gets.
    fn add(&mut self, signal: Signal, branch: &Branch) -> String {
        let name = unique(&signal.name, &mut self.taken);
        self.signals.push(Signal { name: name.clone(), under: branch.under.clone(), ..signal });
        name
    }
}

/// Returns the place of a selector in the data bytes.
fn place(protocol: &Protocol, selector: SelectorId) -> Option<Place> {
    match protocol[selector].place {
        SelectorPlace::Payload(place) => Some(place),
        SelectorPlace::Identifier(_) => None,
    }
}

fn constant(of: Candidate, selector: SelectorId) -> Option<u64> {
    of.layout.constants.iter().find(|known| known.selector == selector && known.open == 0).map(|known| known.value)
}

fn all_have(candidates: &[Candidate], selector: SelectorId) -> bool {
    candidates.iter().all(|candidate| candidate.layout.selectors.contains(&selector))
}

fn has_one_value(candidates: &[Candidate], selector: SelectorId) -> bool {
    candidates.iter().all(|candidate| constant(*candidate, selector) == constant(candidates[0], selector))
}

/// Tests whether a frame carries no signals.
pub fn is_empty(candidate: &Candidate) -> bool {
    candidate.layout.signals.is_empty()
}

/// Returns the frames that a selector does not tell from the others. Without a selector, all but
/// the first are lost.
fn lost<'a>(candidates: &[Candidate<'a>], selector: Option<SelectorId>) -> Vec<Candidate<'a>> {
    match selector {
        Some(selector) => split(candidates, selector).1,
        None => candidates.iter().copied().filter(|other| !has_same_signals(&candidates[0], other)).collect(),
    }
}

/// Tests whether two frames carry the same signals.
fn has_same_signals(one: &Candidate, other: &Candidate) -> bool {
    let is_same = one.layout.message == other.layout.message || one.layout.signals.is_empty();
    is_same && one.layout.signals == other.layout.signals
}

/// Tests whether all frames carry the same signals.
fn is_uniform(candidates: &[Candidate]) -> bool {
    let is_same = |other: &Candidate| {
        has_same_signals(&candidates[0], other) && candidates[0].layout.selectors == other.layout.selectors
    };
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

/// Splits frames by a selector's value. Frames without the selector are left over.
fn split<'a>(candidates: &[Candidate<'a>], selector: SelectorId) -> (Branches<'a>, Vec<Candidate<'a>>) {
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

/// Chooses the selector that loses the fewest frames, then leaves the fewest alike, then has the
/// fewest values.
fn choose(candidates: &[Candidate], left: &[SelectorId]) -> Option<SelectorId> {
    let splits = left.iter().map(|id| (*id, split(candidates, *id)));
    let telling = splits.filter(|(_, (branches, _))| branches.len() > 1);
    let chosen = telling.min_by_key(|(_, (branches, lost))| {
        let mixed = branches.values().filter(|of| !is_uniform(of)).count();
        (lost.len(), mixed, branches.len())
    });
    chosen.map(|(id, _)| id)
}
