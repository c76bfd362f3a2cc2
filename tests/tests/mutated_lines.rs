//! A mistake in one line of a spec, and whether the compiler points at that very line.
//!
//! The mistakes are drawn with a fixed seed, twenty a spec, from what says something about frames. With `--nocapture` the test lists
//! those that are noticed in another line, and those that nothing notices.

use std::fs;
use std::ops::Range;

use canspec_codegen::compile;
use canspec_codegen::source::Source;
use canspec_tests::specs;
use fastrand::Rng;

const MISTAKES_A_SPEC: usize = 20;

/// Of a hundred mistakes so many are noticed at all, and so many by a diagnostic that starts in the line.
const NOTICED: usize = 80;
const NOTICED_IN_THE_LINE: usize = 50;

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
    /// A diagnostic shows the line as another place that has to do with it.
    BesideTheLine,
    /// All diagnostics are about other lines.
    Elsewhere,
    Nothing,
}

#[test]
fn most_mistakes_are_noticed_and_most_of_these_in_their_own_line() {
    let mut notices = Vec::new();
    for path in specs("specs") {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let text = fs::read_to_string(&path).expect("a spec that ships can be read");
        let lines: Vec<_> = text.lines().collect();
        let mut random = Rng::with_seed(7);
        for turn in 0..MISTAKES_A_SPEC {
            let mistake = MISTAKES[turn % MISTAKES.len()];
            let (index, line) = mistaken(mistake, &lines, &mut random);
            let notice = notice(&lines, index, line.as_deref());
            if notice != Notice::InTheLine {
                eprintln!("{name}:{}: {mistake:?} {notice:?}: {}", index + 1, line.unwrap_or_default().trim());
            }
            notices.push(notice);
        }
    }
    let share =
        |wanted: &[Notice]| notices.iter().filter(|notice| wanted.contains(notice)).count() * 100 / notices.len();
    let (in_the_line, nothing) = (share(&[Notice::InTheLine]), share(&[Notice::Nothing]));
    eprintln!("of 100 mistakes {in_the_line} are noticed in their line, {nothing} not at all");
    assert!(in_the_line >= NOTICED_IN_THE_LINE, "{in_the_line} of 100 in their line");
    assert!(100 - nothing >= NOTICED, "{nothing} of 100 not at all");
}

/// Makes a mistake in some line; without text the line is deleted.
fn mistaken(mistake: Mistake, lines: &[&str], random: &mut Rng) -> (usize, Option<String>) {
    loop {
        let index = random.usize(1..lines.len());
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

fn notice(lines: &[&str], index: usize, line: Option<&str>) -> Notice {
    let (before, after) = (&lines[..index], &lines[index + 1..]);
    let text = [before, line.as_slice(), after].concat().join("\n");
    let Ok(source) = Source::new("spec.yaml", text.into_bytes()) else { return Notice::InTheLine };
    let diagnostics = compile(source).diagnostics;
    // What is deleted is missed in the line before or after.
    let own = if line.is_some() { index + 1..index + 2 } else { index..index + 3 };
    let is_own =
        |place: Option<canspec_codegen::diagnostic::Place>| place.is_some_and(|place| own.contains(&place.line));
    let found: Vec<_> = diagnostics.located().collect();
    if found.iter().any(|item| is_own(item.place)) {
        Notice::InTheLine
    } else if found.iter().any(|item| item.others.iter().any(|other| is_own(other.place))) {
        Notice::BesideTheLine
    } else if found.is_empty() {
        Notice::Nothing
    } else {
        Notice::Elsewhere
    }
}
