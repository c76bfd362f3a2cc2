//! Messages as they are written, and their frames in the document.

use serde::Deserialize;

use super::{ByModel, Field, Map, Names, PartData, Pattern, Reserved, Words};

/// A message: what chooses it, how it travels, and what it carries.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Message {
    /// Raw values that fields of the identifier and the header have in every frame of the message: `{command: 0x03}`;
    /// none if absent.
    #[serde(rename = "match", default)]
    pub pattern: Pattern,
    /// List of accesses by which the message travels: `[read, set]`. A member of a set needs none,
    /// because it travels as part of the set.
    #[serde(default)]
    pub access: Vec<String>,
    /// The addressing modes that may be used, and who answers in each: `{single: one}`. They replace
    /// the `answers` of the accesses, which hold if absent.
    #[serde(default)]
    pub answers: Map<String>,
    /// Number of data bytes of its frames, 0 to 8, or a list of several: `4` or `[7, 8]`; the
    /// protocol's `length` if absent. It never chooses the message. Fields beyond the shortest length
    /// are optional. If the last text of several frames is open, it is the least and the greatest number of data
    /// bytes in all of them: `0..400`.
    #[serde(default)]
    pub length: Names,
    /// Raw values that fields of the identifier have in frames that are built, in place of their own
    /// `send`: `{priority: 4}`. Received frames may have any. None if absent.
    #[serde(default)]
    pub send: Pattern,
    /// What the bits are that nothing names, in place of the protocol's `reserved`:
    /// `{send: 1, expect: any}`.
    pub reserved: Option<Reserved>,
    /// List of the only device models that have the message: `[SM_750]`; every model has it if
    /// absent.
    #[serde(default)]
    pub models: Vec<String>,
    /// Entry of `timing` that says how often its report comes: `cycle`; as its access says if absent.
    pub every: Option<String>,
    /// Fields by name that the message carries: `{voltage: {bytes: 0..1, scale: 1/10, unit: V}}`; none if absent.
    #[serde(default)]
    pub fields: Map<Field>,
    /// The only field of the message, in place of `fields`: `{bytes: 4..7, as: float, unit: V}`;
    /// none if absent. Its name is `value`.
    pub value: Option<Field>,
    /// Messages that travel in this order, one in each frame, in place of `fields`:
    /// `[voltage, current]`; none if absent. They make the message a set of frames.
    #[serde(default)]
    pub members: Vec<String>,
    /// How a message travels in several frames with numbers: `{number: {bytes: 0}, first: 1, data: 1..6}`;
    /// it is one frame if absent. The bytes of its fields then count in the data of all parts
    /// together.
    pub parts: Option<Parts>,
    /// Entry of `transports` that carries the message if it is longer than a frame: `tp`; it is one
    /// frame if absent. Its `length` can then be up to what the transport carries.
    pub via: Option<String>,
    /// Kinds of frames that each of the `members` has, out of `request` and `reply`:
    /// `[request, reply]`; `[reply]` if absent.
    #[serde(rename = "in", default)]
    pub kinds: Vec<String>,
    /// Frames of the document, in its order: `[{request: 000302F0#0000000000000000}]`; none if
    /// absent. A reply answers the request before it.
    #[serde(default)]
    pub examples: Vec<Example>,
    /// What it is, in a few words without a full stop: `Output voltage and current of one module`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `a module that is switched off answers with zeros`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// How a message longer than a frame is parted.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Parts {
    /// Field of the frame with the number of the part: `{bytes: 0}`, or `{bytes: 0, bits: 4..0}` for some of its bits.
    pub number: Field,
    /// Field of the frame with a number that all parts of a message share: `{bytes: 0, bits: 7..5}`; none if absent.
    /// The next message has another one.
    pub counter: Option<Field>,
    /// Number of the first part, or one for each model: `1` or `{V10: 0, V11: 1}`.
    pub first: ByModel,
    /// Bytes of the frame with the data of the part, the first one first: `1..6`. Or the bytes of the first element of
    /// an array in it, and how many elements each part has: `{bytes: 1..2, repeat: 3}`. The frame then shows these.
    pub data: PartData,
    /// Field of the first part with the number of data bytes of all parts: `{bytes: 1}`; none if absent. It stands at
    /// the front of `data`, and its bytes do not count.
    pub length: Option<Field>,
    /// Signal of the same device with the number of elements that an array really has, or of bytes that an open text
    /// has: `status.cells`. If absent, the number is not known.
    pub count: Option<String>,
    /// Name of the entry of `timing` that ends a message: no further part has come for so long. It is whole if nothing
    /// says that more of it comes. If absent, silence says nothing.
    pub silence: Option<String>,
}

