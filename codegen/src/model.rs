//! The checked, target-neutral description of a protocol that both engines and every emitter read.
//!
//! Only the compiler makes these values: a [`Protocol`] that exists has passed every check.

use canspec_runtime::Place;

use crate::number::Rational;
use crate::syntax::tree::Path;

/// A whole protocol.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Protocol {
    /// Module name of the generated code.
    pub name: String,
    /// The spec's file name, without folders.
    pub file: String,
    /// What the devices are, without a full stop.
    pub title: String,
    /// The vendor document that the spec follows.
    pub document: Document,
    /// Bit rates of the bus in bit/s.
    pub bit_rates: Vec<u32>,
    /// Layout of the identifier.
    pub identifier: Identifier,
    /// Fields whose constants choose a message: of the identifier, of the header, of a message.
    pub selectors: Vec<Selector>,
    /// Named values of signals, selectors and fields of the identifier.
    pub enumerations: Vec<Enumeration>,
    /// Status words of signals.
    pub status_words: Vec<StatusWord>,
    /// Kinds of addresses that the addressing modes name.
    pub address_types: Vec<AddressType>,
    /// Addressing modes in the order of the spec.
    pub modes: Vec<Mode>,
    /// How an identifier shows that a frame goes to a module.
    pub to_module: Direction,
    /// How an identifier shows that a frame goes to the controller.
    pub to_controller: Direction,
    /// Accesses in the order of the spec.
    pub accesses: Vec<Access>,
    /// Identifiers that are never sent, and refused on receipt.
    pub foreign: Vec<Foreign>,
    /// Messages in the order of the spec.
    pub messages: Vec<Message>,
    /// Device models in the order of the spec.
    pub models: Vec<DeviceModel>,
    /// Times that the document states.
    pub timing: Vec<Timing>,
    /// Procedures that the document describes.
    pub procedures: Vec<Procedure>,
    /// Examples of whole messages in the order of the spec, then those of the sequences.
    pub examples: Vec<Example>,
    /// Examples of types: bytes alone, and the value they mean.
    pub value_examples: Vec<ValueExample>,
    /// What the spec says beside the sequences of examples.
    pub sequences: Vec<Doc>,
    /// What the spec says beside the types.
    pub types: Vec<Doc>,
    /// Remarks of words of fields, which are no signals themselves.
    pub words: Vec<Doc>,
    /// Departures from the document.
    pub errata: Vec<Erratum>,
}

/// The vendor document.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Document {
    /// Title as printed.
    pub title: String,
    /// Version as printed.
    pub version: String,
    /// Date of that version, if the spec states it.
    pub date: Option<String>,
    /// Name of the file that was read, if the spec states it.
    pub file: Option<String>,
}

/// What a spec says about an item beside its meaning for the codec.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Doc {
    /// What the item is, in a few words without a full stop.
    pub title: Option<String>,
    /// What else a reader must know.
    pub note: Option<String>,
    /// The item's own section, or that of what it stands in.
    pub section: Option<String>,
    /// Errata by name.
    pub errata: Vec<String>,
    /// Place in the spec.
    pub path: Path,
}

/// The identifier's layout.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Identifier {
    /// 29 bits rather than 11.
    pub extended: bool,
    /// Fields from the most to the least significant bit.
    pub fields: Vec<IdentifierField>,
    /// Bits with a fixed value: constant fields, `ones` and `zeros`.
    pub mask: u32,
    /// Values of these bits.
    pub value: u32,
}

/// A named bit field of the identifier.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct IdentifierField {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Least significant bit.
    pub shift: u8,
    /// Number of bits, `1..=29`.
    pub width: u8,
    /// The only value of this protocol, if there is one.
    pub constant: Option<u32>,
    /// Sent unless the caller says otherwise.
    pub send: Option<u32>,
    /// The value of a reply that is no error reply.
    pub normal: Option<u32>,
    /// Index into [`Protocol::enumerations`].
    pub enumeration: Option<usize>,
}

impl IdentifierField {
    /// Returns the field's bits in the identifier.
    pub fn mask(&self) -> u32 {
        let ones = u32::MAX >> (32 - self.width);
        ones << self.shift
    }

