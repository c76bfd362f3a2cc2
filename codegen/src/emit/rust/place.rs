//! Places, in the terms of the document: bytes of the data, bits of a word.

use canspec_runtime::{ByteOrder, Place};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// A place as bytes, and bits of the word that they make.
pub struct Written {
    first: u8,
    last: u8,
    /// Bits of the word, unless they are all of it.
    bits: Option<(u8, u8)>,
}

impl Written {
    pub fn new(place: Place) -> Self {
        let bits = place.bits_of_payload();
        let (low, high) = (bits.shift(), bits.shift() + bits.width() - 1);
        let word = low / 8 * 8;
        let whole = low == word && high % 8 == 7;
        let bits = (!whole).then_some((high - word, low - word));
        match place.order() {
            ByteOrder::Big => Self { first: 7 - high / 8, last: 7 - low / 8, bits },
            ByteOrder::Little => Self { first: high / 8, last: low / 8, bits },
        }
    }

    /// Counts the bytes from another first byte.
    pub fn from_byte(self, byte: u8) -> Self {
        Self { first: self.first.saturating_sub(byte), last: self.last.saturating_sub(byte), ..self }
    }

    /// Writes the expression.
    pub fn expression(&self) -> TokenStream {
        let [first, last] = [self.first, self.last].map(Literal::u8_unsuffixed);
        let word =
            if self.first == self.last { quote!(Place::byte(#first)) } else { quote!(Place::bytes(#first, #last)) };
        let Some((high, low)) = self.bits else { return word };
        let (high_bit, low_bit) = (Literal::u8_unsuffixed(high), Literal::u8_unsuffixed(low));
        if high == low { quote!(#word.bit(#high_bit)) } else { quote!(#word.bits(#high_bit, #low_bit)) }
    }

    /// Writes the place for people.
    pub fn text(&self) -> String {
        let bytes = match (self.first, self.last) {
            (first, last) if first == last => format!("byte {first}"),
            (first, last) => format!("bytes {first}..{last}"),
        };
        match self.bits {
            None => bytes,
            Some((high, low)) if high == low => format!("{bytes}, bit {high}"),
            Some((high, low)) => format!("{bytes}, bits {high}..{low}"),
        }
    }
}
