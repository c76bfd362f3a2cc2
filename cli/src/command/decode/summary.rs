//! What a log holds, in numbers.

use std::collections::BTreeMap;
use std::io::{self, Write};

use canspec_codegen::interpret::{Decoded, Unrecognised};
use canspec_codegen::number::Rational;
use serde::Serialize;
use serde_json::value::RawValue;

use crate::log::{self, Asides};
use crate::show::columns::{self, Row};
use crate::show::outcome::{Outcome, Whole};

/// Counts of a log so far.
#[derive(Clone, Default)]
pub struct Summary {
    frames: u64,
    recognised: u64,
    span: Option<Span>,
    /// By protocol, message, access and kind.
    messages: BTreeMap<[String; 4], u64>,
    /// Messages that several frames carry, in the same way.
    wholes: BTreeMap<[String; 4], Wholes>,
    /// By rule.
    notes: BTreeMap<&'static str, Seen>,
    /// By identifier and problem.
    unrecognised: BTreeMap<(String, &'static str), (Seen, Reasons)>,
    /// Those beyond the most that are counted one by one, by problem.
    others: BTreeMap<&'static str, Seen>,
}

/// More counts of unrecognised frames than any bus has. Noise can have one a line.
const MOST: usize = 10_000;

/// How many messages came whole, and how many did not.
#[derive(Clone, Copy, Default)]
struct Wholes {
    whole: u64,
    incomplete: u64,
}

/// The first reasons, each once: by them registers with one identifier can be told apart.
#[derive(Clone, Default)]
struct Reasons {
    texts: Vec<String>,
    has_more: bool,
}

/// A count lists no more reasons.
const MOST_REASONS: usize = 5;

/// The first and the last time, as written and as numbers.
#[derive(Clone)]
struct Span {
    first: (f64, String),
    last: (f64, String),
}

impl Span {
    /// Returns how long it is, with the digits that the stamps have.
    fn seconds(&self) -> f64 {
        let [first, last] = [&self.first, &self.last].map(|(_, text)| Rational::parse(text));
        let exact = first.zip(last).and_then(|(first, last)| last.minus(first));
        exact.map_or_else(|| self.last.0 - self.first.0, Rational::to_f64)
    }
}

/// How many frames there were, and the line of the first.
#[derive(Clone)]
struct Seen {
    frames: u64,
    line: usize,
}

#[derive(Serialize)]
#[serde(tag = "summary", rename_all = "lowercase")]
enum Object<'a> {
    Log {
        frames: u64,
        recognised: u64,
        first: Option<&'a RawValue>,
        last: Option<&'a RawValue>,
        seconds: Option<f64>,
        rate: Option<f64>,
    },
    Message {
        protocol: &'a str,
        message: &'a str,
        access: &'a str,
        kind: &'a str,
        frames: u64,
        rate: Option<f64>,
    },
    Whole {
        protocol: &'a str,
        message: &'a str,
        access: &'a str,
        kind: &'a str,
        messages: u64,
        incomplete: u64,
        rate: Option<f64>,
    },
    Note {
        rule: &'a str,
        frames: u64,
        line: usize,
    },
    Dropped {
        frames: u64,
        lines: u64,
    },
    Comments {
        lines: u64,
    },
    Unrecognised {
        id: &'a str,
        problem: &'a str,
        frames: u64,
        line: usize,
        reasons: &'a [String],
    },
    Others {
        problem: &'a str,
        frames: u64,
        line: usize,
    },
}

impl Summary {
    /// Counts a frame, or a message that several frames carry.
    pub fn count(&mut self, outcome: &Outcome<'_>) {
        if let (Some(whole), Ok(decoded)) = (&outcome.whole, outcome.decoded) {
            return self.count_whole(outcome, decoded, whole);
        }
        self.frames += 1;
        self.see(outcome.time);
        match outcome.decoded {
            Ok(decoded) => self.recognise(outcome, decoded),
            Err(unrecognised) => self.fail(outcome, unrecognised),
        }
    }

    fn fail(&mut self, outcome: &Outcome<'_>, Unrecognised { problem, text, .. }: &Unrecognised) {
        let first = Seen::first(outcome.line);
        let key = (log::identifier_text(outcome.frame), problem.name());
        if self.unrecognised.len() == MOST && !self.unrecognised.contains_key(&key) {
            self.others.entry(problem.name()).or_insert(first).frames += 1;
            return;
        }
        let (seen, reasons) = self.unrecognised.entry(key).or_insert((first, Reasons::default()));
        seen.frames += 1;
        reasons.add(text);
    }

    fn recognise(&mut self, outcome: &Outcome<'_>, decoded: &Decoded) {
        self.recognised += 1;
        *self.messages.entry(names(outcome, decoded)).or_default() += 1;
        self.note(outcome, decoded);
    }

