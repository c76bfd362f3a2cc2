#![doc = include_str!("../../../docs/rules/spelling.md")]

mod words;

use std::ops::RangeInclusive;

use canspec_runtime::Quantity;
use indexmap::IndexMap;

use super::Written;
use super::table::{Name, Table};
use crate::report::diagnostic::Diagnostic;
use crate::report::rule::rules;
use crate::report::tree::{Node, Path};
use words::{Vocabulary, words};

rules! {
    SPELLING "spelling" Lint WARNING;
}

/// The key with the quantities.
const QUANTITIES: &str = "quantities";

/// Longest name that is tested, in bytes.
const LONGEST: usize = 48;

/// Shortest name that is tested, in bytes.
const SHORTEST: usize = 4;

/// Shortest word in which a letter may be missing, wrong or superfluous. Shorter words are too
/// similar.
const LONG_WORD: usize = 5;

/// Words that two swapped letters turn into one another, and both are right.
const TWINS: [[&str; 2]; 4] = [["altitude", "latitude"], ["angel", "angle"], ["form", "from"], ["trail", "trial"]];

/// Words and signs between the ends of a range.
const TO: [&str; 6] = ["to", "..", "...", "…", "-", "–"];

/// Largest number of strange names that are tested, so that large files take no longer.
const MOST: usize = 500;

pub fn lint(Written { tree, tables, .. }: &Written) -> Vec<Diagnostic> {
    let vocabulary = Vocabulary::new(tree, tables);
    let protocol = tree.text_at("protocol").map(|text| Name {
        text,
        at: Path::default().key("protocol").at_value(),
        title: tree.text_at("title"),
    });
    let definitions = || tables.iter().filter(|table| table.is_definition());
    let names = protocol.into_iter().chain(definitions().flat_map(Table::names));
    let strange = names.filter(|name| is_strange(&vocabulary, name.text)).take(MOST);
    let mistyped = strange.filter_map(|name| Some(mistyped(&name, &meant(&vocabulary, &name)?)));
    let short = definitions().flat_map(Table::names).filter(|name| name.text.len() <= LONGEST);
    let misnumbered = short.filter_map(|name| misnumbered(&name));
    mistyped.chain(misnumbered).chain(nearly_standard(tree)).collect()
}

/// Finds quantities whose names are one slip away from a standard one, so that no program would find them.
fn nearly_standard(tree: &Node) -> Vec<Diagnostic> {
    let known: Vec<_> = Quantity::STANDARD.iter().map(|(quantity, _)| quantity.name()).collect();
    let own = tree.child_at(QUANTITIES).and_then(Node::entries).into_iter().flat_map(IndexMap::keys);
    let strange = own.filter(|name| !known.contains(&name.as_str()));
    let slips = strange.filter_map(|name| {
        let meant = known.iter().find(|standard| strsim::osa_distance(name, standard) == 1)?;
        let at = Path::default().key(QUANTITIES).key(name).at_key();
        let warning = Diagnostic::warning(&SPELLING, at, format!("`{name}`: is `{meant}` meant?"));
        let help = format!("write `{meant}`, or a name that is less like it");
        Some(warning.label("no standard quantity has this name").help(help))
    });
    slips.collect()
}

fn mistyped(name: &Name, meant: &str) -> Diagnostic {
    let text = format!("`{}`: is `{meant}` meant?", name.text);
    let help = format!("write `{meant}`; if `{}` is right, use the word in a `title` or `note`", name.text);
    let label = "the spec has no such word elsewhere";
    Diagnostic::warning(&SPELLING, name.at.clone(), text).label(label).help(help)
}

/// Tests whether a name has a word that stands nowhere else in the spec.
fn is_strange(vocabulary: &Vocabulary, name: &str) -> bool {
    (SHORTEST..=LONGEST).contains(&name.len()) && strange_words(vocabulary, name).next().is_some()
}

fn strange_words<'a>(vocabulary: &'a Vocabulary, name: &'a str) -> impl Iterator<Item = &'a str> {
    words(name).filter(move |word| !vocabulary.has_elsewhere(word, name))
}

