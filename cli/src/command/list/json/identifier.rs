//! The identifier, and the data bytes that choose a message.

use canspec_codegen::model::{self, EnumerationId, Protocol, SelectorPlace, WrittenPlace};
use serde::Serialize;

use super::remarks::{Remarks, Value};

/// The layout of the identifier.
#[derive(Serialize)]
pub struct Identifier<'a> {
    bits: u8,
    /// Bits that each frame of the protocol has.
    mask: u32,
    /// Their values.
    value: u32,
    fields: Vec<Field<'a>>,
}

#[derive(Serialize)]
struct Field<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    high: u8,
    low: u8,
    constant: Option<u32>,
    send: Option<u32>,
    normal: Option<u32>,
    starting: Option<u32>,
    continues: Option<u32>,
    values: Vec<Value<'a>>,
}

impl<'a> Identifier<'a> {
    /// Returns that of a protocol.
    pub fn of(protocol: &'a Protocol) -> Self {
        let model::Identifier { extended, fields, mask, value, .. } = &protocol.identifier;
        let fields = fields.iter().map(|field| Field::of(protocol, field)).collect();
        Self { bits: if *extended { 29 } else { 11 }, mask: *mask, value: *value, fields }
    }
}

impl<'a> Field<'a> {
    fn of(protocol: &'a Protocol, field: &'a model::IdentifierField) -> Self {
        Self {
            name: &field.name,
            remarks: (&field.doc).into(),
            high: field.shift + field.width - 1,
            low: field.shift,
            constant: field.constant,
            send: field.send,
            normal: field.normal,
            starting: field.starting,
            continues: field.continues,
            values: values(protocol, field.enumeration),
        }
    }
}

/// A field of the data bytes that chooses a message.
#[derive(Serialize)]
pub struct Selector<'a> {
    name: &'a str,
    #[serde(flatten)]
    remarks: Remarks<'a>,
    place: WrittenPlace,
    normal: Option<u64>,
    starting: Option<u64>,
    continues: Option<u64>,
    values: Vec<Value<'a>>,
}

impl<'a> Selector<'a> {
    /// Returns those of the data bytes.
    pub fn header(protocol: &'a Protocol) -> Vec<Self> {
        protocol.selectors.iter().filter_map(|selector| Self::of(protocol, selector)).collect()
    }

    fn of(protocol: &'a Protocol, selector: &'a model::Selector) -> Option<Self> {
        let SelectorPlace::Payload(place) = selector.place else { return None };
        Some(Self {
            name: &selector.name,
            remarks: (&selector.doc).into(),
            place: WrittenPlace::of(place),
            normal: selector.normal,
            starting: selector.starting,
            continues: selector.continues,
            values: values(protocol, selector.enumeration),
        })
    }
}

fn values(protocol: &Protocol, names: Option<EnumerationId>) -> Vec<Value<'_>> {
    names.map_or_else(Vec::new, |names| Value::all(protocol, &protocol[names].values))
}
