//! Literals as people write them: hexadecimal fields, digits in groups.

use canspec_runtime::Data;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};

use crate::emit::Float;
use crate::model::Range;
use crate::number::Rational;

/// Writes a field in hexadecimal, with the digits that its width needs.
pub fn hexadecimal(value: impl Into<u64>, width: u8) -> TokenStream {
    let digits = usize::from(width.div_ceil(4));
    positive(&format!("0x{}", from_the_right(&format!("{:0digits$X}", value.into()), 4)))
}

/// Writes a whole number.
pub fn decimal(value: impl Into<i128>) -> TokenStream {
    signed(&value.into().to_string())
}

/// Returns the type of scaled values.
pub fn physical_type(float: Float) -> TokenStream {
    match float {
        Float::F64 => quote!(f64),
        Float::F32 => quote!(f32),
    }
}

/// Writes the double or the single nearest to a number.
pub fn physical(value: Rational, float: Float) -> TokenStream {
    let text = match float {
        Float::F64 => value.to_f64().to_string(),
        #[expect(clippy::cast_possible_truncation, reason = "the nearest single is what is wanted")]
        Float::F32 => (value.to_f64() as f32).to_string(),
    };
    signed(&if text.contains('.') { text } else { format!("{text}.0") })
}

/// Writes the ends of a range as they are compared: as integers, or in floating point.
pub fn ends(range: Range, whole: bool, float: Float) -> [TokenStream; 2] {
    [range.minimum, range.maximum].map(|end| if whole { decimal(end.numerator()) } else { physical(end, float) })
}

/// Writes the eight bytes of a frame.
pub fn data(data: Data) -> TokenStream {
    let bytes = data.map(|byte| hexadecimal(byte, 8));
    if data == [data[0]; 8] {
        let first = &bytes[0];
        return quote!([#first; 8]);
    }
    quote!([#(#bytes),*])
}

fn signed(text: &str) -> TokenStream {
    match text.strip_prefix('-') {
        Some(digits) => {
            let digits = positive(&grouped(digits));
            quote!(-#digits)
        }
        None => positive(&grouped(text)),
    }
}

fn positive(text: &str) -> TokenStream {
    text.parse::<Literal>().unwrap_or_else(|_| Literal::string(text)).into_token_stream()
}

/// Separates digits in threes, from the point outwards.
fn grouped(text: &str) -> String {
    match text.split_once('.') {
        Some((whole, fraction)) => format!("{}.{}", thousands(whole), from_the_left(fraction)),
        None => thousands(text),
    }
}

fn thousands(digits: &str) -> String {
    if digits.len() < 5 { digits.to_owned() } else { from_the_right(digits, 3) }
}

fn from_the_right(digits: &str, size: usize) -> String {
    let first = digits.len() % size;
    let (head, rest) = digits.split_at(first);
    let groups = rest.as_bytes().chunks(size).map(String::from_utf8_lossy);
    let head = (!head.is_empty()).then(|| head.into());
    head.into_iter().chain(groups).collect::<Vec<_>>().join("_")
}

fn from_the_left(digits: &str) -> String {
    let size = if digits.len() < 6 { digits.len() } else { 3 };
    digits.as_bytes().chunks(size).map(String::from_utf8_lossy).collect::<Vec<_>>().join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_stand_in_groups() {
        assert_eq!(hexadecimal(0x0757_F800_u32, 29).to_string(), "0x0757_F800");
        assert_eq!(hexadecimal(0xA_u32, 4).to_string(), "0xA");
        assert_eq!(hexadecimal(1_u32, 13).to_string(), "0x0001");
        assert_eq!(decimal(999_999_999_999_u64).to_string(), "999_999_999_999");
        assert_eq!(decimal(9999).to_string(), "9999");
    }

    #[test]
    fn a_sign_is_an_operator_of_its_own() {
        assert_eq!(decimal(-12_345).to_string(), "- 12_345");
    }

    #[test]
    fn a_double_has_a_point() {
        let literal = |text, float| physical(Rational::parse(text).unwrap_or(Rational::ZERO), float).to_string();
        let float = |text| literal(text, Float::F64);
        assert_eq!(float("750"), "750.0");
        assert_eq!(float("25.7"), "25.7");
        assert_eq!(float("1/3"), "0.333_333_333_333_333_3");
        assert_eq!(float("100000"), "100_000.0");
        assert_eq!(literal("1/3", Float::F32), "0.333_333_34");
    }
}