/// Where each part has elements of the arrays of its message.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Elements {
    /// Bytes of the frame with the first element, the first one first: `1..2`.
    pub bytes: String,
    /// How many elements each part has: `3`. They have no gaps between them.
    pub repeat: String,
}

/// One frame of the document and what it means.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Example {
    /// A frame to a module, in hexadecimal: `000302F0#0000000000000000`, or `000302F0` if the
    /// document prints no data. `0x000302F0 00 00` and `000302F0: 00 00` are read, too. An example
    /// has one of `request`, `reply` and `report`. A list has all frames of a message that is longer than one.
    #[serde(default)]
    pub request: Names,
    /// An answer, in hexadecimal: `0003F002#1388000000000000`, or `0003F002` if the document prints
    /// no data. A list has all frames of a message that is longer than one.
    #[serde(default)]
    pub reply: Names,
    /// A frame sent unasked, in hexadecimal: `185#E803CEFF`, or `185` if the document prints no
    /// data. A list has all frames of a message that is longer than one.
    #[serde(default)]
    pub report: Names,
    /// Message of the frame, only in a sequence or a set of frames: `output`. If absent, a frame of
    /// a set belongs to the set, and a frame of a sequence fails. It then fails as `identifier`,
    /// `foreign` or `unknown_message`.
    pub message: Option<String>,
    /// Values of signals in the frame, each with its unit: `{voltage: 500 V, alarms: [fan_fault]}`,
    /// or `500 V` if there is only one signal. `~51.4 V` is a rounded number. Absent if there are no
    /// signals or no data.
    pub means: Option<Means>,
    /// How many elements the array of a message in `parts` really has, or how many bytes its open text: `13`; not known
    /// if absent.
    pub count: Option<String>,
    /// Device model that the frame comes from or goes to: `SM_750`. If absent, it is the first
    /// model that has the message, or none if every model has it.
    pub model: Option<String>,
    /// Rules of all notes that decoding gives, a list: `[reserved_bit]`; no note if absent.
    #[serde(default)]
    pub notes: Vec<String>,
    /// How the printed frame fails: `identifier`, `foreign`, `length`, `unknown_message`,
    /// `message`, `addressing` or `values`. `message` means that the frame is one of another
    /// message. If absent, the frame decodes and encodes back.
    pub fails: Option<String>,
    /// `ours` for a frame that the document does not print, `captured` for one from a real bus; if
    /// absent, the document prints it.
    pub origin: Option<String>,
    /// What else a reader must know, in one sentence: `the data bytes are not legible`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes: `"2.4"`; if absent, that of the item around it.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// What an example means: one value, a list, or a value for each signal.
#[derive(Clone, Debug)]
pub enum Means {
    /// A number with its unit, a name or a text: `500 V`.
    Value(String),
    /// The set bits of a status word, by name, or by number if they have no name:
    /// `[fan_fault, 28]`. It is `[]` if no bit is set. Of an array it is a list of its elements:
    /// `[3.3 V, 3.2 V]`.
    List(Vec<Means>),
    /// A value for each signal: `{voltage: 500 V, alarms: []}`. Signals of a group can be a map
    /// inside: `{alarms: {level: 52 V}}`.
    Signals(Map<Means>),
}

/// Example frames in the order in which the document shows them.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sequence {
    /// Frames in the document's order, each with its `message`:
    /// `[{request: 000302F0#0000000000000000, message: output}]`.
    pub frames: Vec<Example>,
    /// What it is, in a few words without a full stop: `Two modules are read`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `the last reply is not legible`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}
