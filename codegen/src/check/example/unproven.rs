//! Lists the values in frames that their examples do not state.

use crate::interpret::{Frame, decode};
use crate::model::{Example, Protocol};

/// Signals that an example does not state.
#[derive(Clone, Debug)]
pub struct Unproven<'a> {
    /// The example, which holds otherwise.
    pub example: &'a Example,
    /// Names of signals in its frame.
    pub signals: Vec<&'a str>,
}

/// Returns the examples that state only some of the signals in their frames.
pub fn unproven(protocol: &Protocol) -> impl Iterator<Item = Unproven<'_>> {
    let holds = |example: &&Example| example.fails.is_none() && example.data.is_some();
    let found = protocol.examples.iter().filter(holds).filter_map(|example| of_example(protocol, example));
    found.filter(|unproven| !unproven.signals.is_empty())
}

fn of_example<'a>(protocol: &'a Protocol, example: &'a Example) -> Option<Unproven<'a>> {
    let decoded = decode(protocol, example.model, &Frame::of(protocol, example)).ok()?;
    let is_stated = |signal| example.means.iter().any(|meaning| meaning.signal == signal);
    let silent = decoded.signals.iter().filter(|reading| !is_stated(reading.signal));
    let signals = silent.map(|reading| protocol[decoded.message][reading.signal].name.as_str()).collect();
    Some(Unproven { example, signals })
}
