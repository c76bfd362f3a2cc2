//! The identifier: its fields, and what they show of the direction.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::derives::Derives;
use super::dispatch::argument;
use super::doc;
use super::literal::hexadecimal;
use super::names::{Names, ident, screaming};
use super::word::integer;
use crate::model::{Direction, FieldId, FieldTest, Foreign, Identifier, IdentifierField, Protocol};

/// Emits the struct of the identifier and its fields' places.
pub fn identifier(protocol: &Protocol, names: &Names, derives: Derives) -> TokenStream {
    let optional = derives.structure();
    let Identifier { extended, fields, .. } = &protocol.identifier;
    let comment = doc::line(format!("The {}-bit identifier of a frame.", if *extended { 29 } else { 11 }));
    let members = fields.iter().map(|field| member(protocol, names, field));
    let places = fields.iter().map(place);
    let (split, directions) = (splitting(protocol), directions(protocol));
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #optional
        pub struct Identifier { #(#members),* }
        impl Identifier { #(#places)* #split }
        #directions
    }
}

fn member(protocol: &Protocol, names: &Names, field: &IdentifierField) -> TokenStream {
    let (name, width) = (ident(&field.name), field.width);
    let title = doc::title(&field.doc, &field.name);
    let sentence = doc::sentence_of(&format!("{title}: {}", bits(field)));
    let comment = doc::item(protocol, &field.doc, &sentence, None);
    let integer = integer(width, false);
    let kind = field.enumeration.map_or(integer, |id| {
        let name = &names.enumerations[id];
        quote!(#name)
    });
    quote!(#comment pub #name: #kind)
}

fn bits(field: &IdentifierField) -> String {
    match (field.shift, field.width) {
        (shift, 1) => format!("bit {shift}"),
        (shift, width) => format!("bits {}..{shift}", shift + width - 1),
    }
}

fn place(field: &IdentifierField) -> TokenStream {
    let name = screaming(&field.name);
    let comment = doc::line(format!("Place of `{}`.", field.name));
    let (high, low) = (decimal(field.shift + field.width - 1), decimal(field.shift));
    quote!(#comment pub const #name: Bits = Bits::new(#high, #low);)
}

fn decimal(number: u8) -> TokenStream {
    super::literal::decimal(number)
}

fn splitting(protocol: &Protocol) -> TokenStream {
    let fields: Vec<_> = protocol.identifier.fields.iter().map(|field| ident(&field.name)).collect();
    let places: Vec<_> = protocol.identifier.fields.iter().map(|field| screaming(&field.name)).collect();
    let (_, ones) = unnamed(&protocol.identifier);
    let ones = (ones != 0).then(|| {
        let ones = hexadecimal(ones, 32);
        quote!(#ones |)
    });
    quote! {
        /// Splits an identifier.
        #[must_use]
        pub fn from_raw(id: u32) -> Self {
            Self { #(#fields: Self::#places.read(id)),* }
        }

        /// Joins the fields; bits that a field cannot hold are dropped.
        #[must_use]
        pub fn to_raw(self) -> u32 {
            #ones #(Self::#places.write(self.#fields))|*
        }
    }
}

/// Emits what code for every protocol asks an identifier.
fn directions(protocol: &Protocol) -> TokenStream {
    let foreign = foreign(protocol);
    let to_module = test("is_to_module", any(protocol, &protocol.recognition.to_module));
    let to_controller = test("is_to_controller", any(protocol, &protocol.recognition.to_controller));
    quote! {
        impl IdentifierFields for Identifier {
            const FROM_RAW: fn(u32) -> Self = Self::from_raw;
            const TO_RAW: fn(Self) -> u32 = Self::to_raw;

            #foreign
            #to_module
            #to_controller
        }
    }
}

/// Returns mask and value of the fixed bits that are no field.
pub fn unnamed(identifier: &Identifier) -> (u32, u32) {
    let constants = identifier.fields.iter().filter(|field| field.constant.is_some());
    let mask = constants.fold(identifier.mask, |mask, field| mask & !field.mask());
    (mask, identifier.value & mask)
}

/// Emits a test of an identifier, or of none if it always comes out the same.
fn test(name: &str, condition: Option<TokenStream>) -> TokenStream {
    let condition = condition.unwrap_or_else(|| quote!(false));
    let (name, id) = (ident(name), argument("id", &condition));
    quote!(fn #name(#id: u32) -> bool { #condition })
}

fn foreign(protocol: &Protocol) -> Option<TokenStream> {
    let entries = protocol.foreign.iter().map(|foreign| foreign_test(protocol, foreign)).collect::<Vec<_>>();
    disjunction(entries).map(|condition| test("is_foreign", Some(condition)))
}

fn foreign_test(protocol: &Protocol, foreign: &Foreign) -> TokenStream {
    let ranges = foreign.ranges.iter().map(|(field, first, last)| {
        let value = field.map_or_else(|| quote!(id), |field| value_of(protocol, field));
        let width = field.map_or(29, |field| protocol[field].width);
        inside(&value, (*first, *last), width)
    });
    quote!(#(#ranges)&&*)
}

fn any(protocol: &Protocol, direction: &Direction) -> Option<TokenStream> {
    let lists = direction.any.iter().map(|tests| {
        let tests = tests.iter().map(|test| field_test(protocol, test));
        quote!(#(#tests)&&*)
    });
    disjunction(lists.map(|list| if list.is_empty() { quote!(true) } else { list }).collect())
}

fn disjunction(mut conditions: Vec<TokenStream>) -> Option<TokenStream> {
    match conditions.len() {
        0 | 1 => conditions.pop(),
        _ => Some(quote!(#((#conditions))||*)),
    }
}

fn field_test(protocol: &Protocol, test: &FieldTest) -> TokenStream {
    let value = value_of(protocol, test.field);
    let width = protocol[test.field].width;
    let ranges = test.ranges.iter();
    match (test.inside, test.ranges.len()) {
        (false, _) => {
            let tests = ranges.map(|range| outside(&value, *range, width));
            quote!(#(#tests)&&*)
        }
        (true, 1) => ranges.map(|range| inside(&value, *range, width)).collect(),
        (true, _) => {
            let tests = ranges.map(|range| inside(&value, *range, width));
            quote!((#(#tests)||*))
        }
    }
}

fn value_of(protocol: &Protocol, field: FieldId) -> TokenStream {
    let place = screaming(&protocol[field].name);
    quote!(Self::#place.of(id))
}

/// Tests whether a value lies in a range.
fn inside(value: &TokenStream, (first, last): (u32, u32), width: u8) -> TokenStream {
    let (start, end) = (hexadecimal(first, width), hexadecimal(last, width));
    if first == last { quote!(#value == #start) } else { quote!((#start..=#end).contains(&#value)) }
}

/// Tests whether a value lies outside a range.
fn outside(value: &TokenStream, (first, last): (u32, u32), width: u8) -> TokenStream {
    let (start, end) = (hexadecimal(first, width), hexadecimal(last, width));
    if first == last { quote!(#value != #start) } else { quote!(!(#start..=#end).contains(&#value)) }
}

/// Returns the path of a field's place.
pub fn field_place(protocol: &Protocol, field: FieldId) -> (Ident, u8) {
    let field = &protocol[field];
    (screaming(&field.name), field.width)
}
