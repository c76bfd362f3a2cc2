//! Arrays: equal signals in a row, which are one field of the spec.

use serde::{Deserialize, Serialize};

use crate::model::{ArrayId, Doc, Message, Signal, SignalId};

/// Equal signals in a row.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Array {
    /// Name in the spec, in `snake_case`. The elements are called `NAME_1` and so on.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The elements in order.
    pub elements: Vec<SignalId>,
    /// The least number of elements, if a long message can have fewer than these.
    pub least: Option<usize>,
}

/// Which element of an array a signal is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Element {
    /// The array.
    pub array: ArrayId,
    /// How many elements come before it.
    pub index: u8,
}

impl Message {
    /// Returns the array that a signal is an element of.
    pub fn array_of(&self, signal: &Signal) -> Option<&Array> {
        signal.element.map(|element| &self[element.array])
    }

    /// Finds an array by name.
    pub fn array(&self, name: &str) -> Option<&Array> {
        self.arrays.iter().find(|array| array.name == name)
    }

    /// Returns the name of the field that a signal is, or is an element of.
    pub fn field_name<'a>(&'a self, signal: &'a Signal) -> &'a str {
        self.array_of(signal).map_or(&signal.name, |array| &array.name)
    }

    /// Returns the signals of a field: one, or the elements of an array.
    pub fn signals_of<'a>(&'a self, field: &'a str) -> impl Iterator<Item = &'a Signal> {
        self.signals.iter().filter(move |signal| self.field_name(signal) == field)
    }
}
