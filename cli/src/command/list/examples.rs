//! Tables of examples: the frames of a message, and the bytes of types.

use std::io::{self, Write};

use canspec_codegen::model::{
    Example, Failure, LongExample, Meaning, Message, MessageId, ModelId, NoteRule, Origin, Protocol, ValueExample,
};

use super::remarks::words as text;
use super::{rows, words};
use crate::log;
use crate::show::columns::Row;

/// Writes the examples of a message, or those of none.
pub fn write(out: &mut impl Write, protocol: &Protocol, id: Option<MessageId>) -> io::Result<()> {
    let single = protocol.examples.iter().filter(|example| example.message == id);
    let long = protocol.long_examples.iter().filter(|example| Some(protocol[example.long].message) == id);
    let rows = single.map(|example| of_frame(protocol, example)).chain(long.map(|example| of_long(protocol, example)));
    rows::table(out, &["EXAMPLE", "KIND", "SECTION"], &rows.collect::<Vec<_>>())
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
