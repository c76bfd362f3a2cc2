//! The plan of recognition as rows of a `match`: what a frame must show, and its meaning then.

use std::cmp::Reverse;
use std::collections::BTreeMap;

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
    let mut measured: Vec<Row<Vec<u8>>> = Vec::new();
    for row in all_lengths(protocol, course).into_iter().rev() {
        let less = measured.iter().rfind(|less| implies(&row.constants, &less.constants));
        if less.is_none_or(|less| less.outcome != row.outcome) {
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
pub fn joined<T: PartialEq>(rows: Vec<Row<T>>) -> Vec<Arm<T>> {
    let mut joined: Vec<Arm<T>> = Vec::new();
    for row in rows {
        let is_apart = |other: &Arm<T>| !other.sets.iter().any(|set| agree(set, &row.constants));
        let same = joined.iter().rposition(|other| other.outcome == row.outcome);
        match same.filter(|same| joined[same + 1..].iter().all(is_apart)) {
            Some(same) => joined[same].sets.push(row.constants),
            None => joined.push(Arm { sets: vec![row.constants], outcome: row.outcome }),
        }
    }
    joined
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

/// Tests whether every frame with the first set of constants also has the other.
fn implies(set: &Constants, other: &Constants) -> bool {
    other.iter().all(|(selector, value)| set.get(selector) == Some(value))
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

    #[test]
    fn a_set_implies_what_it_contains_and_agrees_with_other_selectors() {
        let (large, small, other) = (set([(0, 1), (1, 5)]), set([(1, 5)]), set([(1, 6), (2, 0)]));
        assert!(implies(&large, &small) && !implies(&small, &large));
        assert!(agree(&large, &small) && agree(&small, &large));
        assert!(!agree(&large, &other) && agree(&set([(0, 1)]), &other));
    }
}
