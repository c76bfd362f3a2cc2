//! Says why the frame of an example cannot be read, and what is probably wrong.

use crate::interpret::{Frame, Problem, Unrecognised, failed_tests};
use crate::model::{Constant, Example, FieldTest, FrameLayout, Kind, Protocol, SelectorPlace};
use crate::report::diagnostic::{At, Diagnostic};
use crate::resolve::rules;

/// Reports an example whose frame is not recognised.
pub fn report(protocol: &Protocol, example: &Example, problem: &Unrecognised) -> Diagnostic {
    let at = example.doc.path.key(example.kind.name()).at_value();
    let text = format!("this frame cannot be read: {}", problem.text);
    let wrongly = format!("if the document prints it wrongly, add `fails: {}` and an erratum", problem.problem.name());
    match (problem.problem, &example.data) {
        (Problem::Length, Some(data)) => {
            let length = data.len();
            let bytes = if length == 1 { "byte" } else { "bytes" };
            let help = format!("if the message has {length} data {bytes}, write `length: {length}` in it; {wrongly}");
            match other_length(protocol, example, length) {
                None => Diagnostic::error(&rules::EXAMPLE, at, text).help(help),
                Some((place, text)) => Diagnostic::error(&rules::EXAMPLE, place, text).other(at, "a frame").help(help),
            }
        }
        (Problem::Identifier, _) => undirected(protocol, example, at.clone(), &wrongly)
            .unwrap_or_else(|| Diagnostic::error(&rules::EXAMPLE, at, text).help(otherwise(problem))),
        (Problem::UnknownMessage, _) => {
            let diagnostic = Diagnostic::error(&rules::EXAMPLE, at, text);
            match Slip::find(protocol, example) {
                Some(slip) => slip.mark(diagnostic),
                None => diagnostic.help(otherwise(problem)),
            }
        }
        _ => Diagnostic::error(&rules::EXAMPLE, at, text).help(otherwise(problem)),
    }
}

/// Finds the length of a message if no frame of its examples has it, or several have another one.
fn other_length(protocol: &Protocol, example: &Example, length: usize) -> Option<(At, String)> {
    let message = &protocol[example.message?];
    let its = protocol.examples.iter().filter(|other| other.message == example.message && other.fails.is_none());
    let its: Vec<_> = its.filter_map(|other| other.data.as_ref()).map(Vec::len).collect();
    let others = its.iter().filter(|other| **other == length).count();
    let bytes = if length == 1 { "byte" } else { "bytes" };
    let which = if others == its.len() { "all" } else { "several" };
    let text = format!("{which} examples of `{}` have {length} data {bytes}", message.name);
    (others == its.len() || others > 1).then(|| (message.doc.path.key("length").at_value(), text))
}

fn otherwise(problem: &Unrecognised) -> String {
    format!("if the document prints it so, add `fails: {}` and an erratum", problem.problem.name())
}

/// Names the field that does not show the direction of the frame, and what it may be.
fn undirected(protocol: &Protocol, example: &Example, at: At, wrongly: &str) -> Option<Diagnostic> {
    let frame = Frame::of(protocol, example);
    let identifier = &protocol.identifier;
    if frame.extended != identifier.extended || frame.id & identifier.mask != identifier.value {
        return None;
    }
    let tests = failed_tests(protocol, &frame, is_to_module(protocol, example));
    let FieldTest { field, inside, .. } = tests.first()?;
    let ranges: Vec<_> = tests.iter().flat_map(|test| &test.ranges).collect();
    let shown = |(first, last): &&(u32, u32)| {
        if first == last { format!("{first:#04X}") } else { format!("{first:#04X}..{last:#04X}") }
    };
    let allowed = ranges.iter().map(shown).collect::<Vec<_>>().join(" or ");
    let (name, found, kind) = (&protocol[*field].name, protocol[*field].get(frame.id), example.kind.name());
    let has = if *inside { "has" } else { "never has" };
    let text = format!("`{name}` is {found:#04X}, where a {kind} {has} {allowed}");
    let is_named = |range: &(u32, u32)| ranges.contains(&range);
    let mut types =
        protocol.address_types.iter().filter(|known| known.strict && known.raw_ranges().iter().any(is_named));
    let diagnostic = Diagnostic::error(&rules::EXAMPLE, at, text);
    Some(match types.next() {
        Some(known) => diagnostic.other(known.doc.path.key(known.key()).at_value(), "its addresses").help(format!(
            "correct the frame, or the {} of the type `{}`; {wrongly}",
            known.key(),
            known.name
        )),
        None => diagnostic.help(format!("correct the frame, or add an addressing mode for it; {wrongly}")),
    })
}

/// Tests whether the frame of an example should go to a module.
fn is_to_module(protocol: &Protocol, example: &Example) -> bool {
    let mut frames = example.message.into_iter().flat_map(|id| protocol.frames_of(&protocol[id]));
    let found = frames.find(|frame| frame.kind == example.kind);
    found.map_or(example.kind == Kind::Request, FrameLayout::is_to_module)
}

/// A constant of a message whose digits are those of the frame, but in another base.
pub struct Slip {
    at: Option<At>,
    help: String,
}

impl Slip {
    /// Finds the only constant that keeps a frame from being the message of its example.
    pub fn find(protocol: &Protocol, example: &Example) -> Option<Self> {
        let message = &protocol[example.message?];
        let frame = Frame::of(protocol, example);
        let data = frame.padded();
        let read = |constant: &Constant| match constant.place {
            SelectorPlace::Identifier(field) => u64::from(protocol[field].get(frame.id)),
            SelectorPlace::Payload(place) => place.get(&data),
        };
        let slipped = |layout: &FrameLayout| {
            let mut wrong = layout.constants.iter().filter(|constant| !constant.admits(read(constant)));
            let (constant, None) = (wrong.next()?, wrong.next()) else { return None };
            let (written, found) = (constant.value, read(constant));
            let name = &protocol[constant.selector].name;
            let help = if u64::from_str_radix(&written.to_string(), 16) == Ok(found) {
                format!(
                    "`{name}` is {written} in the spec, which is {written:#04X}; if the document counts in hexadecimal, write `{found:#04X}`"
                )
            } else if format!("{written:X}").parse() == Ok(found) {
                format!(
                    "`{name}` is {written:#04X} in the spec, which is {written}; if the document counts in decimals, write `{found}`"
                )
            } else {
                return None;
            };
            let path = message.doc.path.key("match").key(name);
            let at = message.constants.contains(constant).then(|| path.at_value());
            Some(Self { at, help })
        };
        protocol.frames_of(message).filter(|layout| layout.kind == example.kind).find_map(slipped)
    }

    /// Adds the constant and what to do to a diagnostic.
    pub fn mark(self, diagnostic: Diagnostic) -> Diagnostic {
        let diagnostic = diagnostic.help(self.help);
        match self.at {
            Some(at) => diagnostic.other(at, "in this base"),
            None => diagnostic,
        }
    }
}
