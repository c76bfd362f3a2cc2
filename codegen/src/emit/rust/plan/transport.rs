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
    /// What its standard needs.
    pub standard: Needs,
    /// What its frames send in fields of the identifier.
    pub sends: Vec<(Ident, TokenStream)>,
    /// The exchanges of the messages that it carries, and what these are for.
    pub carries: Vec<Carried>,
}

/// An exchange of a message, and what its frames are for.
pub type Carried = (TokenStream, Ident);

/// What a standard needs.
pub enum Needs {
    /// That of J1939.
    J1939 {
        /// The fields of the identifier that are the number of a group.
        group: Vec<Ident>,
        /// The field with the address of the receiver.
        target: Ident,
        /// The field with the address of the sender.
        source: Ident,
    },
    /// ISO-TP.
    Isotp {
        /// The byte that fills frames.
        fill: Option<u8>,
        /// The names of its frames in the spec.
        frames: Vec<String>,
        /// What it carries without values.
        bare: Vec<Carried>,
    },
}

impl Transport {
    /// Plans a transport.
    pub fn new(protocol: &Protocol, types: &Types, messages: &Table<MessageId, Message>, id: TransportId) -> Self {
        let known = &protocol[id];
        let field = |id: FieldId| screaming(&protocol[id].name);
        let carried = || protocol.long_messages.iter().filter(|long| long.transport() == Some(id));
        let layouts = || carried().flat_map(|long| &long.frames);
        let exchange = |frame: &FrameLayout| self::carried(messages, frame);
        let longest = carried().map(LongMessage::longest).max().unwrap_or(0);
        let (memory, standard) = match &known.standard {
            Standard::J1939(groups) => {
                let group = groups.group.iter().copied().map(field).collect();
                let [target, source] = [groups.target, groups.source].map(field);
                (canspec_runtime::tp::memory(longest), Needs::J1939 { group, target, source })
            }
            Standard::Isotp(isotp) => {
                let frames = known.frames.iter().map(|frame| protocol[*frame].name.clone()).collect();
                let bare = layouts().filter(|frame| frame.signals.is_empty()).map(exchange).collect();
                (canspec_runtime::isotp::memory(longest), Needs::Isotp { fill: isotp.fill, frames, bare })
            }
        };
        let own = known.frames.first().map(|frame| &protocol[*frame].sends);
        let sends = own.into_iter().flatten();
        let sentence = doc::sentence_of(&doc::title(&known.doc, &known.name));
        Self {
            name: types.transports[id].clone(),
            comment: Comment::item(protocol, &known.doc, &sentence, None),
            memory,
            standard,
            sends: sends.map(|(id, value)| (field(*id), hexadecimal(*value, protocol[*id].width))).collect(),
            carries: layouts().map(exchange).collect(),
        }
    }
}

/// Returns the exchange by which a frame travels, and what the frame is for.
pub fn carried(messages: &Table<MessageId, Message>, frame: &FrameLayout) -> Carried {
    let Message { owner, exchanges, .. } = &messages[frame.message];
    let exchange = &exchanges[frame.exchange].constant;
    (quote!(#owner::#exchange), ident(&camel_case(frame.kind.name())))
}
