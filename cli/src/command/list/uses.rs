//! What some messages refer to: accesses, types, times and errata.

use std::collections::BTreeSet;

use canspec_codegen::model::{Access, Doc, MessageId, Protocol, Signal, Timing};
use canspec_codegen::text::Text;

use super::meaning;
use super::remarks::{self, Type};

/// What the messages refer to.
pub struct Uses<'a> {
    protocol: &'a Protocol,
    messages: &'a [MessageId],
}

impl<'a> Uses<'a> {
    /// Looks at some messages.
    pub fn of(protocol: &'a Protocol, messages: &'a [MessageId]) -> Self {
        Self { protocol, messages }
    }

    /// Returns the accesses by which they travel.
    pub fn accesses(&self) -> Vec<&'a Access> {
        let exchanges = self.messages.iter().flat_map(|id| &self.protocol[*id].exchanges);
        let accesses: BTreeSet<_> = exchanges.map(|exchange| exchange.access).collect();
        accesses.into_iter().map(|access| &self.protocol[access]).collect()
    }

    /// Returns the types of their signals that have remarks, by name.
    pub fn types(&self) -> Vec<Type<'a>> {
        let signals: Vec<_> = self.messages.iter().flat_map(|id| signals(self.protocol, *id)).collect();
        let mut names: BTreeSet<&str> = signals.iter().flat_map(|signal| &signal.types).map(String::as_str).collect();
        let encodings = || signals.iter().map(|signal| &signal.encoding);
        names.extend(encodings().filter_map(|known| Some(self.protocol[known.enumeration()?].name.as_str())));
        names.extend(encodings().filter_map(|known| Some(self.protocol[known.status_word()?].name.as_str())));
        let is_meant = |known: &Type| names.contains(known.name.as_str()) && remarks::is_remarked(known.doc);
        remarks::types(self.protocol).into_iter().filter(is_meant).collect()
    }

    /// Returns the times that are about them, or about how they travel.
    pub fn times(&self) -> Vec<&'a Timing> {
        let own = self.messages.iter().filter_map(|id| self.protocol[*id].every);
        let every: BTreeSet<_> = own.chain(self.accesses().iter().filter_map(|access| access.every)).collect();
        let is_about = |timing: &Timing| self.messages.iter().any(|id| timing.messages.contains(id));
        let times = self.protocol.timing.entries().filter(|(id, timing)| every.contains(id) || is_about(timing));
        times.map(|(_, timing)| timing).collect()
    }

    /// Returns the names of errata that stand beside any of this.
    pub fn errata(&self) -> BTreeSet<&'a Text> {
        let messages = self.messages.iter().flat_map(|id| docs(self.protocol, *id));
        let others = self.accesses().into_iter().map(|access| &access.doc);
        let others = others.chain(self.types().into_iter().map(|known| known.doc));
        let others = others.chain(self.times().into_iter().map(|timing| &timing.doc));
        messages.chain(others).flat_map(|doc| &doc.errata).collect()
    }
}

/// Returns the signals of the frames of a message, and of what they say together.
fn signals(protocol: &Protocol, id: MessageId) -> impl Iterator<Item = &Signal> {
    let message = &protocol[id];
    let long = protocol.long_message(message).map(|(_, long)| &long.content);
    std::iter::once(message).chain(long).flat_map(|message| &message.signals)
}

/// Returns the remarks of a message, its signals and its examples.
fn docs(protocol: &Protocol, id: MessageId) -> impl Iterator<Item = &Doc> {
    let signals = signals(protocol, id).flat_map(move |signal| of_signal(protocol, signal));
    let single = protocol.examples.iter().filter(move |example| example.message == Some(id));
    let long = protocol.long_examples.iter().filter(move |example| protocol[example.long].message == id);
    let examples = single.map(|example| &example.doc).chain(long.map(|example| &example.doc));
    std::iter::once(&protocol[id].doc).chain(signals).chain(examples)
}

/// Returns the remarks of a signal, of its parts and of its status bits.
fn of_signal<'a>(protocol: &'a Protocol, signal: &'a Signal) -> impl Iterator<Item = &'a Doc> {
    let bits = meaning::status_bits(protocol, signal).map(|bit| &bit.doc);
    std::iter::once(&signal.doc).chain(signal.encoding.parts().iter().map(|part| &part.doc)).chain(bits)
}
