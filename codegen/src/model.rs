//! The checked, target-neutral description of a protocol that both engines and every emitter read.
//!
//! Only the compiler makes these values. A [`Protocol`] that exists has passed every check, unless
//! [`compile_proven`](crate::compile_proven) made it, whose caller vouches for the spec. A stored
//! one is what was stored.
//!
//! Its types refer to each other by ids of their own, so that no reference can miss. `recognition`
//! is the plan by which every engine recognises frames. `keywords` and `unit_prefixes` have the
//! words that a spec uses for what stands here.

mod address;
mod array;
mod data;
mod derivation;
mod encoding;
mod example;
mod extent;
mod id;
mod identifier;
pub(crate) mod keywords;
mod lacking;
mod long;
mod message;
mod note;
mod numeral;
mod place;
mod quantity;
mod recognition;
mod set;
mod signal;
mod silence;
mod timing;
mod transport;
mod unit;
pub mod unit_prefixes;

pub(crate) use address::exclude;
pub use address::{Address, AddressPattern, AddressType, Direction, FieldTest, Mode, Way};
pub use array::{Array, Element};
pub use data::{Allowance, DeviceModel, Doc, Document, Erratum, NamedType, Procedure, Sides, TypeOfModel};
pub use derivation::{Derivation, Descent};
pub use encoding::{Encoding, Linear, Piece, TextForm};
pub use example::{Example, Failure, LongExample, Meaning, Misfit, Origin, Said, ValueExample};
pub use extent::Extent;
pub use id::{
    AccessId, AddressTypeId, ArrayId, Entries, EnumerationId, ExchangeId, FieldId, FrameId, Id, LongMessageId,
    MessageId, ModeId, ModelId, PartId, SelectorId, SignalId, StatusWordId, Table, TimingId, TransportId,
};
pub use identifier::{ErrorCode, Foreign, Identifier, IdentifierField, Selector, SelectorPlace};
pub use lacking::{Lacking, only};
pub use long::{Announcement, Carrier, LongMessage, Parts, Varying};
pub(crate) use message::first_bytes;
pub(crate) use message::submasks;
pub use message::{
    Access, Answers, Constant, Exchange, FixedField, FrameLayout, Kind, Message, Reserved, Side, Travel, Who,
};
pub use note::NoteRule;
pub use numeral::Numeral;
pub use place::WrittenPlace;
pub use quantity::{FieldPath, Fixed, Limit, QuantityPaths, SignalPath};
pub(crate) use recognition::Directions;
pub use recognition::{Choice, Course, Group, Recognition, Scope};
pub use set::{Continuation, Set};
pub use signal::{
    ByteRun, Conduct, Enumeration, NamedValue, OfModel, OutOfRange, Range, Severity, Signal, StatusBit, StatusWord,
};
pub use silence::{AfterSilence, Silence};
pub(crate) use timing::nanoseconds;
pub use timing::{TimeRole, Timing};
pub use transport::{Groups, Isotp, Standard, Transport, TransportFrame};
pub use unit::{Quantity, Symbol, Unit};

use serde::{Deserialize, Serialize};

use crate::words::text::Text;

/// A whole protocol.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Protocol {
    /// Module name of the generated code.
    pub name: String,
    /// The spec's file name, without folders.
    pub file: Text,
    /// How the spec changes the one that it is based on, if it is.
    pub derivation: Option<Derivation>,
    /// What the devices are, without a full stop.
    pub title: Text,
    /// The documents that the spec follows. At most one has no name, and is the first.
    pub documents: Vec<Document>,
    /// What the two sides are called in texts.
    pub sides: Sides,
    /// Bit rates of the bus in bit/s.
    pub bit_rates: Vec<u32>,
    /// Layout of the identifier.
    pub identifier: Identifier,
    /// Fields whose constants choose a message, in the identifier, the header or a message.
    pub selectors: Table<SelectorId, Selector>,
    /// Named values of signals, selectors and fields of the identifier.
    pub enumerations: Table<EnumerationId, Enumeration>,
    /// Status words of signals.
    pub status_words: Table<StatusWordId, StatusWord>,
    /// Kinds of addresses that the addressing modes name.
    pub address_types: Table<AddressTypeId, AddressType>,
    /// Addressing modes in the order of the spec.
    pub modes: Table<ModeId, Mode>,
    /// Accesses in the order of the spec.
    pub accesses: Table<AccessId, Access>,
    /// Identifiers that are never sent, and refused on receipt.
    pub foreign: Vec<Foreign>,
    /// Messages in the order of the spec.
    pub messages: Table<MessageId, Message>,
    /// Transports of long messages in the order of the spec.
    pub transports: Table<TransportId, Transport>,
    /// What several frames of a message say together, in the order of the messages.
    pub long_messages: Table<LongMessageId, LongMessage>,
    /// The frames that exist, message by message.
    pub frames: Table<FrameId, FrameLayout>,
    /// How frames are recognised.
    pub recognition: Recognition,
    /// Where quantities are read and set, by vendor-neutral names.
    pub quantities: Vec<QuantityPaths>,
    /// Limits of the product in which the devices work.
    pub limits: Vec<Limit>,
    /// Device models in the order of the spec.
    pub models: Table<ModelId, DeviceModel>,
    /// Times that the document states.
    pub timing: Table<TimingId, Timing>,
    /// What a device does after the controller was silent, if the spec says it.
    pub after_silence: Option<Silence>,
    /// Procedures that the document describes.
    pub procedures: Vec<Procedure>,
    /// Examples of whole messages in the order of the spec, then those of the sequences.
    pub examples: Vec<Example>,
    /// Examples of long messages: all their frames, and what they say together.
    pub long_examples: Vec<LongExample>,
    /// Examples of types: bytes and their value.
    pub value_examples: Vec<ValueExample>,
    /// What the spec says beside the sequences of examples.
    pub sequences: Vec<Doc>,
    /// The types that the spec defines.
    pub types: Vec<NamedType>,
    /// Remarks of words. Words are no signals themselves.
    pub words: Vec<Doc>,
    /// Departures from the document.
    pub errata: Vec<Erratum>,
    /// Warnings that the spec accepts.
    pub allowances: Vec<Allowance>,
}

