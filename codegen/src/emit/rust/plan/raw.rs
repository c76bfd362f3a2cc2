//! What raw values are in Rust.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::literal::{decimal, hexadecimal};
use crate::model::{Numeral, Signal};

/// Returns the type of a number's raw values.
pub fn raw_type(signal: &Signal) -> TokenStream {
    if signal.encoding.is_single() {
        return quote!(f32);
    }
    integer(signal.place.width(), signal.encoding.numeral())
}

/// Writes a raw value of an integer.
pub fn raw_number(signal: &Signal, raw: i128) -> TokenStream {
    let width = signal.place.width();
    match (Integer::new(width, signal.encoding.numeral()).around, u64::try_from(raw)) {
        (Some(around), Ok(digits)) => {
            let digits = hexadecimal(digits, width);
            quote!(#around::from_raw(#digits))
        }
        _ => decimal(raw),
    }
}

/// Returns the smallest type of raw values that holds `width` bits.
pub fn integer(width: u8, numeral: Numeral) -> TokenStream {
    let Integer { kind, around, .. } = Integer::new(width, numeral);
    around.map_or_else(|| quote!(#kind), |around| quote!(#around<#kind>))
}

/// What a numeral is in Rust.
pub struct Integer {
    /// The smallest integer that holds the bits.
    pub kind: Ident,
    /// The type of the runtime around it, which is made by `from_raw`.
    pub around: Option<Ident>,
    /// What the comment says of the digits.
    pub digits: Option<&'static str>,
}

impl Integer {
    pub fn new(width: u8, numeral: Numeral) -> Self {
        let size = width.next_power_of_two().max(8);
        let plain = |sign| Self { kind: format_ident!("{sign}{size}"), around: None, digits: None };
        match numeral {
            Numeral::Unsigned => plain("u"),
            Numeral::Signed => plain("i"),
            Numeral::Bcd => Self { around: Some(format_ident!("Bcd")), digits: Some("decimal digits"), ..plain("u") },
        }
    }
}
