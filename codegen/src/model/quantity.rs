//! Quantities: vendor-neutral names of signals.

use std::borrow::Cow;

use canspec_runtime::Place;
use serde::{Deserialize, Serialize};

use super::{ExchangeId, FrameLayout, Kind, Message, MessageId, Protocol, Range, Signal, SignalId, Unit, place};
use crate::report::tree::Path;

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
    /// Other fields of requests that set it, as in a total or as a default.
    pub also: Vec<FieldPath>,
    /// Place in the spec.
    pub path: Path,
}

/// The path to a field that a request carries.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FieldPath {
    /// The message.
    pub message: MessageId,
    /// Name of the field. It is a signal, or an array of signals.
    pub field: String,
    /// Place in the spec.
    pub path: Path,
}

/// A limit of the product in which the devices work. Requests to every device model keep to it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Limit {
    /// The quantity that is limited.
    pub quantity: String,
    /// Its lowest and its highest value.
    pub range: Range,
    /// Unit of these values.
    pub unit: Option<Unit>,
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

impl Limit {
    /// Writes it as a spec does: `150..450 V`.
    pub fn text(&self) -> String {
        let unit = self.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
        format!("{}..{}{unit}", self.range.minimum, self.range.maximum)
    }
}

impl QuantityPaths {
    /// Returns the fields that set it, each with the place of its path in the spec.
    pub(crate) fn fields<'a>(
        &'a self,
        message: impl Fn(MessageId) -> &'a Message,
    ) -> impl Iterator<Item = (MessageId, &'a str, &'a Path)> {
        let set = self.set.iter().map(move |set| {
            let message = message(set.message);
            (set.message, message.field_name(&message[set.signal]), &set.path)
        });
        set.chain(self.also.iter().map(|also| (also.message, also.field.as_str(), &also.path)))
    }
}

impl Protocol {
    /// Returns the unit of a quantity. A switch has none.
    pub fn unit_of(&self, known: &QuantityPaths) -> Option<Unit> {
        match known.read.as_ref().or(known.set.as_ref()) {
            Some(path) => self.unit_at(path),
            None => self.setters(known).next()?.1.unit,
        }
    }

    /// Returns the limit of the product on a quantity, if it has one.
    pub fn limit_of(&self, known: &QuantityPaths) -> Option<&Limit> {
        self.limits.iter().find(|limit| limit.quantity == known.name)
    }

    /// Returns the signals of requests that set a quantity, each with its message.
    pub fn setters<'a>(&'a self, known: &'a QuantityPaths) -> impl Iterator<Item = (&'a Message, &'a Signal)> {
        known.fields(|message| &self[message]).flat_map(|(message, field, _)| {
            let content = self.whole(&self[message]);
            content.signals_of(field).map(move |signal| (content, signal))
        })
    }

    /// Returns the protocol without the limits of the product, as the document has it.
    pub(crate) fn documented(&self) -> Cow<'_, Self> {
        if self.limits.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut own = self.clone();
        let long = own.long_messages.iter_mut().map(|long| &mut long.content);
        let signals = own.messages.iter_mut().chain(long).flat_map(|message| message.signals.iter_mut());
        signals.for_each(|signal| signal.limit = None);
        own.limits.clear();
        Cow::Owned(own)
    }

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
