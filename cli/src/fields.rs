//! The fields of a decoded frame: signals alone, and arrays with their elements.

use std::collections::HashMap;

use canspec_codegen::interpret::{Decoded, Reading};
use canspec_codegen::model::{ArrayId, Message, Signal};

/// What a frame says about a signal.
pub type Read<'a> = (&'a Signal, &'a Reading);

/// A field of a decoded frame.
#[derive(Clone)]
pub enum Field<'a> {
    /// A signal that is no element.
    Signal(Read<'a>),
    /// The elements of an array up to the last one that the frame has.
    Array(Vec<Option<Read<'a>>>),
}

/// Returns the fields of a frame, each with its name. An array comes where its first element comes.
pub fn fields<'a>(message: &'a Message, decoded: &'a Decoded) -> Vec<(&'a str, Field<'a>)> {
    let mut fields = Vec::with_capacity(decoded.signals.len());
    let mut places: HashMap<ArrayId, usize> = HashMap::new();
    for reading in &decoded.signals {
        let known = &message.signals[reading.signal];
        let read = (known.on(decoded.model), reading);
        let Some(element) = known.element else {
            fields.push((&*known.name, Field::Signal(read)));
            continue;
        };
        let place = *places.entry(element.array).or_insert(fields.len());
        if place == fields.len() {
            fields.push((&*message[element.array].name, Field::Array(Vec::new())));
        }
        if let Field::Array(elements) = &mut fields[place].1 {
            let index = usize::from(element.index);
            elements.resize(elements.len().max(index + 1), None);
            elements[index] = Some(read);
        }
    }
    fields
}
