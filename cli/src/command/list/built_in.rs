//! The built-in protocols.

use std::io::{self, Write};

use canspec_codegen::model::{Document, Example, MessageId, Protocol};
use canspec_codegen::text::Text;
use canspec_specs::SPECS;
use serde::Serialize;

use super::Format;
use crate::choose::protocols;
use crate::failure::Failure;
use crate::show::columns::{self, Row};

/// A built-in protocol, and how many of its messages have examples that a document prints.
#[derive(Serialize)]
struct Object {
    protocol: &'static str,
    title: Text,
    messages: usize,
    messages_with_examples: usize,
    examples: usize,
    versions: Vec<Text>,
    documents: Vec<Text>,
}

/// Writes them as a table, or as a list of JSON.
pub fn write(out: &mut impl Write, format: Format) -> Result<(), Failure> {
    let mut objects = Vec::new();
    for spec in SPECS {
        objects.push(object(spec.name, &protocols::load_built_in(spec)?));
    }
    match format {
        Format::Text => table(out, &objects)?,
        Format::Json => json(out, &objects)?,
    }
    Ok(())
}

fn json(out: &mut impl Write, objects: &[Object]) -> io::Result<()> {
    serde_json::to_writer(&mut *out, objects)?;
    writeln!(out)
}

fn object(name: &'static str, protocol: &Protocol) -> Object {
    let documented: Vec<&Example> = protocol.examples.iter().filter(|example| example.is_documented()).collect();
    let shown = |id: &MessageId| documented.iter().any(|example| example.message == Some(*id));
    let of_documents =
        |text: fn(&Document) -> &Text| protocol.documents.iter().map(|known| text(known).clone()).collect();
    Object {
        protocol: name,
        title: protocol.title.clone(),
        messages: protocol.messages.len(),
        messages_with_examples: protocol.messages.ids().filter(shown).count(),
        examples: documented.len(),
        versions: of_documents(|document| &document.version),
        documents: of_documents(|document| &document.title),
    }
}

fn table(out: &mut impl Write, objects: &[Object]) -> io::Result<()> {
    let rows: Vec<_> = objects.iter().map(row).collect();
    columns::write(out, &["NAME", "TITLE", "MESSAGES", "EXAMPLES", "VERSION"], "DOCUMENT", &rows)
}

fn row(object: &Object) -> Row {
    let Object { protocol, title, messages, messages_with_examples, examples, versions, documents } = object;
    let cells = vec![
        (*protocol).to_owned(),
        title.for_people().to_owned(),
        messages.to_string(),
        format!("{examples} in {messages_with_examples} of {messages} messages"),
        joined(versions),
    ];
    Row { cells, last: vec![joined(documents)], ..Row::default() }
}

/// Writes what is printed on each document.
fn joined(texts: &[Text]) -> String {
    texts.iter().map(Text::for_people).collect::<Vec<_>>().join("; ")
}
