#![doc = include_str!("../../docs/rules/example.md")]
#![doc = include_str!("../../docs/rules/expected_failure.md")]

mod accused;
mod byte_order;
mod evidence;
mod limit;
mod long;
mod repair;
mod unproven;
mod unread;
mod unreadable;

pub use self::unproven::{Unproven, unproven};
use self::unreadable::Slip;
use super::overlap::bits;
use crate::encoding::{about_offset, escape, value_of_bytes};
use crate::interpret::{Content, Decoded, Frame, Input, Note, Problem, Reading, Unrecognised, Value, decode, encode};
use crate::model::{Example, Failure, Meaning, Message, Misfit, NoteRule, Protocol, Side, Signal, ValueExample};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::resolve::rules;
use crate::words::hex;

crate::report::rule::rules! {
    EXPECTED_FAILURE "expected_failure" Check ERROR;
}

/// How many examples hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// With identifier and data, decoded and encoded back.
    pub frames: usize,
    /// Printed without data.
    pub identifiers: usize,
    /// Printed forms that fail as stated.
    pub expected_failures: usize,
    /// Values in frames that their examples do not state.
    pub unproven: usize,
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) -> Counts {
    let documented = protocol.documented();
    let protocol = &*documented;
    let mut counts = Counts::default();
    let mut explained = accused::blame(protocol, diagnostics);
    for (message, frames) in unread::find(protocol) {
        diagnostics.push(unread::report(protocol, message, &frames));
        explained.extend(frames.into_iter().map(unread::place));
    }
    let is_explained = |diagnostic: &Diagnostic| {
        let others = diagnostic.others.iter().map(|(at, _)| at);
        others.chain([&diagnostic.at]).any(|at| matches!(at, At::Value(path) if explained.contains(path)))
    };
    for example in &protocol.examples {
        let checked = Checker { protocol, example, diagnostics: &*diagnostics };
        match (checked.run(), example.fails, &example.data) {
            (Err(diagnostic), _, _) if is_explained(&diagnostic) => {}
            // Several frames can show the same mistake of a message.
            (Err(diagnostic), _, _) if diagnostic.rule == &rules::EXAMPLE => diagnostics.push_first(*diagnostic),
            (Err(diagnostic), _, _) => diagnostics.push(*diagnostic),
            (Ok(()), Some(_), _) => counts.expected_failures += 1,
            (Ok(()), None, Some(_)) => counts.frames += 1,
            (Ok(()), None, None) => counts.identifiers += 1,
        }
    }
    for example in &protocol.long_examples {
        match long::check(protocol, example) {
            Ok(()) => counts.frames += example.frames.len(),
            Err(diagnostic) => diagnostics.push(*diagnostic),
        }
    }
    counts.unproven = unproven(protocol).map(|of| of.signals.len()).sum();
    for example in &protocol.value_examples {
        check_value(protocol, example, diagnostics);
    }
    counts
}

/// Tests that every text of an example is a value of its signal, unless the signal has an error of
/// its own.
pub fn check_texts(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for example in &protocol.examples {
        let Some(message) = example.message.map(|index| &protocol.messages[index]) else { continue };
        for meaning in &example.means {
            let field = &message.signals[meaning.signal].doc.path;
            if let Err(misfit) = &meaning.said
                && !diagnostics.has_errors_in(field)
            {
                diagnostics.push(no_value(meaning, misfit).other(field.at_key(), "the field"));
            }
        }
    }
}

/// The result of a check. The diagnostic is boxed because it is large.
type Checked = Result<(), Box<Diagnostic>>;

struct Checker<'a> {
    protocol: &'a Protocol,
    example: &'a Example,
    diagnostics: &'a Diagnostics,
}

impl<'a> Checker<'a> {
    fn run(&self) -> Checked {
        let outcome = decode(self.protocol, self.example.model, &self.frame());
        match (self.example.fails, outcome) {
            (Some(failure), outcome) => self.fits().and_then(|()| self.fails(failure, outcome)),
            (None, Err(problem)) => Err(Box::new(unreadable::report(self.protocol, self.example, &problem))),
            (None, Ok(decoded)) => self.holds(&decoded),
        }
    }

    fn frame(&self) -> Frame {
        Frame::of(self.protocol, self.example)
    }

    fn frame_at(&self) -> At {
        self.example.doc.path.key(self.example.kind.name()).at_value()
    }

