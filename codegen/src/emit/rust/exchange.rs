//! How messages travel: each access once, and what each message adds to it.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::address::answers_list;
use super::choice::constant;
use super::doc;
use super::identifier::field_place;
use super::literal::decimal;
use super::model::models_of;
use super::names::{Names, ident};
use super::set;
use crate::model::{
    AccessId, Answers, Constant, ExchangeId, FrameLayout, Kind, Message, MessageId, Protocol, SelectorId,
    SelectorPlace, Who,
};

/// An access as messages share it.
pub struct Shared {
    pub name: Ident,
    access: AccessId,
    /// The set of which the messages are members.
    set: Option<MessageId>,
    frames: Vec<SharedFrame>,
}

/// What one kind of frame shows, whatever the message.
#[derive(PartialEq)]
struct SharedFrame {
    kind: Kind,
    has_values: bool,
    selectors: Vec<SelectorId>,
    constants: Vec<Constant>,
}

impl SharedFrame {
    fn new(message: &Message, frame: &FrameLayout) -> Self {
        Self {
            kind: frame.kind,
            has_values: frame.kind == Kind::Request && !frame.signals.is_empty(),
            selectors: frame.selectors.clone(),
            constants: frame.constants.iter().copied().filter(|known| !message.constants.contains(known)).collect(),
        }
    }
}

/// Returns what messages share of each access; several ways to use one access are told apart by number.
pub fn shared(protocol: &Protocol) -> Vec<Shared> {
    let mut known: Vec<Shared> = Vec::new();
    for (access, of) in protocol.accesses.entries() {
        for (message, id, set) in protocol.messages.iter().flat_map(|message| ways(message, access)) {
            let frames = frames(protocol, message, id);
            let same: Vec<_> = known.iter().filter(|shared| shared.access == access && shared.set == set).collect();
            if same.iter().all(|shared| shared.frames != frames) {
                let suffix = if same.is_empty() { String::new() } else { format!("_{}", same.len() + 1) };
                let name = set::exchange_name(protocol, &of.name, set).to_ascii_uppercase();
                known.push(Shared { name: ident(&format!("{name}_ACCESS{suffix}")), access, set, frames });
            }
        }
    }
    known
}

/// Returns how a message travels by an access, alone and as a member of sets.
fn ways(message: &Message, access: AccessId) -> impl Iterator<Item = (&Message, ExchangeId, Option<MessageId>)> {
    let known = message.exchanges.entries().filter(move |(_, exchange)| exchange.access == access);
    known.map(move |(id, exchange)| (message, id, exchange.set))
}

fn frames(protocol: &Protocol, message: &Message, exchange: ExchangeId) -> Vec<SharedFrame> {
    let frames = protocol.frames_of(message).filter(|frame| frame.exchange == exchange);
    let frames = frames.map(|frame| SharedFrame::new(message, frame));
    frames.chain(whole(message)).collect()
}

/// Returns what every reply of a set shows, if the message is one.
fn whole(message: &Message) -> Option<SharedFrame> {
    let constants = message.set.as_ref()?.replies.clone();
    let payload = constants.iter().filter(|constant| constant.in_payload().is_some());
    let selectors = payload.map(|constant| constant.selector).collect();
    let constants = constants.into_iter().filter(|known| !message.constants.contains(known)).collect();
    Some(SharedFrame { kind: Kind::Reply, has_values: false, selectors, constants })
}

/// Returns the shared constant of a message's access.
pub fn shared_name<'a>(protocol: &Protocol, names: &'a Names, message: &Message, id: ExchangeId) -> Option<&'a Ident> {
    let (known, frames) = (&message[id], frames(protocol, message, id));
    let is_its = |shared: &&Shared| (shared.access, shared.set) == (known.access, known.set) && shared.frames == frames;
    let shared = names.shared.iter().find(is_its);
    shared.map(|shared| &shared.name)
}

/// Emits what messages share of each access.
pub fn accesses(protocol: &Protocol, names: &Names) -> TokenStream {
    names.shared.iter().map(|known| access(protocol, names, known)).collect()
}

