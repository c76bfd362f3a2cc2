//! Transports of long messages, and how each message travels by one.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::plan::long::Transfer;
use super::plan::message::Request;
use super::plan::transport::Transport;

/// Emits what an assembler and a sender need of a transport.
pub fn transport(transport: &Transport) -> TokenStream {
    let Transport { name, comment, group, target, source, .. } = transport;
    let memory = Literal::usize_unsuffixed(transport.memory);
    let sends = transport.sends.iter().map(|(field, value)| quote!((Identifier::#field, #value)));
    let sends = (!transport.sends.is_empty()).then(|| quote!(const SENDS: &'static [(Bits, u32)] = &[#(#sends),*];));
    let carries = transport.carries.iter().map(|(exchange, kind)| quote!((&#exchange, Kind::#kind)));
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct #name;

        impl transfers::Transport for #name {
            type Protocol = Message;
            type Memory = [u8; #memory];
            const GROUP: &'static [Bits] = &[#(Identifier::#group),*];
            const TARGET: Bits = Identifier::#target;
            const SOURCE: Bits = Identifier::#source;
            #sends
            const CARRIES: &'static [(&'static Exchange, Kind)] = &[#(#carries),*];
        }
    }
}

/// Emits that a transport carries a message.
pub fn transferred(name: &Ident, Transfer { transport, sizes, .. }: &Transfer) -> TokenStream {
    let sizes = sizes.iter().map(|size| Literal::u16_unsuffixed(*size));
    let sizes = (sizes.len() > 0).then(|| quote!(const SIZES: &'static [usize] = &[#(#sizes),*];));
    quote! {
        impl Transferred for #name {
            type Transport = #transport;
            #sizes
        }
    }
}

/// Emits the method that sends a message to a module.
pub fn sent(Request { method, comment, exchange, .. }: &Request, Transfer { transport, .. }: &Transfer) -> TokenStream {
    quote! {
        #comment
        pub fn #method<'a>(
            &self,
            route: impl Into<Route<Target>>,
            buffer: &'a mut [u8],
        ) -> Result<transfers::Sender<'a, #transport>, Error> {
            #exchange.transfer_to(route, self, buffer)
        }
    }
}
