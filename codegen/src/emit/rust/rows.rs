//! Which combinations of constants tell frames apart.

use std::collections::{BTreeMap, BTreeSet};

use crate::model::SelectorId;

/// Selectors and the values they must have.
pub type Constants = BTreeMap<SelectorId, u64>;

/// Returns every set of constants once, and every union of such sets that a frame can show at the same time; a larger
/// set comes before the sets it contains, so that the first one that fits a frame is all that the frame shows.
pub fn rows(sets: impl IntoIterator<Item = Constants>) -> Vec<Constants> {
    let mut known = BTreeSet::new();
    let mut rows: Vec<_> = sets.into_iter().filter(|set| known.insert(set.clone())).collect();
    let mut index = 0;
    while let Some(set) = rows.get(index) {
        let unions: Vec<_> = rows[..index].iter().filter_map(|other| union(set, other)).collect();
        rows.extend(unions.into_iter().filter(|union| known.insert(union.clone())));
        index += 1;
    }
    rows.sort_by_key(|set| std::cmp::Reverse(set.len()));
    rows
}

/// Tests whether whatever shows the one set shows the other one too.
pub fn implies(set: &Constants, other: &Constants) -> bool {
    other.iter().all(|(selector, value)| set.get(selector) == Some(value))
}

/// Tests whether a frame can show both sets.
pub fn agree(set: &Constants, other: &Constants) -> bool {
    other.iter().all(|(selector, value)| set.get(selector).is_none_or(|known| known == value))
}

fn union(set: &Constants, other: &Constants) -> Option<Constants> {
    agree(set, other).then(|| set.iter().chain(other).map(|(selector, value)| (*selector, *value)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Id;

    fn set<const N: usize>(constants: [(usize, u64); N]) -> Constants {
        constants.into_iter().map(|(selector, value)| (SelectorId::new(selector), value)).collect()
    }

    #[test]
    fn a_larger_set_comes_before_the_sets_it_contains() {
        let sets = [set([]), set([(0, 1)]), set([(0, 1), (1, 5)]), set([(0, 2)]), set([(0, 1)])];
        let expected = [set([(0, 1), (1, 5)]), set([(0, 1)]), set([(0, 2)]), set([])];
        assert_eq!(rows(sets), expected);
    }

    #[test]
    fn sets_that_one_frame_can_show_meet_in_their_union() {
        let sets = [set([(0, 1)]), set([(1, 5)]), set([(2, 7)]), set([(0, 2)])];
        let unions = rows(sets);
        assert_eq!(unions.len(), 4 + 5 + 2);
        assert!(unions.contains(&set([(0, 2), (1, 5), (2, 7)])));
        assert!(!unions.iter().any(|union| union.len() > 3));
    }

    #[test]
    fn a_set_implies_what_it_contains_and_agrees_with_other_selectors() {
        let (large, small, other) = (set([(0, 1), (1, 5)]), set([(1, 5)]), set([(1, 6), (2, 0)]));
        assert!(implies(&large, &small) && !implies(&small, &large));
        assert!(agree(&large, &small) && agree(&small, &large));
        assert!(!agree(&large, &other) && agree(&set([(0, 1)]), &other));
    }
}
