//! A message with all that the spec says of it: its frames, its signals, and their remarks.

use std::io::{self, Write};

use canspec_codegen::model::{Doc, FixedField, Message, MessageId, Protocol, Signal, StatusBit, only};

use super::remarks::{own_section, sentences, title, words as text};
use super::rows::{self, titled};
use super::{carrier, derivation, examples, frames, meaning, words};
use crate::show::columns::Row;
use crate::show::severity::Severity;

/// Writes a message.
pub fn write(out: &mut impl Write, protocol: &Protocol, id: MessageId) -> io::Result<()> {
    let message = &protocol[id];
    rows::table(out, &["MESSAGE", "SECTION"], &[head(protocol, id)])?;
    frames::write(out, protocol, message)?;
    signals(out, protocol, message, "SIGNAL")?;
    if let Some((_, long)) = protocol.long_message(message) {
        signals(out, protocol, &long.content, "SIGNAL OF ALL FRAMES")?;
    }
    examples::write(out, protocol, Some(id))
}

fn head(protocol: &Protocol, id: MessageId) -> Row {
    let message = &protocol[id];
    let cells = vec![message.name.clone(), text(message.doc.section.as_ref())];
    let mut facts: Vec<_> = only(&protocol.models, &message.models).into_iter().collect();
    facts.extend(protocol.long_message(message).map(|(_, long)| carrier::text(protocol, long)));
    facts.extend(derivation::descent(protocol, id).map(|from| format!("from {from}")));
    facts.extend(message.every.map(|timing| format!("every `{}`", protocol[timing].name)));
    let members = message.set.iter().flat_map(|set| &set.members);
    let members: Vec<_> = members.map(|member| protocol[*member].name.as_str()).collect();
    facts.extend((!members.is_empty()).then(|| format!("consists of {}", members.join(" and "))));
    let sends = message.sends.iter();
    facts.extend(sends.map(|(field, value)| format!("{} sent as {value:#X}", protocol[*field].name)));
    facts.extend(message.reserved.are_ones.then(|| "bits that nothing names are sent as 1".to_owned()));
    facts.extend(message.reserved.are_free.then(|| "received ones may have any value".to_owned()));
    let mut row = rows::row(cells, &message.doc, facts);
    row.below.extend(message.fixed.iter().map(|known| about_fixed(protocol, message, known)));
    row
}

/// Says what a field is that has one value in the message.
fn about_fixed(protocol: &Protocol, message: &Message, known: &FixedField) -> String {
    let value = protocol.selector_value(known.selector, known.value);
    let title = title(&known.doc).map_or(String::new(), |title| format!(": {title}"));
    let section = inner_section(&known.doc, &message.doc);
    let head = format!("{} = {value}{title}{section}", protocol[known.selector].name);
    std::iter::once(head).chain(sentences(&known.doc)).collect::<Vec<_>>().join("; ")
}

fn signals(out: &mut impl Write, protocol: &Protocol, message: &Message, heading: &str) -> io::Result<()> {
    let first = message.signals.iter().filter(|signal| signal.element.is_none_or(|element| element.index == 0));
    let rows: Vec<_> = first.map(|signal| row(protocol, message, signal)).collect();
    rows::table(out, &["BYTES", heading, "UNIT", "SECTION"], &rows)
}

fn row(protocol: &Protocol, message: &Message, signal: &Signal) -> Row {
    let doc = message.array_of(signal).map_or(&signal.doc, |array| &array.doc);
    let cells = vec![
        signal.written().to_string(),
        message.field_name(signal).to_owned(),
        signal.unit.map_or(String::new(), |unit| unit.symbol.to_string()),
        own_section(doc, &message.doc),
    ];
    let facts = elements(message, signal).into_iter().chain(meaning::number(protocol, signal)).collect();
    let mut below = bits(protocol, signal);
    below.extend(meaning::values(protocol, signal));
    below.extend(by_model(protocol, signal));
    below.extend(conduct(protocol, signal));
    below.extend(parts(protocol, signal));
    below.extend(sentences(doc));
    Row { cells, last: titled(title(doc), facts), separator: ", ", below }
}

