//! Transports of long messages, and how each message travels by one.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::plan::literal::hexadecimal;
use super::plan::long::Transfer;
use super::plan::request::Request;
use super::plan::transport::{Carried, Needs, Transport};

/// Emits what an assembler and a sender need of a transport.
pub fn transport(transport: &Transport) -> TokenStream {
    let Transport { name, comment, standard, .. } = transport;
    let memory = Literal::usize_unsuffixed(transport.memory);
    let sends = transport.sends.iter().map(|(field, value)| quote!((Identifier::#field, #value)));
    let sends = (!transport.sends.is_empty()).then(|| quote!(const SENDS: &'static [(Bits, u32)] = &[#(#sends),*];));
    let carries = list(&transport.carries);
    let (kind, needs) = match standard {
        Needs::J1939 { group, target, source } => (
            quote!(J1939),
            quote! {
                impl transfers::Grouped for #name {
                    const GROUP: &'static [Bits] = &[#(Identifier::#group),*];
                    const TARGET: Bits = Identifier::#target;
                    const SOURCE: Bits = Identifier::#source;
                }
            },
        ),
        Needs::Isotp { fill, frames, bare } => (quote!(Isotp), filled(name, *fill, frames, bare)),
    };
    quote! {
        #comment
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct #name;

        impl transfers::Transport for #name {
            type Protocol = Message;
            type Memory = [u8; #memory];
            type Standard = transfers::#kind;
            #sends
            const CARRIES: &'static [(&'static Exchange, Kind)] = #carries;
        }

        #needs
    }
}

/// Emits what ISO-TP needs.
fn filled(name: &Ident, fill: Option<u8>, frames: &[String], bare: &[Carried]) -> TokenStream {
    let fill = fill.map_or_else(
        || quote!(None),
        |fill| {
            let fill = hexadecimal(fill, 8);
            quote!(Some(#fill))
        },
    );
    let list = list(bare);
    let bare = (!bare.is_empty()).then(|| quote!(const BARE: &'static [(&'static Exchange, Kind)] = #list;));
    quote! {
        impl transfers::Filled for #name {
            const FILL: Option<u8> = #fill;
            const FRAMES: &'static [&'static str] = &[#(#frames),*];
            #bare
        }
    }
}

fn list(carried: &[Carried]) -> TokenStream {
    let rows = carried.iter().map(|(exchange, kind)| quote!((&#exchange, Kind::#kind)));
    quote!(&[#(#rows),*])
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

/// Emits the method that sends a message without values to a module.
pub fn bare(Request { method, comment, exchange, .. }: &Request, Transfer { transport, .. }: &Transfer) -> TokenStream {
    quote! {
        #comment
        pub fn #method(route: impl Into<Route<Target>>) -> Result<transfers::Sender<'static, #transport>, Error> {
            #exchange.bare_to(route)
        }
    }
}
