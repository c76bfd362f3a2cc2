//! The plan to recognise frames: which bits tell them apart, and in which order. Every engine runs
//! or prints it.

use serde::{Deserialize, Serialize};

use std::collections::{BTreeMap, BTreeSet};

use indexmap::IndexMap;

use crate::model::{
    Constant, Direction, FrameId, FrameLayout, Id, Kind, Selector, SelectorId, SelectorPlace, Table, Way,
};

/// How frames are recognised, in this order: direction, constants of the identifier, length, constants of the payload.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Recognition {
    /// How an identifier shows that a frame goes to a module.
    pub to_module: Direction,
    /// How an identifier shows that a frame goes to the controller.
    pub to_controller: Direction,
    /// Ways to a module and to the controller that one identifier can show. What their messages show
    /// tells them apart.
    pub alike: Vec<(Way, Way)>,
    /// Frames that go to a module.
    pub requests: Course,
    /// Frames that go to the controller.
    pub replies: Course,
    /// Frames of the ways that look alike, in both directions.
    pub either: Course,
    /// Whether the plan is whole. One whose constants combine in too many ways ends early.
    pub is_whole: bool,
}

/// The frames of one direction.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Course {
    /// All these frames.
    pub all: Scope,
    /// Chooses those that have the constants of an identifier.
    pub choice: Option<Choice<Group>>,
}

/// Frames with the same constants in the identifier.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Group {
    /// All these frames.
    pub all: Scope,
    /// The frames of each length, the shortest first.
    pub lengths: Vec<(u8, Scope)>,
    /// Chooses those that have the constants of a payload, of any length.
    pub choice: Option<Choice<Vec<FrameId>>>,
}

impl Group {
    /// Returns the frames with a number of data bytes.
    pub fn of_length(&self, length: usize) -> Option<&Scope> {
        self.lengths.iter().find(|(known, _)| usize::from(*known) == length).map(|(_, scope)| scope)
    }
}

/// What a group of frames has in all.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Scope {
    /// Their kinds.
    pub kinds: Vec<Kind>,
    /// The selectors that have a constant in some frame.
    pub choosing: Vec<SelectorId>,
    /// The payload selectors that some frame has.
    pub selectors: Vec<SelectorId>,
}

/// A choice by one selector after another.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Choice<T> {
    /// There is one outcome.
    End(T),
    /// A selector's value decides.
    By {
        /// The selector.
        selector: SelectorId,
        /// Where it stands.
        place: SelectorPlace,
        /// How the choice goes on after each value, in the order of the frames.
        cases: IndexMap<u64, Self>,
        /// How the choice goes on after any other value; `None` if no frame has one.
        otherwise: Option<Box<Self>>,
    },
}

impl<T> Choice<T> {
    /// Returns the outcome for a frame whose selectors `read` reads.
    pub fn find(&self, read: impl Fn(SelectorPlace) -> u64) -> Option<&T> {
        let mut choice = self;
        loop {
            match choice {
                Self::End(outcome) => return Some(outcome),
                Self::By { place, cases, otherwise, .. } => {
                    choice = case(cases, read(*place)).or(otherwise.as_deref())?;
                }
            }
        }
    }

    /// Adds every outcome, and the values of selectors that lead to it.
    pub(crate) fn paths<'a>(&'a self, shown: &BTreeMap<SelectorId, u64>, found: &mut Vec<Path<'a, T>>) {
        match self {
            Self::End(outcome) => found.push((shown.clone(), outcome)),
            Self::By { selector, cases, otherwise, .. } => {
                for (value, next) in cases {
                    let mut shown = shown.clone();
                    shown.insert(*selector, *value);
                    next.paths(&shown, found);
                }
                if let Some(next) = otherwise {
                    next.paths(shown, found);
                }
            }
        }
    }

    /// Returns every outcome.
    pub fn ends(&self) -> Vec<&T> {
        match self {
            Self::End(outcome) => vec![outcome],
            Self::By { cases, otherwise, .. } => {
                let after = cases.values().chain(otherwise.as_deref());
                after.flat_map(Self::ends).collect()
            }
        }
    }

    /// Finds the first outcome that passes a test. It looks at frames that can show the constants.
    pub fn find_among<'a, R>(&'a self, constants: &[Constant], test: &mut impl FnMut(&'a T) -> Option<R>) -> Option<R> {
        match self {
            Self::End(outcome) => test(outcome),
            Self::By { selector, cases, otherwise, .. } => {
                if let Some(constant) = constants.iter().find(|constant| constant.selector == *selector) {
                    let mut after = constant.values().filter_map(|value| cases.get(&value).or(otherwise.as_deref()));
                    return after.find_map(|next| next.find_among(constants, test));
                }
                let mut after = cases.values().chain(otherwise.as_deref());
                after.find_map(|next| next.find_among(constants, test))
            }
        }
    }
}

