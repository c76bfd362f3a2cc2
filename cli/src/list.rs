//! `canspec list`.

mod derivation;
mod quantities;
mod timing;

use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use canspec_codegen::interpret::description;
use canspec_codegen::model::{
    Carrier, DeviceModel, Doc, Document, Example, Kind, LongMessage, Message, MessageId, ModelId, NamedValue, Parts,
    Protocol, SelectorId, Side, Signal, StatusBit, only,
};
use canspec_codegen::text::Text;
use canspec_specs::SPECS;
use clap::Args;

use crate::columns::{self, Row};
use crate::failure::{Failure, Finish};
use crate::output::output;
use crate::protocols;
use crate::severity::Severity;

/// The signal of a message that has only a value.
const VALUE: &str = "value";

/// List the built-in protocols, or the messages of one.
///
/// Constants that choose a message are in hexadecimal: `0x55` is what some documents print as `55h`.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec list --protocol NAME")]
pub struct List {
    /// A built-in protocol.
    #[arg(long, value_name = "NAME", conflicts_with = "spec")]
    protocol: Option<String>,
    /// A spec file.
    #[arg(long, value_name = "FILE")]
    spec: Option<PathBuf>,
}

impl List {
    /// Writes the list.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut out = BufWriter::new(output()?);
        match (self.protocol.as_deref(), self.spec.as_deref()) {
            (None, None) => built_in(&mut out)?,
            (name, path) => messages(&mut out, &protocols::load_chosen(name, path)?)?,
        }
        out.flush()?;
        Ok(Finish::Done)
    }
}

fn built_in(out: &mut impl Write) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for spec in SPECS {
        rows.push(protocol_row(spec.name, &protocols::load_built_in(spec)?));
    }
    Ok(columns::write(out, &["NAME", "TITLE", "MESSAGES", "EXAMPLES", "VERSION"], "DOCUMENT", &rows)?)
}

fn protocol_row(name: &str, protocol: &Protocol) -> Row {
    let count = protocol.messages.len();
    let documented: Vec<&Example> = protocol.examples.iter().filter(|example| example.is_documented()).collect();
    let shown = |id: &MessageId| documented.iter().any(|example| example.message == Some(*id));
    let covered = protocol.messages.ids().filter(shown).count();
    let cells = vec![
        name.to_owned(),
        words(Some(&protocol.title)),
        count.to_string(),
        format!("{} in {covered} of {count} messages", documented.len()),
        joined(&protocol.documents, |document| &document.version),
    ];
    Row { cells, last: vec![joined(&protocol.documents, |document| &document.title)], separator: "" }
}

/// Writes a table of messages, each followed by its signals.
fn messages(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    writeln!(out, "{}: {}", protocol.name, protocol.title.for_people())?;
    protocol.documents.iter().try_for_each(|known| writeln!(out, "{}", document(known)))?;
    protocol.sides.sentence().map_or(Ok(()), |sentence| writeln!(out, "{sentence}"))?;
    derivation::write(out, protocol)?;
    writeln!(out)?;
    let selectors = selectors(protocol);
    let upper: Vec<String> = selectors.iter().map(|id| protocol[*id].name.to_uppercase()).collect();
    let mut headings: Vec<&str> = upper.iter().map(String::as_str).collect();
    headings.extend(["ACCESS", "MESSAGE", "UNIT", "SECTION"]);
    headings.extend(protocol.derivation.as_ref().map(|_| "FROM"));
    let mut rows = Vec::new();
    for (id, message) in protocol.messages.ids().zip(&protocol.messages) {
        let mut row = message_row(protocol, &selectors, message);
        row.cells.extend(derivation::descent(protocol, id));
        rows.push(row);
        // What the parts say together tells more than what each frame says.
        let message = protocol.long_message(message).map_or(message, |(_, long)| &long.content);
        let signals = message.signals.iter().filter(|_| value(message).is_none());
        let fields = signals.filter(|signal| signal.element.is_none_or(|element| element.index == 0));
        rows.extend(fields.map(|signal| signal_row(protocol, selectors.len(), message, signal)));
    }
    columns::write(out, &headings, "MEANING", &rows)?;
    if protocol.messages.iter().any(|message| value(message).is_some()) {
        writeln!(out, "\nA message without signals below it has at most one, called `{VALUE}`.")?;
    }
    reports(out, protocol)?;
    starting(out, protocol)?;
    quantities::write(out, protocol)?;
    models(out, protocol)?;
    timing::write(out, protocol)
}

