//! A table of the messages, each followed by its signals, beside which a vendor's table can be laid.

use std::io::{self, Write};

use canspec_codegen::model::{Kind, Message, MessageId, Protocol, SelectorId, Side, Signal, only};

use super::remarks::{errata, own_section, title, words};
use super::rows::titled;
use super::{carrier, derivation, heading, meaning, models, quantities, timing};
use crate::show::columns::{self, Row};

/// The signal of a message that has only a value.
const VALUE: &str = "value";

/// Writes the table, and what surrounds the messages.
pub fn write(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    heading::write(out, protocol)?;
    writeln!(out)?;
    messages(out, protocol)?;
    if protocol.messages.iter().any(|message| value(message).is_some()) {
        paragraph(out, &format!("A message without signals below it has at most one, called `{VALUE}`."))?;
    }
    reports(out, protocol)?;
    starting(out, protocol)?;
    quantities::write(out, protocol)?;
    models::write(out, protocol, false)?;
    timing::write(out, protocol)?;
    paragraph(out, "Notes, frames and errata: --message NAME for a message, --full for all.")
}

fn paragraph(out: &mut impl Write, text: &str) -> io::Result<()> {
    writeln!(out)?;
    columns::text(out, text)
}

fn messages(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let selectors = selectors(protocol);
    let upper: Vec<String> = selectors.iter().map(|id| protocol[*id].name.to_uppercase()).collect();
    let mut headings: Vec<&str> = upper.iter().map(String::as_str).collect();
    headings.extend(["ACCESS", "MESSAGE", "BYTES", "UNIT", "SECTION"]);
    headings.extend(protocol.derivation.as_ref().map(|_| "FROM"));
    let rows: Vec<_> = protocol.messages.ids().flat_map(|id| rows(protocol, &selectors, id)).collect();
    columns::write(out, &headings, "MEANING", &rows)
}

/// Returns the row of a message and those of its signals.
fn rows(protocol: &Protocol, selectors: &[SelectorId], id: MessageId) -> Vec<Row> {
    let message = &protocol[id];
    let mut head = message_row(protocol, selectors, message);
    head.cells.extend(derivation::descent(protocol, id));
    // What the parts say together tells more than what each frame says.
    let content = protocol.long_message(message).map_or(message, |(_, long)| &long.content);
    let signals = content.signals.iter().filter(|_| value(content).is_none());
    let fields = signals.filter(|signal| signal.element.is_none_or(|element| element.index == 0));
    let fields = fields.map(|signal| signal_row(protocol, selectors.len(), content, signal));
    std::iter::once(head).chain(fields).collect()
}

/// Names the accesses whose reports the controller sends, if there are any.
fn reports(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let reports = protocol.accesses.iter().filter(|access| access.sender(Kind::Report) == Side::Controller);
    let names: Vec<_> = reports.map(|access| format!("`{}`", access.name)).collect();
    if names.is_empty() {
        return Ok(());
    }
    paragraph(out, &format!("The {} sends reports by {}.", protocol.sides.controller, names.join(", ")))
}

/// Says how a module answers while it starts, if the document has a code for that.
fn starting(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let code = protocol.error_codes().find_map(|code| Some((code.name, code.starting?)));
    let Some((name, code)) = code else { return Ok(()) };
    paragraph(out, &format!("While a {} starts, `{name}` of its replies is {code}.", protocol.sides.module))
}

/// Returns the selectors whose constants choose a message, whatever its access.
fn selectors(protocol: &Protocol) -> Vec<SelectorId> {
    let chooses = |id: &SelectorId| protocol.messages.iter().any(|message| constant(protocol, message, *id).is_some());
    protocol.selectors.ids().filter(chooses).collect()
}

/// Returns the value that a selector has in every frame of a message. If the message has accesses
/// of its own, frames of sets do not count.
fn constant(protocol: &Protocol, message: &Message, selector: SelectorId) -> Option<u64> {
    let has_own = protocol.layouts_of(message).any(|frame| frame.set.is_none());
    let own = protocol.layouts_of(message).filter(|frame| frame.set.is_none() || !has_own);
    let own = own.map(|frame| &frame.constants).chain(message.set.as_ref().map(|set| &set.replies));
    let mut values = own.map(|constants| {
        let constant = constants.iter().find(|constant| constant.selector == selector && constant.open == 0);
        constant.map(|constant| constant.value)
    });
    let first = values.next()??;
    values.all(|value| value == Some(first)).then_some(first)
}

