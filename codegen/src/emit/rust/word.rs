//! Named values, status words and packed values.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::derives::Derives;
use super::doc;
use super::literal::{decimal, hexadecimal};
use super::names::{ident, screaming, variants};
use super::place::Written;
use crate::model::{
    Encoding, Enumeration, Message, PartId, Piece, Protocol, Severity, Signal, StatusBit, StatusWord, Table,
};

/// Returns the smallest integer type of so many bits.
pub fn integer(width: u8, signed: bool) -> TokenStream {
    let size = width.next_power_of_two().max(8);
    let name = if signed { format_ident!("i{size}") } else { format_ident!("u{size}") };
    quote!(#name)
}

/// Emits an enum with a variant a name, and one for all other values.
pub fn enumeration(protocol: &Protocol, name: &Ident, enumeration: &Enumeration, derives: Derives) -> TokenStream {
    let optional = derives.word(name);
    let sentence = doc::sentence_of(&doc::title(&enumeration.doc, &enumeration.name));
    let comment = doc::item(protocol, &enumeration.doc, &sentence, None);
    let (variants, unknown) = variants(enumeration.values.iter().map(|value| value.name.as_str()));
    let raws: Vec<_> = enumeration.values.iter().map(|value| decimal(value.raw)).collect();
    let texts: Vec<_> = enumeration.values.iter().map(|value| &value.name).collect();
    let comments = enumeration.values.iter().map(|value| doc::line(format!("{}: `{}`.", value.raw, value.name)));
    let raw = integer(enumeration.width, false);
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum #name {
            #(#comments #variants,)*
            /// A value without a name; it is sent as it is.
            #unknown(#raw),
        }

        impl #name {
            /// Returns the value that stands for a raw number, whether it has a name or not.
            #[must_use]
            pub const fn from_raw(raw: #raw) -> Self {
                match raw { #(#raws => Self::#variants,)* _ => Self::#unknown(raw) }
            }

            /// Returns the raw number.
            #[must_use]
            pub const fn raw(self) -> #raw {
                match self { #(Self::#variants => #raws,)* Self::#unknown(raw) => raw }
            }

            /// Returns the name, unless the value has none.
            #[must_use]
            pub fn name(self) -> Option<&'static str> {
                Word::name(self)
            }

            /// Finds a value by its name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                Word::named(name)
            }
        }

        impl Word for #name {
            type Raw = #raw;
            const LEGEND: Legend<Self> = Legend::Names(&[#((Self::#variants, #texts)),*]);
            const FROM_RAW: fn(#raw) -> Self = Self::from_raw;
            const RAW: fn(Self) -> #raw = Self::raw;
        }

        #optional
    }
}

/// Emits a newtype with a constant a bit.
pub fn status_word(protocol: &Protocol, name: &Ident, word: &StatusWord, derives: Derives) -> TokenStream {
    let optional = derives.word(name);
    let comment = doc::item(protocol, &word.doc, &doc::sentence_of(&doc::title(&word.doc, &word.name)), None);
    let raw = integer(word.width, false);
    let constants = word.bits.iter().map(|bit| constant(protocol, word, bit));
    let rows = word.bits.iter().map(row);
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct #name(pub #raw);

        impl #name {
            #(#constants)*

            /// Tests whether all bits of `other` are set.
            #[must_use]
            pub const fn contains(self, other: Self) -> bool {
                self.0 & other.0 == other.0
            }

            /// Tests whether some bit of `other` is set.
            #[must_use]
            pub const fn intersects(self, other: Self) -> bool {
                self.0 & other.0 != 0
            }

            /// Returns the set bits that have a name, the lowest first.
            pub fn set_bits(self) -> impl Iterator<Item = &'static StatusBit> {
                Word::set_bits(self)
            }

            /// Returns the set bits that have no name.
            #[must_use]
            pub fn unknown(self) -> u64 {
                Word::unknown(self)
            }
        }

        impl Word for #name {
            type Raw = #raw;
            const LEGEND: Legend<Self> = Legend::Bits(&[#(#rows),*]);
            const FROM_RAW: fn(#raw) -> Self = Self;
            const RAW: fn(Self) -> #raw = |word| word.0;
        }

        impl core::ops::BitOr for #name {
            type Output = Self;

            fn bitor(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
        }

        #optional
    }
}

fn constant(protocol: &Protocol, word: &StatusWord, bit: &StatusBit) -> TokenStream {
    let name = screaming(&bit.name);
    let mask = hexadecimal(1_u64 << bit.bit, word.width.next_power_of_two().max(8));
    let severity = bit.severity.map_or_else(String::new, |severity| format!(", {}", severity_name(severity)));
    let title = doc::title(&bit.doc, &bit.name);
    let remarks =
        [("Set when", &bit.set_when), ("Cleared when", &bit.clear_when), ("Effect:", &bit.effect), ("LED:", &bit.led)];
    let remarks =
        remarks.into_iter().filter_map(|(word, remark)| Some(format!("{word} {}", doc::plain(remark.as_ref()?))));
    let sentences = std::iter::once(format!("{title}: bit {}{severity}", bit.bit)).chain(remarks);
    let sentence = sentences.map(|text| doc::sentence_of(&text)).collect::<Vec<_>>().join(" ");
    let comment = doc::item(protocol, &bit.doc, &sentence, Some(&word.doc));
    quote!(#comment pub const #name: Self = Self(#mask);)
}

fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::State => "state",
        Severity::Alarm => "alarm",
        Severity::Fault => "fault",
    }
}

