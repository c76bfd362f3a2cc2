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
use crate::model::{Kind, Message, Protocol, SelectorPlace, Shape, Who};

/// An access as messages share it.
pub struct Shared {
    pub name: Ident,
    /// Index into [`Protocol::accesses`].
    access: usize,
    /// Index into [`Protocol::messages`]: the set of which the messages are members.
    set: Option<usize>,
    frames: Vec<SharedFrame>,
}

/// What one kind of frame shows, whatever the message.
#[derive(PartialEq)]
struct SharedFrame {
    kind: Kind,
    has_values: bool,
    selectors: Vec<usize>,
    constants: Vec<(usize, u64)>,
}

impl SharedFrame {
    fn new(message: &Message, shape: &Shape) -> Self {
        Self {
            kind: shape.kind,
            has_values: shape.kind == Kind::Request && !shape.signals.is_empty(),
            selectors: shape.selectors.clone(),
            constants: shape.constants.iter().copied().filter(|known| !message.constants.contains(known)).collect(),
        }
    }
}

/// Returns what messages share of each access; several ways to use one access are told apart by number.
pub fn shared(protocol: &Protocol) -> Vec<Shared> {
    let mut known: Vec<Shared> = Vec::new();
    for (access, of) in protocol.accesses.iter().enumerate() {
        for (message, index, set) in protocol.messages.iter().flat_map(|message| ways(message, access)) {
            let frames = frames(protocol, message, index);
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

/// Returns how a message travels by an access, alone and as a member of sets: index into [`Message::accesses`], and set.
fn ways(message: &Message, access: usize) -> impl Iterator<Item = (&Message, usize, Option<usize>)> {
    let known = message.accesses.iter().enumerate().filter(move |(_, known)| known.access == access);
    known.map(move |(index, known)| (message, index, known.set))
}

fn frames(protocol: &Protocol, message: &Message, access: usize) -> Vec<SharedFrame> {
    let shapes = message.shapes.iter().filter(|shape| shape.access == access);
    let whole = set::reply(protocol, message);
    shapes.chain(&whole).map(|shape| SharedFrame::new(message, shape)).collect()
}

/// Returns the shared constant of a message's access.
pub fn shared_name<'a>(protocol: &Protocol, names: &'a Names, message: &Message, access: usize) -> Option<&'a Ident> {
    let (known, frames) = (&message.accesses[access], frames(protocol, message, access));
    let is_its = |shared: &&Shared| (shared.access, shared.set) == (known.access, known.set) && shared.frames == frames;
    let shared = names.shared.iter().find(is_its);
    shared.map(|shared| &shared.name)
}

/// Emits what messages share of each access.
pub fn accesses(protocol: &Protocol, names: &Names) -> TokenStream {
    names.shared.iter().map(|known| access(protocol, names, known)).collect()
}

fn access(protocol: &Protocol, names: &Names, Shared { name, access, set, frames }: &Shared) -> TokenStream {
    let known = &protocol.accesses[*access];
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
        let facts = frame.constants.iter().map(|(selector, value)| {
            let name = &protocol.selectors[*selector].name;
            format!("In a {}, `{name}` is `{value:#X}`.", frame.kind.name())
        });
        facts.collect::<Vec<_>>()
    });
    facts.collect::<Vec<_>>().join(" ")
}

/// Says in which modes a request can be sent, and who answers.
pub fn modes(protocol: &Protocol, answers: &[Option<Who>]) -> String {
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
pub fn exchange(protocol: &Protocol, names: &Names, message: &Message, name: &Ident, index: usize) -> TokenStream {
    let access = &message.accesses[index];
    let known = &protocol.accesses[access.access];
    let (shared, text) = (shared_name(protocol, names, message, index), &message.name);
    let (set, period) = (set::membership(protocol, access.set), period(protocol, message, access.access));
    let comment = doc::line(format!("How it travels by `{}`{set}.{period}", known.name));
    let own = filter(protocol, &[], &message.constants);
    let answers = (access.answers != known.answers).then(|| {
        let list = answers_list(&access.answers);
        quote!(.answers(&#list))
    });
    let length = (message.length != 8).then(|| {
        let length = decimal(message.length);
        quote!(.length(#length))
    });
    let models = models_of(protocol, message);
    let refusal = message.refusals.iter().find(|shape| shape.access == index).map(|shape| {
        let filter = filter(protocol, &shape.selectors, &shape.constants);
        quote!(.refusal(&#filter))
    });
    quote!(#comment pub const #name: Exchange = #shared.of(#text, #own) #answers #length #models #refusal;)
}

/// Says how often a report comes.
fn period(protocol: &Protocol, message: &Message, access: usize) -> String {
    let every = message.every.or(protocol.accesses[access].every);
    let timing = every.map(|index| &protocol.timing[index]);
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
fn filter(protocol: &Protocol, selectors: &[usize], constants: &[(usize, u64)]) -> TokenStream {
    let constants = constants.iter().map(|(index, value)| {
        let value = constant(protocol, *index, *value);
        match protocol.selectors[*index].place {
            SelectorPlace::Identifier(field) => {
                let (place, _) = field_place(protocol, field);
                quote!(.id(Identifier::#place, #value))
            }
            SelectorPlace::Payload(_) => {
                let selector = selector_name(protocol, *index);
                quote!(.data(#selector.place, #value))
            }
        }
    });
    let names = selectors.iter().map(|index| selector_name(protocol, *index));
    let selectors = (!selectors.is_empty()).then(|| quote!(.selectors(&[#(#names),*])));
    quote!(FRAME #selectors #(#constants)*)
}

/// Returns the name of a payload selector's constant; two places under one name are told apart by number.
pub fn selector_name(protocol: &Protocol, index: usize) -> Ident {
    let name = &protocol.selectors[index].name;
    let earlier = protocol.selectors[..index].iter().filter(|known| known.name == *name).count();
    let suffix = if earlier == 0 { String::new() } else { format!("_{}", earlier + 1) };
    ident(&format!("{}_SELECTOR{suffix}", name.to_ascii_uppercase()))
}