fn access(protocol: &Protocol, names: &Names, Shared { name, access, set, frames }: &Shared) -> TokenStream {
    let known = &protocol[*access];
    let membership = set::membership(protocol, *set);
    let sentence = doc::sentence_of(&format!("{}{membership}", doc::title(&known.doc, &known.name)));
    let member_of = set::member_of(protocol, *set);
    let shows = names.shared.iter().filter(|other| other.access == *access).nth(1).map(|_| shows(protocol, frames));
    let modes = modes(protocol, &known.answers);
    let paragraphs = doc::paragraphs(protocol, &known.doc, &sentence, None);
    let comment = doc::comment(paragraphs.into_iter().chain(shows).chain([modes]).filter(|text| !text.is_empty()));
    let (text, answers) = (&known.name, answers_list(&known.answers));
    let has_values = frames.iter().any(|frame| frame.has_values).then(|| quote!(.with_values()));
    let filters = frames.iter().map(|frame| {
        let (kind, filter) = (ident(frame.kind.name()), filter(protocol, &frame.selectors, &frame.constants));
        quote!(.#kind(#filter))
    });
    quote!(#comment pub const #name: Exchange = Exchange::new(#text, &#answers) #has_values #member_of #(#filters)*;)
}

/// Says by which constants one way to use an access differs from the others.
fn shows(protocol: &Protocol, frames: &[SharedFrame]) -> String {
    let facts = frames.iter().flat_map(|frame| {
        let facts = frame.constants.iter().map(|Constant { selector, value, .. }| {
            format!("In a {}, `{}` is `{value:#X}`.", frame.kind.name(), protocol[*selector].name)
        });
        facts.collect::<Vec<_>>()
    });
    facts.collect::<Vec<_>>().join(" ")
}

/// Says in which modes a request can be sent, and who answers.
pub fn modes(protocol: &Protocol, answers: &Answers) -> String {
    let modes = protocol.modes.iter().zip(answers).filter_map(|(mode, who)| {
        let who = match (*who)? {
            Who::One => "the module answers",
            Who::Each => "each module answers",
            Who::Coordinator => "one answers for all",
            Who::Nobody => "nobody answers",
        };
        Some(format!("`{}`: {who}.", mode.name))
    });
    modes.collect::<Vec<_>>().join(" ")
}

/// Emits how a message travels by one of its accesses.
pub fn exchange(protocol: &Protocol, names: &Names, message: &Message, name: &Ident, id: ExchangeId) -> TokenStream {
    let exchange = &message[id];
    let known = &protocol[exchange.access];
    let (shared, text) = (shared_name(protocol, names, message, id), &message.name);
    let (set, period) = (set::membership(protocol, exchange.set), period(protocol, message, exchange.access));
    let comment = doc::line(format!("How it travels by `{}`{set}.{period}", known.name));
    let own = filter(protocol, &[], &message.constants);
    let answers = (exchange.answers != known.answers).then(|| {
        let list = answers_list(&exchange.answers);
        quote!(.answers(&#list))
    });
    let length = (message.length != 8).then(|| {
        let length = decimal(message.length);
        quote!(.length(#length))
    });
    let models = models_of(protocol, message);
    let refusal = message.refusals.iter().find(|refusal| refusal.exchange == id).map(|refusal| {
        let filter = filter(protocol, &refusal.selectors, &refusal.constants);
        quote!(.refusal(&#filter))
    });
    quote!(#comment pub const #name: Exchange = #shared.of(#text, #own) #answers #length #models #refusal;)
}

/// Says how often a report comes.
fn period(protocol: &Protocol, message: &Message, access: AccessId) -> String {
    let every = message.every.or(protocol[access].every);
    let timing = every.map(|id| &protocol[id]);
    timing.map_or_else(String::new, |timing| {
        let (first, last, unit) = (timing.range.minimum, timing.range.maximum, timing.unit.symbol);
        if first == last {
            format!(" It comes every {first} {unit}.")
        } else {
            format!(" It comes every {first} to {last} {unit}.")
        }
    })
}

/// Emits a filter.
fn filter(protocol: &Protocol, selectors: &[SelectorId], constants: &[Constant]) -> TokenStream {
    let constants = constants.iter().map(|known| {
        let value = constant(protocol, known.selector, known.value);
        match known.place {
            SelectorPlace::Identifier(field) => {
                let (place, _) = field_place(protocol, field);
                quote!(.id(Identifier::#place, #value))
            }
            SelectorPlace::Payload(_) => {
                let selector = selector_name(protocol, known.selector);
                quote!(.data(#selector.place, #value))
            }
        }
    });
    let names = selectors.iter().map(|id| selector_name(protocol, *id));
    let selectors = (!selectors.is_empty()).then(|| quote!(.selectors(&[#(#names),*])));
    quote!(FRAME #selectors #(#constants)*)
}

/// Returns the name of a payload selector's constant; two places under one name are told apart by number.
pub fn selector_name(protocol: &Protocol, id: SelectorId) -> Ident {
    let name = &protocol[id].name;
    let earlier = protocol.selectors.entries().take_while(|(other, _)| *other < id);
    let earlier = earlier.filter(|(_, known)| known.name == *name).count();
    let suffix = if earlier == 0 { String::new() } else { format!("_{}", earlier + 1) };
    ident(&format!("{}_SELECTOR{suffix}", name.to_ascii_uppercase()))
}