    /// Returns the field's value in an identifier.
    pub fn get(&self, identifier: u32) -> u32 {
        (identifier & self.mask()) >> self.shift
    }
}

/// A field whose constants choose a message, or which says whether a request was accepted.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Selector {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Where it stands.
    pub place: SelectorPlace,
    /// The value of a reply that is no error reply.
    pub normal: Option<u64>,
    /// Index into [`Protocol::enumerations`].
    pub enumeration: Option<usize>,
}

/// Where a selector stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SelectorPlace {
    /// Index into [`Identifier::fields`].
    Identifier(usize),
    /// In the data bytes.
    Payload(Place),
}

/// Named values of a signal.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Enumeration {
    /// Name of the type, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Width of the raw value in bits.
    pub width: u8,
    /// Named values in the order of the spec.
    pub values: Vec<NamedValue>,
}

/// A raw value with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct NamedValue {
    /// Raw value, sign-extended where the signal is signed.
    pub raw: i128,
    /// Name in the spec, in `snake_case`.
    pub name: String,
}

/// A word of which each named bit is a condition.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct StatusWord {
    /// Name of the type, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Number of bits, `1..=64`.
    pub width: u8,
    /// Bits by number, the lowest first.
    pub bits: Vec<StatusBit>,
}

impl StatusWord {
    /// Returns the bits that have a name.
    pub fn known(&self) -> u64 {
        self.bits.iter().fold(0, |mask, bit| mask | 1 << bit.bit)
    }
}

/// One bit of a status word.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct StatusBit {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Number of the bit, 0 = least significant.
    pub bit: u8,
    /// How grave the set bit is, if the document says so.
    pub severity: Option<Severity>,
    /// Condition that sets the bit.
    pub set_when: Option<String>,
    /// Condition that clears the bit.
    pub clear_when: Option<String>,
    /// What the device does while the bit is set.
    pub effect: Option<String>,
    /// What the device's LED shows while the bit is set.
    pub led: Option<String>,
}

/// How grave a status bit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Severity {
    /// Describes a condition.
    State,
    /// A warning from which the device recovers.
    Alarm,
    /// A defect.
    Fault,
}

/// A kind of address: a range of numbers in a field of the identifier.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct AddressType {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// First number that the document names.
    pub first: i64,
    /// Last number that the document names.
    pub last: i64,
    /// Number of raw 0.
    pub offset: i64,
    /// Step of the number from one raw value to the next, 1 or -1: raw = (number - offset) * sign.
    pub sign: i64,
    /// A number outside the range is something else, rather than an undocumented address.
    pub strict: bool,
    /// Number sent unless the caller says otherwise.
    pub send: Option<i64>,
}

impl AddressType {
    /// Returns the raw value of an address number.
    pub fn raw(&self, number: i64) -> i64 {
        (number - self.offset) * self.sign
    }

    /// Returns the address number of a raw value.
    pub fn number(&self, raw: u32) -> i64 {
        i64::from(raw) * self.sign + self.offset
    }

    /// Returns the documented raw values as an inclusive range.
    pub fn raw_range(&self) -> (u32, u32) {
        let ends = [self.raw(self.first), self.raw(self.last)].map(|end| u32::try_from(end).unwrap_or(0));
        (ends[0].min(ends[1]), ends[0].max(ends[1]))
    }

    /// Tests whether the document names this raw value.
    pub fn documents(&self, raw: u32) -> bool {
        (self.first..=self.last).contains(&self.number(raw))
    }
}

/// An addressing mode.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Mode {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// What the identifier of a request shows.
    pub request: Option<AddressPattern>,
    /// What the identifier of a reply or report shows if the one module addressed sends it.
    pub one: Option<AddressPattern>,
    /// What the identifier of a reply or report shows if each module addressed sends one.
    pub each: Option<AddressPattern>,
    /// What the identifier of a reply or report shows if one module sends it for all.
    pub coordinator: Option<AddressPattern>,
    /// The address type that the caller chooses in a request: index into [`Protocol::address_types`].
    pub target: Option<usize>,
}

