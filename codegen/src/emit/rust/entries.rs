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

fn entry(Message { home, title, constants, signals, exchanges, .. }: &Message) -> TokenStream {
    let signals = signals.iter().map(|signal| &signal.constant);
    let exchanges = exchanges.iter().map(|exchange| &exchange.constant);
    let constants = constants.iter().map(|(name, value)| quote!((#name, #value)));
    quote!(Entry::new(#title, &[#(#constants),*], &[#(&#home::#signals),*], &[#(&#home::#exchanges),*]))
}