fn row(bit: &StatusBit) -> TokenStream {
    let constructor = bit.severity.map_or_else(|| format_ident!("new"), |severity| ident(severity_name(severity)));
    let (number, name) = (Literal::u8_unsuffixed(bit.bit), &bit.name);
    let title = bit.doc.title.clone().unwrap_or_else(|| bit.name.replace('_', " "));
    quote!(StatusBit::#constructor(#number, #name, #title))
}

/// Emits a struct of the parts of a packed value, with their text.
pub fn packed(
    protocol: &Protocol,
    name: &Ident,
    message: &Message,
    signal: &Signal,
    derives: Derives,
) -> Option<TokenStream> {
    let Encoding::Packed { pieces, parts } = &signal.encoding else { return None };
    let titled = if signal.doc.title.is_some() { &signal.doc } else { &message.doc };
    let sentence = doc::sentence_of(&doc::title(titled, &signal.name));
    let comment = doc::line(format!("{sentence} Written as `{}`.", format(pieces, parts)));
    let members = parts.iter().map(|part| member(protocol, part, signal));
    let constants = parts.iter().map(|part| screaming(&part.name));
    let first = first_byte(signal);
    let places = parts.iter().map(|part| Written::new(part.place).counted_from(first).expression());
    let word = packed_word(name, signal, pieces, parts);
    let optional = derives.word(name);
    Some(quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct #name { #(#members),* }

        impl #name {
            #(const #constants: Place = #places;)*

            /// Returns the text, or `None` if it would not give the same value.
            #[must_use]
            pub fn text(self) -> Option<PackedText> {
                Word::text(self)
            }

            /// Reads a text of the documented form.
            #[must_use]
            pub fn parse(text: &str) -> Option<Self> {
                Word::parse(text)
            }
        }

        #word

        impl core::fmt::Display for #name {
            fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                Word::write(*self, formatter)
            }
        }

        #optional
    })
}

fn packed_word(name: &Ident, signal: &Signal, pieces: &[Piece], parts: &Table<PartId, Signal>) -> TokenStream {
    let bytes = Literal::u8_unsuffixed(signal.place.width() / 8);
    let fields: Vec<_> = parts.iter().map(|part| ident(&part.name)).collect();
    let constants: Vec<_> = parts.iter().map(|part| screaming(&part.name)).collect();
    let pieces = pieces.iter().map(|known| piece(known, parts));
    quote! {
        impl Word for #name {
            type Raw = u64;
            const LEGEND: Legend<Self> = Legend::Text(#bytes, &[#(#pieces),*]);
            const FROM_RAW: fn(u64) -> Self = |raw| {
                let data = left_aligned(raw, #bytes);
                Self { #(#fields: Self::#constants.read(&data)),* }
            };
            const RAW: fn(Self) -> u64 = |value| {
                let mut data = [0; 8];
                #(Self::#constants.write(value.#fields, &mut data);)*
                right_aligned(data, #bytes)
            };
        }
    }
}

fn first_byte(signal: &Signal) -> u8 {
    u8::try_from(u64::from_be_bytes(signal.place.mask()).leading_zeros() / 8).unwrap_or(0)
}

/// Writes the form of the text as in the spec.
fn format(pieces: &[Piece], parts: &Table<PartId, Signal>) -> String {
    let piece = |piece: &Piece| match piece {
        Piece::Literal(literal) => literal.clone(),
        Piece::Part { part, digits: None } => format!("{{{}}}", parts[*part].name),
        Piece::Part { part, digits: Some(digits) } => format!("{{{}:{digits}}}", parts[*part].name),
    };
    pieces.iter().map(piece).collect()
}

fn member(protocol: &Protocol, part: &Signal, signal: &Signal) -> TokenStream {
    let (name, width) = (ident(&part.name), part.place.width());
    let is_text = matches!(part.encoding, Encoding::Text);
    let title = doc::title(&part.doc, &part.name);
    let range = part.range.map_or_else(String::new, |range| format!(", `{}..={}`", range.minimum, range.maximum));
    let sentence = doc::sentence_of(&format!("{title}: {}{range}", Written::new(part.place).text()));
    let comment = doc::item(protocol, &part.doc, &sentence, Some(&signal.doc));
    let kind = if is_text { text_type(width) } else { integer(width, false) };
    quote!(#comment pub #name: #kind)
}

/// Returns the type of a text of so many bits.
pub fn text_type(width: u8) -> TokenStream {
    let bytes = Literal::u8_unsuffixed(width / 8);
    quote!(Text<#bytes>)
}

fn piece(piece: &Piece, parts: &Table<PartId, Signal>) -> TokenStream {
    let (part, digits) = match piece {
        Piece::Literal(literal) => return quote!(Piece::Literal(#literal)),
        Piece::Part { part, digits } => (&parts[*part], digits),
    };
    let place = screaming(&part.name);
    if matches!(part.encoding, Encoding::Text) {
        return quote!(Piece::Text(Self::#place));
    }
    let limits = part.range.map(|range| {
        let (minimum, maximum) = (decimal(range.minimum.numerator()), decimal(range.maximum.numerator()));
        quote!(.limits(#minimum, #maximum))
    });
    match digits {
        None => quote!(Piece::number(Self::#place) #limits),
        Some(digits) => {
            let digits = Literal::usize_unsuffixed(*digits);
            quote!(Piece::digits(Self::#place, #digits) #limits)
        }
    }
}