/// Names the accesses whose reports the controller sends, if there are any.
fn reports(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let reports = protocol.accesses.iter().filter(|access| access.sender(Kind::Report) == Side::Controller);
    let names: Vec<_> = reports.map(|access| format!("`{}`", access.name)).collect();
    if names.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nThe {} sends reports by {}.", protocol.sides.controller, names.join(", "))
}

/// Says how a module answers while it starts, if the document has a code for that.
fn starting(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let code = protocol.error_codes().find_map(|code| Some((code.name, code.starting?)));
    let Some((name, code)) = code else { return Ok(()) };
    writeln!(out, "\nWhile a {} starts, `{name}` of its replies is {code}.", protocol.sides.module)
}

/// Writes a table of the device models, if there are any.
fn models(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let rows: Vec<Row> = protocol.models.iter().map(model_row).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out)?;
    columns::write(out, &["MODEL", "ITEM", "IN PARALLEL", "KBIT/S", "SECTION"], "MEANING", &rows)
}

fn model_row(model: &DeviceModel) -> Row {
    let rates = model.bit_rates.iter().map(|rate| (rate / 1000).to_string());
    let cells = vec![
        model.name.clone(),
        model.items.iter().map(Text::for_people).collect::<Vec<_>>().join(", "),
        model.max_parallel.map_or(String::new(), |count| count.to_string()),
        rates.collect::<Vec<_>>().join(", "),
        words(model.doc.section.as_ref()),
    ];
    let facts = model.facts.iter().map(|(name, fact)| {
        let unit = fact.unit.map_or(String::new(), |unit| format!(" {}", unit.symbol));
        format!("{} {}{unit}", name.for_people(), fact.value)
    });
    let limits = model.types.iter().filter_map(|own| Some((&own.name, own.range?)));
    let limits = limits.map(|(name, range)| format!("{name} {}..{}", range.minimum, range.maximum));
    Row { cells, last: titled(title(&model.doc), facts.chain(limits).collect()), separator: ", " }
}

fn document(document: &Document) -> String {
    let date = document.date.as_ref().map_or(String::new(), |date| format!(", {}", date.for_people()));
    let name = document.name.as_ref().map_or(String::new(), |name| format!("{name}: "));
    format!("{name}{}, {}{date}", document.title.for_people(), document.version.for_people())
}

/// Writes what is printed on each document.
fn joined(documents: &[Document], printed: impl Fn(&Document) -> &Text) -> String {
    documents.iter().map(|document| printed(document).for_people()).collect::<Vec<_>>().join("; ")
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
    cells.push(value(message).and_then(|signal| signal.unit).map_or(String::new(), |unit| unit.symbol.to_string()));
    cells.push(words(message.doc.section.as_ref()));
    let models = of_some(protocol, &message.models);
    let carrier = protocol.long_message(message).map_or(String::new(), |(_, long)| carrier(protocol, long));
    let title = format!("{}{models}{carrier}", title(&message.doc).unwrap_or_default());
    let title = Some(title.trim_start()).filter(|title| !title.is_empty());
    match value(message) {
        Some(signal) => Row { cells, last: titled(title, meaning(protocol, signal)), separator: ", " },
        None if message.set.is_some() => {
            Row { cells, last: titled(title, members(protocol, message)), separator: ", " }
        }
        None => Row { cells, last: split(title.unwrap_or_default()), separator: " " },
    }
}

/// Says how a long message travels: in numbered parts, or by a transport.
fn carrier(protocol: &Protocol, long: &LongMessage) -> String {
    match &long.carrier {
        Carrier::Parts(known) => parts(protocol, long, known),
        Carrier::Transport(transport) => {
            let (least, most) = (long.shortest(), long.longest());
            let lengths: Vec<_> = match long.lengths.as_slice() {
                [] if least == most => vec![most.to_string()],
                [] => vec![format!("{least} to {most}")],
                several => several.iter().map(u16::to_string).collect(),
            };
            format!(" ({} bytes by {})", lengths.join(" or "), protocol[*transport].name)
        }
        // The enum may grow.
        _ => String::new(),
    }
}