impl Mode {
    /// Returns the pattern of the replies when `who` answers.
    pub fn reply(&self, who: Who) -> Option<&AddressPattern> {
        match who {
            Who::One => self.one.as_ref(),
            Who::Each => self.each.as_ref(),
            Who::Coordinator => self.coordinator.as_ref(),
            Who::Nobody => None,
        }
    }
}

/// Constants and addresses that an identifier must show.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct AddressPattern {
    /// Bits of the identifier that are constant.
    pub mask: u32,
    /// Values of these bits.
    pub value: u32,
    /// How many fields the constants cover.
    pub constants: usize,
    /// Fields that hold addresses.
    pub addresses: Vec<Address>,
}

/// A field of the identifier that holds an address.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Address {
    /// Index into [`Identifier::fields`].
    pub field: usize,
    /// Index into [`Protocol::address_types`].
    pub address_type: usize,
    /// Raw ranges that belong to somebody else; the other undocumented ones are tolerated, unless the type is strict.
    pub excluded: Vec<(u32, u32)>,
}

/// How an identifier shows its direction: one of these lists of tests holds.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Direction {
    /// Lists of tests; a direction is shown if all tests of one list hold.
    pub any: Vec<Vec<FieldTest>>,
}

/// A test of one identifier field.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FieldTest {
    /// Index into [`Identifier::fields`].
    pub field: usize,
    /// Inclusive raw ranges.
    pub ranges: Vec<(u32, u32)>,
    /// The value lies in one of the ranges, rather than in none.
    pub inside: bool,
}

/// What a frame is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Towards a module: reads and sets alike.
    Request,
    /// Towards the controller, echoes and failures included.
    Reply,
    /// Sent unasked.
    Report,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Request, Self::Reply, Self::Report];

    /// Returns the word of the spec language.
    pub fn name(self) -> &'static str {
        match self {
            Self::Request => "request",
            Self::Reply => "reply",
            Self::Report => "report",
        }
    }
}

/// Who answers a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// The module addressed.
    One,
    /// Each module addressed.
    Each,
    /// One module for all.
    Coordinator,
    /// Nobody.
    Nobody,
}

/// How a message travels.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Access {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The kinds of frames that exist.
    pub kinds: Vec<Kind>,
    /// The kinds of frames that carry the message's signals.
    pub carries: Vec<Kind>,
    /// Who answers, by [`Protocol::modes`]; `None` where the mode is not allowed.
    pub answers: Vec<Option<Who>>,
    /// Index into [`Protocol::timing`]: how often a report comes.
    pub every: Option<usize>,
}

/// Identifiers of somebody else on the bus.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Foreign {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Inclusive ranges of raw values, all of which must hold: `None` is the identifier as a whole, else an index into [`Identifier::fields`].
    pub ranges: Vec<(Option<usize>, u32, u32)>,
}

/// A message.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Message {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Data bytes of its frames.
    pub length: u8,
    /// Signals by first byte, then as written.
    pub signals: Vec<Signal>,
    /// Accesses by which it travels.
    pub accesses: Vec<MessageAccess>,
    /// The frames that exist: one for each access and kind.
    pub shapes: Vec<Shape>,
    /// Index into [`Protocol::timing`]: how often its report comes, if not as its access says.
    pub every: Option<usize>,
}

/// An access as one message has it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MessageAccess {
    /// Index into [`Protocol::accesses`].
    pub access: usize,
    /// Who answers, by [`Protocol::modes`]; `None` where the mode is not allowed.
    pub answers: Vec<Option<Who>>,
}

/// One kind of frame of one message.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Shape {
    /// Index into [`Message::accesses`].
    pub access: usize,
    /// What the frame is for.
    pub kind: Kind,
    /// What chooses this frame: selectors (index into [`Protocol::selectors`]) and their values.
    pub constants: Vec<(usize, u64)>,
    /// Payload selectors that this frame has, constants included.
    pub selectors: Vec<usize>,
    /// Signals that this frame carries: indices into [`Message::signals`].
    pub signals: Vec<usize>,
}

