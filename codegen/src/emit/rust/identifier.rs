//! The identifier: its fields, and what they show of the direction.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::doc;
use super::literal::hexadecimal;
use super::names::{Names, ident, screaming};
use super::word::integer;
use crate::model::{Direction, FieldTest, Foreign, Identifier, IdentifierField, Protocol};

/// Emits the struct of the identifier and its fields' places.
pub fn identifier(protocol: &Protocol, names: &Names) -> TokenStream {
    let Identifier { extended, fields, .. } = &protocol.identifier;
    let comment = doc::line(format!("The {}-bit identifier of a frame.", if *extended { 29 } else { 11 }));
    let members = fields.iter().map(|field| member(protocol, names, field));
    let places = fields.iter().map(place);
    let split = splitting(protocol);
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct Identifier { #(#members),* }
        impl Identifier { #(#places)* }
        #split
    }
}

fn member(protocol: &Protocol, names: &Names, field: &IdentifierField) -> TokenStream {
    let (name, width) = (ident(&field.name), field.width);
    let title = field.doc.title.as_ref().map_or_else(|| field.name.replace('_', " "), |title| doc::plain(title));
    let sentence = doc::sentence_of(&format!("{title}: {}", bits(field)));
    let comment = doc::item(protocol, &field.doc, &sentence, None);
    let integer = integer(width, false);
    let kind = field.enumeration.map_or(integer, |index| {
        let name = &names.enumerations[index];
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
    let foreign = foreign(protocol);
    let to_module = test("is_to_module", any(protocol, &protocol.to_module));
    let to_controller = test("is_to_controller", any(protocol, &protocol.to_controller));
    quote! {
        impl IdentifierFields for Identifier {
            fn from_raw(id: u32) -> Self {
                Self { #(#fields: Self::#places.read(id)),* }
            }

            fn to_raw(self) -> u32 {
                #(Self::#places.write(self.#fields))|*
            }

            #foreign
            #to_module
            #to_controller
        }
    }
}

/// Emits a test of an identifier, or of none if it always comes out the same.
fn test(name: &str, condition: Option<TokenStream>) -> TokenStream {
    let name = ident(name);
    match condition {
        Some(condition) => quote!(fn #name(id: u32) -> bool { #condition }),
        None => quote!(fn #name(_: u32) -> bool { false }),
    }
}

fn foreign(protocol: &Protocol) -> TokenStream {
    let entries = protocol.foreign.iter().map(|foreign| foreign_test(protocol, foreign)).collect::<Vec<_>>();
    test("is_foreign", disjunction(entries))
}

fn foreign_test(protocol: &Protocol, foreign: &Foreign) -> TokenStream {
    let ranges = foreign.ranges.iter().map(|(field, first, last)| {
        let value = field.map_or_else(|| quote!(id), |field| value_of(protocol, field));
        let width = field.map_or(29, |field| protocol.identifier.fields[field].width);
        inside(&value, &[(*first, *last)], width)
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
    let inside = inside(&value, &test.ranges, protocol.identifier.fields[test.field].width);
    match (test.inside, test.ranges.as_slice()) {
        (true, _) => inside,
        (false, [(first, last)]) if first != last => quote!(!#inside),
        (false, _) => quote!(!(#inside)),
    }
}

fn value_of(protocol: &Protocol, field: usize) -> TokenStream {
    let place = screaming(&protocol.identifier.fields[field].name);
    quote!(Self::#place.of(id))
}

/// Tests whether a value lies in one of the ranges.
fn inside(value: &TokenStream, ranges: &[(u32, u32)], width: u8) -> TokenStream {
    let tests: Vec<_> = ranges
        .iter()
        .map(|(first, last)| {
            let (start, end) = (hexadecimal(*first, width), hexadecimal(*last, width));
            if first == last { quote!(#value == #start) } else { quote!((#start..=#end).contains(&#value)) }
        })
        .collect();
    if tests.len() == 1 { quote!(#(#tests)*) } else { quote!((#(#tests)||*)) }
}

/// Returns the path of a field's place.
pub fn field_place(protocol: &Protocol, field: usize) -> (Ident, u8) {
    let field = &protocol.identifier.fields[field];
    (screaming(&field.name), field.width)
}