/// Says in how many parts a long message travels, and how they are numbered.
fn parts(protocol: &Protocol, long: &LongMessage, parts: &Parts) -> String {
    let of_models = parts.model_firsts.iter().map(|own| format!("{} ({})", own.value, protocol[own.model].name));
    let firsts: Vec<_> = parts.first.map(|first| first.to_string()).into_iter().chain(of_models).collect();
    let (least, most) = (long.parts_of(long.shortest()), long.parts_of(long.longest()));
    let count = if least == most { most.to_string() } else { format!("{least} to {most}") };
    let silence = parts.silence.map_or_else(String::new, |time| format!(", until `{}`", protocol.timing[time].name));
    format!(" (in {count} parts of {} bytes, numbered from {}{silence})", parts.size, firsts.join(" or "))
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

fn signal_row(protocol: &Protocol, selectors: usize, message: &Message, signal: &Signal) -> Row {
    let mut cells = vec![String::new(); selectors + 1];
    cells.push(format!("  {}", field_name(message, signal)));
    cells.push(signal.unit.map_or(String::new(), |unit| unit.symbol.to_string()));
    cells.push(words(signal.doc.section.as_ref().filter(|_| signal.doc.section != message.doc.section)));
    cells.extend(protocol.derivation.as_ref().map(|_| String::new()));
    let doc = message.array_of(signal).map_or(&signal.doc, |array| &array.doc);
    Row { cells, last: titled(title(doc), meaning(protocol, signal)), separator: ", " }
}

/// Returns the name of a signal, or those of an array's first and last element.
fn field_name(message: &Message, signal: &Signal) -> String {
    let last = message.array_of(signal).and_then(|array| array.elements.last());
    last.map_or_else(|| signal.name.clone(), |last| format!("{}..{}", signal.name, message.signals[*last].name))
}

/// Writes a title before the first item.
fn titled(title: Option<&str>, mut items: Vec<String>) -> Vec<String> {
    match (title, items.first_mut()) {
        (Some(title), Some(first)) => *first = format!("{title}: {first}"),
        (Some(title), None) => items.push(title.to_owned()),
        (None, _) => {}
    }
    items
}

/// Returns limits, step and names of a signal.
fn meaning(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    let mut items = Vec::new();
    items.extend(signal.range.map(|range| format!("{}..{}", range.minimum, range.maximum)));
    items.extend(
        (!signal.model_ranges.is_empty() && signal.encoding.by_model().is_empty())
            .then(|| "limits by model".to_owned()),
    );
    match signal.encoding.status_word() {
        Some(word) => items.extend(protocol.status_words[word].bits.iter().map(|bit| status_bit(protocol, bit))),
        None => items.extend(description(protocol, signal)),
    }
    items.extend(only(&protocol.models, &signal.models));
    let special = |value: &NamedValue| format!("{} = {}", value.raw, value.text(&protocol.models));
    items.extend(signal.specials.iter().map(special));
    items
}

/// Returns number, name and severity of a status bit.
fn status_bit(protocol: &Protocol, bit: &StatusBit) -> String {
    let severity = Severity::of(bit).map_or(String::new(), |severity| format!(" ({})", severity.word()));
    format!("bit {} {}{severity}{}", bit.bit, bit.name, of_some(protocol, &bit.models))
}

/// Names the only device models that have an item, behind it.
fn of_some(protocol: &Protocol, models: &[ModelId]) -> String {
    only(&protocol.models, models).map_or(String::new(), |only| format!(" ({only})"))
}

/// Returns a text of the spec, or nothing.
fn words(text: Option<&Text>) -> String {
    text.map_or("", Text::for_people).to_owned()
}

fn title(doc: &Doc) -> Option<&str> {
    doc.title.as_ref().map(Text::for_people)
}

fn split(text: &str) -> Vec<String> {
    text.split(' ').map(str::to_owned).collect()
}