impl Protocol {
    /// Writes a selector's value with as many hexadecimal digits as the selector has.
    pub fn selector_value(&self, selector: SelectorId, value: u64) -> String {
        let width = match self[selector].place {
            SelectorPlace::Identifier(field) => self[field].width,
            SelectorPlace::Payload(place) => place.width(),
        };
        format!("0x{value:0digits$X}", digits = usize::from(width.div_ceil(4)))
    }

    /// Returns the frames of a message.
    pub fn frames_of<'a>(
        &'a self,
        message: &'a Message,
    ) -> impl DoubleEndedIterator<Item = &'a FrameLayout> + ExactSizeIterator + Clone {
        message.frames.iter().map(|frame| &self[*frame])
    }

    /// Returns the signals that a frame carries.
    pub fn signals_of<'a>(
        &'a self,
        frame: &'a FrameLayout,
    ) -> impl DoubleEndedIterator<Item = (SignalId, &'a Signal)> + ExactSizeIterator + Clone {
        let content = self.content_of(frame);
        frame.signals.iter().map(|signal| (*signal, &content[*signal]))
    }

    /// Returns the addressing patterns by which a frame is sent, with their modes.
    pub fn patterns_of<'a>(&'a self, frame: &'a FrameLayout) -> impl Iterator<Item = (ModeId, &'a AddressPattern)> {
        let patterns = frame.travels.iter();
        patterns.filter_map(|Travel { mode, who }| Some((*mode, self[*mode].pattern(frame.is_to_module(), *who)?)))
    }

    /// Returns the identifier of a frame in an addressing pattern, before its addresses are put in.
    pub fn base_identifier(&self, frame: &FrameLayout, pattern: &AddressPattern) -> u32 {
        let fields = self.identifier.fields.iter();
        let id = fields.fold(self.identifier.value, |id, field| field.put(id, field.sent()));
        let sends = self[frame.message].sends.iter();
        let id = sends.fold(id, |id, (field, value)| self[*field].put(id, *value));
        let id = frame.identifier().fold(id, |id, (field, value)| self[field].put(id, value));
        id & !pattern.mask | pattern.value
    }

    /// Returns the short name of a mode's target. It is the address type that only this mode leaves
    /// open, or else the mode.
    pub fn target_name<'a>(&'a self, mode: &'a Mode) -> &'a str {
        let alone = |known: &AddressTypeId| self.modes.iter().filter(|other| other.target == Some(*known)).count() == 1;
        mode.target.filter(alone).map_or(&mode.name, |known| &self[known].name)
    }

    /// Returns the device models that have a message.
    pub fn models_of(&self, message: &Message) -> impl Iterator<Item = ModelId> {
        self.models.ids().filter(|model| message.is_of(*model))
    }

    /// Returns the remarks of every item that can refer to an erratum.
    pub fn docs(&self) -> Vec<&Doc> {
        let mut docs: Vec<&Doc> = Vec::new();
        docs.extend(self.identifier.fields.iter().map(|field| &field.doc));
        docs.extend(self.selectors.iter().map(|selector| &selector.doc));
        docs.extend(self.enumerations.iter().map(|known| &known.doc));
        docs.extend(self.status_words.iter().map(|word| &word.doc));
        docs.extend(self.status_words.iter().flat_map(|word| &word.bits).map(|bit| &bit.doc));
        docs.extend(self.address_types.iter().map(|known| &known.doc));
        docs.extend(self.modes.iter().map(|mode| &mode.doc));
        docs.extend(self.accesses.iter().map(|access| &access.doc));
        docs.extend(self.foreign.iter().map(|foreign| &foreign.doc));
        docs.extend(self.transports.iter().map(|transport| &transport.doc));
        docs.extend(self.messages.iter().map(|message| &message.doc));
        docs.extend(self.messages.iter().flat_map(|message| &message.fixed).map(|field| &field.doc));
        docs.extend(self.contents().flat_map(|message| &message.signals).flat_map(Signal::docs));
        docs.extend(self.models.iter().map(|model| &model.doc));
        docs.extend(self.models.iter().flat_map(|model| &model.types).map(|known| &known.doc));
        docs.extend(self.timing.iter().map(|timing| &timing.doc));
        docs.extend(self.after_silence.iter().map(|silence| &silence.doc));
        docs.extend(self.procedures.iter().map(|procedure| &procedure.doc));
        docs.extend(self.sequences.iter());
        docs.extend(self.types.iter().map(|known| &known.doc));
        docs.extend(self.words.iter());
        docs.extend(self.examples.iter().map(|example| &example.doc));
        docs.extend(self.long_examples.iter().map(|example| &example.doc));
        docs.extend(self.value_examples.iter().map(|example| &example.doc));
        docs
    }
}