    fn holds(&self, decoded: &Decoded) -> Checked {
        self.is_message(decoded)?;
        self.is_addressed(decoded)?;
        self.fits()?;
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
        let diagnostic = *wrong(self.frame_at(), text);
        Err(Box::new(match Slip::find(self.protocol, self.example) {
            Some(slip) => slip.mark(diagnostic),
            None => diagnostic,
        }))
    }

    fn is_addressed(&self, decoded: &Decoded) -> Checked {
        let expected = |rule: NoteRule| self.example.notes.contains(&rule);
        let note = decoded.notes.iter().find(|note| note.rule == NoteRule::Addressing && !expected(note.rule));
        note.map_or(Ok(()), |note| Err(self.unexpected(note, decoded)))
    }

    /// Tests that every text is a value of its signal.
    fn fits(&self) -> Checked {
        let Some(message) = self.example.message.map(|index| &self.protocol.messages[index]) else { return Ok(()) };
        let misfit = self.example.means.iter().find_map(|meaning| Some((meaning, meaning.said.as_ref().err()?)));
        misfit.map_or(Ok(()), |(meaning, misfit)| {
            let its = self.protocol.examples.iter().filter(|other| other.message == self.example.message);
            let means = its.flat_map(|other| &other.means);
            Err(Box::new(misfitting(means, &message.signals[meaning.signal], meaning, misfit)))
        })
    }

    /// Compares value by value.
    fn has_values(&self, decoded: &Decoded) -> Checked {
        let message = &self.protocol.messages[decoded.message].on(self.example.model);
        if let Some((meaning, signal)) = self.first_difference(decoded, message) {
            let reading = decoded.signals.iter().find(|reading| reading.signal == meaning.signal);
            let field = (signal.doc.path.at_key(), "the field");
            let Some(reading) = reading else {
                let text = format!("a {} has no signal `{}`", decoded.kind.name(), signal.name);
                return Err(contradicted(meaning.path.at_value(), text, field));
            };
            let read = shown(self.protocol, signal, reading);
            let diagnostic = if self.is_slip_in_frame(signal, meaning, &read) {
                let text = format!("this frame says {read} for `{}`, one digit from {}", signal.name, meaning.text);
                contradicted(self.frame_at(), text, (meaning.path.at_value(), "what it means"))
            } else {
                let [meant, read] = with_blanks(&meaning.text, &read);
                let text = format!("`{}` is {meant} here, but the frame says {read}", signal.name);
                contradicted(meaning.path.at_value(), text, field)
            };
            let help = fill(&reading.value, &meaning.text)
                .or_else(|| self.by_other_order(signal))
                .or_else(|| unnamed_bits(&reading.value, &read));
            let Some(about_offset) = about_offset(signal).filter(|_| help.is_none()) else {
                return Err(Box::new(diagnostic.help_if(help)));
            };
            return Err(Box::new(match self.possible_offset(signal, &meaning.text, reading.bits) {
                Some((offset, at)) => diagnostic.other(at, "the offset").help(format!("{about_offset}; {offset}")),
                None => diagnostic.help(about_offset),
            }));
        }
        let silent = decoded.signals.first().filter(|_| self.example.means.is_empty());
        match silent {
            None => Ok(()),
            Some(reading) => {
                let signal = &message.signals[reading.signal];
                let read = shown(self.protocol, signal, reading);
                let text =
                    format!("the example does not say what `{}` means, which is {read} in this frame", signal.name);
                let diagnostic = wrong(self.example.doc.path.key("means").at_key(), text);
                Err(Box::new(diagnostic.help_if(self.by_other_order(signal))))
            }
        }
    }

    /// Names the offset that explains the difference, and the place of the present one.
    fn possible_offset(&self, signal: &Signal, text: &str, bits: u64) -> Option<(String, At)> {
        let offset = repair::offset_of(signal, text, bits)?.fraction();
        let at = evidence::written(signal, "offset", self.diagnostics)?;
        Some((format!("`offset: {offset}` would explain this example"), at.at_value()))
    }

    fn by_other_order(&self, signal: &Signal) -> Option<String> {
        byte_order::explain(self.protocol, signal, self.frame().padded())
    }

    /// Tests whether a digit of the frame is probably wrong, and not one of the text.
    fn is_slip_in_frame(&self, signal: &Signal, meaning: &Meaning, read: &str) -> bool {
        let Some(raw) = meaning.bits() else { return false };
        evidence::digits_apart(signal, self.frame().padded(), raw) == 1 && strsim::osa_distance(&meaning.text, read) > 1
    }

