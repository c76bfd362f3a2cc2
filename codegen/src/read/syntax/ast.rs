//! A spec as it is written: every leaf is still its text.

mod field;
mod message;
mod quantity;
mod reading;
mod travel;

pub use field::{Field, Key};
pub use message::{Elements, Example, Means, Message, Parts, Sequence};
pub use quantity::{Product, Quantity, SignalPath, States};
pub use travel::{Access, Foreign, Mode, Transport};

use indexmap::IndexMap;
use serde::Deserialize;

/// Names to entries, in the order of the file.
pub type Map<V> = IndexMap<String, V>;

/// `{field: what it must be}`: a number, a range or the name of an address type.
pub type Pattern = Map<String>;

/// `{field: what it must be}`: a number, or a list of all numbers that it can be.
pub type Constants = Map<Numbers>;

/// A whole spec file.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Spec {
    /// Version of the spec language: `1`.
    pub canspec: String,
    /// Name of the protocol, of its Rust module and of `--protocol`, in lower-case letters, digits and `_`: `charger`.
    pub protocol: String,
    /// What the devices are, in a few words without a full stop: `Charging modules`.
    pub title: Words,
    /// Name of another spec that this one takes over and changes: `charger`. It is a file
    /// `charger.yaml` beside this one, or else a built-in protocol. Nothing is taken over if absent.
    pub based_on: Option<String>,
    /// List of what is in both specs and not joined, by the keys that lead to it: `[messages.output.title]`;
    /// none if absent.
    #[serde(default)]
    pub replaces: Vec<String>,
    /// List of what is not taken over, by the keys that lead to it: `[messages.fan_speed]`; none if absent.
    #[serde(default)]
    pub removes: Vec<String>,
    /// The vendor document that the spec follows: `{title: Charging module CAN protocol, version: V1.0}`.
    /// It may be absent if `documents` names others.
    pub document: Option<Document>,
    /// Other documents by name: `{C: {title: Captured frames, version: not stated}}`. Sections in them
    /// begin with that name: `"C 2.1"`. None if absent.
    #[serde(default)]
    pub documents: Map<Document>,
    /// What the two sides are called in texts: `{module: battery, controller: inverter}`; `module` and
    /// `controller` if absent.
    pub sides: Option<Sides>,
    /// Data bytes of each frame, 0 to 8, unless a message says otherwise: `8`.
    pub length: String,
    /// Speeds of the bus in whole kbit/s, a list: `[125 kbit/s, 250 kbit/s]`; none if absent.
    #[serde(default)]
    pub bit_rates: Vec<String>,
    /// Units beside those of the language, by their names in Rust: `{l_per_min: l/min}`; none if absent.
    #[serde(default)]
    pub units: Map<String>,
    /// Fields of the identifier by name. Together with `ones` and `zeros` they fill all of its 11
    /// or 29 bits: `{command: {bits: 28..16}, target: {bits: 15..8}, source: {bits: 7..0}}`.
    #[cfg_attr(feature = "schema", schemars(schema_with = "crate::reference::schema::identifier"))]
    pub identifier: Map<IdentifierEntry>,
    /// What the bits are that nothing names: `{send: 1, expect: any}`. If absent, they are sent as
    /// 0, and a received 1 gets a note.
    pub reserved: Option<Reserved>,
    /// What stands for a value that the device does not have, unless a field says otherwise: `ones`
    /// or `none`; `none` if absent. `ones` are bits that are all 1, and the greatest signed number.
    pub absent: Option<String>,
    /// Fields by name, in the data bytes, that choose the message: `{register: {bytes: 2..3}}`;
    /// none if absent. A frame has them if its message or its access names one of them.
    #[serde(default)]
    pub header: Map<Field>,
    /// Types by name. Fields take keys from them with `type`, and `addressing` names those that are
    /// address types: `{real: {as: float}, module: {range: 0x00..0x3B}}`; none if absent.
    #[serde(default)]
    pub types: Map<Field>,
    /// Addressing modes by name. A mode says how the identifier shows where a request goes and who
    /// answers: `{single: {request: {target: module}, one: {source: module}}}`; none if absent.
    #[serde(default)]
    pub addressing: Map<Mode>,
    /// Accesses by name. An access says which kinds of frames there are, and what tells them apart:
    /// `{read: {request: {}, reply: {}, in: [reply], answers: {single: one}}}`.
    pub access: Map<Access>,
    /// Identifiers of other devices on the bus, by name. They are never sent, and refused on
    /// receipt: `{others: {match: {identifier: 0x100..0x1FF}}}`; none if absent.
    #[serde(default)]
    pub foreign: Map<Foreign>,
    /// Standards by which messages longer than a frame travel, by name:
    /// `{tp: {kind: isotp}}`; none if absent.
    #[serde(default)]
    pub transports: Map<Transport>,
    /// Messages by name. A register is a message too:
    /// `{fan_speed: {match: {command: 0x03}, access: [read], value: {bytes: 0..1, unit: rpm}}}`;
    /// none if absent.
    #[serde(default)]
    pub messages: Map<Message>,
    /// Where a program reads and sets what devices of any vendor have, by vendor-neutral names:
    /// `{output_voltage: {read: output.voltage, set: set_output.voltage}}`; none if absent.
    #[serde(default)]
    pub quantities: Map<Quantity>,
    /// What is true of the product in which the devices work, and not of the devices:
    /// `{limits: {output_voltage: 150..450 V}}`; nothing if absent.
    pub product: Option<Product>,
    /// Device models by name, and what is different for each:
    /// `{SM75030: {max_parallel: 60, types: {volts: {range: 50..750}}}}`; none if absent.
    #[serde(default)]
    pub models: Map<DeviceModel>,
    /// Times that the document states, by name: `{watchdog: {time: 10 s}}`; none if absent.
    #[serde(default)]
    pub timing: Map<Timing>,
    /// What a device does after the controller was silent: `{output: resumes}`; the document does not say it if absent.
    pub after_silence: Option<AfterSilence>,
    /// Procedures by name, each a list of steps: `{switch_on: {steps: [Apply the input power, Close the relay]}}`; none
    /// if absent.
    #[serde(default)]
    pub procedures: Map<Procedure>,
    /// Sequences of example frames by name, where the document shows several messages in a row:
    /// `{start: {frames: [{request: 000302F0#0000, message: output}]}}`; none if absent.
    #[serde(default)]
    pub examples: Map<Sequence>,
    /// Departures from the document by name:
    /// `{E1: {kind: ocr, prints: 13 38, uses: 13 88, because: the text says 500 V}}`; none if absent.
    #[serde(default)]
    pub errata: Map<Erratum>,
    /// List of warnings that are accepted:
    /// `[{rule: section, at: messages.output, because: only seen on the bus}]`; none if absent.
    #[serde(default)]
    pub allow: Vec<Allowance>,
}

