//! Sets of frames: their members, and what an assembler needs.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::address::Addresses;
use super::doc::{self, Comment};
use super::message::Message;
use super::naming::ident;
use super::types::{FrameTypes, Types};
use super::variant::{self, Variant};
use crate::model::{self, FrameId, Kind, MessageId, Protocol, Table};

/// A set of frames.
pub struct Set {
    /// Comment of the struct.
    pub comment: Comment,
    /// Whether equality is exact.
    pub is_exact: bool,
    /// Its members, in order.
    pub members: Vec<Member>,
    /// The method that builds a request for each member, if each has its own.
    pub requests: Option<Requests>,
    /// What an assembler needs, if replies show who sends them.
    pub assembly: Option<Assembly>,
}

/// A member of a set.
pub struct Member {
    /// Member of the struct.
    pub field: Ident,
    /// Comment of the member.
    pub comment: Comment,
    /// The name in the spec.
    pub name: String,
    /// The struct that its reply carries.
    pub kind: Ident,
    /// Variant of its reply.
    pub variant: Ident,
    /// The path of its exchange.
    pub exchange: TokenStream,
}

/// The method that builds a request for each member.
pub struct Requests {
    /// Its name.
    pub method: Ident,
    /// Comment of the method.
    pub comment: Comment,
}

/// What an assembler needs.
pub struct Assembly {
    /// Constant of the exchange.
    pub exchange: Ident,
    /// Constant of the kind of address that shows who sends a reply.
    pub node: Ident,
    /// The pattern for messages beside the members: none, the only one, or `_`.
    pub others: Option<TokenStream>,
}

/// What sets are planned from.
struct Planner<'a> {
    protocol: &'a Protocol,
    types: &'a Types,
    messages: &'a Table<MessageId, Message>,
    addresses: &'a Addresses,
    variants: &'a [Variant],
    id: MessageId,
}

impl Set {
    /// Plans the set of a message, if it is one.
    pub fn new(
        protocol: &Protocol,
        types: &Types,
        messages: &Table<MessageId, Message>,
        addresses: &Addresses,
        variants: &[Variant],
        id: MessageId,
    ) -> Option<Self> {
        let set = protocol[id].set.as_ref()?;
        Some(Planner { protocol, types, messages, addresses, variants, id }.set(set))
    }
}

impl Planner<'_> {
    fn set(&self, set: &model::Set) -> Set {
        let of_members = set.members.iter().map(|member| &self.messages[*member]);
        let members: Vec<_> = set.members.iter().filter_map(|member| self.member(*member)).collect();
        let assembles = "An `assembler::Assembler` puts it together of the frames that come.".to_owned();
        let paragraphs = self.messages[self.id].paragraphs.iter().cloned().chain([assembles]);
        Set {
            comment: Comment::new(paragraphs),
            is_exact: of_members.flat_map(|message| &message.signals).all(|signal| signal.coding.is_exact()),
            requests: set.kinds.contains(&Kind::Request).then(|| self.requests()).flatten(),
            assembly: self.assembly(&members),
            members,
        }
    }

    fn member(&self, id: MessageId) -> Option<Member> {
        let (message, known) = (&self.protocol[id], &self.messages[id]);
        let is_reply = |frame: &&FrameId| {
            let frame = &self.protocol[**frame];
            frame.kind == Kind::Reply && frame.set == Some(self.id)
        };
        let reply = *message.frames.iter().find(is_reply)?;
        let FrameTypes { variant, carried, .. } = &self.types.frames[reply];
        let (owner, exchange) = (&known.owner, &known.exchanges[self.protocol[reply].exchange].constant);
        Some(Member {
            field: ident(&message.name),
            comment: Comment::line(doc::sentence_of(&doc::title(&message.doc, &message.name))),
            name: message.name.clone(),
            kind: carried.as_ref().unwrap_or(&known.home).clone(),
            variant: variant.clone(),
            exchange: quote!(#owner::#exchange),
        })
    }

    fn requests(&self) -> Option<Requests> {
        let message = &self.protocol[self.id];
        let (id, own) = message.exchanges.entries().next()?;
        let known = &self.messages[self.id];
        let (access, shared) = (&self.protocol[own.access], &known.exchanges[id].shared);
        let comment = Comment::line(format!(
            "Builds the requests [`{}`]({shared}), one for each member in the order in which they are sent. Refuses \
             other addressing modes and undocumented addresses.",
            access.name
        ));
        Some(Requests { method: known.methods[id].clone(), comment })
    }

    fn assembly(&self, members: &[Member]) -> Option<Assembly> {
        let (exchange, own) = (self.messages[self.id].exchanges.first()?, self.protocol[self.id].exchanges.first()?);
        let node = self.addresses[self.protocol.answering(own)?].clone();
        let exchange = exchange.constant.clone();
        let others = variant::others(self.variants, |name| members.iter().any(|member| member.variant == *name));
        Some(Assembly { exchange, node, others })
    }
}
