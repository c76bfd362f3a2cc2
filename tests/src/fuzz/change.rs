//! Changes of a spec. After most of them it can still be read.

use std::ops::Range;

use fastrand::Rng;

use super::specs::{SPECS, WORDS};

/// Numbers at the edges of what a bit field, an integer or a fraction can be.
const EXTREMES: [&str; 28] = [
    "0",
    "-0",
    "1",
    "-1",
    "7",
    "8",
    "9",
    "28",
    "29",
    "63",
    "64",
    "65",
    "255",
    "256",
    "2047",
    "2048",
    "0x1FFFFFFF",
    "0x20000000",
    "4294967296",
    "9223372036854775808",
    "-9223372036854775809",
    "18446744073709551616",
    "170141183460469231731687303715884105728",
    "1/18446744073709551615",
    "1/0",
    "1e-308",
    "1e999999999",
    "0.000000000000000000000000000000000000001",
];

/// What YAML makes something of.
const MARKS: [&str; 14] = ["{", "}", "[", "]", ": ", ",", "- ", "\"", "'", "#", "|", "&", "..", "\\"];

/// What can change, as often as it stands here.
const CHANGES: [fn(&mut Draft); 24] = [
    Draft::number,
    Draft::number,
    Draft::number,
    Draft::number,
    Draft::number,
    Draft::word,
    Draft::word,
    Draft::word,
    Draft::word,
    Draft::word,
    Draft::pair,
    Draft::pair,
    Draft::pair,
    Draft::pair,
    Draft::copy,
    Draft::copy,
    Draft::graft,
    Draft::graft,
    Draft::delete,
    Draft::delete,
    Draft::swap,
    Draft::key,
    Draft::indent,
    Draft::mark,
];

/// Changes a spec in one place, and sometimes in more; what is no text is taken for as much as is one.
pub fn mutated(bytes: &[u8], random: &mut Rng) -> Vec<u8> {
    let lines = String::from_utf8_lossy(bytes).lines().map(str::to_owned).collect();
    let mut draft = Draft { lines, random: random.fork() };
    loop {
        if draft.lines.is_empty() {
            draft.lines.push(String::new());
        }
        CHANGES[draft.random.usize(..CHANGES.len())](&mut draft);
        if draft.random.u8(..3) > 0 {
            return (draft.lines.join("\n") + "\n").into_bytes();
        }
    }
}

/// The lines of a spec, at least one.
struct Draft {
    lines: Vec<String>,
    random: Rng,
}

impl Draft {
    /// Puts an extreme number, or one of the next ones, in the place of a number.
    fn number(&mut self) {
        let Some((line, span)) = self.place(is_number) else { return };
        let next = |number: u64, up: bool| if up { number.saturating_add(1) } else { number.saturating_sub(1) };
        let other = match self.lines[line][span.clone()].parse() {
            Ok(number) if self.random.bool() => next(number, self.random.bool()).to_string(),
            _ => EXTREMES[self.random.usize(..EXTREMES.len())].to_owned(),
        };
        self.lines[line].replace_range(span, &other);
    }

    /// Puts a word of the spec in the place of another one that is no key.
    fn word(&mut self) {
        let Some((from, other)) = self.place(is_word) else { return };
        let other = self.lines[from][other].to_owned();
        let Some((line, span)) = self.place(is_word) else { return };
        if !self.lines[line][span.end..].starts_with(':') {
            self.lines[line].replace_range(span, &other);
        }
    }

    /// Puts a word of the language in the place of a word.
    fn key(&mut self) {
        if let Some((line, span)) = self.place(is_word) {
            self.lines[line].replace_range(span, &WORDS[self.random.usize(..WORDS.len())]);
        }
    }

