#![doc = include_str!("../rules/example.md")]
#![doc = include_str!("../rules/expected_failure.md")]

mod contradiction;

use std::collections::HashSet;

use contradiction::Contradiction;

use crate::diagnostic::{At, Diagnostic, Diagnostics};
use crate::interpret::{
    Content, Decoded, Frame, Input, Note, Problem, Unrecognised, Value, decode, encode, hex, physical,
};
use crate::model::{Example, Failure, Kind, Meaning, Message, Protocol, Signal, ValueExample};
use crate::syntax::tree::Path;

/// How many examples hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// With identifier and data, decoded and encoded back.
    pub frames: usize,
    /// Printed without data.
    pub identifiers: usize,
    /// Printed forms that fail as stated.
    pub expected_failures: usize,
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) -> Counts {
    let mut counts = Counts::default();
    let contradictions = contradiction::find(protocol);
    for (field, contradiction) in &contradictions {
        diagnostics.push(contradiction::report(protocol, *field, contradiction));
    }
    let explained: HashSet<&Path> = contradictions.values().flat_map(Contradiction::places).collect();
    let is_explained = |at: &At| matches!(at, At::Value(path) if explained.contains(path));
    for example in &protocol.examples {
        let checked = Checker { protocol, example };
        match (checked.run(), example.fails, &example.data) {
            (Err(diagnostic), _, _) if is_explained(&diagnostic.at) => {}
            (Err(diagnostic), _, _) => diagnostics.push(*diagnostic),
            (Ok(()), Some(_), _) => counts.expected_failures += 1,
            (Ok(()), None, Some(_)) => counts.frames += 1,
            (Ok(()), None, None) => counts.identifiers += 1,
        }
    }
    for example in &protocol.value_examples {
        check_value(protocol, example, diagnostics);
    }
    counts
}

/// A check of one example; the diagnostic is boxed because it is large.
type Checked = Result<(), Box<Diagnostic>>;

struct Checker<'a> {
    protocol: &'a Protocol,
    example: &'a Example,
}

impl<'a> Checker<'a> {
    fn run(&self) -> Checked {
        let outcome = decode(self.protocol, self.example.model, &self.frame());
        match (self.example.fails, outcome) {
            (Some(failure), outcome) => self.fails(failure, outcome),
            (None, Err(problem)) => Err(self.unreadable(&problem)),
            (None, Ok(decoded)) => self.holds(&decoded),
        }
    }

    fn frame(&self) -> Frame {
        Frame::of(self.protocol, self.example)
    }

    fn frame_at(&self) -> At {
        self.example.doc.path.key(self.example.kind.name()).at_value()
    }

    fn unreadable(&self, problem: &Unrecognised) -> Box<Diagnostic> {
        let text = format!("this frame cannot be read: {}", problem.text);
        let help = format!("if the document prints it so, add `fails: {}` and an erratum", problem.problem.name());
        Box::new(Diagnostic::error("example", self.frame_at(), text).help(help))
    }

    fn holds(&self, decoded: &Decoded) -> Checked {
        self.is_message(decoded)?;
        self.is_addressed(decoded)?;
        if self.example.data.is_none() {
            return Ok(());
        }
        self.has_values(decoded)?;
        self.has_notes(decoded)?;
        self.encodes_back(decoded)
    }

    fn is_message(&self, decoded: &Decoded) -> Checked {
        let shown = &self.protocol.messages[decoded.message];
        if Some(decoded.message) == self.example.message && decoded.kind == self.example.kind {
            return Ok(());
        }
        let said = self.example.message.map_or("another message", |message| &self.protocol.messages[message].name);
        let (found, stated) = (decoded.kind.name(), self.example.kind.name());
        let text = format!("this frame is a {found} of `{}`, not a {stated} of `{said}`", shown.name);
        Err(wrong(self.frame_at(), text))
    }

    fn is_addressed(&self, decoded: &Decoded) -> Checked {
        let expected = |rule: &str| self.example.notes.iter().any(|note| note == rule);
        let note = decoded.notes.iter().find(|note| note.rule == "addressing" && !expected(note.rule));
        note.map_or(Ok(()), |note| Err(self.unexpected(note)))
    }

    /// Compares value by value.
    fn has_values(&self, decoded: &Decoded) -> Checked {
        let message = &self.protocol.messages[decoded.message];
        if let Some((meaning, signal)) = self.first_difference(decoded, message) {
            let reading = decoded.signals.iter().find(|reading| reading.signal == meaning.signal);
            let text = reading.map_or_else(
                || format!("a {} has no signal `{}`", decoded.kind.name(), signal.name),
                |reading| {
                    let read = shown(self.protocol, signal, &reading.value, reading.bits);
                    format!("`{}` is {} here, but the frame says {read}", signal.name, meaning.text)
                },
            );
            let diagnostic = Diagnostic::error("example", meaning.path.at_value(), text);
            return Err(Box::new(diagnostic.other(signal.doc.path.at_key(), "the field")));
        }
        let silent = decoded.signals.iter().find(|reading| self.meaning(reading.signal).is_none());
        match silent {
            None => Ok(()),
            Some(reading) => {
                let signal = &message.signals[reading.signal];
                let read = shown(self.protocol, signal, &reading.value, reading.bits);
                let text = format!("`means` says nothing of `{}`, which is {read}", signal.name);
                Err(wrong(self.example.doc.path.key("means").at_key(), text))
            }
        }
    }

    fn meaning(&self, signal: usize) -> Option<&Meaning> {
        self.example.means.iter().find(|meaning| meaning.signal == signal)
    }

