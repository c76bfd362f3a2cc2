//! The identifier's fields, the fields that choose messages, and identifiers of other devices.

use serde::{Deserialize, Serialize};

use canspec_runtime::Place;

use crate::model::{Doc, EnumerationId, FieldId, Protocol, Table, place};

/// The identifier's layout.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Identifier {
    /// 29 bits rather than 11.
    pub extended: bool,
    /// Fields from the most to the least significant bit.
    pub fields: Table<FieldId, IdentifierField>,
    /// Bits with a fixed value: constant fields, `ones` and `zeros`.
    pub mask: u32,
    /// Values of these bits.
    pub value: u32,
}

/// A named bit field of the identifier.
#[derive(Clone, Debug, Serialize, Deserialize)]
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
    /// The value of a reply while the device starts.
    pub starting: Option<u32>,
    /// The value that says that more frames of a set follow.
    pub continues: Option<u32>,
    /// Names of its values.
    pub enumeration: Option<EnumerationId>,
}

impl IdentifierField {
    /// Returns the field's bits in the identifier.
    pub fn mask(&self) -> u32 {
        let ones = u32::MAX >> (32 - self.width);
        ones << self.shift
    }

    /// Returns the greatest value that fits.
    pub fn greatest(&self) -> u32 {
        u32::MAX >> (32 - self.width)
    }

    /// Returns the value that is sent in the field if nothing else chooses one.
    pub fn sent(&self) -> u32 {
        self.constant.or(self.send).or(self.normal).unwrap_or(0)
    }

    /// Returns an identifier with another value in the field.
    pub fn put(&self, identifier: u32, value: u32) -> u32 {
        identifier & !self.mask() | value << self.shift
    }

    /// Returns the field's value in an identifier.
    pub fn get(&self, identifier: u32) -> u32 {
        (identifier & self.mask()) >> self.shift
    }
}

/// A field whose constants choose a message, or which says whether a request was accepted.
#[derive(Clone, Debug, Serialize, Deserialize)]
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
    /// The value of a reply while the device starts.
    pub starting: Option<u64>,
    /// The value that says that more frames of a set follow.
    pub continues: Option<u64>,
    /// Names of its values.
    pub enumeration: Option<EnumerationId>,
}

/// Where a selector stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum SelectorPlace {
    /// In a field of the identifier.
    Identifier(FieldId),
    /// In the data bytes.
    Payload(#[serde(with = "place")] Place),
}

/// Identifiers of other devices on the bus.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Foreign {
    /// Name in the spec, in `snake_case`.
    pub name: String,
    /// What the spec says beside it.
    pub doc: Doc,
    /// Inclusive ranges of raw values of a field, or of the whole identifier. All must hold.
    pub ranges: Vec<(Option<FieldId>, u32, u32)>,
}

/// The field of replies with the error code.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ErrorCode<'a> {
    /// Name of the field.
    pub name: &'a str,
    /// What the spec says beside it.
    pub doc: &'a Doc,
    /// The value of a reply that is no error reply.
    pub normal: Option<u64>,
    /// The value of a reply while the device starts.
    pub starting: Option<u64>,
    /// Names of its values.
    pub enumeration: Option<EnumerationId>,
}

impl Protocol {
    /// Returns the fields of the identifier and of the data that say whether a reply is an error reply.
    pub fn error_codes(&self) -> impl Iterator<Item = ErrorCode<'_>> {
        let fields = self.identifier.fields.iter().map(|field| ErrorCode {
            name: &field.name,
            doc: &field.doc,
            normal: field.normal.map(u64::from),
            starting: field.starting.map(u64::from),
            enumeration: field.enumeration,
        });
        let selectors = self.selectors.iter().map(|selector| ErrorCode {
            name: &selector.name,
            doc: &selector.doc,
            normal: selector.normal,
            starting: selector.starting,
            enumeration: selector.enumeration,
        });
        fields.chain(selectors).filter(|code| code.normal.is_some() || code.starting.is_some())
    }
}
