//! How a message is used: what chooses it, who answers it, and the frames that the document prints of it.

use super::doc;
use super::exchange::{Accesses, membership};
use crate::model::{
    Constant, Example, Exchange, ExchangeId, Kind, Meaning, Message, MessageId, Protocol, Side, Timing, Who,
};
use crate::words::hex;
use crate::words::text::Text;

/// Describes a message: its selectors, accesses and printed frames, and the errata of all that.
pub fn paragraphs(protocol: &Protocol, accesses: &Accesses, id: MessageId) -> Vec<String> {
    let message = &protocol[id];
    let frames: Vec<_> = Kind::ALL.into_iter().filter_map(|kind| printed(protocol, id, kind)).collect();
    let ways = message.exchanges.ids().map(|exchange| way(protocol, accesses, id, exchange));
    let uses = doc::list(ways.chain(frames.iter().map(|example| documented(protocol, example))));
    let errata = frames.iter().flat_map(|example| &example.doc.errata);
    let mut others: Vec<&Text> = Vec::new();
    for name in errata.filter(|name| !message.doc.errata.contains(name)) {
        if !others.contains(&name) {
            others.push(name);
        }
    }
    let others = others.into_iter().filter_map(|name| doc::erratum(protocol, name));
    let mut paragraphs = doc::paragraphs(protocol, &message.doc, &sentence(protocol, message), None);
    paragraphs.insert(1, uses);
    paragraphs.into_iter().chain(others).collect()
}

/// Says what a message is, and by what it is recognised.
fn sentence(protocol: &Protocol, message: &Message) -> String {
    let selector = |known: &Constant| {
        format!("`{}` {}", protocol[known.selector].name, protocol.selector_value(known.selector, known.value))
    };
    let selectors: Vec<_> = message.constants.iter().map(selector).collect();
    let colon = if selectors.is_empty() { "" } else { ": " };
    doc::sentence_of(&format!("{}{colon}{}", doc::title(&message.doc, &message.name), selectors.join(", ")))
}

/// Returns the first frame of a kind that the document prints whole, and that holds.
pub fn printed(protocol: &Protocol, id: MessageId, kind: Kind) -> Option<&Example> {
    let mut examples = protocol.examples.iter().filter(|example| example.message == Some(id) && example.kind == kind);
    examples.find(|example| example.is_documented() && example.fails.is_none() && example.data.is_some())
}

/// Writes a frame as documents print it.
pub fn frame(example: &Example) -> String {
    let digits = if example.extended { 8 } else { 3 };
    format!("{:0digits$X}#{}", example.id, hex::digits(example.data.as_deref().unwrap_or_default()))
}

/// Shows a frame of the document and what it means.
fn documented(protocol: &Protocol, example: &Example) -> String {
    let signals = example.message.map(|id| &protocol[id].signals);
    let value = |meaning: &Meaning| {
        let name = signals.map_or("", |signals| signals[meaning.signal].name.as_str());
        format!("`{name}` {}", Text::new(&meaning.text).within_rust_doc())
    };
    let values: Vec<_> = example.means.iter().map(value).collect();
    let model = example.model.map_or_else(String::new, |model| format!(" of `{}`", protocol[model].name));
    let colon = if values.is_empty() { "" } else { ": " };
    doc::sentence_of(&format!("{}{model} `{}`{colon}{}", example.kind.name(), frame(example), values.join(", ")))
}

/// Says by which access a message travels, and who answers or sends it.
fn way(protocol: &Protocol, accesses: &Accesses, id: MessageId, exchange: ExchangeId) -> String {
    let (message, own) = (&protocol[id], &protocol[id][exchange]);
    let access = &protocol[own.access];
    let is_report = access.kinds.contains(&Kind::Report);
    let senders = match access.from {
        Side::Controller => format!("the {} sends it{}", protocol.sides.controller, modes(protocol, own)),
        Side::Module => senders(protocol, own, if is_report { "sends it" } else { "answers" }),
    };
    let (link, set) = (accesses.constant(id, exchange), membership(protocol, own.set));
    let colon = if senders.is_empty() { "" } else { ": " };
    let sentence = doc::sentence_of(&format!("[`{}`]({link}){set}{colon}{senders}", access.name));
    format!("{sentence}{}", period(protocol, message, own))
}

/// Names the modes of an exchange, if there are any.
fn modes(protocol: &Protocol, exchange: &Exchange) -> String {
    let modes = protocol.modes.iter().zip(&exchange.answers).filter(|(_, who)| who.is_some());
    let names: Vec<_> = modes.map(|(mode, _)| format!("`{}`", mode.name)).collect();
    if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) }
}

/// Says in which modes who answers or sends.
fn senders(protocol: &Protocol, exchange: &Exchange, does: &str) -> String {
    let modes = protocol.modes.iter().zip(&exchange.answers).filter_map(|(mode, who)| Some((mode, (*who)?)));
    let mut senders: Vec<(Who, Vec<String>)> = Vec::new();
    for (mode, who) in modes {
        let name = format!("`{}`", mode.name);
        match senders.iter_mut().find(|(known, _)| *known == who) {
            Some((_, names)) => names.push(name),
            None => senders.push((who, vec![name])),
        }
    }
    let senders = senders
        .iter()
        .map(|(who, names)| format!("{} ({})", sender(&protocol.sides.module, *who, does), names.join(", ")));
    senders.collect::<Vec<_>>().join(", ")
}

fn sender(module: &str, who: Who, does: &str) -> String {
    match who {
        Who::One => format!("the {module} {does}"),
        Who::Each => format!("each {module} {does}"),
        Who::Coordinator => format!("one {does} for all"),
        Who::Nobody => format!("nobody {does}"),
    }
}

/// Says how often a report comes.
fn period(protocol: &Protocol, message: &Message, exchange: &Exchange) -> String {
    let every = message.every.or(protocol[exchange.access].every).map(|id| &protocol[id]);
    every.map_or_else(String::new, |timing| format!(" It comes every {}.", time(timing)))
}

/// Writes a time of the document.
pub fn time(timing: &Timing) -> String {
    let (first, last, unit) = (timing.range.minimum, timing.range.maximum, timing.unit.symbol);
    if first == last { format!("{first} {unit}") } else { format!("{first} to {last} {unit}") }
}
