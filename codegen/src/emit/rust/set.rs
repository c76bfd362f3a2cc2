//! A set of frames: the struct of its members, its requests, and how it is put together.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::address::address_name;
use super::doc;
use super::exchange::{exchange, modes, selector_name, shared_name};
use super::identifier::field_place;
use super::literal::hexadecimal;
use super::message::{Emitter, is_exact};
use crate::model::{FrameId, Kind, Message, MessageId, Protocol, SelectorPlace, Set};

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
            let id = protocol.selectors.position(|selector| selector.place == continuation.place)?;
            let (selector, raw) = (selector_name(protocol, id), hexadecimal(continuation.raw, place.width()));
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
    id: MessageId,
    reply: FrameId,
}

impl<'a> SetEmitter<'a> {
    /// Returns the emitter of a message that is a set.
    pub fn new(message: &'a Emitter<'a>) -> Option<Self> {
        let set = message.message.set.as_ref()?;
        let members = set.members.iter().filter_map(|id| Member::new(message, *id)).collect();
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
        let names = &self.message.all.messages[member.id];
        let carried = names.carried(&self.message.protocol[member.reply]);
        &carried.unwrap_or(&names.structs[0]).name
    }

    fn implementation(&self) -> TokenStream {
        let name = self.name();
        let Emitter { protocol, all, names, message, .. } = self.message;
        let exchanges = names.exchanges.entries();
        let exchanges = exchanges.map(|(id, name)| exchange(protocol, all, message, name, id));
        let own = self.message.requests().map(|frame| self.message.method(frame));
        let split = self.set.kinds.contains(&Kind::Request).then(|| self.requests());
        quote!(impl #name { #(#exchanges)* #(#own)* #split })
    }

    /// Emits the method that builds a request for each member.
    fn requests(&self) -> Option<TokenStream> {
        let Emitter { protocol, message, names, all, .. } = self.message;
        let (id, own) = message.exchanges.entries().next()?;
        let access = &protocol[own.access];
        let method = &names.methods[id];
        let shared = shared_name(protocol, all, message, id)?;
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
            let names = &all.messages[member.id];
            let exchange = &names.exchanges[protocol[member.reply].exchange];
            let home = &names.structs[0].name;
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
        let node = address_name(&protocol[protocol.answering(message.exchanges.first()?)?].name);
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
        &self.message.all.variants[member.reply]
    }

    /// Returns the pattern of what frames can carry beside the members: none, the only one, or `_`.
    fn other_variants(&self) -> Option<TokenStream> {
        let members: Vec<_> = self.members.iter().map(|member| self.variant(member)).collect();
        let Emitter { protocol, all: names, .. } = self.message;
        let frames = protocol.frames.iter().zip(&names.variants);
        let all = frames.map(|(frame, variant)| (variant, names.messages[frame.message].carried(frame).is_some()));
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
    fn new(set: &Emitter<'a>, id: MessageId) -> Option<Self> {
        let message = &set.protocol[id];
        let is_whole = |whole: MessageId| set.protocol[whole].name == set.message.name;
        let is_reply = |frame: &&FrameId| {
            set.protocol[**frame].kind == Kind::Reply && set.protocol[**frame].set.is_some_and(is_whole)
        };
        let reply = *message.frames.iter().find(is_reply)?;
        Some(Self { field: super::names::ident(&message.name), message, id, reply })
    }
}

/// Emits of which set a message is a member when it travels by an access.
pub fn member_of(protocol: &Protocol, set: Option<MessageId>) -> Option<TokenStream> {
    let name = &protocol[set?].name;
    Some(quote!(.member_of(#name)))
}

/// Names the exchange or the method of a member of a set.
pub fn exchange_name(protocol: &Protocol, access: &str, set: Option<MessageId>) -> String {
    set.map_or_else(|| access.to_owned(), |set| format!("{access}_{}", protocol[set].name))
}

/// Says as a member of which set a message travels.
pub fn membership(protocol: &Protocol, set: Option<MessageId>) -> String {
    set.map_or_else(String::new, |set| format!(" in the set `{}`", protocol[set].name))
}
