//! Quantities: vendor-neutral names of signals.

use canspec_runtime::Place;
use serde::{Deserialize, Serialize};

use super::{ExchangeId, FrameLayout, Kind, MessageId, Protocol, Signal, SignalId, Unit, place};
use crate::syntax::tree::Path;

/// Where a quantity is read and set.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct QuantityPaths {
    /// Vendor-neutral name, in `snake_case`.
    pub name: String,
    /// Where it is read.
    pub read: Option<SignalPath>,
    /// Where it is set.
    pub set: Option<SignalPath>,
    /// Place in the spec.
    pub path: Path,
}

/// The path to a signal.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SignalPath {
    /// The message.
    pub message: MessageId,
    /// The signal.
    pub signal: SignalId,
    /// Name of the status bit, if one is meant.
    pub bit: Option<String>,
    /// The bits of the signal, or of the status bit.
    #[serde(with = "place")]
    pub place: Place,
    /// The bits of a switch that is off, and of one that is on.
    pub states: Option<[u64; 2]>,
    /// Other signals of the request, and their bits.
    pub with: Vec<Fixed>,
    /// Place in the spec.
    pub path: Path,
}

/// A signal that always has the same bits in a request.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Fixed {
    /// The signal.
    pub signal: SignalId,
    /// Its bits.
    pub bits: u64,
    /// Place in the spec.
    pub path: Path,
}

impl Protocol {
    /// Returns the signal to which a path leads.
    pub fn signal_at(&self, path: &SignalPath) -> &Signal {
        &self[path.message][path.signal]
    }

    /// Returns a path as a spec has it: `MESSAGE.SIGNAL`, or `MESSAGE.WORD.BIT` of a status bit.
    pub fn path_text(&self, path: &SignalPath) -> String {
        let bit = path.bit.iter().map(String::as_str);
        let names = [&*self[path.message].name, &*self.signal_at(path).name].into_iter().chain(bit);
        names.collect::<Vec<_>>().join(".")
    }

    /// Returns the unit of the value at a path. A switch has none.
    pub fn unit_at(&self, path: &SignalPath) -> Option<Unit> {
        if path.states.is_some() { None } else { self.signal_at(path).unit }
    }

    /// Returns the replies and reports of modules in which a path leads to a value.
    pub fn frames_with(&self, path: &SignalPath) -> impl Iterator<Item = &FrameLayout> + use<'_> {
        self.carrying(path).filter(|frame| !frame.is_to_module())
    }

    /// Returns the exchange that asks for the value at a path. It is `None` if no request without fields does.
    pub fn asking(&self, path: &SignalPath) -> Option<ExchangeId> {
        let mut replies = self.frames_with(path).filter(|frame| frame.kind == Kind::Reply && frame.set.is_none());
        let asks = |reply: &&FrameLayout| {
            let mut requests = self.frames_of(&self[path.message]);
            requests.any(|frame| {
                frame.kind == Kind::Request && frame.exchange == reply.exchange && frame.signals.is_empty()
            })
        };
        replies.find(asks).map(|reply| reply.exchange)
    }

    /// Returns the request, or the report of the controller, that sets the value at a path.
    pub fn setting(&self, path: &SignalPath) -> Option<&FrameLayout> {
        self.carrying(path).find(|frame| frame.is_to_module() && frame.set.is_none())
    }

    /// Returns what paths that set values of a message fix of it.
    pub fn fixed_in(&self, message: MessageId) -> impl Iterator<Item = &Fixed> {
        self.setters_of(message).flat_map(|path| &path.with)
    }

    /// Returns the paths that set values of a message.
    pub fn setters_of(&self, message: MessageId) -> impl Iterator<Item = &SignalPath> {
        self.quantities.iter().filter_map(|known| known.set.as_ref()).filter(move |path| path.message == message)
    }

    fn carrying(&self, path: &SignalPath) -> impl Iterator<Item = &FrameLayout> + use<'_> {
        let signal = path.signal;
        self.frames_of(&self[path.message]).filter(move |frame| frame.signals.contains(&signal))
    }
}