/// The values of selectors that lead to an outcome, and the outcome.
pub(crate) type Path<'a, T> = (BTreeMap<SelectorId, u64>, &'a T);

/// Cases up to this number are compared one after another, which takes less time than a hash.
const FEW_CASES: usize = 24;

/// Returns how a choice goes on after a value.
fn case<T>(cases: &IndexMap<u64, T>, value: u64) -> Option<&T> {
    if cases.len() > FEW_CASES {
        return cases.get(&value);
    }
    cases.iter().find(|(known, _)| **known == value).map(|(_, case)| case)
}

impl Recognition {
    /// Plans how to recognise frames.
    pub(crate) fn new(
        Directions { to_module, to_controller, alike }: Directions,
        frames: &Table<FrameId, FrameLayout>,
        selectors: &Table<SelectorId, Selector>,
    ) -> Self {
        // A frame has a few ends of its own, and shares some with other frames.
        let mut planner = Planner { frames, selectors, ends_left: 64 * frames.len() + 1024 };
        let (requests, replies) = frames.ids().partition(|frame| frames[*frame].is_to_module());
        let is_alike = |frame: &FrameLayout| alike.iter().any(|(one, other)| one.has(frame) || other.has(frame));
        let either = frames.entries().filter(|(_, frame)| is_alike(frame)).map(|(id, _)| id).collect();
        let [requests, replies, either] = [requests, replies, either].map(|frames| planner.course(frames));
        Self { to_module, to_controller, alike, requests, replies, either, is_whole: planner.ends_left > 0 }
    }

    /// Returns the frames of one direction.
    pub fn course(&self, is_to_module: bool) -> &Course {
        if is_to_module { &self.requests } else { &self.replies }
    }
}

/// How identifiers show their direction, and the ways that they leave open.
pub(crate) struct Directions {
    pub to_module: Direction,
    pub to_controller: Direction,
    pub alike: Vec<(Way, Way)>,
}

/// Largest number of selectors that are read one after another. A frame has fewer bits.
const DEEPEST: usize = 96;

/// Makes the plan of both directions.
struct Planner<'a> {
    frames: &'a Table<FrameId, FrameLayout>,
    selectors: &'a Table<SelectorId, Selector>,
    /// How many more outcomes the plan may have.
    ends_left: usize,
}

