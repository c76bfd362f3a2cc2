//! The plan of recognition as rows of a `match`: what a frame must show, and its meaning then.

use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};
use std::hash::Hash;

use indexmap::IndexMap;

use crate::model::{Choice, Course, FrameId, Protocol, SelectorId};

/// Selectors and the values they must have.
pub type Constants = BTreeMap<SelectorId, u64>;

/// The meaning of frames with some constants.
pub struct Row<T> {
    pub constants: Constants,
    pub outcome: T,
    /// The first frame that has these constants and no others.
    own: Option<FrameId>,
}

/// Returns the kinds of frames by their constants. A row comes before those whose constants it
/// contains. So the first row that fits a frame has all constants that the frame shows.
pub fn rows(protocol: &Protocol, course: &Course) -> Vec<Row<Vec<FrameId>>> {
    let mut found = Vec::new();
    for (shown, group) in paths(course.choice.as_ref(), &Constants::new()) {
        for (shown, frames) in paths(group.choice.as_ref(), &shown) {
            found.push(row(protocol, frames, &shown, frames.clone()));
        }
    }
    in_order(found.into_iter())
}

/// Returns every outcome of a choice, with the values of selectors that lead to it.
fn paths<'a, T>(choice: Option<&'a Choice<T>>, shown: &Constants) -> Vec<(Constants, &'a T)> {
    let mut found = Vec::new();
    if let Some(choice) = choice {
        choice.paths(shown, &mut found);
    }
    found
}

/// Returns the lengths of frames by their constants in the identifier, in the same order. The
/// shortest length comes first.
fn all_lengths(protocol: &Protocol, course: &Course) -> Vec<Row<Vec<u8>>> {
    let groups = paths(course.choice.as_ref(), &Constants::new()).into_iter();
    in_order(groups.map(|(shown, group)| {
        let frames: Vec<_> = group.choice.iter().flat_map(|choice| choice.ends()).flatten().copied().collect();
        let lengths = group.lengths.iter().map(|(length, _)| *length).collect();
        row(protocol, &frames, &shown, lengths)
    }))
}

/// Returns the lengths of frames by their constants in the identifier, unless fewer constants say the same.
pub fn lengths(protocol: &Protocol, course: &Course) -> Vec<Row<Vec<u8>>> {
    let (mut measured, mut known): (Vec<Row<Vec<u8>>>, _) = (Vec::new(), Known::default());
    for row in all_lengths(protocol, course).into_iter().rev() {
        let less = known.last_implied_by(&row.constants);
        if less.is_none_or(|less| measured[less].outcome != row.outcome) {
            known.add(&row.constants, measured.len());
            measured.push(row);
        }
    }
    measured.reverse();
    measured
}

/// The outcome of frames with one of these sets of constants.
#[derive(PartialEq)]
pub struct Arm<T> {
    /// The sets.
    pub sets: Vec<Constants>,
    /// The outcome.
    pub outcome: T,
}

/// Joins rows with the same outcome, unless a row between them can hold for the same frame.
pub fn joined<T: Clone + Eq + Hash>(rows: Vec<Row<T>>) -> Vec<Arm<T>> {
    let mut joined: Vec<(Arm<T>, Known)> = Vec::new();
    let mut last: HashMap<T, usize> = HashMap::new();
    for row in rows {
        let is_apart = |(_, other): &(Arm<T>, Known)| !other.agrees_with(&row.constants);
        let same = last.get(&row.outcome).copied().filter(|same| joined[same + 1..].iter().all(is_apart));
        let place = same.unwrap_or_else(|| {
            last.insert(row.outcome.clone(), joined.len());
            joined.push((Arm { sets: Vec::new(), outcome: row.outcome }, Known::default()));
            joined.len() - 1
        });
        let (arm, known) = &mut joined[place];
        known.add(&row.constants, place);
        arm.sets.push(row.constants);
    }
    joined.into_iter().map(|(arm, _)| arm).collect()
}

/// Sets of constants, each with the place where it was found last. Those with the same selectors are found by their
/// values, however many there are.
#[derive(Default)]
struct Known(IndexMap<Vec<SelectorId>, HashMap<Constants, usize>>);

impl Known {
    fn add(&mut self, set: &Constants, place: usize) {
        self.0.entry(set.keys().copied().collect()).or_default().insert(set.clone(), place);
    }

    /// Returns the last place of a set that a frame has which has another set.
    fn last_implied_by(&self, set: &Constants) -> Option<usize> {
        self.0.iter().filter_map(|(selectors, sets)| sets.get(&part(set, selectors)?)).max().copied()
    }

    /// Tests whether a frame can show a set and one of these.
    fn agrees_with(&self, set: &Constants) -> bool {
        self.0.iter().any(|(selectors, sets)| match part(set, selectors) {
            Some(part) => sets.contains_key(&part),
            None => sets.keys().any(|known| agree(known, set)),
        })
    }
}

