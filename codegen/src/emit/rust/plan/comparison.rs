//! How values of the identifier's fields are compared.

use proc_macro2::{Ident, TokenStream};

use super::literal::hexadecimal;
use super::naming::screaming;
use crate::model::{FieldId, FieldTest, Protocol};

/// A test of an identifier. It holds if all tests of one list hold.
#[derive(Default)]
pub struct Test {
    /// The lists.
    pub any: Vec<Vec<Comparison>>,
}

/// A test of one value.
pub struct Comparison {
    /// Place of the field; `None` for the identifier as a whole.
    pub place: Option<Ident>,
    /// Whether the value must lie in one of the ranges, or else in none.
    pub inside: bool,
    /// First and last value of each.
    pub ranges: Vec<Range>,
}

/// A range of values.
pub enum Range {
    /// One value.
    One(TokenStream),
    /// First and last value.
    Span(TokenStream, TokenStream),
}

/// Plans the test of a field.
pub fn field_test(protocol: &Protocol, test: &FieldTest) -> Comparison {
    let (place, width) = field_place(protocol, test.field);
    let ranges = test.ranges.iter().map(|ends| range(*ends, width)).collect();
    Comparison { place: Some(place), inside: test.inside, ranges }
}

/// Plans a range of values of a field that is `width` bits wide.
pub fn range((first, last): (u32, u32), width: u8) -> Range {
    let (start, end) = (hexadecimal(first, width), hexadecimal(last, width));
    if first == last { Range::One(start) } else { Range::Span(start, end) }
}

/// Returns the constant of a field's place, and the field's width.
pub fn field_place(protocol: &Protocol, field: FieldId) -> (Ident, u8) {
    let field = &protocol[field];
    (screaming(&field.name), field.width)
}