    fn count_whole(&mut self, outcome: &Outcome<'_>, decoded: &Decoded, whole: &Whole<'_>) {
        let known = self.wholes.entry(names(outcome, decoded)).or_default();
        *(if whole.incomplete.is_none() { &mut known.whole } else { &mut known.incomplete }) += 1;
        self.note(outcome, decoded);
    }

    /// Counts the rules of notes, each once.
    fn note(&mut self, outcome: &Outcome<'_>, decoded: &Decoded) {
        let mut rules: Vec<_> = decoded.notes.iter().map(|note| note.rule.name()).collect();
        rules.sort_unstable();
        rules.dedup();
        for rule in rules {
            self.notes.entry(rule).or_insert(Seen::first(outcome.line)).frames += 1;
        }
    }

    /// Makes the span reach a time.
    fn see(&mut self, time: Option<&str>) {
        let Some(time) = time else { return };
        let Ok(seconds) = time.parse::<f64>() else { return };
        let now = || (seconds, time.to_owned());
        match &mut self.span {
            None => self.span = Some(Span { first: now(), last: now() }),
            Some(span) if seconds < span.first.0 => span.first = now(),
            Some(span) if seconds > span.last.0 => span.last = now(),
            Some(_) => {}
        }
    }

    fn seconds(&self) -> Option<f64> {
        self.span.as_ref().map(Span::seconds)
    }

    /// Returns how many frames a second that is, if the log has a duration.
    #[expect(clippy::cast_precision_loss, reason = "no log has that many frames")]
    fn rate(&self, frames: u64) -> Option<f64> {
        self.seconds().filter(|seconds| *seconds > 0.0).map(|seconds| frames as f64 / seconds)
    }

    /// Returns messages, those with most frames first.
    fn messages(&self) -> Vec<(&[String; 4], u64)> {
        let mut messages: Vec<_> = self.messages.iter().map(|(key, frames)| (key, *frames)).collect();
        messages.sort_by_key(|(_, frames)| std::cmp::Reverse(*frames));
        messages
    }

    /// Returns unrecognised frames, the most frequent ones first.
    fn unrecognised(&self) -> Vec<(&str, &'static str, &Seen, &Reasons)> {
        let counts = self.unrecognised.iter();
        let mut unrecognised: Vec<_> =
            counts.map(|((id, problem), (seen, reasons))| (id.as_str(), *problem, seen, reasons)).collect();
        unrecognised.sort_by_key(|(_, _, seen, _)| std::cmp::Reverse(seen.frames));
        unrecognised
    }

    /// Writes a JSON object for each count.
    ///
    /// # Errors
    ///
    /// Where `out` cannot be written.
    pub fn write_jsonl(&self, asides: Asides, out: &mut impl Write) -> io::Result<()> {
        let span = self.span.as_ref();
        let first = span.and_then(|span| serde_json::from_str(&span.first.1).ok());
        let last = span.and_then(|span| serde_json::from_str(&span.last.1).ok());
        let Self { frames, recognised, .. } = *self;
        let log = Object::Log { frames, recognised, first, last, seconds: self.seconds(), rate: self.rate(frames) };
        let messages = self.messages().into_iter().map(|([protocol, message, access, kind], frames)| Object::Message {
            protocol,
            message,
            access,
            kind,
            frames,
            rate: self.rate(frames),
        });
        let wholes = self.wholes.iter().map(|([protocol, message, access, kind], Wholes { whole, incomplete })| {
            let (messages, incomplete) = (*whole, *incomplete);
            Object::Whole { protocol, message, access, kind, messages, incomplete, rate: self.rate(messages) }
        });
        let notes =
            self.notes.iter().map(|(rule, Seen { frames, line })| Object::Note { rule, frames: *frames, line: *line });
        let unrecognised = self.unrecognised().into_iter().map(|(id, problem, Seen { frames, line }, reasons)| {
            Object::Unrecognised { id, problem, frames: *frames, line: *line, reasons: &reasons.texts }
        });
        let others = self.others.iter();
        let others =
            others.map(|(problem, Seen { frames, line })| Object::Others { problem, frames: *frames, line: *line });
        let Asides { comments, drops, dropped } = asides;
        let dropped = (drops > 0).then_some(Object::Dropped { frames: dropped, lines: drops });
        let comments = (comments > 0).then_some(Object::Comments { lines: comments });
        let counts = messages.chain(wholes).chain(notes).chain(unrecognised).chain(others);
        for object in [log].into_iter().chain(counts).chain(dropped).chain(comments) {
            serde_json::to_writer(&mut *out, &object)?;
            writeln!(out)?;
        }
        Ok(())
    }

