//! Named values, status words and packed values.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::doc;
use super::literal::{decimal, hexadecimal};
use super::names::{camel, ident, screaming};
use super::place::Written;
use crate::model::{
    Encoding, Enumeration, Message, NamedValue, Piece, Protocol, Severity, Signal, StatusBit, StatusWord,
};

/// Returns the smallest integer type of so many bits.
pub fn integer(width: u8, signed: bool) -> TokenStream {
    let size = width.next_power_of_two().max(8);
    let name = if signed { format_ident!("i{size}") } else { format_ident!("u{size}") };
    quote!(#name)
}

/// Emits an enum with a variant a name, and one for all other values.
pub fn enumeration(protocol: &Protocol, name: &Ident, enumeration: &Enumeration) -> TokenStream {
    let sentence = title(&enumeration.doc.title, &enumeration.name);
    let comment = doc::item(protocol, &enumeration.doc, &sentence, None);
    let variants: Vec<_> = enumeration.values.iter().map(variant).collect();
    let raws: Vec<_> = enumeration.values.iter().map(|value| decimal(value.raw)).collect();
    let texts: Vec<_> = enumeration.values.iter().map(|value| &value.name).collect();
    let comments = enumeration.values.iter().map(|value| doc::line(format!("{}: `{}`.", value.raw, value.name)));
    let unknown = unknown(&variants);
    let raw = integer(enumeration.width, false);
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum #name {
            #(#comments #variants,)*
            /// A value without a name.
            #unknown(#raw),
        }

        impl Word for #name {
            type Raw = #raw;
            const LEGEND: Legend<Self> = Legend::Names(&[#((Self::#variants, #texts)),*]);

            fn from_raw(raw: #raw) -> Self {
                match raw { #(#raws => Self::#variants,)* _ => Self::#unknown(raw) }
            }

            fn raw(self) -> #raw {
                match self { #(Self::#variants => #raws,)* Self::#unknown(raw) => raw }
            }
        }

        impl Named for #name {}
    }
}

/// Returns the title as a sentence, or the name if there is none.
fn title(title: &Option<String>, name: &str) -> String {
    doc::sentence_of(&title.as_ref().map_or_else(|| name.replace('_', " "), |title| doc::plain(title)))
}

fn variant(value: &NamedValue) -> Ident {
    ident(&camel(&value.name))
}

/// Names the variant of values without a name, so that it is none of the others.
fn unknown(variants: &[Ident]) -> Ident {
    let taken = variants.iter().any(|variant| variant == "Unknown");
    if taken { format_ident!("Other") } else { format_ident!("Unknown") }
}

/// Emits a newtype with a constant a bit.
pub fn status_word(protocol: &Protocol, name: &Ident, word: &StatusWord) -> TokenStream {
    let comment = doc::item(protocol, &word.doc, &title(&word.doc.title, &word.name), None);
    let raw = integer(word.width, false);
    let constants = word.bits.iter().map(|bit| constant(protocol, word, bit));
    let rows = word.bits.iter().map(row);
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct #name(pub #raw);

        impl #name { #(#constants)* }

        impl Word for #name {
            type Raw = #raw;
            const LEGEND: Legend<Self> = Legend::Bits(&[#(#rows),*]);

            fn from_raw(raw: #raw) -> Self {
                Self(raw)
            }

            fn raw(self) -> #raw {
                self.0
            }
        }

        impl StatusWord for #name {}

        impl BitOr for #name {
            type Output = Self;

            fn bitor(self, other: Self) -> Self {
                self.union(other)
            }
        }
    }
}

