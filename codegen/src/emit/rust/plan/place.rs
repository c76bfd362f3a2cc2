//! Places, in the terms of the document: bytes of the data, bits of a word.

use canspec_runtime::Place;
use canspec_runtime::plumbing::ByteOrder;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};

/// A place as bytes, and bits of the word that they make.
pub struct Written {
    first: u16,
    last: u16,
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
        let (first, last) = match place.order() {
            ByteOrder::Big => (7 - high / 8, 7 - low / 8),
            ByteOrder::Little => (high / 8, low / 8),
        };
        Self { first: first.into(), last: last.into(), bits }
    }

    /// Writes the place as bits of all eight bytes, which says their order however few the bits are.
    pub fn in_all(place: Place) -> Self {
        let bits = place.bits_of_payload();
        let (first, last) = if place.order() == ByteOrder::Big { (0, 7) } else { (7, 0) };
        Self { first, last, bits: Some((bits.shift() + bits.width() - 1, bits.shift())) }
    }

    /// Counts the bytes with those before the first one.
    pub fn after(self, bytes: u16) -> Self {
        Self { first: self.first + bytes, last: self.last + bytes, ..self }
    }

    /// Counts the bytes from another first byte.
    pub fn counted_from(self, byte: u16) -> Self {
        Self { first: self.first.saturating_sub(byte), last: self.last.saturating_sub(byte), ..self }
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

impl ToTokens for Written {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        let [first, last] = [self.first, self.last].map(Literal::u16_unsuffixed);
        tokens.extend(if self.first == self.last {
            quote!(Place::byte(#first))
        } else {
            quote!(Place::bytes(#first, #last))
        });
        let Some((high, low)) = self.bits else { return };
        let (high_bit, low_bit) = (Literal::u8_unsuffixed(high), Literal::u8_unsuffixed(low));
        tokens.extend(if high == low { quote!(.bit(#high_bit)) } else { quote!(.bits(#high_bit, #low_bit)) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(place: Place) -> (String, String) {
        let written = Written::new(place);
        (written.to_token_stream().to_string().replace(' ', ""), written.text())
    }

    #[test]
    fn places_are_written_as_in_the_document() {
        let cases = [
            (Place::bytes(0, 3), "Place::bytes(0,3)", "bytes 0..3"),
            (Place::bytes(7, 4), "Place::bytes(7,4)", "bytes 7..4"),
            (Place::byte(2), "Place::byte(2)", "byte 2"),
            (Place::bytes(7, 0).bits(23, 12), "Place::bytes(2,1).bits(15,4)", "bytes 2..1, bits 15..4"),
            (Place::bytes(0, 1).bits(11, 0), "Place::bytes(0,1).bits(11,0)", "bytes 0..1, bits 11..0"),
            (Place::bytes(7, 0).bit(48), "Place::byte(6).bit(0)", "byte 6, bit 0"),
        ];
        for (place, expression, text) in cases {
            assert_eq!(written(place), (expression.to_owned(), text.to_owned()));
        }
    }

    #[test]
    fn the_expression_is_the_same_place() {
        let place = Place::bytes(7, 0).bits(23, 12);
        assert_eq!(Place::bytes(2, 1).bits(15, 4), place);
    }
}
