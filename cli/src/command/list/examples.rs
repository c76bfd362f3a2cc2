//! Tables of examples: the frames of a message, and the bytes of types.

use std::collections::{BTreeMap, HashMap};
use std::io::{self, Write};

use canspec_codegen::model::{
    Doc, Example, Failure, LongExample, Meaning, Message, MessageId, ModelId, NoteRule, Origin, Protocol, ValueExample,
};
use canspec_codegen::syntax::tree::{Path, Step};

use super::remarks::words as text;
use super::{remarks, rows, words};
use crate::log;
use crate::show::columns::Row;

/// Writes the examples of a message, or those of none.
pub fn write(out: &mut impl Write, protocol: &Protocol, id: Option<MessageId>) -> io::Result<()> {
    let single = protocol.examples.iter().filter(|example| example.message == id);
    let long = protocol.long_examples.iter().filter(|example| Some(protocol[example.long].message) == id);
    let rows = single.map(|example| of_frame(protocol, example)).chain(long.map(|example| of_long(protocol, example)));
    rows::table(out, &["EXAMPLE", "KIND", "SECTION"], &rows.collect::<Vec<_>>())
}

/// Writes the frames of each sequence, in the order of the document.
pub fn sequences(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let mut frames = frames_of_sequences(protocol);
    protocol.sequences.iter().try_for_each(|sequence| {
        let name = remarks::name_of(sequence);
        let cells = vec![name.to_owned(), text(sequence.section.as_ref())];
        rows::table(out, &["SEQUENCE", "SECTION"], &[rows::row(cells, sequence, Vec::new())])?;
        let frames: Vec<_> = frames.remove(name).into_iter().flat_map(BTreeMap::into_values).collect();
        rows::table(out, &["FRAME", "KIND", "SECTION", "MESSAGE"], &frames)
    })
}

/// Returns the rows of the frames of each sequence, by their places in it.
fn frames_of_sequences<'a>(protocol: &'a Protocol) -> HashMap<&'a str, BTreeMap<usize, Row>> {
    let mut sequences: HashMap<_, BTreeMap<_, _>> = HashMap::new();
    let mut add = |doc: &'a Doc, mut row: Row, message: Option<MessageId>| {
        let Some((sequence, place)) = sequence(doc) else { return };
        row.cells.push(message.map_or(String::new(), |message| protocol[message].name.clone()));
        sequences.entry(sequence).or_default().insert(place, row);
    };
    for example in &protocol.examples {
        add(&example.doc, of_frame(protocol, example), example.message);
    }
    for example in &protocol.long_examples {
        add(&example.doc, of_long(protocol, example), Some(protocol[example.long].message));
    }
    sequences
}

/// Returns the name of the sequence in which an example stands, and its place there.
pub fn sequence(example: &Doc) -> Option<(&str, usize)> {
    let (frames, Step::Index(place)) = example.path.split()? else { return None };
    let (sequence, _) = frames.split()?;
    let (outer, Step::Key(name)) = sequence.split()? else { return None };
    (*outer == Path::default().key("examples")).then_some((name, *place))
}

/// Writes the examples of types.
pub fn of_types(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let rows: Vec<_> = protocol.value_examples.iter().map(of_type).collect();
    rows::table(out, &["BYTES", "TYPE", "SECTION"], &rows)
}

fn of_type(example: &ValueExample) -> Row {
    let data = log::hexadecimal(bytes(example));
    let cells = vec![data, example.signal.name.clone(), text(example.doc.section.as_ref())];
    rows::row(cells, &example.doc, vec![example.meaning.text.clone()])
}

/// Returns the bytes of an example of a type.
pub fn bytes(example: &ValueExample) -> &[u8] {
    example.data.get(..example.signal.end().into()).unwrap_or(&example.data)
}

fn of_frame(protocol: &Protocol, example: &Example) -> Row {
    let id = log::identifier_digits(example.id, example.extended);
    let data = example.data.as_deref().map_or(String::new(), |data| format!("#{}", log::hexadecimal(data)));
    let cells = vec![format!("{id}{data}"), example.kind.name().to_owned(), text(example.doc.section.as_ref())];
    let mut facts: Vec<_> = model(protocol, example.model).into_iter().collect();
    facts.extend(example.message.map(|message| means(&protocol[message], &example.means)).into_iter().flatten());
    facts.extend(rules(&example.notes));
    facts.extend(example.fails.map(Failure::name).map(|failure| format!("fails: {failure}")));
    facts.extend(origin(example.origin));
    rows::row(cells, &example.doc, facts)
}

fn of_long(protocol: &Protocol, example: &LongExample) -> Row {
    let frames = example.frames.iter().map(|(id, data)| {
        let id = log::identifier_digits(*id, protocol.identifier.extended);
        format!("{id}#{}", log::hexadecimal(data))
    });
    let frames: Vec<_> = frames.collect();
    let first = frames.first().cloned().unwrap_or_default();
    let cells = vec![first, example.kind.name().to_owned(), text(example.doc.section.as_ref())];
    let mut facts: Vec<_> = model(protocol, example.model).into_iter().collect();
    facts.extend(means(&protocol[example.long].content, &example.means));
    facts.extend(rules(&example.notes).into_iter().chain(origin(example.origin)));
    let mut row = rows::row(cells, &example.doc, facts);
    row.below.extend(frames.into_iter().skip(1).map(|frame| format!("then {frame}")));
    row
}

fn model(protocol: &Protocol, model: Option<ModelId>) -> Option<String> {
    model.map(|model| format!("of {}", protocol[model].name))
}

fn means(message: &Message, means: &[Meaning]) -> Vec<String> {
    means.iter().map(|known| format!("{} {}", message[known.signal].name, known.text)).collect()
}

fn rules(notes: &[NoteRule]) -> Option<String> {
    let rules: Vec<_> = notes.iter().map(|rule| rule.name()).collect();
    (!rules.is_empty()).then(|| format!("notes: {}", rules.join(" ")))
}

/// Says where an example comes from, unless the document prints it.
fn origin(origin: Origin) -> Option<String> {
    (origin != Origin::Document).then(|| format!("origin: {}", words::origin(origin)))
}