fn constant(protocol: &Protocol, word: &StatusWord, bit: &StatusBit) -> TokenStream {
    let name = screaming(&bit.name);
    let mask = hexadecimal(1_u64 << bit.bit, word.width.next_power_of_two().max(8));
    let severity = bit.severity.map_or_else(String::new, |severity| format!(", {}", severity_name(severity)));
    let title = doc::plain(bit.doc.title.as_ref().unwrap_or(&bit.name.replace('_', " ")));
    let mut sentence = doc::sentence_of(&format!("{title}: bit {}{severity}", bit.bit));
    let remarks =
        [("Set when", &bit.set_when), ("Cleared when", &bit.clear_when), ("Effect:", &bit.effect), ("LED:", &bit.led)];
    for (word, remark) in remarks {
        if let Some(remark) = remark {
            sentence.push_str(&format!(" {}", doc::sentence_of(&format!("{word} {}", doc::plain(remark)))));
        }
    }
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
    let (number, name) = (proc_macro2::Literal::u8_unsuffixed(bit.bit), &bit.name);
    let title = bit.doc.title.clone().unwrap_or_else(|| bit.name.replace('_', " "));
    quote!(StatusBit::#constructor(#number, #name, #title))
}

/// Emits a struct of the parts of a packed value, with their text.
pub fn packed(protocol: &Protocol, name: &Ident, message: &Message, signal: &Signal) -> Option<TokenStream> {
    let Encoding::Packed { pieces, parts } = &signal.encoding else { return None };
    let sentence = title(signal.doc.title.as_ref().map_or(&message.doc.title, |_| &signal.doc.title), &signal.name);
    let text = doc::line(format!("{sentence} Written as `{}`.", format(pieces, parts)));
    let first = first_byte(signal);
    let bytes = proc_macro2::Literal::u8_unsuffixed(signal.place.width() / 8);
    let fields: Vec<_> = parts.iter().map(|part| ident(&part.name)).collect();
    let constants: Vec<_> = parts.iter().map(|part| screaming(&part.name)).collect();
    let places = parts.iter().map(|part| Written::new(part.place).from_byte(first).expression());
    let members = parts.iter().map(|part| member(protocol, part, signal));
    let pieces = pieces.iter().map(|known| piece(known, parts));
    Some(quote! {
        #text
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct #name { #(#members),* }

        impl #name { #(const #constants: Place = #places;)* }

        impl Word for #name {
            type Raw = u64;
            const LEGEND: Legend<Self> = Legend::Text(#bytes, &[#(#pieces),*]);

            fn from_raw(raw: u64) -> Self {
                let data = left_aligned(raw, #bytes);
                Self { #(#fields: Self::#constants.read(&data)),* }
            }

            fn raw(self) -> u64 {
                let mut data = [0; 8];
                #(Self::#constants.write(self.#fields, &mut data);)*
                right_aligned(data, #bytes)
            }
        }

        impl Packed for #name {}

        impl Display for #name {
            fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
                self.write(formatter)
            }
        }
    })
}

fn first_byte(signal: &Signal) -> u8 {
    u8::try_from(u64::from_be_bytes(signal.place.mask()).leading_zeros() / 8).unwrap_or(0)
}

/// Writes the form of the text as in the spec.
fn format(pieces: &[Piece], parts: &[Signal]) -> String {
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
    let title = doc::plain(part.doc.title.as_ref().unwrap_or(&part.name.replace('_', " ")));
    let range = part.range.map_or_else(String::new, |range| format!(", `{}..={}`", range.minimum, range.maximum));
    let sentence = doc::sentence_of(&format!("{title}: {}{range}", Written::new(part.place).text()));
    let comment = doc::item(protocol, &part.doc, &sentence, Some(&signal.doc));
    let kind = if is_text { text_type(width) } else { integer(width, false) };
    quote!(#comment pub #name: #kind)
}

/// Returns the type of a text of so many bits.
pub fn text_type(width: u8) -> TokenStream {
    let bytes = proc_macro2::Literal::u8_unsuffixed(width / 8);
    quote!(Text<#bytes>)
}

fn piece(piece: &Piece, parts: &[Signal]) -> TokenStream {
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
            let digits = proc_macro2::Literal::usize_unsuffixed(*digits);
            quote!(Piece::digits(Self::#place, #digits) #limits)
        }
    }
}