/// What the bits are that nothing names.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Reserved {
    /// What they are in frames that are built: `0` or `1`; 0 if absent.
    pub send: Option<String>,
    /// What they may be in received frames without a note: `sent` (what is sent) or `any`; `sent`
    /// if absent.
    pub expect: Option<String>,
}

/// What the two sides are called in texts.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sides {
    /// What a module is, in lower-case letters, digits and `_`: `battery`; `module` if absent.
    pub module: Option<String>,
    /// What the controller is, in lower-case letters, digits and `_`: `inverter`; `controller` if absent.
    pub controller: Option<String>,
}

/// The vendor document that the spec follows.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Title as printed: `Charging module CAN protocol`.
    pub title: Words,
    /// Version as printed: `V1.0`.
    pub version: Words,
    /// Date of that version: `2020-10-18`; not stated if absent.
    pub date: Option<Words>,
    /// Name of the file that was read: `charger.pdf`; not stated if absent.
    pub file: Option<Words>,
}

/// One entry of `identifier`: a named field, or the place of unnamed `ones` or `zeros`.
#[derive(Clone, Debug)]
pub enum IdentifierEntry {
    /// Bits from the most to the least significant: `6..1` or `25`. They must be 1 after `ones`,
    /// and 0 after `zeros`.
    Place(String),
    /// A field with its `bits`: `{bits: 28..16}`.
    Field(Box<Field>),
}