/// Returns the part of a set that has some selectors, if it has all of them.
fn part(set: &Constants, selectors: &[SelectorId]) -> Option<Constants> {
    selectors.iter().map(|selector| Some((*selector, *set.get(selector)?))).collect()
}

/// Makes a row from the constants that frames have in the selectors that lead to them. `shown` has the values of these.
fn row<T>(protocol: &Protocol, frames: &[FrameId], shown: &Constants, outcome: T) -> Row<T> {
    let constants = |frame: &FrameId| -> Constants {
        let known = protocol[*frame].constants.iter();
        known.filter_map(|constant| Some((constant.selector, *shown.get(&constant.selector)?))).collect()
    };
    let all: Constants = frames.iter().flat_map(constants).collect();
    let own = frames.iter().filter(|frame| constants(frame) == all).min().copied();
    Row { constants: all, outcome, own }
}

/// Puts the rows with more constants first, each once.
fn in_order<T>(rows: impl Iterator<Item = Row<T>>) -> Vec<Row<T>> {
    let mut once = BTreeMap::new();
    for row in rows {
        once.entry((Reverse(row.constants.len()), row.own.is_none(), row.own, row.constants.clone())).or_insert(row);
    }
    once.into_values().collect()
}

/// Tests whether a frame can show both sets.
fn agree(set: &Constants, other: &Constants) -> bool {
    other.iter().all(|(selector, value)| set.get(selector).is_none_or(|known| known == value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Id;

    fn set<const N: usize>(constants: [(usize, u64); N]) -> Constants {
        constants.into_iter().map(|(selector, value)| (SelectorId::new(selector), value)).collect()
    }

    fn known<const N: usize>(sets: [&Constants; N]) -> Known {
        let mut known = Known::default();
        sets.into_iter().enumerate().for_each(|(place, set)| known.add(set, place));
        known
    }

    fn row(constants: &Constants, outcome: char) -> Row<char> {
        Row { constants: constants.clone(), outcome, own: None }
    }

    #[test]
    fn a_set_implies_what_it_contains_and_agrees_with_other_selectors() {
        let (large, small, first) = (set([(0, 1), (1, 5)]), set([(1, 5)]), set([(0, 1)]));
        let (other, six) = (set([(1, 6), (2, 0)]), set([(1, 6)]));
        let implied = |one, other| known([one]).last_implied_by(other);
        assert_eq!([implied(&small, &large), implied(&large, &small)], [Some(0), None]);
        let agrees = |one, other| known([one]).agrees_with(other);
        assert!(agrees(&large, &small) && agrees(&small, &large));
        assert!(!agrees(&large, &other) && !agrees(&other, &large) && agrees(&first, &other));
        assert!(agrees(&small, &small) && !agrees(&small, &six));
    }

    #[test]
    fn the_last_of_several_implied_sets_counts() {
        let (large, small, first) = (set([(0, 1), (1, 5)]), set([(1, 5)]), set([(0, 1)]));
        assert_eq!(known([&small, &first, &set([(0, 2)])]).last_implied_by(&large), Some(1));
        assert_eq!(known([&first, &small, &set([(1, 6)])]).last_implied_by(&large), Some(1));
        assert_eq!(known([&first, &small, &first]).last_implied_by(&large), Some(2));
    }

    #[test]
    fn rows_with_the_same_outcome_are_joined_unless_a_frame_can_show_one_between_them() {
        let sets = [set([(0, 1)]), set([(0, 2)]), set([(1, 5)]), set([(0, 3)])];
        let arms = |outcomes: &str| {
            let rows = sets.iter().zip(outcomes.chars()).map(|(set, outcome)| row(set, outcome));
            let arms = joined(rows.collect()).into_iter();
            let arms = arms.map(|arm| {
                (arm.outcome, arm.sets.iter().filter_map(|set| sets.iter().position(|known| known == set)).collect())
            });
            arms.collect::<Vec<(char, Vec<usize>)>>()
        };
        assert_eq!(arms("aab"), [('a', vec![0, 1]), ('b', vec![2])]);
        assert_eq!(arms("aba"), [('a', vec![0]), ('b', vec![1]), ('a', vec![2])]);
        assert_eq!(arms("abba"), [('a', vec![0]), ('b', vec![1, 2]), ('a', vec![3])]);
        assert_eq!(arms("abca"), [('a', vec![0]), ('b', vec![1]), ('c', vec![2]), ('a', vec![3])]);
        let apart = [row(&sets[0], 'a'), row(&sets[1], 'b'), row(&sets[3], 'a')];
        assert_eq!(joined(apart.into()).len(), 2);
    }
}
