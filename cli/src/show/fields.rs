//! The fields of a decoded frame: signals alone, and arrays with their elements.

use canspec_codegen::interpret::{Decoded, Reading};
use canspec_codegen::model::{ArrayId, Message, Signal};

/// What a frame says about a signal.
pub type Read<'a> = (&'a Signal, &'a Reading);

/// A field of a decoded frame.
#[derive(Clone, Copy)]
pub enum Field<'a> {
    /// A signal that is no element.
    Signal(Read<'a>),
    /// An array whose elements the frame has.
    Array(ArrayId),
}

/// Returns the fields of a frame, each with its name. An array comes where its first element comes.
pub fn fields<'a>(
    message: &'a Message,
    decoded: &'a Decoded,
) -> impl Iterator<Item = (&'a str, Field<'a>)> + Clone + use<'a> {
    decoded.signals.iter().enumerate().filter_map(move |(place, reading)| {
        let known = &message[reading.signal];
        let Some(element) = known.element else {
            return Some((known.name.as_str(), Field::Signal((known.on(decoded.model), reading))));
        };
        // The element before is the nearest, so elements that follow one another cost little.
        let mut before = decoded.signals[..place].iter().rev();
        let is_first = before.all(|other| array_of(message, other) != Some(element.array));
        is_first.then(|| (message[element.array].name.as_str(), Field::Array(element.array)))
    })
}

/// Returns the elements of an array up to the last one that the frame has.
pub fn elements<'a>(message: &'a Message, decoded: &'a Decoded, array: ArrayId) -> Vec<Option<Read<'a>>> {
    let mut elements = Vec::new();
    for reading in &decoded.signals {
        let known = &message[reading.signal];
        let Some(element) = known.element.filter(|element| element.array == array) else { continue };
        let index = usize::from(element.index);
        elements.resize(elements.len().max(index + 1), None);
        elements[index] = Some((known.on(decoded.model), reading));
    }
    elements
}

fn array_of(message: &Message, reading: &Reading) -> Option<ArrayId> {
    message[reading.signal].element.map(|element| element.array)
}
