//! The interpreter decodes and encodes by the model, at run time.
//!
//! `decode` follows the plan of the model to the kind of a frame and reads its values; `fit` ranks
//! what the frame may be, and `notes` says what its document does not expect. `encode` and `request`
//! make frames, which must decode to what was given. `assembly` and `transfer` put long messages
//! together, `long` reads what they say. Generated Rust does the same, by the same model.

mod arrays;
mod assembled;
mod assembly;
mod content;
mod continuation;
mod decode;
mod device;
mod encode;
mod fit;
mod given;
mod long;
mod notes;
mod oddities;
mod refusal;
mod request;
mod transfer;
mod value;

pub use assembled::{Assembled, Taken};
pub use assembly::Assembly;
pub(crate) use decode::failed_tests;
pub use decode::{Recognised, decode, recognise};
pub use device::{Sent, module, sent};
pub use encode::{encode, encode_long};
pub(crate) use oddities::signal_note;
pub use request::{Target, Targets, accesses, request, requests, source, targets};
pub use value::{Limits, physical, raw_of};

use std::fmt;

use crate::encoding::value_of_bytes;
pub use crate::encoding::{Input, Value, escape};
use crate::model::{
    AccessId, AddressTypeId, FieldId, FrameId, IdentifierField, Kind, LongMessageId, Message, MessageId, ModelId,
    NoteRule, Protocol, SelectorId, Side, Signal, SignalId, Table, Travel,
};
use crate::words::hex;

/// A frame as it stood on the bus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Identifier.
    pub id: u32,
    /// 29-bit identifier rather than 11-bit.
    pub extended: bool,
    /// Data bytes, at most 8.
    pub data: Vec<u8>,
    /// What sort of frame it is.
    pub form: Form,
}

impl Frame {
    /// Returns the data bytes, filled up with zeros.
    pub fn padded(&self) -> [u8; 8] {
        padded(&self.data)
    }
}

/// Returns a data frame.
fn frame(protocol: &Protocol, id: u32, data: Vec<u8>) -> Frame {
    Frame { id, extended: protocol.identifier.extended, data, form: Form::Data }
}

/// Writes a data frame as documents print it: `ID#DATA`.
impl fmt::Display for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = if self.extended { 8 } else { 3 };
        write!(f, "{:0digits$X}#{}", self.id, hex::digits(&self.data))
    }
}

/// Returns the first eight bytes, filled up with zeros.
pub(crate) fn padded(bytes: &[u8]) -> [u8; 8] {
    let mut data = [0; 8];
    data.iter_mut().zip(bytes).for_each(|(byte, given)| *byte = *given);
    data
}

/// What sort of frame it is. Only data frames are ever recognised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A classic data frame.
    Data,
    /// A remote frame, which asks for data.
    Remote,
    /// An error frame.
    Error,
    /// CAN FD.
    Fd,
}

/// A recognised frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// The kind of frame.
    pub frame: FrameId,
    /// The message that it carries.
    pub message: MessageId,
    /// The access by which it travels.
    pub access: AccessId,
    /// What the frame is for.
    pub kind: Kind,
    /// Who sends it.
    pub sender: Side,
    /// The device model that it was decoded for, if one was chosen.
    pub model: Option<ModelId>,
    /// The set that the frame belongs to.
    pub set: Option<MessageId>,
    /// The addressing mode, if one fits, and who answers or sends the frame.
    pub addressing: Option<Travel>,
    /// The identifier.
    pub id: u32,
    /// Payload selectors and their raw values.
    pub selectors: Vec<(SelectorId, u64)>,
    /// The long message whose signals these are, if they are not those of a frame.
    pub long: Option<LongMessageId>,
    /// Values of the signals.
    pub signals: Vec<Reading>,
    /// Set bits of the data bytes that nothing covers, first byte first.
    pub reserved: [u8; 8],
    /// Data bytes of the frame.
    pub length: usize,
    /// Notes on what the document does not foresee.
    pub notes: Vec<Note>,
}

impl Decoded {
    /// Takes out the signals that the chosen device model does not have, if no bit shows them.
    pub fn hide_lacking(&mut self, protocol: &Protocol) {
        let Some(model) = self.model else { return };
        let message = self.content(protocol);
        self.signals.retain(|reading| {
            let signal = &message[reading.signal];
            let mut words = reading.words(signal);
            signal.is_of(model) || words.any(|bits| protocol.lack(message, signal, model, bits).is_some())
        });
    }

    /// Tests whether `length` data bytes are more than the message has without some signal that they reach, and that is
    /// hidden since the chosen device model does not have it.
    pub fn is_length_hidden(&self, protocol: &Protocol, length: usize) -> bool {
        let (message, Some(model)) = (self.content(protocol), self.model) else { return false };
        let shortest = self.long.map_or(message.shortest().into(), |long| protocol[long].shortest_sent());
        let is_hidden = |id: SignalId| self.signals.iter().all(|reading| reading.signal != id);
        message.signals.entries().filter(|(_, signal)| !signal.is_of(model)).any(|(id, signal)| {
            let reach = signal.reach_with(length.checked_sub(signal.window.into()));
            (shortest + 1..=length).contains(&reach) && is_hidden(id)
        })
    }