    /// Finds the first value that the frame does not show.
    fn first_difference<'m>(&self, decoded: &Decoded, message: &'m Message) -> Option<(&'a Meaning, &'m Signal)> {
        let differs = |meaning: &&Meaning| {
            let reading = decoded.signals.iter().find(|reading| reading.signal == meaning.signal);
            reading.is_none_or(|reading| Some(reading.bits) != meaning.raw)
        };
        let meaning = self.example.means.iter().find(differs)?;
        Some((meaning, &message.signals[meaning.signal]))
    }

    fn has_notes(&self, decoded: &Decoded) -> Checked {
        let unexpected = decoded.notes.iter().find(|note| !self.example.notes.iter().any(|rule| rule == note.rule));
        if let Some(note) = unexpected {
            return Err(self.unexpected(note));
        }
        let missing = |rule: &String| !decoded.notes.iter().any(|note| note.rule == rule);
        self.example.notes.iter().position(missing).map_or(Ok(()), |index| Err(self.missing(index, decoded)))
    }

    fn unexpected(&self, note: &Note) -> Box<Diagnostic> {
        let text = format!("this frame has the note `{}`: {}", note.rule, note.text);
        let help = format!("if the document shows it so, add `{}` to its `notes`", note.rule);
        Box::new(Diagnostic::error("example", self.frame_at(), text).help(help))
    }

    fn missing(&self, index: usize, decoded: &Decoded) -> Box<Diagnostic> {
        let text = format!("this frame has no note `{}`", self.example.notes[index]);
        let notes: Vec<_> = decoded.notes.iter().map(|note| format!("`{}`", note.rule)).collect();
        let help = if notes.is_empty() { "it has none".to_owned() } else { format!("it has {}", notes.join(", ")) };
        let at = self.example.doc.path.key("notes").index(index).at_value();
        Box::new(Diagnostic::error("example", at, text).help(help))
    }

    fn encodes_back(&self, decoded: &Decoded) -> Checked {
        let content = Content::of(self.protocol, decoded);
        let frame = self.frame();
        match encode(self.protocol, self.example.model, &content) {
            Ok(encoded) if encoded == frame => Ok(()),
            Ok(encoded) => {
                let text =
                    format!("it encodes back to other bytes: {} instead of {}", hex(&encoded.data), hex(&frame.data));
                Err(wrong(self.frame_at(), text))
            }
            Err(_) if decoded.kind == Kind::Request && !self.example.notes.is_empty() => Ok(()),
            Err(refusal) => Err(wrong(self.frame_at(), format!("it does not encode back: {refusal}"))),
        }
    }

    /// Tests that the printed form fails as stated.
    fn fails(&self, failure: Failure, outcome: Result<Decoded, Unrecognised>) -> Checked {
        let seen = self.seen(&outcome);
        if seen == Some(failure) {
            return Ok(());
        }
        let text = match (seen, outcome) {
            (None, _) => "this frame does not fail".to_owned(),
            (Some(seen), Err(problem)) => format!("this frame fails as `{}`: {}", seen.name(), problem.text),
            (Some(seen), Ok(_)) => format!("this frame fails as `{}`", seen.name()),
        };
        let help = match seen {
            None => "remove `fails`, or correct the frame or its meaning".to_owned(),
            Some(seen) => format!("write `fails: {}`, or correct the frame", seen.name()),
        };
        let at = self.example.doc.path.key("fails").at_value();
        Err(Box::new(Diagnostic::error("expected_failure", at, text).help(help)))
    }

    /// Returns how a frame fails in fact.
    fn seen(&self, outcome: &Result<Decoded, Unrecognised>) -> Option<Failure> {
        let decoded = match outcome {
            Err(problem) => {
                return match problem.problem {
                    Problem::Foreign => Some(Failure::Foreign),
                    Problem::Frame | Problem::Identifier => Some(Failure::Identifier),
                    Problem::Length => Some(Failure::Length),
                    Problem::UnknownMessage => Some(Failure::UnknownMessage),
                };
            }
            Ok(decoded) => decoded,
        };
        let message = &self.protocol.messages[decoded.message];
        if self.is_message(decoded).is_err() {
            Some(Failure::Message)
        } else if self.is_addressed(decoded).is_err() {
            Some(Failure::Addressing)
        } else if self.first_difference(decoded, message).is_some() {
            Some(Failure::Values)
        } else {
            None
        }
    }
}

/// Shows a value as a spec writes it.
fn shown(protocol: &Protocol, signal: &Signal, value: &Value, bits: u64) -> String {
    let unit = signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
    match Input::of(protocol, signal, value, bits) {
        Input::Raw(raw) => format!("raw {raw:#X}"),
        Input::Integer(value) => format!("{value}{unit}"),
        Input::Number(value) => format!("{value}{unit}"),
        Input::Text(text) => text,
        Input::Status { set, unknown: 0 } => format!("[{}]", set.join(", ")),
        Input::Status { set, unknown } => format!("[{}] and {unknown:#X}", set.join(", ")),
    }
}

fn wrong(at: At, text: String) -> Box<Diagnostic> {
    Box::new(Diagnostic::error("example", at, text))
}

/// Runs an example of a type: bytes alone, and what they mean.
fn check_value(protocol: &Protocol, example: &ValueExample, diagnostics: &mut Diagnostics) {
    let bits = example.signal.place.get(&example.data);
    if example.meaning.raw.is_some_and(|raw| raw != bits) {
        let value = physical(protocol, &example.signal, bits);
        let read = shown(protocol, &example.signal, &value, bits);
        let text = format!("these bytes say {read}, not {}", example.meaning.text);
        diagnostics.push(Diagnostic::error("example", example.meaning.path.at_value(), text));
    }
}
