//! To whom frames go, and how they travel.

use canspec_codegen::model::{self, AddressPattern, AddressTypeId, Answers, Protocol};
use serde::Serialize;

use super::remarks::Remarks;
use crate::command::list::words;

/// A kind of addresses. The number of a raw value is `raw * sign + offset`.
#[derive(Serialize)]
pub struct AddressType<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    minimum: i64,
    maximum: i64,
    names: Vec<AddressName<'a>>,
    sign: i64,
    offset: i64,
    strict: bool,
    send: Option<i64>,
}

#[derive(Serialize)]
struct AddressName<'a> {
    number: i64,
    name: &'a str,
}

impl<'a> From<&'a model::AddressType> for AddressType<'a> {
    fn from(known: &'a model::AddressType) -> Self {
        Self {
            name: &known.name,
            remarks: (&known.doc).into(),
            minimum: known.first,
            maximum: known.last,
            names: known.names.iter().map(|(number, name)| AddressName { number: *number, name }).collect(),
            sign: known.sign,
            offset: known.offset,
            strict: known.strict,
            send: known.send,
        }
    }
}

/// An addressing mode.
#[derive(Serialize)]
pub struct Mode<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    target: Option<&'a str>,
    request: Option<Pattern<'a>>,
    one: Option<Pattern<'a>>,
    each: Option<Pattern<'a>>,
    coordinator: Option<Pattern<'a>>,
}

impl<'a> Mode<'a> {
    /// Returns a mode of a protocol.
    pub fn of(protocol: &'a Protocol, mode: &'a model::Mode) -> Self {
        let pattern = |pattern: Option<&AddressPattern>| pattern.map(|known| Pattern::of(protocol, known));
        Self {
            name: &mode.name,
            remarks: (&mode.doc).into(),
            target: mode.target.map(|target: AddressTypeId| protocol[target].name.as_str()),
            request: pattern(mode.request.as_ref()),
            one: pattern(mode.one.as_ref()),
            each: pattern(mode.each.as_ref()),
            coordinator: pattern(mode.coordinator.as_ref()),
        }
    }
}

/// What an identifier shows.
#[derive(Serialize)]
pub struct Pattern<'a> {
    mask: u32,
    value: u32,
    addresses: Vec<Address<'a>>,
}

#[derive(Serialize)]
struct Address<'a> {
    field: &'a str,
    address: &'a str,
}

impl<'a> Pattern<'a> {
    fn of(protocol: &'a Protocol, pattern: &AddressPattern) -> Self {
        Self::with(protocol, pattern, pattern.mask, pattern.value)
    }

    /// Returns the addresses of a pattern with other constant bits.
    pub fn with(protocol: &'a Protocol, pattern: &AddressPattern, mask: u32, value: u32) -> Self {
        let addresses = pattern
            .addresses
            .iter()
            .map(|known| Address { field: &protocol[known.field].name, address: &protocol[known.address_type].name });
        Self { mask, value, addresses: addresses.collect() }
    }
}

/// A way in which messages travel.
#[derive(Serialize)]
pub struct Access<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    kinds: Vec<&'static str>,
    carries: Vec<&'static str>,
    reports_from: &'static str,
    every: Option<&'a str>,
    answers: Vec<Answer<'a>>,
}

impl<'a> Access<'a> {
    /// Returns an access of a protocol.
    pub fn of(protocol: &'a Protocol, access: &'a model::Access) -> Self {
        let names = |kinds: &[model::Kind]| kinds.iter().map(|kind| kind.name()).collect();
        Self {
            name: &access.name,
            remarks: (&access.doc).into(),
            kinds: names(&access.kinds),
            carries: names(&access.carries),
            reports_from: words::side(access.from),
            every: access.every.map(|timing| protocol[timing].name.as_str()),
            answers: Answer::all(protocol, &access.answers),
        }
    }
}

/// Who answers in an addressing mode.
#[derive(Serialize)]
pub struct Answer<'a> {
    mode: &'a str,
    who: &'static str,
}

impl<'a> Answer<'a> {
    /// Returns those of the modes that are allowed.
    pub fn all(protocol: &'a Protocol, answers: &Answers) -> Vec<Self> {
        let answers = answers
            .entries()
            .filter_map(|(mode, who)| Some(Self { mode: &protocol[mode].name, who: words::who((*who)?) }));
        answers.collect()
    }
}

/// Identifiers of somebody else.
#[derive(Serialize)]
pub struct Foreign<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    ranges: Vec<FieldRange<'a>>,
}

#[derive(Serialize)]
struct FieldRange<'a> {
    /// None for the whole identifier.
    field: Option<&'a str>,
    minimum: u32,
    maximum: u32,
}

impl<'a> Foreign<'a> {
    /// Returns some of a protocol.
    pub fn of(protocol: &'a Protocol, foreign: &'a model::Foreign) -> Self {
        let ranges = foreign.ranges.iter().map(|(field, minimum, maximum)| FieldRange {
            field: field.map(|field| protocol[field].name.as_str()),
            minimum: *minimum,
            maximum: *maximum,
        });
        Self { name: &foreign.name, remarks: (&foreign.doc).into(), ranges: ranges.collect() }
    }
}