/// One bit of a status word.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StatusBit {
    /// Number of the bit in its word, or in the `byte`: `3`. Bit 0 is the least significant.
    pub bit: String,
    /// Byte of the frame in which `bit` counts, 0 to 7: `5`; if absent, `bit` counts in the word.
    pub byte: Option<String>,
    /// How many bits in a row have this name and a number: `48`; one bit without a number if absent.
    pub repeat: Option<String>,
    /// Number of the first bit of a row: `0`; 1 if absent.
    pub first: Option<String>,
    /// Severity of the set bit: `state` (a condition), `alarm` (the device recovers) or `fault` (a
    /// defect); not stated if absent.
    pub severity: Option<String>,
    /// Condition that sets the bit, as a text: `no command for 10 s`; not stated if absent.
    pub set_when: Option<Words>,
    /// Condition that clears the bit, as a text: `a command arrives`; not stated if absent.
    pub clear_when: Option<Words>,
    /// What the device does while the bit is set, as a text: `module switches off`; not stated if absent.
    pub effect: Option<Words>,
    /// What the device's LED shows while the bit is set, as a text: `red`; not stated if absent.
    pub led: Option<Words>,
    /// List of the only device models that have the bit: `[SM_750]`; if absent, every model that has
    /// the word.
    #[serde(default)]
    pub models: Vec<String>,
    /// What it is, in a few words without a full stop: `Fan fault`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `valid on three-phase modules only`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes: `"2.4"`; if absent, that of the item around it.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// The name of a raw value. It is a map if more is said of it.
#[derive(Clone, Debug)]
pub struct NamedValue {
    /// The name.
    pub name: String,
    /// What the value is, in a few words.
    pub title: Option<Words>,
    /// The only device models that have the value; empty if every model has it.
    pub models: Vec<String>,
}

/// A named raw value with a title, or of some device models.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DescribedValue {
    /// Name of the raw value: `boost`.
    pub name: String,
    /// What the value is, in a few words without a full stop: `Charges faster`.
    pub title: Option<Words>,
    /// List of the only device models that have the value: `[SM_750]`; every model has it if absent.
    #[serde(default)]
    pub models: Vec<String>,
}