/// Says how many elements an array has, and where they stand.
fn elements(message: &Message, signal: &Signal) -> Option<String> {
    let array = message.array_of(signal)?;
    let places: Vec<_> = array.elements.iter().map(|id| message[*id].written().to_string()).collect();
    let places = match places.as_slice() {
        [first, second, _, .., last] => format!("{first}, {second} and so on to {last}"),
        few => few.join(", "),
    };
    let least = array.least.map_or(String::new(), |least| format!("{least} to "));
    Some(format!("{least}{} elements at {places}", array.elements.len()))
}

/// Returns the bits of a status word, each with what the spec says of it.
fn bits(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    meaning::status_bits(protocol, signal).map(|bit| about_bit(protocol, signal, bit)).collect()
}

fn about_bit(protocol: &Protocol, signal: &Signal, bit: &StatusBit) -> String {
    let severity = Severity::of(bit).map_or(String::new(), |severity| format!(" ({})", severity.word()));
    let title = title(&bit.doc).map_or(String::new(), |title| format!(": {title}"));
    let section = inner_section(&bit.doc, &signal.doc);
    let models = meaning::of_some(protocol, &bit.models);
    let head = format!("{} {}{severity}{models}{title}{section}", meaning::number_of(signal, bit), bit.name);
    let texts =
        [("set when", &bit.set_when), ("cleared when", &bit.clear_when), ("effect:", &bit.effect), ("LED:", &bit.led)];
    let texts = texts.into_iter().filter_map(|(word, text)| Some(format!("{word} {}", text.as_ref()?.for_people())));
    std::iter::once(head).chain(texts).chain(sentences(&bit.doc)).collect::<Vec<_>>().join("; ")
}

/// Names the section of an item inside a signal, unless both have the same.
fn inner_section(doc: &Doc, outer: &Doc) -> String {
    let section = own_section(doc, outer);
    if section.is_empty() { section } else { format!(", section {section}") }
}

/// Says which limits and defaults device models have of their own.
fn by_model(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    // Limits of a number whose scale depends on the model stand beside the scale.
    let ranges = signal.model_ranges.iter().filter(|_| signal.encoding.by_model().is_empty());
    let ranges = ranges.map(|own| format!("{} on {}", meaning::limits(own.value), protocol[own.model].name));
    let defaults = signal.model_defaults.iter().map(|own| {
        format!(
            "default {} on {}",
            meaning::raw(protocol, signal.on(Some(own.model)), own.value),
            protocol[own.model].name
        )
    });
    ranges.chain(defaults).collect()
}

/// Says what a device and a frame do with a signal.
fn conduct(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    let mut facts = Vec::new();
    facts.extend(signal.default.map(|raw| format!("default {}", meaning::raw(protocol, signal, raw))));
    let out_of_range = signal.conduct.out_of_range.map(words::out_of_range);
    facts.extend(out_of_range.map(|word| format!("a value outside the range is {word}")));
    facts.extend(signal.conduct.keeps.map(words::power_off).map(|word| format!("{word} without power")));
    let kinds: Vec<_> = signal.kinds.iter().map(|kind| kind.name()).collect();
    facts.extend((!kinds.is_empty()).then(|| format!("only in: {}", kinds.join(", "))));
    facts.extend((!signal.types.is_empty()).then(|| format!("type: {}", signal.types.join(", "))));
    facts
}

/// Returns what the spec says of the parts of a packed value.
fn parts(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    let about = |part: &Signal| {
        let facts = title(&part.doc).map(str::to_owned).into_iter().chain(meaning::number(protocol, part));
        let facts: Vec<_> = facts.chain(sentences(&part.doc)).collect();
        let section = inner_section(&part.doc, &signal.doc);
        format!("{{{}}} at {}{section}: {}", part.name, part.written(), facts.join(", "))
    };
    signal.encoding.parts().iter().map(about).collect()
}
