//! What the identifier shows of an addressing mode.

use proc_macro2::TokenStream;
use quote::quote;

use super::plan::address::{Address, Pattern};

pub fn pattern(Pattern { constants, addresses }: &Pattern) -> TokenStream {
    let constants = constants.iter().map(|(place, value)| quote!((Identifier::#place, #value)));
    let addresses = addresses.iter().map(address);
    quote!(Pattern { constants: &[#(#constants),*], addresses: &[#(#addresses),*] })
}

/// Writes a field that holds an address.
pub fn address(Address { place, kind, excluded }: &Address) -> TokenStream {
    let ranges = excluded.iter().map(|(first, last)| quote!((#first, #last)));
    let excluding = (!excluded.is_empty()).then(|| quote!(.excluding(&[#(#ranges),*])));
    quote!(Address::new(Identifier::#place, &#kind) #excluding)
}
