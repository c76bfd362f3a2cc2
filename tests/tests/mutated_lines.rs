//! A mistake in one line of a spec, and whether the compiler points at that very line.
//!
//! The mistakes are drawn with a fixed seed, a hundred for each spec, in lines about frames. A change
//! without an effect on generated code is no mistake, and is drawn again. With `--nocapture`, the
//! test lists all mistakes that are not noticed in their line. It says why a mistake does no harm,
//! or which generated code it changes.

use std::fs;
use std::ops::Range;
use std::path::Path;

use canspec_codegen::emit::{Options, rust};
use canspec_codegen::source::Source;
use canspec_codegen::{Outcome, compile};
use canspec_tests::specs;
use fastrand::Rng;
use rayon::prelude::*;

const MISTAKES_A_SPEC: usize = 100;

/// Fewest mistakes in a hundred that a diagnostic in their line must notice, and most that may do
/// harm unnoticed.
const NOTICED_IN_THE_LINE: usize = 90;
const HARMFUL: usize = 3;

/// Keys with words for people.
const REMARKS: [&str; 11] = [
    "title: ",
    "note: ",
    "because: ",
    "prints: ",
    "uses: ",
    "set_when: ",
    "clear_when: ",
    "effect: ",
    "led: ",
    "section: ",
    "erratum: ",
];

const UNITS: [&str; 12] = ["V", "A", "W", "Hz", "°C", "\"%\"", "s", "ms", "min", "h", "rpm", "m"];

#[derive(Clone, Copy, Debug)]
enum Mistake {
    Digit,
    Name,
    Unit,
    Bit,
    Deletion,
}

const MISTAKES: [Mistake; 5] = [Mistake::Digit, Mistake::Name, Mistake::Unit, Mistake::Bit, Mistake::Deletion];

/// What came of a mistake.
#[derive(Debug, PartialEq, Eq)]
enum Notice {
    /// A diagnostic starts in the line.
    InTheLine,
    /// An error about another line, so that no code is generated, or a warning.
    Elsewhere(String),
    /// Nothing but the documentation of the generated code differs.
    OfDocumentation,
    /// Nothing that is generated differs.
    OfNothing,
    /// The first line of code that differs.
    OfCode(String),
}

/// How many mistakes were made, and what came of them.
#[derive(Clone, Copy, Default)]
struct Count {
    all: usize,
    in_the_line: usize,
    harmful: usize,
}

impl Count {
    /// Makes mistakes in a spec.
    fn of(path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let text = fs::read_to_string(path).expect("a spec that ships can be read");
        let lines: Vec<_> = text.lines().collect();
        let right = code(&compiled(&lines, 0..0, None));
        let mut random = Rng::with_seed(7);
        let mut count = Self::default();
        for turn in 0..MISTAKES_A_SPEC {
            let mistake = MISTAKES[turn % MISTAKES.len()];
            let (index, line, notice) = drawn(mistake, &lines, &right, &mut random);
            // Nothing contradicts what only the documentation says.
            count.all += usize::from(notice != Notice::OfDocumentation);
            count.in_the_line += usize::from(notice == Notice::InTheLine);
            count.harmful += usize::from(matches!(notice, Notice::OfCode(_)));
            if notice != Notice::InTheLine {
                let line = line.unwrap_or_else(|| format!("without {}", lines[index].trim()));
                eprintln!("{name}:{}: {mistake:?}: {}\n    {notice:?}", index + 1, line.trim());
            }
        }
        count
    }

    fn and(self, other: Self) -> Self {
        Self {
            all: self.all + other.all,
            in_the_line: self.in_the_line + other.in_the_line,
            harmful: self.harmful + other.harmful,
        }
    }
}

#[test]
fn nine_of_ten_mistakes_are_noticed_in_their_line() {
    let counts = specs("specs").into_par_iter().map(|path| Count::of(&path));
    let Count { all, in_the_line, harmful } = counts.reduce(Count::default, Count::and);
    eprintln!("of {all} mistakes {in_the_line} are noticed in their line, {harmful} do harm unnoticed");
    assert!(in_the_line * 100 >= NOTICED_IN_THE_LINE * all, "{in_the_line} of {all} in their line");
    assert!(harmful * 100 <= HARMFUL * all, "{harmful} of {all} do harm unnoticed");
}

/// Draws a mistake that changes something; without text the line is deleted.
fn drawn(mistake: Mistake, lines: &[&str], right: &str, random: &mut Rng) -> (usize, Option<String>, Notice) {
    loop {
        let (index, line) = mistaken(mistake, lines, random);
        let notice = notice(lines, index, line.as_deref(), right);
        if notice != Notice::OfNothing {
            return (index, line, notice);
        }
    }
}

/// Makes a mistake in some line; without text the line is deleted.
fn mistaken(mistake: Mistake, lines: &[&str], random: &mut Rng) -> (usize, Option<String>) {
    loop {
        let index = random.usize(1..lines.len());
        if is_of_times(&lines[..=index]) {
            continue;
        }
        let spans = spans(mistake, lines[index]);
        let Some(span) = random.choice(spans) else { continue };
        let wrong = wrong(mistake, &lines[index][span.clone()], random);
        if wrong.as_deref() != Some(&lines[index][span.clone()]) {
            let line =
                wrong.map(|wrong| format!("{}{wrong}{}", &lines[index][..span.start], &lines[index][span.end..]));
            return (index, line);
        }
    }
}

