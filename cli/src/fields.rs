//! The fields of a decoded frame: signals alone, and arrays with their elements.

use canspec_codegen::interpret::{Decoded, Reading};
use canspec_codegen::model::{Message, Signal, SignalId};

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
pub fn fields<'a>(
    message: &'a Message,
    decoded: &'a Decoded,
) -> impl Iterator<Item = (&'a str, Field<'a>)> + Clone + use<'a> {
    let read = |reading: &'a Reading| (message.signals[reading.signal].on(decoded.model), reading);
    decoded.signals.iter().enumerate().filter_map(move |(index, reading)| {
        let signal = &message.signals[reading.signal];
        let Some(array) = message.array_of(signal) else { return Some((&*signal.name, Field::Signal(read(reading)))) };
        let is_known = decoded.signals[..index].iter().any(|known| array.elements.contains(&known.signal));
        let find = |id: &SignalId| decoded.signals.iter().find(|reading| reading.signal == *id).map(read);
        let mut elements: Vec<_> = array.elements.iter().map(find).collect();
        elements.truncate(elements.iter().rposition(Option::is_some).map_or(0, |last| last + 1));
        (!is_known).then_some((&*array.name, Field::Array(elements)))
    })
}
