//! Fields that no example bears out: where several examples speak of a field and all disagree, rather the field is wrong.

use indexmap::IndexMap;

use super::shown;
use crate::diagnostic::Diagnostic;
use crate::interpret::{Frame, decode};
use crate::model::{Meaning, Protocol};
use crate::syntax::tree::Path;

/// Most examples that are shown beside a field.
const SHOWN: usize = 3;

/// What the examples say of one field.
#[derive(Default)]
pub struct Contradiction<'a> {
    /// What disagrees with its frame, and what the frame says.
    disagreeing: Vec<(&'a Meaning, String)>,
    /// One agrees, and not just because both are zero.
    is_borne_out: bool,
}

impl Contradiction<'_> {
    /// Returns the places where a complaint would be one about the field.
    pub fn places(&self) -> impl Iterator<Item = &Path> {
        self.disagreeing.iter().map(|(meaning, _)| &meaning.path)
    }
}

/// Finds the fields that at least two examples speak against and none for, by message and signal.
pub fn find(protocol: &Protocol) -> IndexMap<(usize, usize), Contradiction<'_>> {
    let mut fields: IndexMap<(usize, usize), Contradiction> = IndexMap::new();
    let whole = protocol.examples.iter().filter(|example| example.fails.is_none() && example.data.is_some());
    for example in whole {
        let Ok(decoded) = decode(protocol, example.model, &Frame::of(protocol, example)) else { continue };
        for meaning in example.means.iter().filter(|_| example.message == Some(decoded.message)) {
            let Some(reading) = decoded.signals.iter().find(|reading| reading.signal == meaning.signal) else {
                continue;
            };
            let field = fields.entry((decoded.message, meaning.signal)).or_default();
            if Some(reading.bits) == meaning.raw {
                field.is_borne_out |= reading.bits != 0;
            } else {
                let signal = &protocol.messages[decoded.message].signals[meaning.signal];
                field.disagreeing.push((meaning, shown(protocol, signal, &reading.value, reading.bits)));
            }
        }
    }
    fields.retain(|_, field| field.disagreeing.len() > 1 && !field.is_borne_out);
    fields
}

/// Says that a field is not what its examples say.
pub fn report(protocol: &Protocol, (message, signal): (usize, usize), field: &Contradiction) -> Diagnostic {
    let message = &protocol.messages[message];
    let signal = &message.signals[signal];
    let count = field.disagreeing.len();
    let text = format!("no example bears out `{}.{}`, and {count} contradict it", message.name, signal.name);
    let help = "correct its place, its scale or its kind of number, or else the examples";
    let diagnostic = Diagnostic::error("example", signal.doc.path.at_key(), text).help(help);
    field.disagreeing.iter().take(SHOWN).fold(diagnostic, |diagnostic, (meaning, read)| {
        diagnostic.other(meaning.path.at_value(), format!("by the field this frame says {read}"))
    })
}
