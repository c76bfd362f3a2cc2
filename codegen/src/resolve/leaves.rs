//! What the fields of a message come to.

use super::window::in_frame;
use crate::model::{Array, ArrayId, Element, Id, Signal, Table};
use crate::read::syntax::ast;
use crate::report::tree::Path;

/// The result of resolving the fields of a message.
#[derive(Default)]
pub struct Leaves {
    pub signals: Vec<Signal>,
    /// Arrays without their elements, which are signals.
    pub arrays: Table<ArrayId, Array>,
    /// Constant fields of the payload and their values.
    pub constants: Vec<(Signal, u64)>,
    /// Constants that a reply shows because of the fields, each with its place in the spec.
    pub replies: Vec<(Path, ast::Pattern)>,
    /// Names of fields with an error of their own.
    pub given_up: Vec<String>,
}

impl Leaves {
    /// Returns the names of all fields, also of those with an error.
    pub fn names(self) -> impl Iterator<Item = String> {
        let constants = self.constants.into_iter().map(|(signal, _)| signal);
        self.signals.into_iter().chain(constants).map(|signal| signal.name).chain(self.given_up)
    }

    /// Returns the signals of the first bytes, which stand behind some others in a frame, and the arrays that have elements
    /// there.
    pub fn in_one_frame(&self, before: u16, bytes: usize) -> (Vec<Signal>, Table<ArrayId, Array>) {
        let signals = self.signals.iter().filter(|signal| signal.run.is_none() && signal.reach() <= bytes);
        let moved = |signal: &Signal| signal.clone().changed(|signal| signal.window += before);
        let signals: Vec<_> = signals.filter_map(|signal| in_frame(&moved(signal))).collect();
        let has_element =
            |array: &ArrayId| signals.iter().filter_map(|signal| signal.element).any(|of| of.array == *array);
        let kept: Vec<ArrayId> = self.arrays.ids().filter(has_element).collect();
        let arrays = kept.iter().map(|id| Array { least: None, ..self.arrays[*id].clone() }).collect();
        let renumber = |element: Element| {
            let place = kept.iter().position(|id| *id == element.array)?;
            Some(Element { array: Id::new(place), ..element })
        };
        let renumbered = |signal: Signal| signal.changed(|signal| signal.element = signal.element.and_then(renumber));
        (signals.into_iter().map(renumbered).collect(), arrays)
    }
}
