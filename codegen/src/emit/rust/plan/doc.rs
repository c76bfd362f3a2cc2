//! Documentation comments.

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};

use crate::model::{Doc, Protocol};

/// The longest line of text behind `/// `.
const WIDTH: usize = 100;

/// A documentation comment, line by line.
#[derive(Clone)]
pub struct Comment {
    lines: Vec<String>,
}

impl Comment {
    /// Makes a comment of paragraphs.
    pub fn new(paragraphs: impl IntoIterator<Item = String>) -> Self {
        let mut lines: Vec<String> = Vec::new();
        for paragraph in paragraphs {
            if !lines.is_empty() {
                lines.push(String::new());
            }
            lines.extend(wrapped(&paragraph));
        }
        Self { lines }
    }

    /// Makes a comment of one sentence.
    pub fn line(text: impl Into<String>) -> Self {
        Self::new([text.into()])
    }

    /// Makes the comment of an item of the spec: a sentence, where it stands in the document, its note and its errata.
    pub fn item(protocol: &Protocol, doc: &Doc, sentence: &str, outer: Option<&Doc>) -> Self {
        Self::new(paragraphs(protocol, doc, sentence, outer))
    }
}

impl ToTokens for Comment {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let lines = self.lines.iter().map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
        tokens.extend(quote!(#(#[doc = #lines])*));
    }
}

/// Returns the paragraphs of an item's comment; what the outer item says already is not repeated.
pub fn paragraphs(protocol: &Protocol, doc: &Doc, sentence: &str, outer: Option<&Doc>) -> Vec<String> {
    let section =
        doc.section.as_ref().filter(|section| outer.is_none_or(|outer| outer.section.as_ref() != Some(section)));
    let section = section.map(|section| sentence_of(&reference(section)));
    let first = std::iter::once(sentence.to_owned()).chain(section).collect::<Vec<_>>().join(" ");
    let note = doc.note.iter().map(|note| sentence_of(&plain(note)));
    let errata = doc.errata.iter().filter_map(|name| erratum(protocol, name));
    std::iter::once(first).chain(note).chain(errata).collect()
}

/// Returns a section as `Section 2.4`, or as the table that it names.
fn reference(section: &str) -> String {
    if section.starts_with(|first: char| first.is_ascii_digit()) {
        format!("Section {section}")
    } else {
        plain(section)
    }
}

/// Writes an erratum in one line, unless it is about the scan of the document alone.
fn erratum(protocol: &Protocol, name: &str) -> Option<String> {
    let erratum = protocol.errata.iter().find(|erratum| erratum.name == name)?;
    if matches!(erratum.kind.as_str(), "ocr" | "note") {
        return None;
    }
    let [prints, uses] = [&erratum.prints, &erratum.uses].map(|text| plain(text));
    Some(sentence_of(&format!("Erratum {name}: printed is \"{prints}\", used is \"{uses}\"")))
}

/// Returns what an item is called, for people.
pub fn title(doc: &Doc, name: &str) -> String {
    doc.title.as_ref().map_or_else(|| name.replace('_', " "), |title| plain(title))
}

/// Begins with a capital and ends with a full stop.
pub fn sentence_of(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string()).unwrap_or_default();
    let stop = if text.ends_with(['.', '!', '?', ':']) { "" } else { "." };
    format!("{first}{}{stop}", letters.as_str())
}

/// Writes a text so that Markdown shows it as it is: names that look like code are marked as code.
pub fn plain(text: &str) -> String {
    let is_paired = text.matches('`').count().is_multiple_of(2);
    let text = if is_paired { text.to_owned() } else { text.replace('`', "'") };
    let mut in_code = false;
    let words = text.split_whitespace().map(|word| {
        let ticks = word.matches('`').count();
        let shown = if in_code || ticks > 0 { word.to_owned() } else { escaped(word) };
        in_code ^= ticks % 2 == 1;
        shown
    });
    words.collect::<Vec<_>>().join(" ")
}

fn escaped(word: &str) -> String {
    let core = word.trim_matches(|letter: char| !letter.is_alphanumeric());
    if looks_like_code(core) {
        return word.replacen(core, &format!("`{core}`"), 1);
    }
    let special = |letter: char| matches!(letter, '[' | ']' | '<' | '>' | '*' | '_' | '\\' | '#');
    word.chars().fold(String::new(), |mut shown, letter| {
        if special(letter) {
            shown.push('\\');
        }
        shown.push(letter);
        shown
    })
}

/// Tests for `snake_case`, `CamelCase` and paths.
fn looks_like_code(word: &str) -> bool {
    let bytes = word.as_bytes();
    let camel = bytes.windows(2).any(|pair| pair[0].is_ascii_lowercase() && pair[1].is_ascii_uppercase());
    camel || word.contains('_') || word.contains("::")
}

/// Breaks a paragraph into lines, but never before a word that would begin a list.
fn wrapped(paragraph: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in paragraph.split(' ').filter(|word| !word.is_empty()) {
        let fits = |line: &String| line.is_empty() || line.chars().count() + 1 + word.chars().count() <= WIDTH;
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if fits(line) || begins_list(word) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

fn begins_list(word: &str) -> bool {
    let numbered = word.trim_end_matches(['.', ')']);
    word.starts_with(['-', '+', '*', '#', '>', '|', '=', '~'])
        || (numbered.len() < word.len() && numbered.bytes().all(|byte| byte.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_code_and_markdown_is_shown_as_it_is() {
        assert_eq!(plain("see set_group, or [1] in CamelCase"), "see `set_group`, or \\[1\\] in `CamelCase`");
        assert_eq!(plain("wait after `set group now` once"), "wait after `set group now` once");
        assert_eq!(plain("a stray ` of set_group"), "a stray ' of `set_group`");
    }

    #[test]
    fn no_line_begins_a_list() {
        let lines = wrapped(&format!("{} - and 12. so", "x".repeat(WIDTH)));
        assert_eq!(lines, [format!("{} -", "x".repeat(WIDTH)), "and 12. so".to_owned()]);
    }

    #[test]
    fn sentences_begin_with_a_capital_and_end_with_a_stop() {
        assert_eq!(sentence_of("output voltage"), "Output voltage.");
        assert_eq!(sentence_of("Done?"), "Done?");
    }
}
