//! Quantities: where vendor-neutral names lead to.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::literal::hexadecimal;
use super::message::Message;
use super::naming::{camel_case, ident};
use super::place::Written;
use crate::model::{Conduct, ExchangeId, FrameLayout, Kind, MessageId, Protocol, SignalPath, Table};

/// Where quantities are read and set.
pub struct Quantities {
    /// Where they are read.
    pub reads: Vec<Read>,
    /// Where they are set.
    pub sets: Vec<Set>,
}

/// Where a quantity is read.
pub struct Read {
    /// Its name and its value.
    pub value: Value,
    /// Kinds and paths of the exchanges whose frames carry it.
    pub frames: Vec<(Ident, TokenStream)>,
    /// The path of the exchange that asks for it.
    pub request: Option<TokenStream>,
}

/// Where a quantity is set.
pub struct Set {
    /// Its name and its value.
    pub value: Value,
    /// The path of the exchange that sets it.
    pub request: TokenStream,
    /// The reply carries it, too.
    pub is_echoed: bool,
    /// What a device does with it.
    pub conduct: Conduct,
    /// Places that the message has elsewhere, with their bits.
    pub others: Vec<(Written, TokenStream)>,
}

/// The value of a quantity in a frame.
pub struct Value {
    /// Name of the quantity.
    pub name: String,
    /// The unit.
    pub unit: Option<String>,
    /// What it is.
    pub kind: ValueKind,
}

/// What the value of a quantity is.
pub enum ValueKind {
    /// A number, with the path of its signal.
    Number(TokenStream),
    /// A switch.
    Switch(States),
}

/// The states of a switch.
pub struct States {
    /// Where the bits stand.
    pub place: Written,
    /// What they are if it is off.
    pub inactive: TokenStream,
    /// What they are if it is on.
    pub active: TokenStream,
}

impl Quantities {
    /// Plans the quantities of a protocol, if it has some.
    pub fn new(protocol: &Protocol, messages: &Table<MessageId, Message>) -> Option<Self> {
        let planner = Planner { protocol, messages };
        let known = &protocol.quantities;
        let reads = known.iter().filter_map(|known| Some(planner.read(&known.name, known.read.as_ref()?)));
        let sets = known.iter().filter_map(|known| planner.set(&known.name, known.set.as_ref()?));
        let (reads, sets): (Vec<_>, Vec<_>) = (reads.collect(), sets.collect());
        (!reads.is_empty() || !sets.is_empty()).then_some(Self { reads, sets })
    }
}

struct Planner<'a> {
    protocol: &'a Protocol,
    messages: &'a Table<MessageId, Message>,
}

impl Planner<'_> {
    fn read(&self, name: &str, path: &SignalPath) -> Read {
        let frames = self.protocol.frames_with(path);
        let frames = frames.map(|frame| (ident(&camel_case(frame.kind.name())), self.exchange(path, frame.exchange)));
        Read {
            value: self.value(name, path),
            frames: frames.collect(),
            request: self.protocol.asking(path).map(|exchange| self.exchange(path, exchange)),
        }
    }

    fn set(&self, name: &str, path: &SignalPath) -> Option<Set> {
        let request = self.protocol.setting(path)?;
        let message = &self.protocol[path.message];
        let others = path.with.iter().map(|fixed| {
            let place = message[fixed.signal].place;
            (Written::new(place), hexadecimal(fixed.bits, place.width()))
        });
        let is_echo = |frame: &FrameLayout| frame.kind == Kind::Reply && frame.exchange == request.exchange;
        Some(Set {
            value: self.value(name, path),
            request: self.exchange(path, request.exchange),
            is_echoed: self.protocol.frames_with(path).any(is_echo),
            conduct: message[path.signal].conduct,
            others: others.collect(),
        })
    }

    fn value(&self, name: &str, path: &SignalPath) -> Value {
        let kind = match path.states {
            None => {
                let (message, signal) = (&self.messages[path.message], path.signal);
                let (home, constant) = (&message.home, &message.signals[signal].constant);
                ValueKind::Number(quote!(&#home::#constant))
            }
            Some([inactive, active]) => {
                let bits = |bits| hexadecimal(bits, path.place.width());
                let place = Written::new(path.place);
                ValueKind::Switch(States { place, inactive: bits(inactive), active: bits(active) })
            }
        };
        let unit = self.protocol.unit_at(path).map(|unit| unit.symbol.to_string());
        Value { name: name.to_owned(), unit, kind }
    }

    fn exchange(&self, path: &SignalPath, exchange: ExchangeId) -> TokenStream {
        let Message { owner, exchanges, .. } = &self.messages[path.message];
        let constant = &exchanges[exchange].constant;
        quote!(&#owner::#constant)
    }
}
