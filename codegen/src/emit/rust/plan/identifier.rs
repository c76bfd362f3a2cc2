//! The identifier: its fields, what every frame shows in it, and how it shows the direction.

use proc_macro2::{Ident, TokenStream};

use super::comparison::{Comparison, Test, field_place, range};
use super::doc::{self, Comment};
use super::documented::Documented;
use super::heading::Heading;
use super::literal::{decimal, hexadecimal};
use super::naming::{ident, screaming};
use super::raw::integer;
use super::types::Types;
use crate::model::{self, FieldId, Foreign, FrameLayout, Numeral, Protocol};

/// The identifier.
pub struct Identifier {
    /// Comment of its struct.
    pub comment: Comment,
    /// Its fields from the most to the least significant bit.
    pub fields: Vec<Field>,
    /// The fixed bits that are no field and are 1.
    pub ones: Option<TokenStream>,
    /// How it shows that it belongs to another device, if it can.
    pub foreign: Option<Test>,
    /// How it shows where a frame goes.
    pub heading: Heading,
    /// How the requests of each addressing mode show documented addresses only.
    pub documented: Documented,
}

/// A field of the identifier.
pub struct Field {
    /// Comment of the member.
    pub comment: Comment,
    /// Member of the struct.
    pub member: Ident,
    /// Type of the member.
    pub kind: TokenStream,
    /// Comment of the place.
    pub place_comment: Comment,
    /// Constant of the place.
    pub place: Ident,
    /// Most and least significant bit.
    pub bits: [TokenStream; 2],
}

/// What every frame shows.
pub struct Base {
    /// Whether it has 29 bits, not 11.
    pub extended: bool,
    /// Mask and value of the fixed bits that are no field.
    pub bits: Option<(TokenStream, TokenStream)>,
    /// Places of the constant fields, and their values.
    pub constants: Vec<(Ident, TokenStream)>,
    /// Places of the other fields that are sent with a value of their own.
    pub sent: Vec<(Ident, TokenStream)>,
    /// Places of the fields that tell an error reply, and their values in others.
    pub normal: Vec<(Ident, TokenStream)>,
}

impl Identifier {
    /// Plans the identifier.
    pub fn new(protocol: &Protocol, types: &Types) -> Self {
        let model::Identifier { extended, fields, .. } = &protocol.identifier;
        let (_, ones) = unnamed(&protocol.identifier);
        let foreign: Vec<_> = protocol.foreign.iter().map(|known| foreign(protocol, known)).collect();
        Self {
            comment: Comment::line(format!("The {}-bit identifier of a frame.", if *extended { 29 } else { 11 })),
            fields: fields.iter().map(|field| Field::new(protocol, types, field)).collect(),
            ones: (ones != 0).then(|| hexadecimal(ones, 32)),
            foreign: (!foreign.is_empty()).then_some(Test { any: foreign }),
            heading: Heading::new(protocol),
            documented: Documented::new(protocol),
        }
    }
}

impl Field {
    fn new(protocol: &Protocol, types: &Types, field: &model::IdentifierField) -> Self {
        let sentence = doc::sentence_of(&format!("{}: {}", doc::title(&field.doc, &field.name), bits(field)));
        Self {
            comment: Comment::item(protocol, &field.doc, &sentence, None),
            member: ident(&field.name),
            kind: field.enumeration.map_or_else(|| integer(field.width, Numeral::Unsigned), |id| types.enumeration(id)),
            place_comment: Comment::line(format!("Place of `{}`.", field.name)),
            place: screaming(&field.name),
            bits: [field.shift + field.width - 1, field.shift].map(decimal),
        }
    }
}

fn bits(field: &model::IdentifierField) -> String {
    match (field.shift, field.width) {
        (shift, 1) => format!("bit {shift}"),
        (shift, width) => format!("bits {}..{shift}", shift + width - 1),
    }
}

impl Base {
    /// Plans what every frame shows.
    pub fn new(identifier: &model::Identifier) -> Self {
        let (mask, value) = unnamed(identifier);
        let fields = |value: &dyn Fn(&model::IdentifierField) -> Option<u32>| -> Vec<_> {
            let shown = identifier.fields.iter().filter_map(|field| Some((field, value(field)?)));
            shown.map(|(field, value)| (screaming(&field.name), hexadecimal(value, field.width))).collect()
        };
        Self {
            extended: identifier.extended,
            bits: (mask != 0).then(|| (hexadecimal(mask, 32), hexadecimal(value, 32))),
            constants: fields(&|field| field.constant),
            sent: fields(&|field| (field.constant.is_none() && field.sent() != 0).then(|| field.sent())),
            normal: fields(&|field| field.normal),
        }
    }
}

/// Returns mask and value of the fixed bits that are no field.
fn unnamed(identifier: &model::Identifier) -> (u32, u32) {
    let constants = identifier.fields.iter().filter(|field| field.constant.is_some());
    let mask = constants.fold(identifier.mask, |mask, field| mask & !field.mask());
    (mask, identifier.value & mask)
}

fn foreign(protocol: &Protocol, foreign: &Foreign) -> Vec<Comparison> {
    let tests = foreign.ranges.iter().map(|(field, first, last)| {
        let width = field.map_or(29, |field| protocol[field].width);
        let ranges = vec![range((*first, *last), width)];
        Comparison { place: field.map(|field| field_place(protocol, field).0), inside: true, ranges }
    });
    tests.collect()
}

/// Tests whether foreign identifiers can show what chooses a message.
pub fn foreign_like_own(protocol: &Protocol) -> bool {
    let frames = || protocol.frames.iter();
    let is_like = |foreign: &Foreign, frame: &FrameLayout| {
        frame.identifier().all(|(field, value)| can_show(protocol, foreign, field, value))
    };
    protocol.foreign.iter().any(|foreign| frames().any(|frame| is_like(foreign, frame)))
}

/// Tests whether a field may have a value in a foreign identifier.
fn can_show(protocol: &Protocol, foreign: &Foreign, field: FieldId, value: u32) -> bool {
    let known = &protocol[field];
    foreign.ranges.iter().all(|(place, first, last)| match place {
        Some(place) => *place != field || (*first..=*last).contains(&value),
        // The field has one value in a range whose ends only differ below it.
        None => first >> known.shift != last >> known.shift || known.get(*first) == value,
    })
}
