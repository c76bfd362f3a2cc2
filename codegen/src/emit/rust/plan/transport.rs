//! Transports of long messages.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::doc::{self, Comment};
use super::literal::hexadecimal;
use super::message::Message;
use super::naming::{camel_case, ident, screaming};
use super::types::Types;
use crate::model::{FieldId, FrameLayout, LongMessage, MessageId, Protocol, Standard, Table, TransportId};

/// A transport of long messages.
pub struct Transport {
    /// Its type.
    pub name: Ident,
    /// Comment of the type.
    pub comment: Comment,
    /// How many bytes of memory its longest message needs.
    pub memory: usize,
    /// The fields of the identifier that are the number of a group.
    pub group: Vec<Ident>,
    /// The field with the address of the receiver.
    pub target: Ident,
    /// The field with the address of the sender.
    pub source: Ident,
    /// What its frames send in fields of the identifier.
    pub sends: Vec<(Ident, TokenStream)>,
    /// The exchanges of the messages that it carries, and what these are for.
    pub carries: Vec<(TokenStream, Ident)>,
}

impl Transport {
    /// Plans a transport. That of ISO-TP has no Rust yet.
    pub fn new(
        protocol: &Protocol,
        types: &Types,
        messages: &Table<MessageId, Message>,
        id: TransportId,
    ) -> Option<Self> {
        let known = &protocol[id];
        let Standard::J1939(groups) = &known.standard else { return None };
        let field = |id: FieldId| screaming(&protocol[id].name);
        let carried = || protocol.long_messages.iter().filter(|long| long.transport() == Some(id));
        let exchange = |frame: &FrameLayout| {
            let Message { owner, exchanges, .. } = &messages[frame.message];
            let exchange = &exchanges[frame.exchange].constant;
            (quote!(#owner::#exchange), ident(&camel_case(frame.kind.name())))
        };
        let own = known.frames.first().map(|frame| &protocol[*frame].sends);
        let sends = own.into_iter().flatten();
        let sentence = doc::sentence_of(&doc::title(&known.doc, &known.name));
        Some(Self {
            name: types.transports[id].clone(),
            comment: Comment::item(protocol, &known.doc, &sentence, None),
            memory: canspec_runtime::tp::memory(carried().map(LongMessage::longest).max().unwrap_or(0)),
            group: groups.group.iter().copied().map(field).collect(),
            target: field(groups.target),
            source: field(groups.source),
            sends: sends.map(|(id, value)| (field(*id), hexadecimal(*value, protocol[*id].width))).collect(),
            carries: carried().flat_map(|long| &long.frames).map(exchange).collect(),
        })
    }
}
