//! What each encoding is in Rust: its type, and how values are read and written.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::literal::{decimal, ends, physical, physical_type};
use crate::emit::Float;
use crate::model::{Doc, Encoding, EnumerationId, Numeral, Protocol, Range, Signal, StatusWordId, Table};
use crate::number::Rational;
use crate::syntax::tree::Path;

/// The types that words have of their own.
pub struct WordTypes<'a> {
    /// Named values.
    pub enumerations: &'a Table<EnumerationId, Ident>,
    /// Status words.
    pub statuses: &'a Table<StatusWordId, Ident>,
    /// The packed value of a signal.
    pub packed: Option<&'a Ident>,
}

/// What a signal's encoding is in Rust.
pub struct Coding {
    /// Type of the raw value.
    pub raw: TokenStream,
    /// Whether the value is calculated from the raw value.
    pub is_scaled: bool,
    /// Whether the value can be infinite or NaN.
    pub is_float: bool,
    /// Numerator and denominator of the step, unless it is 1.
    pub scale: Option<[TokenStream; 2]>,
    /// Numerator and denominator of the value of raw 0, unless it is 0.
    pub offset: Option<[TokenStream; 2]>,
    /// How limits are compared.
    pub limits: Limits,
    /// What the comment says of both.
    pub step: Option<String>,
    /// The type of the spec that is a type in Rust too.
    pub documented: Option<Path>,
}

