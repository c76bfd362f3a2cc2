//! Literals as people write them: hexadecimal fields, digits in groups.

use std::fmt::Display;

use canspec_runtime::Data;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};

use crate::emit::Scaled;
use crate::words::number::Rational;

/// Writes a field in hexadecimal, with the digits that its width needs.
pub fn hexadecimal(value: impl Into<u64>, width: u8) -> TokenStream {
    let digits = usize::from(width.div_ceil(4));
    positive(&format!("0x{}", from_the_right(&format!("{:0digits$X}", value.into()), 4)))
}

/// Writes a whole number.
pub fn decimal(value: impl Into<i128>) -> TokenStream {
    signed(&value.into().to_string())
}

/// A floating-point type.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// `f64`.
    Double,
    /// `f32`.
    Single,
}

impl Precision {
    /// Returns the type of scaled values, unless they are whole steps.
    pub fn of(scaled: Scaled) -> Option<Self> {
        match scaled {
            Scaled::F64 => Some(Self::Double),
            Scaled::F32 => Some(Self::Single),
            Scaled::Steps => None,
        }
    }

    /// Returns the type.
    pub fn kind(self) -> TokenStream {
        match self {
            Self::Double => quote!(f64),
            Self::Single => quote!(f32),
        }
    }

    /// Writes what is nearest to a number.
    pub fn nearest(self, number: Rational) -> TokenStream {
        match self {
            Self::Double => float(number.to_f64()),
            Self::Single => float(single(number)),
        }
    }

    /// Writes limits, which no number beyond them passes. They are what is nearest to the ends of a range, unless
    /// numbers outside it would be rounded to the same.
    pub fn inside(self, ends: [Rational; 2], beyond: [Rational; 2]) -> [TokenStream; 2] {
        match self {
            Self::Double => {
                let [ends, [below, above]] = [ends, beyond].map(|pair| pair.map(Rational::to_f64));
                [ends[0].max(below.next_up()), ends[1].min(above.next_down())].map(float)
            }
            Self::Single => {
                let [ends, [below, above]] = [ends, beyond].map(|pair| pair.map(single));
                [ends[0].max(below.next_up()), ends[1].min(above.next_down())].map(float)
            }
        }
    }
}

/// Returns the nearest single.
#[expect(clippy::cast_possible_truncation, reason = "the nearest single is what is wanted")]
fn single(number: Rational) -> f32 {
    number.to_f64() as f32
}

fn float(number: impl Display) -> TokenStream {
    let text = number.to_string();
    signed(&if text.contains('.') { text } else { format!("{text}.0") })
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

/// Separates digits in threes, from the point outwards: on both sides of it if one side is long.
fn grouped(text: &str) -> String {
    match text.split_once('.') {
        Some((whole, fraction)) if whole.len() > 4 || fraction.len() > 5 => {
            format!("{}.{}", from_the_right(whole, 3), from_the_left(fraction))
        }
        Some(_) => text.to_owned(),
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
    digits.as_bytes().chunks(3).map(String::from_utf8_lossy).collect::<Vec<_>>().join("_")
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
        let literal = |text, kind: Precision| kind.nearest(Rational::parse(text).unwrap_or(Rational::ZERO)).to_string();
        let float = |text| literal(text, Precision::Double);
        assert_eq!(float("750"), "750.0");
        assert_eq!(float("25.7"), "25.7");
        assert_eq!(float("1/3"), "0.333_333_333_333_333_3");
        assert_eq!(float("100000"), "100_000.0");
        assert_eq!(float("3604.4793945"), "3_604.479_394_5");
        assert_eq!(float("3604.25"), "3604.25");
        assert_eq!(literal("1/3", Precision::Single), "0.333_333_34");
    }
}