/// Returns a name of known words that differs by one typing slip.
fn meant(vocabulary: &Vocabulary, name: &Name) -> Option<String> {
    if let Some(known) = swapped(name.text).find(|other| is_meant(vocabulary, name.text, other)) {
        return Some(known);
    }
    let mut strange = strange_words(vocabulary, name.text);
    let word = strange.next().filter(|word| word.len() >= LONG_WORD && strange.next().is_none())?;
    let other = vocabulary.nearest(word, name.title.unwrap_or_default())?;
    Some(name.text.replacen(word, &other, 1))
}

/// Returns the names with two neighbouring letters swapped.
fn swapped(name: &str) -> impl Iterator<Item = String> {
    let is_part = |letter: u8| letter.is_ascii_alphabetic() || letter == b'_';
    let pairs = name.as_bytes().windows(2).enumerate();
    let places = pairs.filter(move |(_, pair)| pair[0] != pair[1] && pair.iter().all(|letter| is_part(*letter)));
    places.map(|(at, pair)| {
        let neighbours = [char::from(pair[1]), char::from(pair[0])];
        format!("{}{}{}", &name[..at], String::from_iter(neighbours), &name[at + 2..])
    })
}

/// Tests whether a swap turned known words into a strange one. A single word must be long or in
/// other names, because short words are too similar. Words of two letters are all similar.
fn is_meant(vocabulary: &Vocabulary, name: &str, other: &str) -> bool {
    let before: Vec<_> = words(name).collect();
    let after: Vec<_> = words(other).collect();
    let mut lost = before.iter().filter(|word| !after.contains(word));
    let mut found = after.iter().filter(|word| !before.contains(word));
    let is_regrouped = found.clone().count() > 1;
    let is_certain = |word: &str| is_regrouped || word.len() >= LONG_WORD || vocabulary.has_in_names(word);
    let are_twins = |one: &str, other: &str| TWINS.contains(&[one, other]) || TWINS.contains(&[other, one]);
    let is_twin = |word: &&str| before.iter().any(|other| are_twins(other, word));
    lost.any(|word| !vocabulary.has_elsewhere(word, name))
        && !found.clone().any(is_twin)
        && found.all(|word| word.len() > 2 && vocabulary.has_often(word, name) && is_certain(word))
}

/// Finds a number in a name that is not in its title, if the title has the same words and other
/// numbers.
fn misnumbered(name: &Name) -> Option<Diagnostic> {
    let title = name.title?;
    let title_numbers: Vec<_> = numbers(title).collect();
    let ranges = ranges(title, &title_numbers);
    let is_in_range =
        |number: &str| ranges.iter().any(|range| number.parse().is_ok_and(|number| range.contains(&number)));
    let others: Vec<_> = title_numbers.iter().copied().filter(|number| !is_in_range(number)).collect();
    let number = numbers(name.text).find(|number| !others.contains(number) && !is_in_range(number))?;
    let mut own_words = words(name.text).peekable();
    own_words.peek().filter(|_| !others.is_empty())?;
    if !own_words.all(|word| words(title).any(|other| word.eq_ignore_ascii_case(other))) {
        return None;
    }
    let text = format!("`{}` has the number {number}, but its title has {}", name.text, others.join(", "));
    let help = format!("its title is `{title}`: correct the one that is wrong");
    Some(Diagnostic::warning(&SPELLING, name.at.clone(), text).help(help))
}

/// Returns the numbers in a text, without leading zeros.
fn numbers(text: &str) -> impl Iterator<Item = &str> {
    let digits = text.split(|letter: char| !letter.is_ascii_digit()).filter(|digits| !digits.is_empty());
    digits.map(|digits| digits.trim_start_matches('0')).map(|digits| if digits.is_empty() { "0" } else { digits })
}

/// Returns the ranges in a text, such as `5 to 11`. Their ends do not number the thing itself.
fn ranges(text: &str, numbers: &[&str]) -> Vec<RangeInclusive<u64>> {
    let is_digit = |letter: char| letter.is_ascii_digit();
    let between = text.split(is_digit).filter(|between| !between.is_empty());
    let between = between.skip(usize::from(!text.starts_with(is_digit)));
    let pairs = numbers.windows(2).zip(between).filter(|(_, between)| TO.contains(&between.trim()));
    pairs.filter_map(|(pair, _)| Some(pair[0].parse().ok()?..=pair[1].parse().ok()?)).collect()
}