impl Coding {
    /// Returns how a signal looks in Rust.
    pub fn new(protocol: &Protocol, words: &WordTypes, signal: &Signal) -> Self {
        let width = signal.place.width();
        match &signal.encoding {
            Encoding::Number { numeral, scale, offset } => Self {
                is_scaled: !signal.encoding.is_unscaled(),
                scale: (*scale != Rational::ONE).then(|| fraction(*scale)),
                offset: (*offset != Rational::ZERO).then(|| fraction(*offset)),
                limits: if is_compared_raw(signal) { Limits::Raw } else { Limits::Physical },
                step: step(signal, Integer::new(width, *numeral).digits, *scale, *offset),
                ..Self::raw(integer(width, *numeral))
            },
            Encoding::Float => Self {
                is_float: true,
                limits: if signal.ranges().next().is_some() { Limits::Double } else { Limits::Raw },
                ..Self::raw(quote!(f32))
            },
            Encoding::Named(known) => Self::named(&words.enumerations[*known], &protocol[*known].doc),
            Encoding::Status(known) => Self::named(&words.statuses[*known], &protocol[*known].doc),
            Encoding::Text => Self::raw(text(width)),
            Encoding::Packed { .. } => {
                let packed = words.packed;
                Self::raw(quote!(#packed))
            }
        }
    }

    /// Returns the coding of a value that is its raw value.
    fn raw(raw: TokenStream) -> Self {
        Self {
            raw,
            is_scaled: false,
            is_float: false,
            scale: None,
            offset: None,
            limits: Limits::Raw,
            step: None,
            documented: None,
        }
    }

    /// Returns the coding of a value with a type of its own.
    fn named(name: &Ident, doc: &Doc) -> Self {
        Self { documented: Some(doc.path.clone()), ..Self::raw(quote!(#name)) }
    }

    /// Returns the type of the value.
    pub fn value(&self, float: Float) -> TokenStream {
        if self.is_scaled { physical_type(float) } else { self.raw.clone() }
    }

    /// Returns the methods that read and write the value.
    pub fn methods(&self) -> [Ident; 2] {
        let names = if self.is_scaled { ["decode", "encode"] } else { ["get", "put"] };
        names.map(|name| format_ident!("{name}"))
    }

    /// Returns the type in which limits are compared, if it is not that of the raw value.
    pub fn physical(&self, float: Float) -> Option<TokenStream> {
        match (self.limits, float) {
            (Limits::Raw, _) | (Limits::Double, Float::F32) => None,
            (Limits::Physical, _) | (Limits::Double, Float::F64) => Some(physical_type(float)),
        }
    }

    /// Writes the ends of a range as they are compared.
    pub fn ends(&self, range: Range, float: Float) -> [TokenStream; 2] {
        ends(range, self.limits == Limits::Raw, float)
    }

    /// Tests whether equality of values is exact.
    pub fn is_exact(&self) -> bool {
        !self.is_float && !self.is_scaled
    }

    /// Writes the value that a raw value of the signal stands for.
    pub fn value_of(&self, signal: &Signal, raw: i128, float: Float) -> TokenStream {
        if self.is_scaled {
            return physical(signal.encoding.value_of(raw).unwrap_or(Rational::ZERO), float);
        }
        let raw = decimal(raw);
        match Integer::new(signal.place.width(), signal.encoding.numeral()).around {
            None => raw,
            Some(around) => quote!(#around::from_raw(#raw)),
        }
    }
}

/// How the limits of a signal are compared with its values.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Limits {
    /// As raw values.
    Raw,
    /// As physical values.
    Physical,
    /// In double precision if that is the type of scaled values, else as raw values.
    Double,
}

/// Tests whether limits can be raw values. Without limits, any unscaled number passes.
fn is_compared_raw(signal: &Signal) -> bool {
    whole(signal).is_some() || signal.encoding.is_unscaled() && signal.ranges().next().is_none()
}

/// Returns the type of a number that is a raw integer, and its limits too.
pub fn whole(signal: &Signal) -> Option<TokenStream> {
    let is_raw = signal.encoding.is_unscaled() && signal.encoding.numeral().is_raw();
    let is_whole = is_raw && signal.has_whole_limits();
    is_whole.then(|| integer(signal.place.width(), signal.encoding.numeral()))
}

fn fraction(number: Rational) -> [TokenStream; 2] {
    [number.numerator(), number.denominator()].map(decimal)
}

fn step(signal: &Signal, digits: Option<&str>, scale: Rational, offset: Rational) -> Option<String> {
    let unit = signal.unit.map_or_else(String::new, |unit| format!(" {}", unit.symbol));
    let step = (scale != Rational::ONE).then(|| format!("steps of {scale}{unit}"));
    let offset = (offset != Rational::ZERO).then(|| format!("raw 0 is {offset}{unit}"));
    let facts: Vec<_> = digits.map(str::to_owned).into_iter().chain(step).chain(offset).collect();
    (!facts.is_empty()).then(|| facts.join(", "))
}

/// Returns the smallest type of raw values that holds `width` bits.
pub fn integer(width: u8, numeral: Numeral) -> TokenStream {
    let Integer { kind, around, .. } = Integer::new(width, numeral);
    around.map_or_else(|| quote!(#kind), |around| quote!(#around<#kind>))
}

/// What a numeral is in Rust.
struct Integer {
    /// The smallest integer that holds the bits.
    kind: Ident,
    /// The type of the runtime around it, which is made by `from_raw`.
    around: Option<Ident>,
    /// What the comment says of the digits.
    digits: Option<&'static str>,
}

impl Integer {
    fn new(width: u8, numeral: Numeral) -> Self {
        let size = width.next_power_of_two().max(8);
        let plain = |sign| Self { kind: format_ident!("{sign}{size}"), around: None, digits: None };
        match numeral {
            Numeral::Unsigned => plain("u"),
            Numeral::Signed => plain("i"),
            Numeral::Bcd => Self { around: Some(format_ident!("Bcd")), digits: Some("decimal digits"), ..plain("u") },
        }
    }
}

/// Returns the type of a text that takes `width` bits.
fn text(width: u8) -> TokenStream {
    let bytes = Literal::u8_unsuffixed(width / 8);
    quote!(Text<#bytes>)
}

/// What a part of a packed value is in Rust.
pub enum Part {
    /// A number of this type.
    Number(TokenStream),
    /// A text of this type.
    Text(TokenStream),
}

impl Part {
    /// Returns how a part looks in Rust.
    pub fn new(part: &Signal) -> Self {
        let width = part.place.width();
        if part.encoding.is_text() {
            Self::Text(text(width))
        } else {
            Self::Number(integer(width, part.encoding.numeral()))
        }
    }
}
