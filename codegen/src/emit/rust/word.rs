//! Named values, status words and packed values.

use proc_macro2::TokenStream;
use quote::quote;

use super::derives::Derives;
use super::plan::word::{Enumeration, Packed, PackedPart, Piece, StatusBit, StatusWord, Value};

/// Emits an enum with a variant a name, and one for all other values.
///
/// `PartialEq` is not derived, since a number that has a name can also be given as one without.
pub fn enumeration(enumeration: &Enumeration, derives: Derives) -> TokenStream {
    let Enumeration { name, comment, raw, values, unknown } = enumeration;
    let optional = derives.word(name);
    let definitions = values.iter().map(|Value { variant, comment, .. }| quote!(#comment #variant,));
    let variants: Vec<_> = values.iter().map(|value| &value.variant).collect();
    let raws: Vec<_> = values.iter().map(|value| &value.raw).collect();
    let texts = values.iter().map(|value| &value.name);
    quote! {
        #comment
        #[derive(Clone, Copy, Debug)]
        pub enum #name {
            #(#definitions)*
            /// A value without a name; it is sent as it is.
            #unknown(#raw),
        }

        /// Two values are equal if they have the same raw number.
        impl PartialEq for #name {
            #[inline]
            fn eq(&self, other: &Self) -> bool {
                self.raw() == other.raw()
            }
        }

        impl Eq for #name {}

        impl core::hash::Hash for #name {
            #[inline]
            fn hash<H: core::hash::Hasher>(&self, state: &mut H) {
                core::hash::Hash::hash(&self.raw(), state);
            }
        }

        impl #name {
            /// Returns the value that stands for a raw number, whether it has a name or not.
            #[must_use]
            pub const fn from_raw(raw: #raw) -> Self {
                match raw { #(#raws => Self::#variants,)* _ => Self::#unknown(raw) }
            }

            /// Returns the raw number.
            #[must_use]
            #[inline]
            pub const fn raw(self) -> #raw {
                match self { #(Self::#variants => #raws,)* Self::#unknown(raw) => raw }
            }

            /// Returns the name, unless the value has none.
            #[must_use]
            #[inline]
            pub fn name(self) -> Option<&'static str> {
                Word::name(self)
            }

            /// Finds a value by its name.
            #[must_use]
            #[inline]
            pub fn from_name(name: &str) -> Option<Self> {
                Word::named(name)
            }
        }

        impl Word for #name {
            type Raw = #raw;
            const LEGEND: Legend<#raw> = Legend::Names(&[#((#raws, #texts)),*]);
            const FROM_RAW: fn(#raw) -> Self = Self::from_raw;
            const RAW: fn(Self) -> #raw = Self::raw;
        }

        #optional
    }
}

/// Emits a newtype with a constant a bit.
pub fn status_word(StatusWord { name, comment, raw, bits }: &StatusWord, derives: Derives) -> TokenStream {
    let optional = derives.word(name);
    let constants = bits
        .iter()
        .map(|StatusBit { constant, comment, mask, .. }| quote!(#comment pub const #constant: Self = Self(#mask);));
    let rows = bits.iter().map(
        |StatusBit { constructor, number, name, title, .. }| quote!(StatusBit::#constructor(#number, #name, #title)),
    );
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
            #[inline]
            pub fn set_bits(self) -> impl Iterator<Item = &'static StatusBit> {
                Word::set_bits(self)
            }

            /// Returns the set bits that have no name.
            #[must_use]
            #[inline]
            pub fn unknown(self) -> u64 {
                Word::unknown(self)
            }
        }

        impl Word for #name {
            type Raw = #raw;
            const LEGEND: Legend<#raw> = Legend::Bits(&[#(#rows),*]);
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

/// Emits a struct of the parts of a packed value, with their text.
pub fn packed(packed: &Packed, derives: Derives) -> TokenStream {
    let Packed { name, comment, parts, .. } = packed;
    let (optional, word) = (derives.word(name), packed_word(packed));
    let members = parts.iter().map(|PackedPart { member, comment, kind, .. }| quote!(#comment pub #member: #kind));
    let constants = parts.iter().map(|PackedPart { constant, place, .. }| quote!(const #constant: Place = #place;));
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct #name { #(#members),* }

        impl #name {
            #(#constants)*

            /// Returns the text, or `None` if it would not give the same value.
            #[must_use]
            #[inline]
            pub fn text(self) -> Option<PackedText> {
                Word::text(self)
            }

            /// Reads a text of the documented form.
            #[must_use]
            #[inline]
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
    }
}

fn packed_word(Packed { name, bytes, parts, pieces, .. }: &Packed) -> TokenStream {
    let fields: Vec<_> = parts.iter().map(|part| &part.member).collect();
    let constants: Vec<_> = parts.iter().map(|part| &part.constant).collect();
    let pieces = pieces.iter().map(piece);
    quote! {
        impl Word for #name {
            type Raw = u64;
            const LEGEND: Legend<u64> = Legend::Text(#bytes, &[#(#pieces),*]);
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

fn piece(piece: &Piece) -> TokenStream {
    let (place, kind, digits, limits) = match piece {
        Piece::Literal(literal) => return quote!(Piece::Literal(#literal)),
        Piece::Text(place) => return quote!(Piece::Text(Self::#place)),
        Piece::Number { place, kind, digits, limits } => (place, kind, digits, limits),
    };
    let limits = limits.iter().map(|(minimum, maximum)| quote!(.limits(#minimum, #maximum)));
    match digits {
        None => quote!(Piece::number::<#kind>(Self::#place) #(#limits)*),
        Some(digits) => quote!(Piece::digits::<#kind>(Self::#place, #digits) #(#limits)*),
    }
}