impl Planner<'_> {
    fn course(&mut self, frames: Vec<FrameId>) -> Course {
        let all = self.scope(&frames);
        let by = self.ordered(&all.choosing, |place| matches!(place, SelectorPlace::Identifier(_)));
        Course { all, choice: self.choice(frames, &by, &mut Self::group) }
    }

    fn group(&mut self, frames: Vec<FrameId>) -> Group {
        let all = self.scope(&frames);
        let lengths: BTreeSet<u8> = frames.iter().flat_map(|frame| &self.frames[*frame].lengths).copied().collect();
        let of_length = |length: u8| {
            let has = |frame: &FrameId| self.frames[*frame].lengths.contains(&length);
            let frames: Vec<_> = frames.iter().copied().filter(has).collect();
            (length, self.scope(&frames))
        };
        let lengths = lengths.into_iter().map(of_length).collect();
        let by = self.ordered(&all.choosing, |place| matches!(place, SelectorPlace::Payload(_)));
        Group { all, lengths, choice: self.choice(frames, &by, &mut |_, frames| frames) }
    }

    fn scope(&self, frames: &[FrameId]) -> Scope {
        let frames = || frames.iter().map(|frame| &self.frames[*frame]);
        let kinds: BTreeSet<_> = frames().map(|frame| frame.kind).collect();
        let choosing: BTreeSet<_> = frames().flat_map(|frame| &frame.constants).map(|known| known.selector).collect();
        let selectors: BTreeSet<_> = frames().flat_map(|frame| &frame.selectors).copied().collect();
        Scope {
            kinds: kinds.into_iter().collect(),
            choosing: choosing.into_iter().collect(),
            selectors: selectors.into_iter().collect(),
        }
    }

    /// Returns the selectors in the order in which they are read: those of the identifier, then
    /// those of the header.
    fn ordered(&self, selectors: &[SelectorId], is_asked: impl Fn(SelectorPlace) -> bool) -> Vec<SelectorId> {
        let place = |selector: &SelectorId| self.selectors[*selector].place;
        let mut ordered: Vec<_> = selectors.iter().copied().filter(|selector| is_asked(place(selector))).collect();
        ordered.sort_by_key(|selector| match place(selector) {
            SelectorPlace::Identifier(field) => field.place(),
            SelectorPlace::Payload(_) => selector.place(),
        });
        ordered
    }

    /// Chooses among frames by one selector after another. If the plan becomes too large, the
    /// choice is empty.
    fn choice<T>(
        &mut self,
        frames: Vec<FrameId>,
        by: &[SelectorId],
        end: &mut impl FnMut(&mut Self, Vec<FrameId>) -> T,
    ) -> Option<Choice<T>> {
        if by.len() > DEEPEST {
            self.ends_left = 0;
        }
        if frames.is_empty() || self.ends_left == 0 {
            return None;
        }
        let all = self.frames;
        let constant = |frame: &FrameId, selector: SelectorId| {
            all[*frame].constants.iter().find(|constant| constant.selector == selector)
        };
        let asked = by.iter().position(|selector| frames.iter().any(|frame| constant(frame, *selector).is_some()));
        let Some(asked) = asked else {
            self.ends_left -= 1;
            return Some(Choice::End(end(self, frames)));
        };
        let (selector, by) = (by[asked], &by[asked + 1..]);
        let mut cases: IndexMap<u64, Vec<FrameId>> = IndexMap::new();
        for frame in &frames {
            for value in constant(frame, selector).into_iter().flat_map(Constant::values) {
                cases.entry(value).or_default();
            }
        }
        let mut others = Vec::new();
        for frame in frames {
            if let Some(known) = constant(&frame, selector) {
                known.values().for_each(|value| cases.entry(value).or_default().push(frame));
            } else {
                cases.values_mut().for_each(|frames| frames.push(frame));
                others.push(frame);
            }
        }
        let cases = cases.into_iter();
        let cases = cases.filter_map(|(value, frames)| Some((value, self.choice(frames, by, end)?))).collect();
        let otherwise = self.choice(others, by, end).map(Box::new);
        Some(Choice::By { selector, place: self.selectors[selector].place, cases, otherwise })
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{FrameId, Protocol, SelectorPlace};
    use crate::read::source::Source;

    /// Two messages of one command, told apart by their first byte, and a short one of another command.
    const SPEC: &str = r#"
canspec: 1
protocol: meter
title: Meters
document: {title: Meters, version: "1"}
length: 8
identifier: {command: {bits: 10..5}, node: {bits: 4..0}}
types:
  meter: {range: 1..9}
addressing:
  single: {request: {node: meter}}
access:
  set: {request: {}, answers: {single: nobody}}
messages:
  one: {section: "1", match: {command: 1}, access: [set], fields: {kind: {bytes: 0, const: 1}, value: {bytes: 1}}}
  two: {section: "1", match: {command: 1}, access: [set], fields: {kind: {bytes: 0, const: 2}, value: {bytes: 1}}}
  short: {section: "1", match: {command: 2}, length: 2, access: [set], fields: {value: {bytes: 1}}}
"#;

    fn meters() -> Protocol {
        crate::compile(Source::new("meter.yaml", SPEC.into()).expect("plain text")).protocol.expect("no errors")
    }

    /// Returns the names of the frames that the plan finds for a command and a first byte.
    fn found(protocol: &Protocol, command: u64, first: u64) -> Vec<&str> {
        let read = |place: SelectorPlace| match place {
            SelectorPlace::Identifier(_) => command,
            SelectorPlace::Payload(_) => first,
        };
        let group = protocol.recognition.requests.choice.as_ref().and_then(|choice| choice.find(read));
        let frames = group.and_then(|group| group.choice.as_ref()?.find(read));
        let name = |frame: &FrameId| protocol[protocol[*frame].message].name.as_str();
        frames.map_or(Vec::new(), |frames| frames.iter().map(name).collect())
    }

    #[test]
    fn a_frame_is_found_by_its_constants_and_by_no_others() {
        let meters = meters();
        assert_eq!(found(&meters, 1, 1), ["one"]);
        assert_eq!(found(&meters, 1, 2), ["two"]);
        assert_eq!(found(&meters, 2, 7), ["short"]);
        assert_eq!(found(&meters, 1, 3), [""; 0]);
        assert_eq!(found(&meters, 3, 1), [""; 0]);
    }

    #[test]
    fn a_group_knows_the_lengths_of_its_frames() {
        let meters = meters();
        let group = |command| {
            let choice = meters.recognition.requests.choice.as_ref().expect("there are requests");
            choice.find(|_| command).expect("there is such a command")
        };
        assert!(group(1).of_length(8).is_some() && group(1).of_length(2).is_none());
        assert!(group(2).of_length(2).is_some() && group(2).of_length(8).is_none());
    }
}
