//! How frames carry a long message in numbered parts.

use std::time::Duration;

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens as _, quote};

use super::message::Message;
use super::models::Models;
use super::place::Written;
use super::transport::{Carried, carried};
use super::types::Types;
use super::variant::{self, Variant};
use crate::model::{FrameLayout, LongMessage, LongMessageId, MessageId, Protocol, SignalId, Table};

/// How frames carry a long message.
pub struct Carrier {
    /// The struct of the whole.
    pub whole: Ident,
    /// The struct of a part.
    pub part: Ident,
    /// Constant of the signal that numbers the parts.
    pub number: Ident,
    /// Constant of the signal that all parts of a message share.
    pub counter: Option<Ident>,
    /// Where the data of a part are.
    pub data: TokenStream,
    /// Where the first part says how many data bytes there are.
    pub length: Option<TokenStream>,
    /// The numbers of data bytes that it can have, if the spec lists them.
    pub sizes: Vec<u16>,
    /// How many bytes of memory the parts need: their data, and a bit for each.
    pub memory: usize,
    /// How many milliseconds of silence end a message, if it ends so.
    pub silence: Option<u32>,
    /// Number of the first part, if it is the same for every model.
    pub first: Option<u16>,
    /// Numbers of the first part by variant of the device model.
    pub model_firsts: Vec<(Ident, u16)>,
    /// Whether a field says that more parts follow.
    pub continues: bool,
    /// The exchanges by which it goes to a module, and what these frames are for.
    pub to_module: Vec<Carried>,
    /// The variants whose frames carry parts.
    pub parts: Vec<Ident>,
    /// The variants whose frames say how many elements there are, and where.
    pub counts: Option<(Vec<Ident>, TokenStream)>,
    /// The pattern for the other variants.
    pub others: Option<TokenStream>,
}

/// What carriers are planned from.
pub struct Planner<'a> {
    /// The protocol.
    pub protocol: &'a Protocol,
    /// Types of the module.
    pub types: &'a Types,
    /// Device models.
    pub models: &'a Models,
    /// Messages.
    pub messages: &'a Table<MessageId, Message>,
    /// The variants of the enum of all messages.
    pub variants: &'a [Variant],
}

impl Planner<'_> {
    /// Returns how the parts of a message go to a module.
    fn to_module(&self, id: LongMessageId) -> Vec<Carried> {
        let frames = self.protocol.frames_of(&self.protocol[self.protocol[id].message]);
        let carrying = frames.filter(|frame| frame.is_to_module() && self.protocol.part_of(frame) == Some(id));
        carrying.map(|frame| carried(self.messages, frame)).collect()
    }

    /// Plans how a long message is carried, if it has numbered parts.
    pub fn carrier(&self, id: LongMessageId) -> Option<Carrier> {
        let long = &self.protocol[id];
        let (LongMessage { message, .. }, rule) = (long, long.parts()?);
        let frame = &self.messages[*message];
        let parts = self.variants_with(*message, rule.number);
        let counts = rule.count.map(|(message, signal)| {
            let (home, constant) = (&self.messages[message].home, &self.messages[message].signals[signal].constant);
            (self.variants_with(message, signal), quote!(#home::#constant.place()))
        });
        let counting = counts.iter().flat_map(|(variants, _)| variants);
        let known: Vec<_> = parts.iter().chain(counting).cloned().collect();
        let count = long.parts_of(long.longest());
        Some(Carrier {
            whole: self.types.long[id].clone(),
            part: frame.home.clone(),
            number: frame.signals[rule.number].constant.clone(),
            counter: rule.counter.map(|counter| frame.signals[counter].constant.clone()),
            data: Written::new(rule.data).to_token_stream(),
            length: rule.length.map(|length| Written::new(length.place).to_token_stream()),
            sizes: long.lengths.clone(),
            silence: self.protocol.silence(long).map(milliseconds),
            memory: count * usize::from(rule.size) + count.div_ceil(8),
            first: rule.first,
            model_firsts: rule
                .model_firsts
                .iter()
                .map(|own| (self.models.variant(own.model).clone(), own.value))
                .collect(),
            to_module: self.to_module(id),
            continues: self.protocol.continuation().is_some(),
            others: variant::others(self.variants, |name| known.contains(name)),
            parts,
            counts,
        })
    }

    /// Returns the variants of the frames that carry a signal, each once.
    fn variants_with(&self, message: MessageId, signal: SignalId) -> Vec<Ident> {
        let carries = |frame: &FrameLayout| frame.signals.contains(&signal);
        let frames = self.protocol[message].frames.iter().filter(|id| carries(&self.protocol[**id]));
        let mut variants: Vec<_> = frames.map(|id| self.types.frames[*id].variant.clone()).collect();
        variants.sort();
        variants.dedup();
        variants
    }
}

/// Returns a time in whole milliseconds, rounded up.
fn milliseconds(time: Duration) -> u32 {
    u32::try_from(time.as_nanos().div_ceil(1_000_000)).unwrap_or(u32::MAX)
}