/// Tests whether the last line is one of `timing`. No frame shows a time, so nothing can contradict one.
fn is_of_times(lines: &[&str]) -> bool {
    let mut before = lines.iter().rev();
    before.find(|line| line.starts_with(|first: char| first.is_ascii_lowercase())) == Some(&"timing:")
}

/// Returns where a line can be mistaken.
fn spans(mistake: Mistake, line: &str) -> Vec<Range<usize>> {
    let end = end_of_facts(line);
    let words = words(&line[..end]);
    let follows = |span: &Range<usize>, before: &[&str]| before.iter().any(|text| line[..span.start].ends_with(text));
    match mistake {
        Mistake::Digit => {
            line[..end].match_indices(|letter: char| letter.is_ascii_digit()).map(|(at, _)| at..at + 1).collect()
        }
        Mistake::Name => words.into_iter().filter(|word| is_name(&line[word.clone()])).collect(),
        Mistake::Unit => words.into_iter().filter(|word| UNITS.contains(&&line[word.clone()])).collect(),
        Mistake::Bit => words
            .into_iter()
            .filter(|word| follows(word, &["bit: ", "bits: ", ".."]) && line[word.clone()].parse::<u64>().is_ok())
            .collect(),
        Mistake::Deletion if end > 0 => std::iter::once(0..0).collect(),
        Mistake::Deletion => Vec::new(),
    }
}

/// Returns where the comment or the first words for people start.
fn end_of_facts(line: &str) -> usize {
    let starts = REMARKS.iter().copied().chain(["#  ", " # ", "- ["]).filter_map(|start| line.find(start));
    let end = starts.min().unwrap_or(line.len());
    let is_prose = line[..end].split_whitespace().count() > 3 && !line[..end].contains(": ");
    if is_prose || line.trim_start().starts_with('#') || line[..end].trim().is_empty() { 0 } else { end }
}

/// Splits a text where YAML does, and at dots.
fn words(text: &str) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut words = Vec::new();
    for (at, letter) in text.char_indices().chain([(text.len(), ' ')]) {
        if " {}[],:.".contains(letter) {
            if at > start {
                words.push(start..at);
            }
            start = at + letter.len_utf8();
        }
    }
    words
}

fn is_name(word: &str) -> bool {
    word.len() > 3 && word.bytes().all(|letter| letter.is_ascii_lowercase() || letter == b'_')
}

/// Returns something else than what is right; nothing for a line that is deleted.
fn wrong(mistake: Mistake, right: &str, random: &mut Rng) -> Option<String> {
    Some(match mistake {
        Mistake::Digit => random.u8(0..10).to_string(),
        Mistake::Name => swapped(right, random.usize(0..right.len() - 1)),
        Mistake::Unit => UNITS[random.usize(0..UNITS.len())].to_owned(),
        Mistake::Bit => {
            let number: u64 = right.parse().unwrap_or_default();
            (if number == 0 || random.bool() { number + 1 } else { number - 1 }).to_string()
        }
        Mistake::Deletion => return None,
    })
}

/// Swaps two letters, as hands do.
fn swapped(name: &str, at: usize) -> String {
    let mut letters: Vec<_> = name.chars().collect();
    letters.swap(at, at + 1);
    letters.into_iter().collect()
}

fn notice(lines: &[&str], index: usize, line: Option<&str>, right: &str) -> Notice {
    let outcome = compiled(lines, index..index + 1, line);
    let own = own_lines(lines, index, line.is_none());
    let found: Vec<_> = outcome.diagnostics.located().collect();
    if found.iter().any(|item| item.place.is_some_and(|place| own.contains(&place.line))) {
        return Notice::InTheLine;
    }
    if let Some(item) = found.first() {
        return Notice::Elsewhere(item.to_string());
    }
    let wrong = code(&outcome);
    let differs = |is_code: fn(&&str) -> bool| {
        let differing = |(one, other): &(&str, &str)| one != other;
        right
            .lines()
            .filter(is_code)
            .zip(wrong.lines().filter(is_code))
            .find(differing)
            .map(|(_, line)| line.to_owned())
    };
    if wrong == right {
        Notice::OfNothing
    } else {
        differs(|line| !line.trim_start().starts_with("//")).map_or(Notice::OfDocumentation, Notice::OfCode)
    }
}

/// Returns the lines, counted from 1, where a mistake is noticed. A deleted line is noticed in a
/// line beside it, or at the start of its entry.
fn own_lines(lines: &[&str], index: usize, is_deleted: bool) -> Vec<usize> {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let outer = (0..index).rfind(|above| indent(lines[*above]) < indent(lines[index]) && !lines[*above].is_empty());
    let start = lines.iter().position(|line| !line.starts_with('#')).unwrap_or_default();
    if is_deleted { vec![index, index + 1, outer.unwrap_or(start) + 1] } else { vec![index + 1] }
}

/// Compiles a spec in which something else stands in place of some lines.
fn compiled(lines: &[&str], replaced: Range<usize>, line: Option<&str>) -> Outcome {
    let text = [&lines[..replaced.start], line.as_slice(), &lines[replaced.end..]].concat().join("\n");
    compile(Source::new("spec.yaml", text.into_bytes()).expect("a mistake is a text as well"))
}

/// Returns the generated code; nothing if there are errors.
fn code(outcome: &Outcome) -> String {
    outcome.protocol.as_ref().map_or_else(String::new, |protocol| rust(protocol, &Options::default()))
}
