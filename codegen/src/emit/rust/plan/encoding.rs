//! What each encoding is in Rust: its type, and how values are read and written.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::limits::Limits;
use super::literal::{Precision, decimal, hexadecimal};
use super::raw::{Integer, integer, raw_number, raw_type};
use crate::emit::Scaled;
use crate::model::{ByteRun, Doc, Encoding, EnumerationId, Linear, Protocol, Signal, StatusWordId, Table, TextForm};
use crate::report::tree::Path;
use crate::words::number::Rational;

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
    /// Type of the value if it is calculated from the raw value.
    pub calculated: Option<Precision>,
    /// Whether the value can be infinite or NaN.
    pub is_float: bool,
    /// Numerator and denominator of the step, unless it is 1.
    pub scale: Option<[TokenStream; 2]>,
    /// Numerator and denominator of the value of raw 0, unless it is 0.
    pub offset: Option<[TokenStream; 2]>,
    /// How limits are compared.
    pub limits: Limits,
    /// What the comment says of the digits and of both.
    pub step: Option<String>,
    /// The type of the spec that is a type in Rust too.
    pub documented: Option<Path>,
}

impl Coding {
    /// Returns how a signal looks in Rust.
    pub fn new(protocol: &Protocol, words: &WordTypes, signal: &Signal, scaled: Scaled) -> Self {
        let (scaled, limits) = (scaled.of(signal), Limits::new(signal, scaled));
        match &signal.encoding {
            Encoding::Number { numeral, scale, offset } => Self {
                calculated: Precision::of(scaled).filter(|_| !signal.encoding.is_unscaled()),
                scale: (*scale != Rational::ONE).then(|| fraction(*scale)),
                offset: (*offset != Rational::ZERO).then(|| fraction(*offset)),
                limits,
                step: step(signal, scaled, Linear { numeral: *numeral, scale: *scale, offset: *offset }),
                ..Self::raw(raw_type(signal))
            },
            Encoding::ByModel { .. } => Self { limits, ..Self::raw(raw_type(signal)) },
            Encoding::Float => Self { is_float: true, limits, ..Self::raw(raw_type(signal)) },
            Encoding::Named(known) => Self::named(&words.enumerations[*known], &protocol[*known].doc),
            Encoding::Status(known) => Self::named(&words.statuses[*known], &protocol[*known].doc),
            Encoding::Text(form) => Self::raw(match signal.run {
                Some(run) => long_text(run, *form),
                None => text((signal.place.width() / 8).into(), *form),
            }),
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
            calculated: None,
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
    pub fn value(&self) -> TokenStream {
        self.calculated.map_or_else(|| self.raw.clone(), Precision::kind)
    }

    /// Returns the methods that read and write the value.
    pub fn methods(&self) -> [Ident; 2] {
        let names = if self.calculated.is_some() { ["decode", "encode"] } else { ["get", "put"] };
        names.map(|name| format_ident!("{name}"))
    }

    /// Returns the type in which limits are compared, if it is not that of the raw value.
    pub fn physical(&self) -> Option<TokenStream> {
        match self.limits {
            Limits::Raw => None,
            Limits::Physical(precision) => Some(precision.kind()),
        }
    }

    /// Tests whether equality of values is exact.
    pub fn is_exact(&self) -> bool {
        !self.is_float && self.calculated.is_none()
    }

    /// Writes the value that a raw value of the signal stands for.
    pub fn value_of(&self, signal: &Signal, raw: i128) -> TokenStream {
        match self.calculated {
            Some(precision) => precision.nearest(signal.encoding.value_of(raw).unwrap_or(Rational::ZERO)),
            None => raw_number(signal, raw),
        }
    }
}

/// Writes the numerator and the denominator of a number.
pub fn fraction(number: Rational) -> [TokenStream; 2] {
    [number.numerator(), number.denominator()].map(decimal)
}

fn step(signal: &Signal, scaled: Scaled, Linear { numeral, scale, offset }: Linear) -> Option<String> {
    let (unit, digits) = (signal.unit_text(), Integer::new(signal.place.width(), numeral).digits);
    // The unit of whole steps says what a step is.
    let step = (scale != Rational::ONE && scaled != Scaled::Steps).then(|| format!("steps of {scale}{unit}"));
    let offset = (offset != Rational::ZERO).then(|| format!("raw 0 is {offset}{unit}"));
    let facts: Vec<_> = digits.map(str::to_owned).into_iter().chain(step).chain(offset).collect();
    (!facts.is_empty()).then(|| facts.join(", "))
}

/// Returns the type of a text that no place holds.
fn long_text(run: ByteRun, form: TextForm) -> TokenStream {
    match form {
        TextForm::Hexadecimal if run.varies() => {
            let most = Literal::u16_unsuffixed(run.most);
            quote!(Elements<u8, #most>)
        }
        TextForm::Ascii { .. } | TextForm::Hexadecimal => text(run.most, form),
    }
}

/// Returns the type of a text of some number of bytes.
fn text(bytes: u16, form: TextForm) -> TokenStream {
    let bytes = Literal::u16_unsuffixed(bytes);
    match form {
        TextForm::Ascii { fill: 0 } => quote!(Text<#bytes>),
        TextForm::Ascii { fill } => {
            let fill = hexadecimal(fill, 8);
            quote!(Text<#bytes, #fill>)
        }
        TextForm::Hexadecimal => quote!(Bytes<#bytes>),
    }
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
        match part.encoding.text_form() {
            Some(form) => Self::Text(text((width / 8).into(), form)),
            None => Self::Number(integer(width, part.encoding.numeral())),
        }
    }
}
