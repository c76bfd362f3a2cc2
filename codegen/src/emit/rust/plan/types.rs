//! The types of a module, each with its own name, and the type that each frame carries.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::encoding::WordTypes;
use super::naming::{Pool, camel_case};
use crate::model::{
    EnumerationId, FrameId, FrameLayout, Kind, LongMessageId, Message, MessageId, Protocol, Signal, SignalId,
    StatusWordId, Table, TransportId,
};

/// The types of a module.
pub struct Types {
    /// Named values.
    pub enumerations: Table<EnumerationId, Ident>,
    /// Status words.
    pub status_words: Table<StatusWordId, Ident>,
    /// Packed values of messages.
    pub packed: Table<MessageId, Table<SignalId, Option<Ident>>>,
    /// Structs of messages, one for each set of signals that some frame carries. The first one is
    /// the message's own.
    pub structs: Table<MessageId, Vec<Struct>>,
    /// Structs of what several frames carry together.
    pub long: Table<LongMessageId, Ident>,
    /// Transports.
    pub transports: Table<TransportId, Ident>,
    /// How frames look in the enum of all messages.
    pub frames: Table<FrameId, FrameTypes>,
}

/// A struct and the signals it has.
pub struct Struct {
    /// Its name.
    pub name: Ident,
    /// The name in texts, of names of the spec.
    pub text: String,
    /// The signals.
    pub signals: Vec<SignalId>,
}

/// How a kind of frame looks in the enum of all messages.
pub struct FrameTypes {
    /// Its variant.
    pub variant: Ident,
    /// The name in texts, of names of the spec.
    pub text: String,
    /// The struct that it carries.
    pub carried: Option<Ident>,
}

impl Types {
    /// Names the types.
    pub fn new(protocol: &Protocol) -> Self {
        let mut pool = Pool::of_types();
        let long = protocol.long_messages.map(|long| pool.take(camel_case(&long.content.name), "Message"));
        let structs = protocol.messages.map(|message| structs(protocol, message, &long, &mut pool));
        let transports = protocol.transports.map(|known| pool.take(camel_case(&known.name), "Transport"));
        let mut named = |name: &str, suffix| pool.take(camel_case(name), suffix);
        let enumerations = protocol.enumerations.map(|known| named(&known.name, "Value"));
        let status_words = protocol.status_words.map(|word| named(&word.name, "Word"));
        let packed = protocol.messages.map(|message| message.signals.map(|signal| packed(message, signal, &mut pool)));
        let taken = structs.iter().flatten().map(|known: &Struct| known.name.to_string());
        let mut variants = Pool::without(taken);
        let frames = protocol.frames.map(|frame| FrameTypes::new(protocol, &structs, frame, &mut variants));
        Self { enumerations, status_words, packed, structs, long, transports, frames }
    }

    /// Returns the struct that has the exchanges of a message: that of the whole, if a transport carries it, or else
    /// the message's own.
    pub fn owner(&self, protocol: &Protocol, message: MessageId) -> &Ident {
        protocol.by_transport(&protocol[message]).map_or_else(|| self.home(message), |long| &self.long[long])
    }

    /// Returns the message's own struct.
    pub fn home(&self, message: MessageId) -> &Ident {
        &self.structs[message][0].name
    }

    /// Returns the types of a signal's words. `packed` is that of a packed value.
    pub fn words<'a>(&'a self, packed: Option<&'a Ident>) -> WordTypes<'a> {
        WordTypes { enumerations: &self.enumerations, statuses: &self.status_words, packed }
    }

    /// Returns the type of named values.
    pub fn enumeration(&self, id: EnumerationId) -> TokenStream {
        let name = &self.enumerations[id];
        quote!(#name)
    }
}

/// Names a struct for each set of signals, the largest first. A message without signals has an
/// empty struct. What several frames carry together has the name of the message, and each frame a part.
/// A message that no frame has room for has only that struct.
fn structs(
    protocol: &Protocol,
    message: &Message,
    long: &Table<LongMessageId, Ident>,
    types: &mut Pool,
) -> Vec<Struct> {
    let mut sets: Vec<&FrameLayout> = Vec::new();
    for frame in protocol.frames_of(message) {
        if !frame.signals.is_empty() && !sets.iter().any(|known| known.signals == frame.signals) {
            sets.push(frame);
        }
    }
    sets.sort_by_key(|frame| std::cmp::Reverse(frame.signals.len()));
    let first = sets.first().map(|frame| frame.signals.clone()).unwrap_or_default();
    let transferred = protocol.by_transport(message);
    if let (Some(id), true) = (transferred, first.is_empty()) {
        return vec![Struct { name: long[id].clone(), text: message.name.clone(), signals: first }];
    }
    let mut named = |text: String, signals| {
        let name = types.take(camel_case(&text), "Message");
        Struct { name, text, signals }
    };
    let part = match (protocol.in_parts(message), transferred) {
        (Some(_), _) => "_part",
        (None, Some(_)) => "_frame",
        (None, None) => "",
    };
    let own = named(format!("{}{part}", message.name), first);
    let others = sets
        .iter()
        .skip(1)
        .map(|frame| named(format!("{}_{}", message.name, frame.kind.name()), frame.signals.clone()));
    std::iter::once(own).chain(others).collect()
}

fn packed(message: &Message, signal: &Signal, types: &mut Pool) -> Option<Ident> {
    let name = if signal.name == "value" { message.name.clone() } else { format!("{}_{}", message.name, signal.name) };
    signal.encoding.packed().map(|_| types.take(camel_case(&name), "Value"))
}

impl FrameTypes {
    /// Names a variant after the struct it carries, else after the frame.
    fn new(
        protocol: &Protocol,
        structs: &Table<MessageId, Vec<Struct>>,
        frame: &FrameLayout,
        variants: &mut Pool,
    ) -> Self {
        let own = structs[frame.message].iter().filter(|known| !known.signals.is_empty());
        if let Some(Struct { name, text, .. }) = own.into_iter().find(|known| known.signals == frame.signals) {
            return Self { variant: name.clone(), text: text.clone(), carried: Some(name.clone()) };
        }
        let text = empty_variant(protocol, frame);
        Self { variant: variants.take(camel_case(&text), "Frame"), text, carried: None }
    }
}

fn empty_variant(protocol: &Protocol, frame: &FrameLayout) -> String {
    let (access, message) = (&protocol[frame.access].name, &protocol[frame.message].name);
    match frame.kind {
        Kind::Request => format!("{access}_{message}"),
        kind @ (Kind::Reply | Kind::Report) => format!("{message}_{access}_{}", kind.name()),
    }
}
