//! How messages travel: each access once, and what each message adds to it.

use std::collections::HashMap;

use indexmap::{IndexMap, IndexSet};
use proc_macro2::{Ident, TokenStream};

use super::doc::{self, Comment};
use super::literal::{data, decimal, hexadecimal};
use super::models::Models;
use super::naming::{Pool, ident, screaming};
use super::selector::{Filter, Required, Selectors, required};
use crate::model::{
    AccessId, Constant, ExchangeId, FrameLayout, Kind, Message, MessageId, Protocol, SelectorId, Set, Side, Table, Who,
};

/// The shared parts of accesses, and the part that each message uses.
pub struct Accesses {
    /// What they share.
    pub shared: Vec<Access>,
    /// The constants of the parts that each message uses, by exchange.
    constants: Table<MessageId, Table<ExchangeId, Ident>>,
}

/// An access as messages share it.
pub struct Access {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The name in the spec.
    pub name: String,
    /// Who answers, by addressing mode.
    pub answers: Vec<Option<Who>>,
    /// Whether requests carry values.
    pub has_values: bool,
    /// The set whose members the messages are.
    pub member_of: Option<String>,
    /// Its kinds of frames.
    pub frames: Vec<SharedFrame>,
    /// Whether the controller sends its reports.
    pub is_from_controller: bool,
}

/// What one kind of frame shows, whatever the message, and the method that adds it.
pub struct SharedFrame {
    /// The method.
    pub method: Ident,
    /// What it shows.
    pub filter: Filter,
    /// Whether a selector in its data says that there is no error.
    pub is_accepting: bool,
}

/// How a message travels by one of its accesses.
pub struct Exchange {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The constant of the part that it shares with others.
    pub shared: Ident,
    /// The message's name in the spec.
    pub message: String,
    /// What its frames show beside what the access says.
    pub required: Vec<Required>,
    /// Who answers, if not as the access says.
    pub answers: Option<Vec<Option<Who>>>,
    /// Data bytes of its frames, if not eight.
    pub length: Option<TokenStream>,
    /// Variants of the only device models that have it; empty if all have.
    pub models: Vec<Ident>,
    /// Fields of the identifier that it sends with a value of its own.
    pub sends: Vec<(Ident, TokenStream)>,
    /// The methods that set data bits of a kind of frame to 1 although nothing names them, and those bits. A report of
    /// the controller is built like a request.
    pub filled: Vec<(Ident, TokenStream)>,
    /// What a frame that refuses its request shows.
    pub refusal: Option<Filter>,
}

/// A way to use an access, which messages share.
#[derive(PartialEq, Eq, Hash)]
struct Way {
    access: AccessId,
    /// The set whose members the messages are.
    set: Option<MessageId>,
    frames: Vec<Shown>,
}

/// What one kind of frame shows, whatever the message.
#[derive(PartialEq, Eq, Hash)]
struct Shown {
    kind: Kind,
    has_values: bool,
    selectors: Vec<SelectorId>,
    constants: Vec<Constant>,
}

impl Accesses {
    /// Plans the parts that messages share.
    pub fn new(protocol: &Protocol, selectors: &Selectors, constants: &mut Pool) -> Self {
        let ways = ways(protocol, constants);
        let constant = |message: &Message, id: ExchangeId| ways.get(&Way::new(protocol, message, id)).cloned();
        let of_message = |message: &Message| message.exchanges.ids().filter_map(|id| constant(message, id)).collect();
        let constants = protocol.messages.map(of_message);
        let mut counts = HashMap::new();
        ways.keys().for_each(|way| *counts.entry(way.access).or_insert(0) += 1);
        let shared = ways.iter().map(|(way, constant)| {
            let is_one_of_several = counts.get(&way.access).is_some_and(|count| *count > 1);
            Access::new(protocol, selectors, (way, constant), is_one_of_several)
        });
        let shared = shared.collect();
        Self { shared, constants }
    }

