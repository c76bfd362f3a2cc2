#![doc = include_str!("../../../docs/rules/order.md")]

use indexmap::IndexMap;

use super::Written;
use super::table::Table;
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::rule::rules;
use crate::report::tree::{Node, Path};
use crate::words::number::Rational;

rules! {
    ORDER "order" Lint WARNING;
}

/// Fewest siblings that show an order.
const FEWEST: usize = 5;

/// First and last number of a place. Both are the same for a single number.
type Range = (i128, i128);

/// The number of an entry.
struct Step<'a> {
    at: At,
    text: &'a str,
    range: Range,
}

/// Numbers that ascend or descend with the entries of a map.
struct Sequence<'a> {
    steps: Vec<Step<'a>>,
    may_repeat: bool,
}

impl<'a> Step<'a> {
    /// Reads a number, or a place such as `31..16`.
    fn read(text: &'a str, at: At) -> Option<Self> {
        let (start, end) = text.split_once("..").unwrap_or((text, text));
        let number = |text: &str| Rational::parse(text)?.to_integer();
        let (start, end) = (number(start)?, number(end)?);
        Some(Self { at, text, range: (start.min(end), start.max(end)) })
    }
}

pub fn lint(written: &Written) -> Vec<Diagnostic> {
    let sequences = written.tables.iter().filter(|table| table.is_definition()).flat_map(sequences);
    sequences.filter_map(|sequence| misplaced(&sequence)).collect()
}

/// Finds the sequences in a map.
fn sequences<'a>(table: &Table<'a>) -> Vec<Sequence<'a>> {
    let once = |steps| Sequence { steps, may_repeat: false };
    match table.kind {
        "status" => vec![once(places(table, "bit"))],
        "fields" | "header" | "identifier" => vec![once(places(table, "bits")), once(places(table, "bytes"))],
        "values" => vec![once(keys(table))],
        "messages" => selectors(table).chain(numbered_names(table)).collect(),
        // Numbers of models are ratings.
        "models" => Vec::new(),
        _ => numbered_names(table).collect(),
    }
}

fn places<'a>(table: &Table<'a>, key: &str) -> Vec<Step<'a>> {
    let texts = table.entries.iter().filter_map(|(name, entry)| Some((name, entry.value.text_at(key)?)));
    texts.filter_map(|(name, text)| Step::read(text, table.path.key(name).key(key).at_value())).collect()
}

fn keys<'a>(table: &Table<'a>) -> Vec<Step<'a>> {
    table.entries.keys().filter_map(|number| Step::read(number, table.path.key(number).at_key())).collect()
}

/// Groups names that differ only in the number at their end.
fn numbered_names<'a>(table: &Table<'a>) -> impl Iterator<Item = Sequence<'a>> {
    let mut siblings: IndexMap<_, Vec<_>> = IndexMap::new();
    for name in table.entries.keys() {
        let shared = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
        let step = Step::read(&name[shared.len()..], table.path.key(name).at_key());
        siblings.entry(shared).or_default().extend(step.map(|step| Step { text: name, ..step }));
    }
    siblings.into_values().map(|steps| Sequence { steps, may_repeat: false })
}

/// Groups messages that differ only in the last of their selectors.
fn selectors<'a>(table: &Table<'a>) -> impl Iterator<Item = Sequence<'a>> {
    let mut siblings: IndexMap<_, Vec<_>> = IndexMap::new();
    for (name, entry) in table.entries {
        if let Some((shared, step)) = selector(&table.path.key(name), &entry.value) {
            siblings.entry(shared).or_default().push(step);
        }
    }
    siblings.into_values().map(|steps| Sequence { steps, may_repeat: true })
}

/// What a message shares with its siblings: the key of the last selector, and the other selectors.
type Shared<'a> = (&'a str, Vec<(&'a str, Option<&'a str>)>);

fn selector<'a>(path: &Path, message: &'a Node) -> Option<(Shared<'a>, Step<'a>)> {
    let pattern = message.child_at("match")?.entries()?;
    let (last, value) = pattern.last()?;
    let others = pattern.iter().take(pattern.len() - 1).map(|(key, entry)| (key.as_str(), entry.value.text()));
    let step = Step::read(value.value.text()?, path.key("match").key(last).at_value())?;
    Some(((last, others.collect()), step))
}