/// A named value in the data bytes.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Signal {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The entries of `types` it takes keys from, the last first.
    pub types: Vec<String>,
    /// Bits of the data bytes.
    pub place: Place,
    /// What these bits mean.
    pub encoding: Encoding,
    /// Unit of the physical value.
    pub unit: Option<Unit>,
    /// Physical limits.
    pub range: Option<Range>,
    /// Named raw values that are legal outside the range.
    pub specials: Vec<NamedValue>,
    /// Raw value that the device starts with.
    pub default: Option<i128>,
    /// The only kinds of frames that have it; empty if the access decides.
    pub kinds: Vec<Kind>,
}

/// What a signal's bits mean.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Encoding {
    /// physical = raw * scale + offset.
    Number {
        /// Two's complement.
        signed: bool,
        /// Physical value of one step.
        scale: Rational,
        /// Physical value of raw 0.
        offset: Rational,
    },
    /// IEEE 754 single precision.
    Float,
    /// Index into [`Protocol::enumerations`].
    Named(usize),
    /// Index into [`Protocol::status_words`].
    Status(usize),
    /// ASCII, the first character at the most significant byte of the place.
    Text,
    /// One text made of several parts.
    Packed {
        /// What the text consists of, in order.
        pieces: Vec<Piece>,
        /// Bits of the payload that the pieces name.
        parts: Vec<Signal>,
    },
}

impl Encoding {
    /// Tests whether the physical value is a raw integer.
    pub fn is_unscaled(&self) -> bool {
        matches!(self, Self::Number { scale, offset, .. } if *scale == Rational::ONE && *offset == Rational::ZERO)
    }
}

/// A piece of a packed value's text.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Piece {
    /// A text that stands as it is.
    Literal(String),
    /// The text or the number of a part.
    Part {
        /// Index into the parts of the packed value.
        part: usize,
        /// To how many digits a number is filled with zeros.
        digits: Option<usize>,
    },
}

/// Physical limits, both legal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Range {
    /// Lowest value.
    pub minimum: Rational,
    /// Highest value.
    pub maximum: Rational,
}

/// A unit of the spec language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Unit {
    /// The symbol in specs, logs and documentation.
    pub symbol: &'static str,
    /// The ending of a Rust field name.
    pub suffix: &'static str,
}

impl Unit {
    /// Every unit of the language.
    pub const ALL: [Self; 12] = [
        Self { symbol: "V", suffix: "v" },
        Self { symbol: "A", suffix: "a" },
        Self { symbol: "W", suffix: "w" },
        Self { symbol: "Hz", suffix: "hz" },
        Self { symbol: "°C", suffix: "c" },
        Self { symbol: "%", suffix: "percent" },
        Self { symbol: "s", suffix: "s" },
        Self { symbol: "ms", suffix: "ms" },
        Self { symbol: "min", suffix: "min" },
        Self { symbol: "h", suffix: "h" },
        Self { symbol: "rpm", suffix: "rpm" },
        Self { symbol: "m", suffix: "m" },
    ];

    /// Finds a unit by its symbol.
    pub fn find(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol == symbol)
    }
}

/// A device model.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct DeviceModel {
    /// Name in the spec, as the vendor spells it.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Item numbers.
    pub items: Vec<String>,
    /// Most devices that can work together, if the document says so.
    pub max_parallel: Option<u32>,
    /// Bit rates of this model in bit/s; empty if the document says nothing of it.
    pub bit_rates: Vec<u32>,
    /// Ratings that no message carries, by name.
    pub facts: Vec<(String, Quantity)>,
    /// What this model changes of a type, by the type's name.
    pub types: Vec<TypeOfModel>,
}

/// What a device model changes of a type.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TypeOfModel {
    /// Name of the type.
    pub name: String,
    /// Physical limits of this model, if it has its own.
    pub range: Option<Range>,
    /// Physical value that the device starts with.
    pub default: Option<Rational>,
    /// What the spec says beside it.
    pub doc: Doc,
}

/// A number with a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Quantity {
    /// The number.
    pub value: Rational,
    /// Its unit, if it has one.
    pub unit: Option<Unit>,
}

/// A time that the document states; both ends are equal where it names one value.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Timing {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// The shortest and the longest time.
    pub range: Range,
    /// Unit of the range.
    pub unit: Unit,
    /// Lower limit that holds beside a recommended time.
    pub minimum: Option<Quantity>,
}

/// Steps in order.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Procedure {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// One sentence each; names of messages stand in backquotes.
    pub steps: Vec<String>,
}

