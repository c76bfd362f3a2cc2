//! How messages travel, and whose identifiers there are.

use serde::Deserialize;

use super::{Constants, Map, Names, Pattern, Words};

/// An addressing mode: the request's addresses, and the reply's by who answers.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Identifier of a request, with a number or an address type for each field:
    /// `{target: module, source: controller}`. If absent, nobody is asked in this mode.
    pub request: Option<Pattern>,
    /// Identifier of a reply from the one addressed module, or of a report:
    /// `{target: controller, source: module}`; none if absent.
    pub one: Option<Pattern>,
    /// Identifier of a reply, if each addressed module answers for itself:
    /// `{target: controller, source: module}`; none if absent.
    pub each: Option<Pattern>,
    /// Identifier of a reply, if one module answers for all: `{target: controller, source: group}`;
    /// none if absent.
    pub coordinator: Option<Pattern>,
    /// What it is, in a few words without a full stop: `All modules of one group`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `the group must have been set before`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// How a message travels.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Access {
    /// Raw values that fields of the identifier and the header have in a request to a module:
    /// `{function: 3}`. Write `{}` if no values are fixed. If absent, there is no request.
    pub request: Option<Pattern>,
    /// Raw values that fields of the identifier and the header have in a reply: `{function: 3}`.
    /// A field of the header can have one of several: `{command: [0x43, 0x47, 0x4B, 0x4F]}`.
    /// Write `{}` if no values are fixed. If absent, there is no reply.
    pub reply: Option<Constants>,
    /// Raw values that fields of the identifier and the header have in a reply that refuses the
    /// request: `{function: 0x80}`. They replace those of `reply`. Another message has such
    /// replies, and says why. If absent, there are none.
    pub refusal: Option<Pattern>,
    /// Raw values that fields of the identifier and the header have in a report, which is sent
    /// unasked: `{function: 5}`. Write `{}` if no values are fixed. If absent, there is no report.
    pub report: Option<Pattern>,
    /// Who sends the report: `module` or `controller`; `module` if absent. The report of a controller
    /// goes where a request would go.
    pub from: Option<String>,
    /// Kinds of frames that carry the message's fields, out of `request`, `reply` and `report`:
    /// `[reply]`; all kinds of the access if absent.
    #[serde(rename = "in", default)]
    pub kinds: Vec<String>,
    /// The addressing modes that may be used, and who answers in each: `one`, `each`, `coordinator`
    /// or `nobody`. For a report it is who sends it, or who gets it from the controller. An example is
    /// `{single: one, broadcast: nobody}`. If absent, no mode may be used.
    #[serde(default)]
    pub answers: Map<String>,
    /// Entry of `timing` that says how often a report comes: `cycle`; not stated if absent.
    pub every: Option<String>,
    /// What it is, in a few words without a full stop: `Read from modules`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `the reply carries the values now in effect`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// A standard by which messages longer than a frame travel. Its frames are messages of the protocol.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Transport {
    /// The standard: `j1939` or `isotp`.
    pub kind: String,
    /// Of `j1939`: fields of the identifier that are the number of a message, highest bits first, the receiver last:
    /// `[page, format, target]`.
    #[serde(default)]
    pub group: Names,
    /// Of `j1939`: field of the identifier with the address of the receiver: `target`.
    pub target: Option<String>,
    /// Of `j1939`: field of the identifier with the address of the sender: `source`.
    pub source: Option<String>,
    /// Of `isotp`: byte that fills frames up to eight bytes, or `none` if they end with their data: `0x00`;
    /// 0xCC if absent. Received frames may be filled with anything.
    pub fill: Option<String>,
    /// Raw values that fields of the identifier have in its frames, in place of their own `send`:
    /// `{priority: 7}`. Received frames may have any. None if absent.
    #[serde(default)]
    pub send: Pattern,
    /// What it is, in a few words without a full stop: `Transport of long messages`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `only the vehicle uses it`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; its frames inherit it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}

/// Identifiers that belong to other devices on the bus.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Foreign {
    /// A number or a range for each field of the identifier: `{command: 0x21}`. All must hold.
    /// `identifier` stands for the whole identifier: `{identifier: 0x100..0x1FF}`.
    #[serde(rename = "match")]
    pub pattern: Pattern,
    /// What it is, in a few words without a full stop: `Traffic between modules`.
    pub title: Option<Words>,
    /// What else a reader must know, in one sentence: `a controller may ignore it`.
    pub note: Option<Words>,
    /// Section of the document that says so, in quotes; what is inside inherits it: `"2.4"`.
    pub section: Option<Words>,
    /// Names of entries of `errata` that are about it, one or a list: `E1` or `[E1, E2]`.
    #[serde(default)]
    pub erratum: Names,
}
