//! The sentences that people read on pages and in diagnostics.

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// A sentence, or text that stands alone like one: a heading, an item of a list, a cell of a table.
#[derive(Debug)]
pub struct Sentence {
    /// Number of the line where its paragraph begins.
    pub line: usize,
    /// Number of its paragraph in the text.
    pub paragraph: usize,
    /// Its text, without marks of Markdown.
    pub text: String,
}

impl Sentence {
    /// Counts the words, also those in pieces of code.
    #[must_use]
    pub fn words(&self) -> usize {
        self.text.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
    }

    /// Tests whether the sentence has these words one after the other, whatever their case.
    #[must_use]
    pub fn says(&self, words: &str) -> bool {
        let text = self.text.to_lowercase();
        let said: Vec<_> =
            text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        format!(" {} ", said.join(" ")).contains(&format!(" {words} "))
    }
}

/// Returns the sentences of a file. Its name decides how they are found, and most kinds of files have none.
#[must_use]
pub fn sentences(name: &str, text: &str) -> Vec<Sentence> {
    match name.rsplit_once('.').map(|(_, ending)| ending) {
        Some("md") => of_markdown(text, 1).collect(),
        Some("stderr") => of_diagnostics(text).collect(),
        _ => Vec::new(),
    }
}

/// Returns the numbers of the lines in Markdown that are wider than `columns` and could be broken.
///
/// Rows of tables cannot be broken, nor can code.
pub fn wide_lines(text: &str, columns: usize) -> impl Iterator<Item = usize> {
    let mut is_code = false;
    text.lines().enumerate().filter_map(move |(place, line)| {
        is_code ^= line.starts_with("```");
        let can_be_broken = !is_code && !line.starts_with('|');
        (can_be_broken && line.chars().count() > columns).then_some(place + 1)
    })
}

/// Returns what stands one after the other in a paragraph and has at most `words` words, in runs. What does not end
/// like a sentence, as a heading or an item does, is in none.
#[must_use]
pub fn short_runs(sentences: &[Sentence], words: usize) -> Vec<&[Sentence]> {
    let is_short = |one: &Sentence| one.words() <= words && one.text.ends_with(['.', '?', '!']);
    let runs = sentences.chunk_by(|one, other| one.paragraph == other.paragraph && is_short(one) == is_short(other));
    runs.filter(|run| run.first().is_some_and(is_short)).collect()
}

/// Returns the messages and the helps of diagnostics.
fn of_diagnostics(text: &str) -> impl Iterator<Item = Sentence> {
    text.lines().enumerate().flat_map(|(place, line)| {
        let says = ["error", "warning", "= help", "= note"].iter().any(|word| line.trim_start().starts_with(word));
        let said = says.then(|| line.split_once(": ")).flatten().map_or("", |(_, said)| said);
        // A list of alternatives follows, which nobody reads as a sentence.
        let said = said.split("allowed here: ").next().unwrap_or_default();
        of_markdown(said, place + 1).collect::<Vec<_>>()
    })
}

/// Returns the sentences of a text in Markdown. `first` is the number of its first line.
fn of_markdown(text: &str, first: usize) -> impl Iterator<Item = Sentence> {
    let line = move |at: usize| first + text.get(..at).map_or(0, |before| before.matches('\n').count());
    let sentence = move |line, paragraph, text| Sentence { line, paragraph, text };
    let blocks = blocks(text).into_iter().enumerate();
    blocks.flat_map(move |(paragraph, (at, words))| {
        let line = line(at);
        split(&words).into_iter().map(move |text| sentence(line, paragraph, text))
    })
}

/// Returns each paragraph, heading, item and cell with the place where it begins. No sentence ends within code.
fn blocks(text: &str) -> Vec<(usize, String)> {
    let mut blocks = vec![(0, String::new())];
    let mut is_code = false;
    for (event, place) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
        let said = match event {
            Event::Text(said) if !is_code => said.to_string(),
            Event::Code(said) => format!("`{}`", said.replace(' ', "\u{a0}")),
            Event::SoftBreak | Event::HardBreak => " ".to_owned(),
            Event::Start(tag) if !is_inline(tag.to_end()) => {
                is_code = matches!(tag, Tag::CodeBlock(_));
                blocks.push((place.start, String::new()));
                continue;
            }
            Event::End(tag) if !is_inline(tag) => {
                is_code = false;
                blocks.push((place.end, String::new()));
                continue;
            }
            _ => continue,
        };
        blocks.last_mut().expect("there is a block").1.push_str(&said);
    }
    blocks
}

/// Tests whether a sentence goes on after the tag.
fn is_inline(tag: TagEnd) -> bool {
    matches!(tag, TagEnd::Emphasis | TagEnd::Strong | TagEnd::Link | TagEnd::Image)
}