/// A frame of the document and what it means.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Example {
    /// What the spec says beside it.
    pub doc: Doc,
    /// What the spec says the frame is for.
    pub kind: Kind,
    /// Identifier.
    pub id: u32,
    /// 29-bit identifier rather than 11-bit.
    pub extended: bool,
    /// `None` where the document prints an identifier alone.
    pub data: Option<Vec<u8>>,
    /// Index into [`Protocol::messages`]; `None` for a frame that is none of them.
    pub message: Option<usize>,
    /// Raw values of the message's signals (indices into [`Message::signals`]), and the text that says so.
    pub means: Vec<Meaning>,
    /// Rules of the notes that decoding must report.
    pub notes: Vec<String>,
    /// How the frame fails, if it has to.
    pub fails: Option<Failure>,
    /// The document does not print it.
    pub ours: bool,
    /// The place in the list it stands in: a reply answers the request before it.
    pub position: usize,
}

/// What an example says of one signal.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Meaning {
    /// Index into [`Message::signals`].
    pub signal: usize,
    /// As written in the spec.
    pub text: String,
    /// The raw bits, if the value lies on the signal's grid.
    pub raw: Option<u64>,
    /// Place in the spec.
    pub path: Path,
}

/// How a printed frame fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Failure {
    /// Its identifier has the wrong width or a wrong fixed bit, or does not show its direction.
    Identifier,
    /// Its identifier belongs to somebody else.
    Foreign,
    /// It has another number of data bytes.
    Length,
    /// No message has its constants.
    UnknownMessage,
    /// It decodes as another message.
    Message,
    /// It decodes to other values.
    Values,
    /// It shows an addressing mode that the message does not have, or none.
    Addressing,
}

impl Failure {
    /// Every failure with its word of the spec language.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::Identifier, "identifier"),
        (Self::Foreign, "foreign"),
        (Self::Length, "length"),
        (Self::UnknownMessage, "unknown_message"),
        (Self::Message, "message"),
        (Self::Values, "values"),
        (Self::Addressing, "addressing"),
    ];

    /// Returns the word of the spec language.
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(failure, _)| *failure == self).map_or("", |(_, name)| name)
    }
}

/// Bytes of a type alone, and the value they mean.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ValueExample {
    /// What the spec says beside it.
    pub doc: Doc,
    /// The type as a signal at the first byte.
    pub signal: Signal,
    /// The bytes, followed by zeros.
    pub data: [u8; 8],
    /// The value they mean.
    pub meaning: Meaning,
}

/// A departure from the document.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Erratum {
    /// Name in the spec.
    pub name: String,
    /// What is wrong: `vendor`, `translation`, `ocr`, `unclear`, `gap` or `note`.
    pub kind: String,
    /// Section of the document that prints it.
    pub section: Option<String>,
    /// What the document prints.
    pub prints: String,
    /// What the spec uses.
    pub uses: String,
    /// Why the spec departs from the document.
    pub because: String,
    /// Place in the spec.
    pub path: Path,
}

impl Protocol {
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
        docs.extend(self.messages.iter().map(|message| &message.doc));
        docs.extend(self.messages.iter().flat_map(|message| &message.signals).flat_map(Signal::docs));
        docs.extend(self.models.iter().map(|model| &model.doc));
        docs.extend(self.models.iter().flat_map(|model| &model.types).map(|known| &known.doc));
        docs.extend(self.timing.iter().map(|timing| &timing.doc));
        docs.extend(self.procedures.iter().map(|procedure| &procedure.doc));
        docs.extend(self.sequences.iter());
        docs.extend(self.types.iter());
        docs.extend(self.words.iter());
        docs.extend(self.examples.iter().map(|example| &example.doc));
        docs.extend(self.value_examples.iter().map(|example| &example.doc));
        docs
    }
}

impl Signal {
    /// Returns the remarks of the signal and of its parts.
    fn docs(&self) -> Vec<&Doc> {
        let parts = match &self.encoding {
            Encoding::Packed { parts, .. } => parts.as_slice(),
            _ => &[],
        };
        std::iter::once(&self.doc).chain(parts.iter().map(|part| &part.doc)).collect()
    }
}