/// Bytes of a type, and the value that they stand for.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ValueExample {
    /// The 1 to 8 bytes of the type alone, in hexadecimal, first byte first: `43FA0000`.
    pub bytes: String,
    /// Physical value of these bytes, with its unit if the type has one: `500 V`. It can also be a
    /// name or a text.
    pub means: String,
    /// Section of the document that says so, in quotes: `"2.4"`; if absent, that of the item around it.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// A device model, and what is different for it.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DeviceModel {
    /// What it is, in a few words without a full stop: `Module for up to 750 V`.
    pub title: Option<Words>,
    /// Item numbers of the model, a list of texts: `[SM-750-30]`; none if absent.
    #[serde(default)]
    pub items: Vec<Words>,
    /// Largest number of devices that can work together, 1 to 65535: `60`; not stated if absent.
    pub max_parallel: Option<String>,
    /// Speeds of this model in whole kbit/s, a list: `[125 kbit/s]`; not stated if absent.
    #[serde(default)]
    pub bit_rates: Vec<String>,
    /// Ratings by name that no message carries, each a number with its unit:
    /// `{rated_current: 20 A}`; none if absent.
    #[serde(default)]
    pub facts: Map<String>,
    /// What this model changes of entries of `types`: `range` and `default` without units, and
    /// `scale`, `offset` and `unit`. An example is `{amperes: {scale: 1/20, range: 0..60}}`; none if absent.
    #[serde(default)]
    pub types: Map<Field>,
    /// What else a reader must know, in one sentence: `answers to broadcasts from software 1.20 on`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// A time that the document states.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// The time or its range, with its unit: `10 s` or `50..200 ms`.
    pub time: String,
    /// Lower limit that holds beside a recommended time, with its unit: `20 ms`; not stated if absent.
    pub minimum: Option<String>,
    /// What it is for; not stated if absent. `request_gap` is the time from one request to the next,
    /// and `reply_timeout` the wait for a reply. After a silence as long as `watchdog`, the other side
    /// acts by itself. `boot` is the time from power-on until a device can be asked. `settling` is
    /// that from a request until what it changes is in effect.
    pub role: Option<String>,
    /// How often a request is sent before it counts as unanswered, with `role: reply_timeout`: `2`;
    /// not stated if absent.
    pub tries: Option<String>,
    /// List of the only messages that the time with a `role` is about: `[keep_alive]`; every message
    /// if absent.
    #[serde(default)]
    pub messages: Vec<String>,
    /// What it is, in a few words without a full stop: `Silence until the module switches off`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `any command counts`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// What a device does after the controller was silent.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct AfterSilence {
    /// What becomes of its output: `off`, `resumes`, `starts`, `keeps` or `unknown`. After `off` it stays off until it is
    /// switched on. What `resumes` goes off, and comes back when the device hears any request. A device that `starts`
    /// delivers by itself, also if it was switched off. One that `keeps` goes on as it was.
    pub output: String,
    /// What it is, in a few words without a full stop: `Output after silence`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `a module that was off stays off`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// Steps in order.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Procedure {
    /// Steps in order, each a sentence: ``[Wait 10 s, Read `output`]``. A name in backquotes must
    /// be a message.
    pub steps: Vec<Words>,
    /// What it is, in a few words without a full stop: `Switching on`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `repeat it when a module has been replaced`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// Where the spec departs from the document.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Erratum {
    /// What is wrong: `vendor`, `translation`, `ocr`, `unclear`, `gap` or `note`. `vendor` is a
    /// mistake in the original, and `ocr` one in the reading of a scan. `unclear` text can be read
    /// in two ways, and a `gap` lacks something. A `note` is an oddity that the spec uses as
    /// printed.
    pub kind: String,
    /// What the document prints: `13 38`.
    pub prints: Words,
    /// What the spec uses: `13 88`.
    pub uses: Words,
    /// Why the spec departs from the document: `the text beside it says 500 V`.
    pub because: Words,
    /// Section that prints it, in quotes: `"2.4"`; not stated if absent.
    pub section: Option<Words>,
}

/// Warnings of one rule that are accepted.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Allowance {
    /// Rule that warns: `section`.
    pub rule: String,
    /// Item in which the warnings are, by the keys that lead to it: `messages.output`.
    pub at: String,
    /// Why they are accepted: `only seen on the bus`.
    pub because: Words,
}

/// A number, or one for each device model.
#[derive(Clone, Debug)]
pub enum ByModel {
    /// The same for every model: `1`.
    Every(String),
    /// One for each of these models: `{V10: 0, V11: 1}`.
    Each(Map<String>),
}

/// What a part of a message carries.
#[derive(Clone, Debug)]
pub enum PartData {
    /// Bytes that say nothing alone: `1..6`.
    Bytes(String),
    /// Elements of the arrays of its message: `{bytes: 1..2, repeat: 3}`.
    Elements(Elements),
}

/// One number, or a list of numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Numbers(pub Vec<String>);

/// A text for people, which is not blank.
#[derive(Clone, Debug)]
pub struct Words(pub String);

/// One name, or a list of names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names(pub Vec<String>);
