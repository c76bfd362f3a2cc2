//! Documentation comments.

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};

use crate::model::{Doc, Protocol};
use crate::words::text::Text;

/// The longest line of text behind `/// `.
const WIDTH: usize = 100;

/// What an item of a list begins with; no text of a spec does.
const ITEM: &str = "- ";

/// What a heading begins with, around which no line is left empty; no text of a spec does.
const HEADING: &str = "# ";

/// A documentation comment, line by line.
#[derive(Clone)]
pub struct Comment {
    lines: Vec<String>,
}

impl Comment {
    /// Makes a comment of paragraphs, with an empty line between two of them, but none before a [`list`] or a heading.
    pub fn new(paragraphs: impl IntoIterator<Item = String>) -> Self {
        let mut lines: Vec<String> = Vec::new();
        for paragraph in paragraphs {
            let is_set_off = ![ITEM, HEADING].iter().any(|start| paragraph.starts_with(start));
            if is_set_off && lines.last().is_some_and(|last| !last.starts_with(HEADING)) {
                lines.push(String::new());
            }
            lines.extend(paragraph.lines().flat_map(wrapped));
        }
        Self { lines }
    }

    /// Returns the lines, without what marks a comment.
    pub fn lines(&self) -> &[String] {
        &self.lines
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

/// Makes a paragraph of the items of a list.
pub fn list(items: impl IntoIterator<Item = String>) -> String {
    items.into_iter().map(|item| format!("{ITEM}{item}")).collect::<Vec<_>>().join("\n")
}

impl ToTokens for Comment {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let lines = self.lines.iter().map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
        tokens.extend(quote!(#(#[doc = #lines])*));
    }
}

/// Returns the paragraphs of an item's comment, without what the outer item says already.
pub fn paragraphs(protocol: &Protocol, doc: &Doc, sentence: &str, outer: Option<&Doc>) -> Vec<String> {
    let section =
        doc.section.as_ref().filter(|section| outer.is_none_or(|outer| outer.section.as_ref() != Some(section)));
    let section = section.map(|section| sentence_of(&reference(protocol, section)));
    let first = std::iter::once(sentence.to_owned()).chain(section).collect::<Vec<_>>().join(" ");
    let note = doc.note.iter().map(|note| sentence_of(&note.in_rust_doc()));
    let errata = doc.errata.iter().filter_map(|name| erratum(protocol, name));
    std::iter::once(first).chain(note).chain(errata).collect()
}

/// Returns a section as `Section 2.4` or `Section C 2.4`, or as the table that it names.
fn reference(protocol: &Protocol, section: &Text) -> String {
    let first = section.for_people().split_whitespace().next().unwrap_or_default();
    let is_document = protocol.documents.iter().any(|document| document.name.as_deref() == Some(first));
    let is_number = first.starts_with(|letter: char| letter.is_ascii_digit());
    let section = section.in_rust_doc();
    if is_number || is_document { format!("Section {section}") } else { section }
}

/// Writes an erratum as a paragraph, unless it is about the scan of the document alone.
pub fn erratum(protocol: &Protocol, name: &Text) -> Option<String> {
    let erratum = protocol.errata.iter().find(|erratum| erratum.name == *name)?;
    if matches!(erratum.kind.as_str(), "ocr" | "note") {
        return None;
    }
    let [name, prints, uses] = [name, &erratum.prints, &erratum.uses].map(Text::in_rust_doc);
    let because = erratum.because.within_rust_doc();
    Some(sentence_of(&format!("Erratum {name}: printed is \"{prints}\", used is \"{uses}\", because {because}")))
}

/// Returns the title of an item, for people.
pub fn title(doc: &Doc, name: &str) -> String {
    doc.title.as_ref().map_or_else(|| name.replace('_', " "), Text::in_rust_doc)
}

/// Returns the title of an item, for a string.
pub fn plain_title(doc: &Doc, name: &str) -> String {
    doc.title.as_ref().map_or_else(|| name.replace('_', " "), |title| title.as_rust_str().to_owned())
}

/// Returns a text with a capital letter at its start and a full stop at its end.
pub fn sentence_of(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string()).unwrap_or_default();
    let stop = if text.ends_with(['.', '!', '?', ':']) { "" } else { "." };
    format!("{first}{}{stop}", letters.as_str())
}

/// Breaks a paragraph into lines, but never before a word that would begin a list or anything else than words.
///
/// The further lines of an item of a list are indented.
fn wrapped(paragraph: &str) -> Vec<String> {
    let indent = if paragraph.starts_with(ITEM) { "  " } else { "" };
    let mut lines = vec![String::new()];
    for word in paragraph.split(' ').filter(|word| !word.is_empty()) {
        let fits = |line: &String| line.is_empty() || line.chars().count() + 1 + word.chars().count() <= WIDTH;
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if fits(line) || begins_block(word) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(format!("{indent}{word}")),
        }
    }
    lines
}

/// Tests for marks of Markdown at the start of a line, which count in the midst of code as well.
fn begins_block(word: &str) -> bool {
    let numbered = word.trim_end_matches(['.', ')']);
    let is_number = numbered.len() < word.len() && numbered.bytes().all(|byte| byte.is_ascii_digit());
    is_number || word.starts_with(|mark: char| mark.is_ascii_punctuation() && !"\\`\"'(".contains(mark))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_begins_a_list_or_a_footnote() {
        let lines = wrapped(&format!("{} - and 12. so", "x".repeat(WIDTH)));
        assert_eq!(lines, [format!("{} -", "x".repeat(WIDTH)), "and 12. so".to_owned()]);
        let lines = wrapped(&format!("`{} [^1]: x`", "x".repeat(WIDTH)));
        assert_eq!(lines, [format!("`{} [^1]:", "x".repeat(WIDTH)), "x`".to_owned()]);
    }

    #[test]
    fn the_lines_of_an_item_are_indented() {
        let items = list(["a".to_owned(), format!("b {}", "x".repeat(WIDTH))]);
        assert_eq!(
            Comment::new([items]).lines,
            ["- a".to_owned(), "- b".to_owned(), format!("  {}", "x".repeat(WIDTH))]
        );
    }

    #[test]
    fn sentences_begin_with_a_capital_and_end_with_a_stop() {
        assert_eq!(sentence_of("output voltage"), "Output voltage.");
        assert_eq!(sentence_of("Done?"), "Done?");
    }
}
