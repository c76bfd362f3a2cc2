//! The list of all messages.

use proc_macro2::TokenStream;
use quote::quote;

use super::plan::message::Message;

/// Emits the list.
pub fn entries(messages: &[Message]) -> TokenStream {
    let entries = messages.iter().map(entry);
    quote! {
        /// Every message, for programs that go through them without naming one.
        pub const MESSAGES: &[Entry<Message>] = &[#(#entries),*];
    }
}

fn entry(Message { home, owner, title, constants, signals, exchanges, structs, .. }: &Message) -> TokenStream {
    let has_all = structs.iter().any(|own| own.is_home && own.signals.len() == signals.len());
    let exchanges = exchanges.iter().map(|exchange| &exchange.constant);
    let constants = constants.iter().map(|(name, value)| quote!((#name, #value)));
    if has_all && !signals.is_empty() {
        return quote!(Entry::of::<#home>(#title, &[#(#constants),*], &[#(&#owner::#exchanges),*]));
    }
    let signals = signals.iter().map(|signal| &signal.constant);
    quote!(Entry::new(#title, &[#(#constants),*], &[#(&#home::#signals),*], &[#(&#owner::#exchanges),*]))
}
