//! What frames show: every frame, those with a selector in the data, and those with constants.

use proc_macro2::TokenStream;
use quote::quote;

use super::plan::identifier::Base;
use super::plan::selector::{Filter, InData, Required, Source};

/// Emits what every frame shows.
pub fn base(Base { extended, bits, constants, sent, .. }: &Base) -> TokenStream {
    let width = if *extended { quote!(EXTENDED) } else { quote!(STANDARD) };
    let bits = bits.iter().map(|(mask, value)| quote!(.id_bits(#mask, #value)));
    let constants = constants.iter().map(|(place, value)| quote!(.id(Identifier::#place, #value)));
    let sent = sent.iter().map(|(place, value)| quote!(.send_id(Identifier::#place, #value)));
    quote! {
        /// What every frame shows.
        pub const FRAME: Filter = Filter::#width #(#bits)* #(#constants)* #(#sent)*;
    }
}

/// Emits the filter of replies that report no error.
pub fn normal(base: &Base) -> TokenStream {
    let normal = base.normal.iter().map(|(place, value)| quote!(.id(Identifier::#place, #value)));
    quote!(FRAME #(#normal)*)
}

/// Emits the constant of a selector in the data.
pub fn in_data(InData { constant, comment, name, place, normal }: &InData) -> TokenStream {
    let normal = normal.iter().map(|normal| quote!(.normal(#normal)));
    quote!(#comment pub const #constant: Selector = Selector::new(#name, #place) #(#normal)*;)
}

/// Emits the field that says whether more frames follow.
pub fn continuation((source, raw): &(Source, TokenStream)) -> TokenStream {
    let value = match source {
        Source::Identifier(place) => quote!(Continuation::identifier(Identifier::#place, #raw)),
        Source::Data(selector) => quote!(Continuation::data(#selector.place, #raw)),
    };
    quote! {
        /// The field that says whether more frames follow.
        pub const CONTINUATION: Continuation = #value;
    }
}

/// Emits a filter.
pub fn filter(Filter { selectors, required }: &Filter) -> TokenStream {
    let selectors = (!selectors.is_empty()).then(|| quote!(.selectors(&[#(#selectors),*])));
    let required = self::required(required);
    quote!(FRAME #selectors #required)
}

/// Emits the calls by which a filter or an exchange requires values.
pub fn required(required: &[Required]) -> TokenStream {
    let calls = required.iter().map(|Required { source, value, open }| match source {
        Source::Identifier(place) => quote!(.id(Identifier::#place, #value)),
        Source::Data(selector) => {
            let open = open.iter();
            quote!(.data(#selector.place, #value) #(.open(#selector.place, #open))*)
        }
    });
    calls.collect()
}