    /// Finds the first value that the frame does not show.
    fn first_difference<'m>(&self, decoded: &Decoded, message: &'m Message) -> Option<(&'a Meaning, &'m Signal)> {
        let differs = |meaning: &&Meaning| {
            let reading = decoded.signals.iter().find(|reading| reading.signal == meaning.signal);
            reading.is_none_or(|reading| !meaning.is(&message[meaning.signal], reading.bits))
        };
        let meaning = self.example.means.iter().find(differs)?;
        Some((meaning, &message.signals[meaning.signal]))
    }

    fn has_notes(&self, decoded: &Decoded) -> Checked {
        let unexpected = decoded.notes.iter().find(|note| !self.example.notes.contains(&note.rule));
        if let Some(note) = unexpected {
            let diagnostic = self.unexpected(note, decoded);
            let reserved = (note.rule == NoteRule::ReservedBit).then(|| u64::from_be_bytes(decoded.reserved));
            return Err(match reserved {
                Some(reserved) => Box::new(diagnostic.label(bits(reserved))),
                None => diagnostic,
            });
        }
        let missing = |rule: &NoteRule| !decoded.notes.iter().any(|note| note.rule == *rule);
        self.example.notes.iter().position(missing).map_or(Ok(()), |index| Err(self.missing(index, decoded)))
    }

    fn unexpected(&self, note: &Note, decoded: &Decoded) -> Box<Diagnostic> {
        if let Some(diagnostic) = self.limit(note.rule, decoded, self.frame_at()) {
            return Box::new(diagnostic);
        }
        let text = format!("this frame has the note `{}`: {}", note.rule, note.text);
        let mut signals = decoded.signals.iter().map(|reading| &self.protocol[decoded.message][reading.signal]);
        let by_other_order = signals.find_map(|signal| self.by_other_order(signal)).filter(|_| note.is_about_value());
        let by_notes = || {
            let so = format!("if the document shows it so, add `{}` to its `notes`", note.rule);
            if note.rule == NoteRule::ReservedBit {
                "add the field that has these bits; \
                 if the document reserves them and prints them set, add `reserved_bit` to its `notes`"
                    .to_owned()
            } else if note.rule == NoteRule::UnknownValue && self.has_nameless(decoded) {
                format!("name the value; or add a `range` if these are numbers with a few named values; {so}")
            } else {
                so
            }
        };
        let help = by_other_order.unwrap_or_else(by_notes);
        Box::new(Diagnostic::error(&rules::EXAMPLE, self.frame_at(), text).help(help))
    }

    /// Tests whether a signal of named values has a value without a name.
    fn has_nameless(&self, decoded: &Decoded) -> bool {
        let message = &self.protocol[decoded.message];
        let is_named = |reading: &&Reading| message[reading.signal].encoding.enumeration().is_some();
        decoded.signals.iter().filter(is_named).any(|reading| reading.value == Value::None)
    }

    fn missing(&self, index: usize, decoded: &Decoded) -> Box<Diagnostic> {
        let rule = self.example.notes[index];
        let at = self.example.doc.path.key("notes").index(index).at_value();
        if let Some(diagnostic) = self.limit(rule, decoded, at.clone()) {
            return Box::new(diagnostic);
        }
        let text = format!("this frame has no note `{rule}`");
        let notes: Vec<_> = decoded.notes.iter().map(|note| format!("`{}`", note.rule)).collect();
        let help = match notes.as_slice() {
            [] => "take it out: the frame has no note".to_owned(),
            _ => format!("take it out: the frame has only {}", notes.join(", ")),
        };
        Box::new(Diagnostic::error(&rules::EXAMPLE, at, text).help(help))
    }

    /// Blames the range for a missing note, or for one that the example does not state.
    fn limit(&self, rule: NoteRule, decoded: &Decoded, at: At) -> Option<Diagnostic> {
        if rule == NoteRule::OutOfRange { limit::report(self.protocol, self.example, decoded, at) } else { None }
    }

    fn encodes_back(&self, decoded: &Decoded) -> Checked {
        let content = Content::of(self.protocol, decoded);
        let frame = self.frame();
        match encode(self.protocol, self.example.model, &content) {
            Ok(encoded) if encoded == frame => Ok(()),
            Ok(encoded) => Err(wrong(self.frame_at(), format!("it encodes back to {encoded} instead of {frame}"))),
            Err(_) if decoded.sender == Side::Controller && !self.example.notes.is_empty() => Ok(()),
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
        Err(Box::new(Diagnostic::error(&EXPECTED_FAILURE, at, text).help(help)))
    }

    /// Returns how a frame really fails.
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
        let message = &self.protocol.messages[decoded.message].on(self.example.model);
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
fn shown(protocol: &Protocol, signal: &Signal, reading: &Reading) -> String {
    let unit = signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
    match Input::of(protocol, signal, reading) {
        Input::Raw(raw) => format!("raw {raw:#X}"),
        Input::Integer(value) => format!("{value}{unit}"),
        Input::Number(value) => format!("{value}{unit}"),
        Input::Text(text) => escape::written(&text),
        Input::Bytes { bytes, .. } => {
            if let Value::Text(text) = value_of_bytes(signal, &bytes) {
                escape::written(&text)
            } else {
                format!("raw 0x{}", hex::digits(&bytes))
            }
        }
        Input::Status { set, unknown } => {
            let numbers = (0..64).filter(|bit| unknown >> bit & 1 == 1).map(|bit: u8| bit.to_string());
            format!("[{}]", set.into_iter().chain(numbers).collect::<Vec<_>>().join(", "))
        }
    }
}

/// Shows the ends of two texts if only blanks tell them apart.
fn with_blanks(meant: &str, read: &str) -> [String; 2] {
    let is_alike = meant.trim() == read.trim();
    [meant, read].map(|text| if is_alike { format!("`{text}`") } else { text.to_owned() })
}

/// Says which byte fills up a text that is longer than the one that is meant.
fn fill(value: &Value, meant: &str) -> Option<String> {
    let Value::Text(read) = value else { return None };
    let rest = read.strip_prefix(meant)?;
    let byte = rest.bytes().next().filter(|byte| !byte.is_ascii_alphanumeric())?;
    rest.bytes().all(|other| other == byte).then(|| {
        format!(
            "if the byte {byte:#04X} fills up the text, write `fill: {byte:#04X}` in the field; else add it to the text"
        )
    })
}

/// Says how to write a status bit without a name in an example.
fn unnamed_bits(value: &Value, read: &str) -> Option<String> {
    let is_unnamed = matches!(value, Value::Status { unknown, .. } if *unknown != 0);
    is_unnamed.then(|| {
        format!(
            "a number is a bit without a name: name it in the status word, or write `{read}` and `notes: [unknown_bit]`"
        )
    })
}

fn wrong(at: At, text: String) -> Box<Diagnostic> {
    Box::new(Diagnostic::error(&rules::EXAMPLE, at, text))
}

fn contradicted(at: At, text: String, (other, what): (At, &str)) -> Box<Diagnostic> {
    Box::new(Diagnostic::error(&rules::EXAMPLE, at, text).other(other, what))
}

/// Says that a text is no value of its signal. If no example has one of several, the field is at fault.
fn misfitting<'m>(
    means: impl Iterator<Item = &'m Meaning>,
    signal: &Signal,
    meaning: &Meaning,
    misfit: &Misfit,
) -> Diagnostic {
    let field = signal.doc.path.at_key();
    let said: Vec<_> = means.filter(|other| other.signal == meaning.signal).map(|other| other.said.is_err()).collect();
    let diagnostic = no_value(meaning, misfit);
    if said.len() < 2 || said.contains(&false) {
        return diagnostic.other(field, "the field");
    }
    let Misfit { why, help } = misfit.clone();
    Diagnostic::error(&rules::VALUE, field, why).help_if(help).other(meaning.path.at_value(), "a value")
}

/// Says that a text is no value of its signal.
fn no_value(meaning: &Meaning, misfit: &Misfit) -> Diagnostic {
    let Misfit { why, help } = misfit.clone();
    Diagnostic::error(&rules::VALUE, meaning.path.at_value(), why).help_if(help)
}

/// Runs an example of a type, which has only bytes and their meaning.
fn check_value(protocol: &Protocol, example: &ValueExample, diagnostics: &mut Diagnostics) {
    let bits = example.signal.place.get(&example.data);
    match &example.meaning.said {
        Err(misfit) => diagnostics.push(no_value(&example.meaning, misfit)),
        Ok(said) if !said.is(&example.signal, bits) => {
            let reading = Reading::of(protocol, (example.meaning.signal, &example.signal), bits);
            let read = shown(protocol, &example.signal, &reading);
            let text = format!("these bytes say {read}, not {}", example.meaning.text);
            diagnostics.push(Diagnostic::error(&rules::EXAMPLE, example.meaning.path.at_value(), text));
        }
        Ok(_) => {}
    }
}