    /// Returns the message that has the signals: that of the frame, or what its parts carry together.
    #[inline]
    pub fn content<'a>(&self, protocol: &'a Protocol) -> &'a Message {
        self.long.map_or(&protocol[self.message], |long| &protocol[long].content)
    }

    /// Returns the identifier's fields and their values.
    #[inline]
    pub fn identifier<'a>(
        &self,
        protocol: &'a Protocol,
    ) -> impl Iterator<Item = (&'a IdentifierField, u32)> + Clone + use<'a> {
        let id = self.id;
        protocol.identifier.fields.iter().map(move |field| (field, field.get(id)))
    }

    /// Returns the addresses that an identifier shows, each with its kind.
    #[inline]
    pub fn addresses<'a>(
        &self,
        protocol: &'a Protocol,
        id: u32,
    ) -> impl Iterator<Item = (AddressTypeId, i64)> + Clone + use<'a> {
        let is_to_module = self.sender == Side::Controller;
        let pattern = self.addressing.and_then(|travel| protocol[travel.mode].pattern(is_to_module, travel.who));
        pattern.map_or(&[][..], |pattern| &pattern.addresses).iter().map(move |address| {
            (address.address_type, protocol[address.address_type].number(protocol[address.field].get(id)))
        })
    }

    /// Tests whether a module reports an error by this frame, for instance a refused request. The
    /// values mean nothing then.
    #[inline]
    pub fn is_error_reply(&self) -> bool {
        self.sender == Side::Module && self.notes.iter().any(|note| note.rule == NoteRule::ErrorCode)
    }
}

/// What a frame says about one signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The signal.
    pub signal: SignalId,
    /// The bits, as the low bits of a number without sign extension. Of a run they are 0.
    pub bits: u64,
    /// The bytes of a run.
    pub bytes: Vec<u8>,
    /// The physical value.
    pub value: Value,
}

impl Reading {
    /// Returns what the bits of a signal say. The signal is as the device model has it.
    pub fn of(protocol: &Protocol, (id, signal): (SignalId, &Signal), bits: u64) -> Self {
        Self { signal: id, bits, bytes: Vec::new(), value: physical(protocol, signal, bits) }
    }

    /// Returns what the bytes of a run say.
    pub fn of_bytes((id, signal): (SignalId, &Signal), bytes: Vec<u8>) -> Self {
        Self { signal: id, bits: 0, value: value_of_bytes(signal, &bytes), bytes }
    }

    /// Returns how many data bytes reach to its end.
    fn reach(&self, signal: &Signal) -> usize {
        signal.reach_with(Some(self.bytes.len()))
    }

    /// Returns the bits, or those of each byte of a run.
    fn words(&self, signal: &Signal) -> impl Iterator<Item = u64> {
        let alone = signal.run.is_none().then_some(self.bits);
        alone.into_iter().chain(self.bytes.iter().copied().map(u64::from))
    }
}

/// Something about a recognised frame that the document does not foresee.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// What is noted.
    pub rule: NoteRule,
    /// What was found, in one sentence without a full stop.
    pub text: String,
}

impl Note {
    /// Tests whether the note is about the value of a signal.
    pub fn is_about_value(&self) -> bool {
        use NoteRule::{NotFinite, OutOfRange, UnknownBit, UnknownValue};
        matches!(self.rule, UnknownValue | UnknownBit | OutOfRange | NotFinite)
    }
}

/// A frame that is not recognised, and what could be read from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unrecognised {
    /// Which test failed.
    pub problem: Problem,
    /// What was found, in one sentence without a full stop.
    pub text: String,
    /// Values of the identifier's fields; empty if it was not split.
    pub identifier: Table<FieldId, u32>,
    /// Payload selectors and their raw values.
    pub selectors: Vec<(SelectorId, u64)>,
}

/// Why a frame is not recognised, in the order of the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// A remote, error or FD frame.
    Frame,
    /// An identifier that belongs to another device.
    Foreign,
    /// A wrong width or fixed bit, or an unknown direction.
    Identifier,
    /// No message has these constants in the identifier, or in the data bytes.
    UnknownMessage,
    /// Another number of data bytes.
    Length,
}

impl Problem {
    /// Returns the word of the output formats.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frame => "frame",
            Self::Foreign => "foreign",
            Self::Identifier => "identifier",
            Self::UnknownMessage => "unknown_message",
            Self::Length => "length",
        }
    }
}

/// The content of a decoded line, from which [`encode()`] makes a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Content {
    /// Name of the message.
    pub message: String,
    /// Name of the access; `None` for any that fits.
    pub access: Option<String>,
    /// What the frame is for; `None` for what identifier and selectors show.
    pub kind: Option<Kind>,
    /// Named fields of the identifier and their raw values.
    pub identifier: Vec<(String, u64)>,
    /// Selectors of the data bytes and their raw values.
    pub selectors: Vec<(String, u64)>,
    /// Signals and their values.
    pub signals: Vec<(String, Input)>,
    /// Arrays and the values of their elements. An element can be missing.
    pub arrays: Vec<(String, Vec<Option<Input>>)>,
    /// Bits to set beside the signals, first byte first.
    pub reserved: Vec<u8>,
}

/// Why a frame was not made. It names message, signal, value, unit and limits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal(pub String);

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

/// Shows an address field as documents print it.
fn hexadecimal(value: u32) -> String {
    format!("0x{value:02X}")
}

/// Shows inclusive ranges of raw values of a field of the identifier.
fn hexadecimal_ranges(ranges: &[(u32, u32)]) -> String {
    let shown = |(first, last): &(u32, u32)| {
        let [first, last] = [*first, *last].map(hexadecimal);
        if first == last { first } else { format!("{first}..{last}") }
    };
    ranges.iter().map(shown).collect::<Vec<_>>().join(", ")
}
