//! The list of all messages.

use proc_macro2::TokenStream;
use quote::quote;

use super::choice::constant;
use super::names::{MessageNames, Names};
use crate::model::{Message, Protocol};

/// Emits the list.
pub fn entries(protocol: &Protocol, names: &Names) -> TokenStream {
    let messages = protocol.messages.iter().zip(&names.messages);
    let entries = messages.map(|(message, names)| entry(protocol, message, names));
    quote! {
        /// Every message, for programs that go through them without naming one.
        pub const MESSAGES: &[Entry<Message>] = &[#(#entries),*];
    }
}

fn entry(protocol: &Protocol, message: &Message, names: &MessageNames) -> TokenStream {
    let (home, signals, exchanges) = (&names.structs[0].name, names.constants.iter(), names.exchanges.iter());
    let title = message.doc.title.clone().unwrap_or_else(|| message.name.replace('_', " "));
    let constants = message.constants.iter().map(|known| {
        let (name, value) = (&protocol[known.selector].name, constant(protocol, known.selector, known.value));
        quote!((#name, #value))
    });
    quote!(Entry::new(#title, &[#(#constants),*], &[#(&#home::#signals),*], &[#(&#home::#exchanges),*]))
}