    /// Returns the constant of the part that a message shares with others.
    pub fn constant(&self, message: MessageId, exchange: ExchangeId) -> &Ident {
        &self.constants[message][exchange]
    }
}

/// Returns the ways to use each access, in order of accesses; several are told apart by number.
fn ways(protocol: &Protocol, constants: &mut Pool) -> IndexMap<Way, Ident> {
    let exchanges = protocol.messages.iter().flat_map(|message| message.exchanges.ids().map(move |id| (message, id)));
    let mut distinct: IndexSet<_> = exchanges.map(|(message, id)| Way::new(protocol, message, id)).collect();
    distinct.sort_by(|one, other| one.access.cmp(&other.access));
    let mut numbers = HashMap::new();
    let named = distinct.into_iter().map(|way| {
        let number = numbers.entry((way.access, way.set)).and_modify(|number| *number += 1).or_insert(1);
        let suffix = if *number == 1 { String::new() } else { format!("_{number}") };
        let name = exchange_name(protocol, &protocol[way.access].name, way.set);
        let constant = constants.constant(&format!("{name}_ACCESS{suffix}"));
        (way, constant)
    });
    named.collect()
}

impl Way {
    /// Returns how a message travels by one of its exchanges.
    fn new(protocol: &Protocol, message: &Message, id: ExchangeId) -> Self {
        let known = &message[id];
        Self { access: known.access, set: known.set, frames: frames(protocol, message, id) }
    }
}

fn frames(protocol: &Protocol, message: &Message, exchange: ExchangeId) -> Vec<Shown> {
    let frames = protocol.layouts_of(message).filter(|frame| frame.exchange == exchange);
    let frames = frames.map(|frame| Shown::new(message, frame, protocol.carried(frame).is_some()));
    frames.chain(Shown::whole(protocol, message)).collect()
}

impl Shown {
    fn new(message: &Message, frame: &FrameLayout, is_long: bool) -> Self {
        Self {
            kind: frame.kind,
            has_values: frame.is_to_module() && (is_long || !frame.signals.is_empty()),
            selectors: frame.selectors.clone(),
            constants: frame.constants.iter().copied().filter(|known| !message.constants.contains(known)).collect(),
        }
    }

    /// Plans how the access gets it.
    fn shown(&self, protocol: &Protocol, selectors: &Selectors) -> SharedFrame {
        let says_normal = self.selectors.iter().any(|id| protocol[*id].normal.is_some());
        SharedFrame {
            method: ident(self.kind.name()),
            filter: Filter::new(selectors, &self.selectors, &self.constants),
            is_accepting: says_normal && self.kind != Kind::Request,
        }
    }

    /// Returns what every reply of the message shows, if it is a set.
    fn whole(protocol: &Protocol, message: &Message) -> Option<Self> {
        let set = message.set.as_ref()?;
        let constants = set.replies.iter().filter(|known| !message.constants.contains(known));
        Some(Self {
            kind: Kind::Reply,
            has_values: false,
            selectors: shared_selectors(protocol, message, set),
            constants: constants.copied().collect(),
        })
    }
}

/// Returns the selectors in the data that the replies of all members have. One of them may tell an error.
fn shared_selectors(protocol: &Protocol, message: &Message, set: &Set) -> Vec<SelectorId> {
    let members = set.members.iter().map(|member| &protocol[*member]);
    let is_of_set = |id: Option<MessageId>| id.is_some_and(|id| protocol[id].name == message.name);
    let mut replies = members.flat_map(|member| {
        let frames = protocol.frames_of(member).filter(|frame| frame.kind == Kind::Reply);
        frames.filter(|frame| is_of_set(member[frame.exchange].set))
    });
    let mut shared = replies.next().map_or_else(Vec::new, |frame| frame.selectors.clone());
    replies.for_each(|frame| shared.retain(|selector| frame.selectors.contains(selector)));
    shared
}