    /// Puts an entry of a map of another spec into a map.
    fn pair(&mut self) {
        let others = self.another();
        let parts = others.lines.iter().flat_map(|line| line.split(['{', '}', ',', '[', ']'])).map(str::trim);
        let pairs: Vec<&str> = parts.filter(|part| part.contains(": ")).collect();
        let Some(pair) = self.random.choice(pairs) else { return };
        let lines = self.lines.iter().enumerate();
        let open = lines.flat_map(|(at, line)| line.match_indices('{').map(move |(brace, _)| (at, brace)));
        if let Some((line, brace)) = self.random.choice(open.collect::<Vec<_>>()) {
            self.lines[line].insert_str(brace + 1, &format!("{pair}, "));
        }
    }

    /// Copies an entry, and gives it another name.
    fn copy(&mut self) {
        let entry = self.entry();
        let mut copied = self.lines[entry.clone()].to_vec();
        if let Some(name) = words(&copied[0]).into_iter().find(|span| copied[0][span.end..].starts_with(':')) {
            copied[0].insert_str(name.end, "_2");
        }
        self.lines.splice(entry.end..entry.end, copied);
    }

    /// Puts an entry of another spec behind an entry, as deep as this one.
    fn graft(&mut self) {
        let mut others = self.another();
        let grafted = others.entry();
        let entry = self.entry();
        let (own, other) = (depth(&self.lines[entry.start]), depth(&others.lines[grafted.start]));
        let moved = |line: &String| format!("{}{}", " ".repeat(own), line.get(other..).unwrap_or(line));
        self.lines.splice(entry.end..entry.end, others.lines[grafted].iter().map(moved));
    }

    fn delete(&mut self) {
        let entry = self.entry();
        self.lines.drain(entry);
    }

    fn swap(&mut self) {
        let (one, other) = (self.line(), self.line());
        self.lines.swap(one, other);
    }

    /// Moves an entry by two columns.
    fn indent(&mut self) {
        let entry = self.entry();
        let inward = self.random.bool();
        for line in &mut self.lines[entry] {
            if inward {
                line.insert_str(0, "  ");
            } else if let Some(rest) = line.strip_prefix("  ") {
                *line = rest.to_owned();
            }
        }
    }

    /// Puts something into a line that YAML makes something of.
    fn mark(&mut self) {
        let line = self.line();
        let places = self.lines[line].char_indices().map(|(at, _)| at).chain([self.lines[line].len()]);
        let places: Vec<usize> = places.collect();
        let place = places[self.random.usize(..places.len())];
        self.lines[line].insert_str(place, MARKS[self.random.usize(..MARKS.len())]);
    }

    /// Returns a spec of the workspace.
    fn another(&mut self) -> Self {
        let lines = SPECS[self.random.usize(..SPECS.len())].lines().map(str::to_owned).collect();
        Self { lines, random: self.random.fork() }
    }

    fn line(&mut self) -> usize {
        self.random.usize(..self.lines.len())
    }

    /// Returns a line and those below it that are indented more.
    fn entry(&mut self) -> Range<usize> {
        let start = self.line();
        let outer = depth(&self.lines[start]);
        let inner = self.lines[start + 1..].iter().take_while(|line| depth(line) > outer).count();
        start..start + 1 + inner
    }

    /// Returns a line, and where in it a word is that is `wanted`.
    fn place(&mut self, wanted: fn(&str) -> bool) -> Option<(usize, Range<usize>)> {
        let start = self.line();
        (start..self.lines.len()).chain(0..start).find_map(|at| {
            let line = &self.lines[at];
            let spans = words(line).into_iter().filter(|span| wanted(&line[span.clone()]));
            Some((at, self.random.choice(spans.collect::<Vec<_>>())?))
        })
    }
}

fn depth(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Returns where the words and numbers of a line are.
fn words(line: &str) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut words = Vec::new();
    for (at, letter) in line.char_indices().chain([(line.len(), ' ')]) {
        if !letter.is_alphanumeric() && letter != '_' {
            if at > start {
                words.push(start..at);
            }
            start = at + letter.len_utf8();
        }
    }
    words
}

fn is_number(word: &str) -> bool {
    word.starts_with(|letter: char| letter.is_ascii_digit())
}

fn is_word(word: &str) -> bool {
    !is_number(word)
}
