//! A set of frames: the struct of its members, its requests, and how it is put together.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::address::address_name;
use super::doc;
use super::exchange::{exchange, modes, selector_name, shared_name};
use super::identifier::field_place;
use super::literal::hexadecimal;
use super::message::{Emitter, is_exact};
use crate::model::{Kind, Message, Protocol, SelectorPlace, Set, Shape};

/// Emits the field that says whether more frames follow, if there are sets.
pub fn continuation(protocol: &Protocol) -> Option<TokenStream> {
    protocol.messages.iter().find(|message| message.set.is_some())?;
    let continuation = protocol.continuation()?;
    let value = match continuation.place {
        SelectorPlace::Identifier(field) => {
            let (place, width) = field_place(protocol, field);
            let raw = hexadecimal(continuation.raw, width);
            quote!(Continuation::identifier(Identifier::#place, #raw))
        }
        SelectorPlace::Payload(place) => {
            let index = protocol.selectors.iter().position(|selector| selector.place == continuation.place)?;
            let (selector, raw) = (selector_name(protocol, index), hexadecimal(continuation.raw, place.width()));
            quote!(Continuation::data(#selector.place, #raw))
        }
    };
    Some(quote! {
        /// The field that says whether more frames of a set follow.
        pub const CONTINUATION: Continuation = #value;
    })
}

/// A set on its way into Rust.
pub struct SetEmitter<'a> {
    message: &'a Emitter<'a>,
    set: &'a Set,
    members: Vec<Member<'a>>,
}

/// A member of a set: its reply, and its request if each member has its own.
struct Member<'a> {
    /// Member of the struct.
    field: Ident,
    message: &'a Message,
    /// Index into [`Protocol::messages`].
    index: usize,
    /// Index into [`Message::accesses`].
    access: usize,
    /// Index into [`Message::shapes`].
    reply: usize,
}

impl<'a> SetEmitter<'a> {
    /// Returns the emitter of a message that is a set.
    pub fn new(message: &'a Emitter<'a>) -> Option<Self> {
        let set = message.message.set.as_ref()?;
        let members = set.members.iter().filter_map(|index| Member::new(message, *index)).collect();
        Some(Self { message, set, members })
    }

    /// Emits the struct, its requests, and what an assembler needs.
    pub fn items(&self) -> TokenStream {
        let (definition, implementation) = (self.definition(), self.implementation());
        let assembly = self.assembly();
        quote!(#definition #implementation #assembly)
    }

    fn name(&self) -> &Ident {
        &self.message.names.structs[0].name
    }

    fn definition(&self) -> TokenStream {
        let Emitter { protocol, message, derives, .. } = self.message;
        let mut paragraphs = doc::paragraphs(protocol, &message.doc, &self.message.sentence(), None);
        paragraphs.push("An [`Assembler`](assembler::Assembler) puts it together of the frames that come.".to_owned());
        let comment = doc::comment(paragraphs);
        let (name, optional) = (self.name(), derives.structure());
        let mut signals = self.members.iter().flat_map(|member| &member.message.signals);
        let eq = signals.all(is_exact).then(|| quote!(, Eq, Hash));
        let members = self.members.iter().map(|member| {
            let Message { doc, name, .. } = member.message;
            let comment = doc::line(doc::sentence_of(&doc::title(doc, name)));
            let (field, kind) = (&member.field, self.struct_of(member));
            quote!(#comment pub #field: Option<#kind>)
        });
        quote!(#comment #[derive(Clone, Copy, Debug, Default, PartialEq #eq)] #optional pub struct #name { #(#members),* })
    }

    /// Returns the struct that a member's reply carries.
    fn struct_of(&self, member: &Member) -> &Ident {
        let names = &self.message.all.messages[member.index];
        let carried = names.carried(&member.message.shapes[member.reply]);
        &carried.unwrap_or(&names.structs[0]).name
    }

    fn implementation(&self) -> TokenStream {
        let name = self.name();
        let Emitter { protocol, all, names, message, .. } = self.message;
        let exchanges = names.exchanges.iter().enumerate();
        let exchanges = exchanges.map(|(access, name)| exchange(protocol, all, message, name, access));
        let own = message.shapes.iter().filter(|shape| shape.kind == Kind::Request);
        let own = own.map(|shape| self.message.method(shape));
        let split = self.set.kinds.contains(&Kind::Request).then(|| self.requests());
        quote!(impl #name { #(#exchanges)* #(#own)* #split })
    }

    /// Emits the method that builds a request for each member.
    fn requests(&self) -> Option<TokenStream> {
        let Emitter { protocol, message, names, all, .. } = self.message;
        let own = message.accesses.first()?;
        let access = &protocol.accesses[own.access];
        let method = names.methods.first()?;
        let shared = shared_name(protocol, all, message, 0)?;
        let first = format!(
            "Builds the requests [`{}`]({shared}), one for each member in the order in which they are sent.",
            access.name
        );
        let modes = (own.answers != access.answers).then(|| modes(protocol, &own.answers));
        let errors = "Refuses other addressing modes, and undocumented addresses.".to_owned();
        let paragraphs = std::iter::once(first).chain(modes).chain(["# Errors".to_owned(), errors]);
        let comment = doc::comment(paragraphs);
        let count = Literal::usize_unsuffixed(self.members.len());
        let requests = self.members.iter().enumerate().map(|(position, member)| {
            let names = &all.messages[member.index];
            let (home, exchange) = (&names.structs[0].name, &names.exchanges[member.access]);
            let followed = (position + 1 < self.members.len()).then(|| quote!(.followed(&CONTINUATION)));
            quote!(#home::#exchange.request_to(route, &())? #followed)
        });
        Some(quote! {
            #comment
            pub fn #method(route: impl Into<Route<Target>>) -> Result<[Request<()>; #count], Error> {
                let route = route.into();
                Ok([#(#requests),*])
            }
        })
    }

    /// Emits the trait that an assembler needs.
    fn assembly(&self) -> Option<TokenStream> {
        let Emitter { protocol, message, names, .. } = self.message;
        let (name, exchange) = (self.name(), names.exchanges.first()?);
        let node = address_name(&protocol.address_types[protocol.answering(message.accesses.first()?)?].name);
        let texts = self.members.iter().map(|member| &member.message.name);
        let variants: Vec<_> = self.members.iter().map(|member| self.variant(member)).collect();
        let fields: Vec<_> = self.members.iter().map(|member| &member.field).collect();
        let positions = (0..self.members.len()).map(Literal::usize_unsuffixed);
        let other = self.other_variants().into_iter().collect::<Vec<_>>();
        let (no_position, no_values) = (quote!(#(#other => None,)*), quote!(#(#other => false,)*));
        Some(quote! {
            impl FrameSet for #name {
                type Protocol = Message;
                const EXCHANGE: &'static Exchange = &Self::#exchange;
                const NODE: &'static AddressType = &#node;
                const CONTINUATION: Continuation = CONTINUATION;
                const MEMBERS: &'static [&'static str] = &[#(#texts),*];

                fn position(message: &Message) -> Option<usize> {
                    match message { #(Message::#variants(_) => Some(#positions),)* #no_position }
                }

                fn put(&mut self, message: &Message) -> bool {
                    match *message {
                        #(Message::#variants(values) => self.#fields.replace(values) == Some(values),)*
                        #no_values
                    }
                }
            }
        })
    }

    fn variant(&self, member: &Member) -> &Ident {
        &self.message.all.messages[member.index].variants[member.reply]
    }

    /// Returns the pattern of what frames can carry beside the members: none, the only one, or `_`.
    fn other_variants(&self) -> Option<TokenStream> {
        let members: Vec<_> = self.members.iter().map(|member| self.variant(member)).collect();
        let messages = self.message.protocol.messages.iter().zip(&self.message.all.messages);
        let all = messages.flat_map(|(message, names)| {
            let shapes = message.shapes.iter().zip(&names.variants);
            shapes.map(move |(shape, variant)| (variant, names.carried(shape).is_some()))
        });
        let mut others: Vec<_> = all.filter(|(variant, _)| !members.contains(variant)).collect();
        others.dedup();
        match others.as_slice() {
            [] => None,
            [(variant, true)] => Some(quote!(Message::#variant(_))),
            [(variant, false)] => Some(quote!(Message::#variant)),
            _ => Some(quote!(_)),
        }
    }
}

impl<'a> Member<'a> {
    fn new(set: &Emitter<'a>, index: usize) -> Option<Self> {
        let message = set.protocol.messages.get(index)?;
        let whole = set.protocol.messages.iter().position(|known| known.name == set.message.name);
        let access = message.accesses.iter().position(|access| access.set.is_some() && access.set == whole)?;
        let is_reply = |shape: &Shape| shape.access == access && shape.kind == Kind::Reply;
        let reply = message.shapes.iter().position(is_reply)?;
        Some(Self { field: super::names::ident(&message.name), message, index, access, reply })
    }
}

/// Returns what every reply of a set shows, if the message is one.
pub fn reply(protocol: &Protocol, message: &Message) -> Option<Shape> {
    let constants = message.set.as_ref()?.replies.clone();
    let is_in_data = |index: &usize| matches!(protocol.selectors[*index].place, SelectorPlace::Payload(_));
    let selectors = constants.iter().map(|(index, _)| *index).filter(is_in_data).collect();
    Some(Shape { access: 0, kind: Kind::Reply, constants, selectors, signals: Vec::new() })
}

/// Emits of which set a message is a member when it travels by an access.
pub fn member_of(protocol: &Protocol, set: Option<usize>) -> Option<TokenStream> {
    let name = &protocol.messages[set?].name;
    Some(quote!(.member_of(#name)))
}

/// Names the exchange or the method of a member of a set.
pub fn exchange_name(protocol: &Protocol, access: &str, set: Option<usize>) -> String {
    set.map_or_else(|| access.to_owned(), |set| format!("{access}_{}", protocol.messages[set].name))
}

/// Says as a member of which set a message travels.
pub fn membership(protocol: &Protocol, set: Option<usize>) -> String {
    set.map_or_else(String::new, |set| format!(" in the set `{}`", protocol.messages[set].name))
}
