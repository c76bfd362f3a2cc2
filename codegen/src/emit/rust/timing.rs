//! The times of the document by their roles.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::plan::timing::{Times, Timing};

/// Emits the constant of all times that have a role.
pub fn timing(Timing { general, of_messages }: &Timing) -> TokenStream {
    let all = times(general);
    let own = of_messages.iter().map(|(name, own)| {
        let own = times(own);
        quote!((#name, #own))
    });
    let own = (!of_messages.is_empty()).then(|| quote!(.with_messages(&[#(#own),*])));
    quote! {
        /// The times that the document states, by their roles.
        pub const TIMING: Timing = #all #own;
    }
}

fn times(times: &Times) -> TokenStream {
    let setters = times.iter().map(|(name, value)| {
        let setter = format_ident!("with_{name}");
        quote!(.#setter(#value))
    });
    quote!(Timing::NONE #(#setters)*)
}