fn message_row(protocol: &Protocol, selectors: &[SelectorId], message: &Message) -> Row {
    let shown = |id: &SelectorId| {
        let value = constant(protocol, message, *id);
        value.map_or(String::new(), |value| protocol.selector_value(*id, value))
    };
    let accesses = message.exchanges.iter().filter(|exchange| exchange.set.is_none());
    let accesses = accesses.map(|exchange| protocol[exchange.access].name.as_str());
    let mut cells: Vec<String> = selectors.iter().map(shown).collect();
    cells.extend([accesses.collect::<Vec<_>>().join(", "), message.name.clone()]);
    cells.extend(value(message).map_or([String::new(), String::new()], place_and_unit));
    cells.push(words(message.doc.section.as_ref()));
    let title = heading_of(protocol, message);
    let title = Some(title.as_str()).filter(|title| !title.is_empty());
    match value(message) {
        Some(signal) => {
            Row { cells, last: titled(title, meaning(protocol, message, signal)), separator: ", ", ..Row::default() }
        }
        None if message.set.is_some() => {
            Row { cells, last: titled(title, members(protocol, message)), separator: ", ", ..Row::default() }
        }
        None => Row { cells, last: split(title.unwrap_or_default()), separator: " ", ..Row::default() },
    }
}

/// Returns the title of a message, with what is behind it: models, how it travels, and errata.
fn heading_of(protocol: &Protocol, message: &Message) -> String {
    let models = only(&protocol.models, &message.models).map(|only| format!("({only})"));
    let carrier = protocol.long_message(message).map(|(_, long)| format!("({})", carrier::text(protocol, long)));
    let title = title(&message.doc).map(str::to_owned);
    let words: Vec<_> = [title, models, carrier, errata(&message.doc)].into_iter().flatten().collect();
    words.join(" ")
}

/// Returns the names of the messages that travel in the frames of a set.
fn members(protocol: &Protocol, message: &Message) -> Vec<String> {
    let members = message.set.iter().flat_map(|set| &set.members);
    members.map(|member| protocol.messages[*member].name.clone()).collect()
}

/// Returns the signal of a message that has only a value, like a register.
fn value(message: &Message) -> Option<&Signal> {
    message.signals.first().filter(|signal| message.signals.len() == 1 && signal.name == VALUE)
}

fn place_and_unit(signal: &Signal) -> [String; 2] {
    [signal.written().to_string(), signal.unit.map_or(String::new(), |unit| unit.symbol.to_string())]
}

fn signal_row(protocol: &Protocol, selectors: usize, message: &Message, signal: &Signal) -> Row {
    let doc = message.array_of(signal).map_or(&signal.doc, |array| &array.doc);
    let mut cells = vec![String::new(); selectors + 1];
    cells.push(format!("  {}", field_name(message, signal)));
    cells.extend(place_and_unit(signal));
    cells.push(own_section(doc, &message.doc));
    cells.extend(protocol.derivation.as_ref().map(|_| String::new()));
    Row { cells, last: titled(title(doc), meaning(protocol, message, signal)), separator: ", ", ..Row::default() }
}

/// Returns the name of a signal, or those of an array's first and last element.
fn field_name(message: &Message, signal: &Signal) -> String {
    let last = message.array_of(signal).and_then(|array| array.elements.last());
    last.map_or_else(|| signal.name.clone(), |last| format!("{}..{}", signal.name, message.signals[*last].name))
}

/// Returns limits, number format and names of a signal, and its errata.
fn meaning(protocol: &Protocol, message: &Message, signal: &Signal) -> Vec<String> {
    let mut items = meaning::number(protocol, signal);
    items.extend(meaning::names(protocol, signal));
    let last = message.array_of(signal).and_then(|array| array.elements.last());
    items.extend(last.map(|last| format!("last at {}", message[*last].written())));
    items.extend(errata(&signal.doc));
    items
}

fn split(text: &str) -> Vec<String> {
    text.split(' ').map(str::to_owned).collect()
}
