//! What the spec says about the protocol as a whole.

use proc_macro2::TokenStream;
use quote::quote;

use super::plan::about::About;

/// Emits the constants of the documents and of the speeds of the bus.
pub fn about(About { documents, bit_rates }: &About) -> TokenStream {
    let documents = documents.iter().map(|[title, version]| quote!(Document { title: #title, version: #version }));
    let bit_rates = (!bit_rates.is_empty()).then(|| {
        quote! {
            /// Speeds of the bus, in bit/s.
            pub const BIT_RATES: &[u32] = &[#(#bit_rates),*];
        }
    });
    quote! {
        /// What this module follows.
        pub const DOCUMENTS: &[Document] = &[#(#documents),*];
        #bit_rates
    }
}