/// Finds the one entry that is out of order.
fn misplaced(sequence: &Sequence) -> Option<Diagnostic> {
    let Sequence { steps, may_repeat } = sequence;
    let upwards: Vec<_> = steps.iter().map(|step| step.range).collect();
    let downwards: Vec<_> = upwards.iter().map(|(first, last)| (-last, -first)).collect();
    if steps.len() < FEWEST {
        return None;
    }
    let index = odd_one(&upwards, *may_repeat).or_else(|| odd_one(&downwards, *may_repeat))?;
    let (before, after) = (steps.get(index.checked_sub(1)?)?.text, steps.get(index + 1)?.text);
    let Step { text, at, .. } = &steps[index];
    let text = format!("`{text}` is out of order: it stands between `{before}` and `{after}`");
    let others = steps.len() - 1;
    let help = format!("the {others} others are in order: correct the number, or move the entry to its place");
    Some(Diagnostic::warning(&ORDER, at.clone(), text).help(help))
}

fn is_before(left: Range, right: Range, may_repeat: bool) -> bool {
    left.1 < right.0 || (may_repeat && left == right)
}

fn is_ordered(ranges: &[Range], may_repeat: bool) -> bool {
    ranges.windows(2).all(|pair| is_before(pair[0], pair[1], may_repeat))
}

/// Finds the only number without which the others ascend.
fn odd_one(ranges: &[Range], may_repeat: bool) -> Option<usize> {
    let at = ranges.windows(2).position(|pair| !is_before(pair[0], pair[1], may_repeat))?;
    let mends = |index: usize| is_ordered(&[&ranges[..index], &ranges[index + 1..]].concat(), may_repeat);
    match (mends(at), mends(at + 1)) {
        // Two swapped numbers are not one mistake.
        (true, true) if ranges[at].0 > ranges[at + 1].1 => None,
        (true, true) => one_of_two(ranges, at),
        (true, false) => Some(at),
        (false, true) => Some(at + 1),
        (false, false) => None,
    }
    .filter(|index| has_room(ranges, *index))
}

/// Returns which of two neighbours with the same number is wrong. The right one has no gap on its
/// other side.
fn one_of_two(ranges: &[Range], at: usize) -> Option<usize> {
    let gap = |left: usize| Some(ranges.get(left + 1)?.0 - ranges.get(left)?.1);
    match (gap(at.checked_sub(1)?)?, gap(at + 1)?) {
        (1, 2..) => Some(at + 1),
        (2.., 1) => Some(at),
        _ => None,
    }
}

/// Tests whether there is a number between the neighbours of an entry. The first and the last entry
/// could belong anywhere.
fn has_room(ranges: &[Range], index: usize) -> bool {
    let before = index.checked_sub(1).and_then(|index| ranges.get(index));
    before.zip(ranges.get(index + 1)).is_some_and(|(before, after)| after.0 - before.1 > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn odd(numbers: &[i128], may_repeat: bool) -> Option<usize> {
        odd_one(&numbers.iter().map(|number| (*number, *number)).collect::<Vec<_>>(), may_repeat)
    }

    #[test]
    fn the_one_is_odd_without_which_the_others_ascend() {
        assert_eq!(odd(&[1, 2, 30, 4, 5], false), Some(2));
        assert_eq!(odd(&[10, 20, 3, 40, 50], false), Some(2));
        assert_eq!(odd(&[1, 9, 3, 8, 5], false), None);
        assert_eq!(odd(&[1, 3, 2, 4, 5], false), None);
    }

    #[test]
    fn nothing_says_where_the_first_and_the_last_belong() {
        assert_eq!(odd(&[9, 1, 2, 3, 4], false), None);
        assert_eq!(odd(&[1, 2, 3, 4, 0], false), None);
    }

    #[test]
    fn of_two_with_one_number_the_one_beside_a_gap_is_odd() {
        assert_eq!(odd(&[0, 1, 1, 3, 4], false), Some(2));
        assert_eq!(odd(&[0, 1, 3, 3, 4], false), Some(2));
        assert_eq!(odd(&[0, 2, 4, 4, 6], false), None);
        assert_eq!(odd(&[0, 1, 1, 3, 4], true), None);
    }

    #[test]
    fn places_may_not_overlap() {
        assert_eq!(odd_one(&[(0, 1), (2, 3), (3, 3), (5, 5), (6, 7)], false), Some(2));
    }
}