impl Access {
    fn new(
        protocol: &Protocol,
        selectors: &Selectors,
        (way, constant): (&Way, &Ident),
        is_one_of_several: bool,
    ) -> Self {
        let known = &protocol[way.access];
        let shows = is_one_of_several.then(|| shows(protocol, &way.frames));
        let sentence = format!("{}{}", doc::title(&known.doc, &known.name), membership(protocol, way.set));
        let paragraphs = doc::paragraphs(protocol, &known.doc, &doc::sentence_of(&sentence), None);
        let paragraphs = paragraphs.into_iter().chain(shows);
        Self {
            constant: constant.clone(),
            comment: Comment::new(paragraphs.filter(|text| !text.is_empty())),
            name: known.name.clone(),
            answers: known.answers.to_vec(),
            has_values: way.frames.iter().any(|frame| frame.has_values),
            member_of: way.set.map(|set| protocol[set].name.clone()),
            frames: way.frames.iter().map(|frame| frame.shown(protocol, selectors)).collect(),
            is_from_controller: known.from == Side::Controller,
        }
    }
}

/// Names the constants by which one way to use an access differs from the others.
fn shows(protocol: &Protocol, frames: &[Shown]) -> String {
    let facts = frames.iter().flat_map(|frame| {
        let facts = frame.constants.iter().map(|constant| {
            let values: Vec<_> = constant.values().map(|value| format!("`{value:#X}`")).collect();
            let name = &protocol[constant.selector].name;
            format!("In a {}, `{name}` is {}.", frame.kind.name(), values.join(" or "))
        });
        facts.collect::<Vec<_>>()
    });
    facts.collect::<Vec<_>>().join(" ")
}

/// Names the exchange or the method of a member of a set.
pub fn exchange_name(protocol: &Protocol, access: &str, set: Option<MessageId>) -> String {
    set.map_or_else(|| access.to_owned(), |set| format!("{access}_{}", protocol[set].name))
}

/// Names the set in which a message travels as a member.
pub fn membership(protocol: &Protocol, set: Option<MessageId>) -> String {
    set.map_or_else(String::new, |set| format!(" in the set `{}`", protocol[set].name))
}

/// Returns the fields of the identifier that a message sends with a value of its own.
fn sends(protocol: &Protocol, message: &Message) -> Vec<(Ident, TokenStream)> {
    let sends = message.sends.iter().map(|(id, value)| (&protocol[*id], *value));
    sends.map(|(field, value)| (screaming(&field.name), hexadecimal(value, field.width))).collect()
}

/// Writes the bits of the data that a frame has as 1 although nothing names them.
fn filled(frame: &FrameLayout) -> Option<(Ident, TokenStream)> {
    let kind = if frame.is_to_module() { Kind::Request } else { frame.kind };
    Some(frame.filled()).filter(|ones| *ones != 0).map(|ones| (ident(kind.name()), data(ones.to_be_bytes())))
}

impl Exchange {
    /// Plans how a message travels; `constant` and `shared` are those of the exchange.
    pub fn new(
        protocol: &Protocol,
        (selectors, models): (&Selectors, &Models),
        (constant, shared): (&Ident, &Ident),
        message: &Message,
        id: ExchangeId,
    ) -> Self {
        let exchange = &message[id];
        let known = &protocol[exchange.access];
        let set = membership(protocol, exchange.set);
        let frames = protocol.frames_of(message).filter(|frame| frame.exchange == id);
        let refusal = message.refusals.iter().find(|refusal| refusal.exchange == id);
        Self {
            constant: constant.clone(),
            comment: Comment::line(format!("The access `{}`{set}, for filters and blank frames of it.", known.name)),
            shared: shared.clone(),
            message: message.name.clone(),
            required: required(selectors, &message.constants),
            answers: (exchange.answers != known.answers).then(|| exchange.answers.to_vec()),
            length: (message.shortest() != 8).then(|| decimal(message.shortest())),
            models: message.models.iter().map(|model| models.variant(*model).clone()).collect(),
            sends: sends(protocol, message),
            filled: frames.filter_map(filled).collect(),
            refusal: refusal.map(|refusal| Filter::new(selectors, &refusal.selectors, &refusal.constants)),
        }
    }
}