    /// Writes a table for each sort of count.
    ///
    /// # Errors
    ///
    /// Where `out` cannot be written.
    pub fn write_text(&self, asides: Asides, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "{}", self.headline())?;
        for line in spoken(asides) {
            writeln!(out, "{line}")?;
        }
        let row = |cells: Vec<String>, last: String| Row { cells, last: vec![last], separator: "", ..Row::default() };
        let messages = self.messages().into_iter().map(|([protocol, message, access, kind], frames)| {
            let names = [protocol, message, access, kind].map(String::clone);
            row([&names[..], &[frames.to_string()]].concat(), rounded(self.rate(frames)))
        });
        table(out, &["PROTOCOL", "MESSAGE", "ACCESS", "KIND", "FRAMES"], "A SECOND", &messages.collect::<Vec<_>>())?;
        let wholes = self.wholes.iter().map(|(names, Wholes { whole, incomplete })| {
            let counts = [whole, incomplete].map(u64::to_string);
            row([&names[..], &counts].concat(), rounded(self.rate(*whole)))
        });
        let headings = ["PROTOCOL", "LONG MESSAGE", "ACCESS", "KIND", "WHOLE", "INCOMPLETE"];
        table(out, &headings, "WHOLE A SECOND", &wholes.collect::<Vec<_>>())?;
        let notes = self.notes.iter();
        let notes =
            notes.map(|(rule, seen)| row(vec![(*rule).to_owned(), seen.frames.to_string()], seen.line.to_string()));
        table(out, &["NOTE", "FRAMES"], "FIRST LINE", &notes.collect::<Vec<_>>())?;
        let unrecognised = self.unrecognised().into_iter().map(|(id, problem, seen, reasons)| {
            let cells = vec![id.to_owned(), problem.to_owned(), seen.frames.to_string(), seen.line.to_string()];
            Row { cells, last: reasons.words(), separator: " ", ..Row::default() }
        });
        let others = self.others.iter().map(|(problem, seen)| {
            let cells = ["others", problem, &seen.frames.to_string(), &seen.line.to_string()].map(str::to_owned);
            row(cells.to_vec(), format!("only the first {MOST} are counted one by one"))
        });
        let headings = ["UNRECOGNISED", "PROBLEM", "FRAMES", "FIRST LINE"];
        table(out, &headings, "REASONS", &unrecognised.chain(others).collect::<Vec<_>>())
    }

    /// Says how many frames there are, in which time.
    fn headline(&self) -> String {
        let Self { frames, recognised, .. } = self;
        let noun = if *frames == 1 { "frame" } else { "frames" };
        let count = format!("{frames} {noun}, {recognised} recognised");
        match (&self.span, self.seconds(), self.rate(*frames)) {
            (Some(span), Some(seconds), Some(rate)) => {
                let (first, last) = (&span.first.1, &span.last.1);
                format!("{count}, {rate:.2} a second in {seconds:.3} s from {first} to {last}")
            }
            _ => count,
        }
    }
}

/// Returns protocol, message, access and kind.
fn names(outcome: &Outcome<'_>, decoded: &Decoded) -> [String; 4] {
    let protocol = outcome.protocol;
    let (message, access) = (&protocol.messages[decoded.message].name, &protocol.accesses[decoded.access].name);
    [&protocol.name, message, access, decoded.kind.name()].map(str::to_owned)
}

/// Says which lines were no frames.
fn spoken(Asides { comments, drops, dropped }: Asides) -> impl Iterator<Item = String> {
    let counted = |count: u64, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
    let lost =
        (drops > 0).then(|| format!("{} lost by candump, in {}", counted(dropped, "frame"), counted(drops, "line")));
    lost.into_iter().chain((comments > 0).then(|| counted(comments, "comment")))
}

/// Shows a rate, which a log without stamps does not have.
fn rounded(rate: Option<f64>) -> String {
    rate.map_or_else(|| "-".to_owned(), |rate| format!("{rate:.2}"))
}

fn table(out: &mut impl Write, headings: &[&str], last: &str, rows: &[Row]) -> io::Result<()> {
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out)?;
    columns::write(out, headings, last, rows)
}

impl Seen {
    /// Begins to count with the frame in this line.
    fn first(line: usize) -> Self {
        Self { frames: 0, line }
    }
}

impl Reasons {
    fn add(&mut self, text: &str) {
        if self.texts.iter().any(|known| known == text) {
            return;
        }
        if self.texts.len() < MOST_REASONS {
            self.texts.push(text.to_owned());
        } else {
            self.has_more = true;
        }
    }

    /// Returns the words of all reasons.
    fn words(&self) -> Vec<String> {
        let more = if self.has_more { "; ..." } else { "" };
        let text = self.texts.join("; ") + more;
        text.split(' ').map(str::to_owned).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_duration_has_the_digits_of_the_stamps() {
        let at = |text: &str| (text.parse().expect("a number"), text.to_owned());
        let seconds = |first, last| Span { first: at(first), last: at(last) }.seconds().to_string();
        assert_eq!(seconds("1700000000.000001", "1700000006.399080"), "6.399079");
        assert_eq!(seconds("1700000000", "1.7e9"), "0");
    }
}
