//! Counts the words of a spec.

use std::collections::HashMap;

use super::super::table::Table;
use crate::report::tree::{Content, Node};

/// Keys of the language with words for people.
const PROSE: [&str; 10] =
    ["title", "note", "because", "prints", "uses", "set_when", "clear_when", "effect", "led", "steps"];

/// How often each word of a spec occurs, in lower case.
pub struct Vocabulary {
    in_names: HashMap<String, usize>,
    in_prose: HashMap<String, usize>,
}

impl Vocabulary {
    /// Counts the words of all names and texts, without keys of the language. Reasons of allowances
    /// do not count, since a reason with the word would end the warning that it allows.
    pub fn new(tree: &Node, tables: &[Table]) -> Self {
        let mut vocabulary = Self { in_names: HashMap::new(), in_prose: HashMap::new() };
        let Content::Map(entries) = &tree.content else { return vocabulary };
        for (key, entry) in entries.iter().filter(|(key, _)| *key != "allow") {
            vocabulary.add_texts(&entry.value, PROSE.contains(&key.as_str()));
        }
        for name in tables.iter().flat_map(|table| table.entries.keys()) {
            count(&mut vocabulary.in_names, name);
        }
        vocabulary
    }

    /// Tests whether a word also stands outside a name.
    pub fn has_elsewhere(&self, word: &str, name: &str) -> bool {
        self.names_beside(word, name) > 0 || times(&self.in_prose, word) > 0
    }

    /// Tests whether a word stands in prose, or in two other names. A single other name could
    /// itself be mistyped.
    pub fn has_often(&self, word: &str, name: &str) -> bool {
        self.names_beside(word, name) > 1 || times(&self.in_prose, word) > 0
    }

    /// Tests whether a word stands in a name.
    pub fn has_in_names(&self, word: &str) -> bool {
        times(&self.in_names, word) > 0
    }

    /// Returns the similar word in the title or in two names. Similar words differ by one letter
    /// more or less. In the title, one other letter is similar, too. In names alone too many words
    /// differ by one letter. Endings do not count, because they can be intended.
    pub fn nearest(&self, word: &str, title: &str) -> Option<String> {
        let word = word.to_ascii_lowercase();
        let title = title.to_ascii_lowercase();
        let is_known = |other: &String| words(&title).any(|word| word == other) || times(&self.in_names, other) > 1;
        let mut resized = without_a_letter(&word).chain(with_a_letter(&word));
        let known = resized.find(|other| !is_inflected(&word, other) && is_known(other));
        let replaced = || words(&title).find(|other| !is_inflected(&word, other) && has_another_letter(&word, other));
        known.or_else(|| replaced().map(str::to_owned))
    }

    fn names_beside(&self, word: &str, name: &str) -> usize {
        let inside = words(name).filter(|own| own.eq_ignore_ascii_case(word)).count();
        times(&self.in_names, word).saturating_sub(inside)
    }

    fn add_texts(&mut self, node: &Node, is_prose: bool) {
        match &node.content {
            Content::Text(text) => count(if is_prose { &mut self.in_prose } else { &mut self.in_names }, text),
            Content::List(items) => items.iter().for_each(|item| self.add_texts(item, is_prose)),
            Content::Map(entries) => {
                for (key, entry) in entries {
                    self.add_texts(&entry.value, PROSE.contains(&key.as_str()));
                }
            }
            Content::Refused => {}
        }
    }
}

fn times(counted: &HashMap<String, usize>, word: &str) -> usize {
    counted.get(&word.to_ascii_lowercase()).copied().unwrap_or(0)
}

/// Splits a text into its words, which have only letters.
pub fn words(text: &str) -> impl Iterator<Item = &str> + Clone {
    text.split(|letter: char| !letter.is_ascii_alphabetic()).filter(|word| !word.is_empty())
}

fn count(counted: &mut HashMap<String, usize>, text: &str) {
    for word in words(text) {
        *counted.entry(word.to_ascii_lowercase()).or_default() += 1;
    }
}

/// Tests whether two words differ only in their last letter, as `module` and `modules` do.
fn is_inflected(word: &str, other: &str) -> bool {
    let shared = word.bytes().zip(other.bytes()).take_while(|(left, right)| left == right).count();
    shared + 1 >= word.len().max(other.len())
}

fn without_a_letter(word: &str) -> impl Iterator<Item = String> {
    (0..word.len()).map(move |at| format!("{}{}", &word[..at], &word[at + 1..]))
}

fn with_a_letter(word: &str) -> impl Iterator<Item = String> {
    (0..=word.len())
        .flat_map(move |at| ('a'..='z').map(move |letter| format!("{}{letter}{}", &word[..at], &word[at..])))
}

fn has_another_letter(word: &str, other: &str) -> bool {
    let different = word.bytes().zip(other.bytes()).filter(|(left, right)| left != right);
    word.len() == other.len() && different.count() == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vocabulary(names: &str) -> Vocabulary {
        let mut vocabulary = Vocabulary { in_names: HashMap::new(), in_prose: HashMap::new() };
        count(&mut vocabulary.in_names, names);
        vocabulary
    }

    #[test]
    fn a_word_is_near_one_that_stands_in_two_names_or_in_the_title() {
        let vocabulary = vocabulary("speed speed internal internal charge");
        for (word, title, nearest) in [
            ("speeed", "", Some("speed")),
            ("sped", "", Some("speed")),
            ("chage", "", None),
            ("chage", "Charge of the cell", Some("charge")),
            ("interval", "", None),
            ("intermal", "Internal voltage", Some("internal")),
            ("speeds", "Speed", None),
        ] {
            assert_eq!(vocabulary.nearest(word, title).as_deref(), nearest, "{word}: {title}");
        }
    }

    #[test]
    fn a_word_of_a_name_alone_is_nowhere_else() {
        let vocabulary = vocabulary("fan_speed fan_count");
        assert!(vocabulary.has_elsewhere("fan", "fan_speed"));
        assert!(!vocabulary.has_often("fan", "fan_speed"));
        assert!(!vocabulary.has_elsewhere("speed", "fan_speed"));
    }
}