/// Splits a block into its sentences.
fn split(words: &str) -> Vec<String> {
    let words: Vec<_> = words.split_ascii_whitespace().collect();
    let ends = |word: &&str| word.trim_end_matches(['"', ')']).ends_with(['.', '?', '!']);
    words.split_inclusive(ends).map(|words| words.join(" ")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the sentences of a file with their lines.
    fn found(name: &str, text: &str) -> Vec<(usize, String)> {
        sentences(name, text).into_iter().map(|Sentence { line, text, .. }| (line, text)).collect()
    }

    /// Returns how many words the only sentence of a paragraph has.
    fn words(paragraph: &str) -> usize {
        match sentences("page.md", paragraph).as_slice() {
            [sentence] => sentence.words(),
            several => panic!("{several:?}"),
        }
    }

    fn expected(sentences: &[(usize, &str)]) -> Vec<(usize, String)> {
        sentences.iter().map(|(line, text)| (*line, (*text).to_owned())).collect()
    }

    #[test]
    fn a_word_has_a_letter_or_a_digit() {
        assert_eq!(words("One two – 3 + four & *five*"), 5);
    }

    #[test]
    fn a_piece_of_code_has_its_own_words() {
        assert_eq!(words("Write `let x = 1;` and `a. b` here"), 8);
    }

    #[test]
    fn a_sentence_says_whole_words_in_any_case_and_between_any_signs() {
        let [sentence] = &sentences("page.md", "(So *is* this, also `are` those.)")[..] else { panic!("one sentence") };
        assert!(["so is", "this also are", "those"].iter().all(|words| sentence.says(words)));
        assert!(["so are", "so is th", "o is"].iter().all(|words| !sentence.says(words)));
    }

    #[test]
    fn a_link_counts_with_its_text_and_not_with_its_address() {
        assert_eq!(words("See [the rules](https://example.com/one/two) of **this very** page"), 7);
    }

    #[test]
    fn a_sentence_ends_with_its_stop_and_with_what_closes_after_it() {
        assert_eq!(
            found("page.md", "One. Two 1.5 `a. b.` three? (Four!) \"Five.\"\nSix, seven; eight: nine"),
            expected(&[
                (1, "One."),
                (1, "Two 1.5 `a.\u{a0}b.` three?"),
                (1, "(Four!)"),
                (1, "\"Five.\""),
                (1, "Six, seven; eight: nine"),
            ])
        );
    }

    #[test]
    fn headings_items_cells_and_paragraphs_are_sentences_of_their_own() {
        let page = "# One\n\ntwo\nthree\n\n- four\n- five\n  six\n\n| seven | eight |\n|---|---|\n| nine | |\n\nten";
        assert_eq!(
            found("page.md", page),
            expected(&[
                (1, "One"),
                (3, "two three"),
                (6, "four"),
                (7, "five six"),
                (10, "seven"),
                (10, "eight"),
                (12, "nine"),
                (14, "ten"),
            ])
        );
    }

    #[test]
    fn blocks_of_code_have_no_sentences() {
        let page = "One\n\n```sh\ntwo three. four\n```\n\nfive\n\n    six seven\n\neight";
        assert_eq!(found("page.md", page), expected(&[(1, "One"), (7, "five"), (11, "eight")]));
    }

    #[test]
    fn a_line_is_wide_unless_it_is_a_row_of_a_table_or_code() {
        let page = "four\näöüß\nfifth\n| row | \n```\n$ wide\n```\nwidest\n";
        assert_eq!(wide_lines(page, 4).collect::<Vec<_>>(), [3, 8]);
    }

    #[test]
    fn comments_and_other_files_have_none() {
        for name in ["a.rs", "a.toml", "a.json", "justfile"] {
            assert_eq!(found(name, "// one\n# two\n"), Vec::new(), "{name}");
        }
    }

    #[test]
    fn short_sentences_of_one_paragraph_run_until_a_long_one_or_what_is_none() {
        let page = "A b. C d. E f g h.\n\nOne. Two three four five. Six.\n\n- item\n";
        let runs: Vec<_> = short_runs(&sentences("page.md", page), 3).iter().map(|run| run.len()).collect();
        assert_eq!(runs, [2, 1, 1]);
    }

    #[test]
    fn diagnostics_speak_in_their_messages_helps_and_notes_alone() {
        let report = "error[a]: one\n --> a.yaml:1: two\n  |\n1 | error: three\n  |        ^ four: five\n   \
            = help: six\n   = note: seven. eight\nwarning[b]: nine: ten\n";
        assert_eq!(
            found("a.stderr", report),
            expected(&[(1, "one"), (6, "six"), (7, "seven."), (7, "eight"), (8, "nine: ten")])
        );
    }

    #[test]
    fn the_alternatives_after_allowed_here_are_no_part_of_a_sentence() {
        let report = "  = help: did you mean `b`? allowed here: `a`, `b`\n  = help: write c; allowed here: `d`\n";
        assert_eq!(found("a.stderr", report), expected(&[(1, "did you mean `b`?"), (2, "write c;")]));
    }
}
