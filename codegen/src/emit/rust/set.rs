//! A set of frames: the struct of its members, its requests, and how it is put together.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::derives::Derives;
use super::exchange::exchange;
use super::plan::message::Message;
use super::plan::set::{Assembly, Member, Requests, Set};
use super::request::request;

/// Emits the struct, its requests, and what an assembler needs.
pub fn set(message: &Message, set: &Set, derives: Derives) -> TokenStream {
    let definition = definition(&message.home, set, derives);
    let implementation = implementation(message, set, derives);
    let assembly = set.assembly.as_ref().map(|known| assembly(&message.home, set, known));
    quote!(#definition #implementation #assembly)
}

fn definition(name: &Ident, Set { comment, is_exact, members, .. }: &Set, derives: Derives) -> TokenStream {
    let eq = is_exact.then(|| quote!(, Eq, Hash));
    let attributes = derives.structure(&quote!(Clone, Copy, Debug, Default, PartialEq #eq));
    let members = members.iter().map(|Member { field, comment, kind, .. }| quote!(#comment pub #field: Option<#kind>));
    quote!(#comment #attributes pub struct #name { #(#members),* })
}

fn implementation(message: &Message, set: &Set, derives: Derives) -> TokenStream {
    let name = &message.home;
    let exchanges = message.exchanges.iter().map(exchange);
    let own = message.structs.iter().flat_map(|known| &known.requests).map(|known| request(known, derives));
    let split = set.requests.as_ref().map(|known| requests(known, &set.members));
    quote!(impl #name { #(#exchanges)* #(#own)* #split })
}

/// Emits the method that builds a request for each member.
fn requests(Requests { method, comment }: &Requests, members: &[Member]) -> TokenStream {
    let count = Literal::usize_unsuffixed(members.len());
    let requests = members.iter().enumerate().map(|(position, Member { exchange, .. })| {
        let followed = (position + 1 < members.len()).then(|| quote!(.followed(&CONTINUATION)));
        quote!(#exchange.request_to(route, &())? #followed)
    });
    quote! {
        #comment
        pub fn #method(route: impl Into<Route<Target>>) -> Result<[Request<()>; #count], Error> {
            let route = route.into();
            Ok([#(#requests),*])
        }
    }
}

/// Emits the trait that an assembler needs.
fn assembly(name: &Ident, Set { members, .. }: &Set, Assembly { exchange, node, others }: &Assembly) -> TokenStream {
    let texts = members.iter().map(|member| &member.name);
    let variants: Vec<_> = members.iter().map(|member| &member.variant).collect();
    let fields = members.iter().map(|member| &member.field);
    let positions = (0..members.len()).map(Literal::usize_unsuffixed);
    let (no_position, no_values) = (others.iter(), others.iter());
    quote! {
        impl FrameSet for #name {
            type Protocol = Message;
            const EXCHANGE: &'static Exchange = &Self::#exchange;
            const NODE: &'static AddressType = &#node;
            const CONTINUATION: Continuation = CONTINUATION;
            const MEMBERS: &'static [&'static str] = &[#(#texts),*];

            fn position(message: &Message) -> Option<usize> {
                match message { #(Message::#variants(_) => Some(#positions),)* #(#no_position => None,)* }
            }

            fn put(&mut self, message: &Message) -> bool {
                match *message {
                    #(Message::#variants(values) => self.#fields.replace(values) == Some(values),)*
                    #(#no_values => false,)*
                }
            }
        }
    }
}
