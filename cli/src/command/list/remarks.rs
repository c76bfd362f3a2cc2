//! What a spec says beside an item: title, note, section and errata.

use std::collections::HashSet;

use canspec_codegen::model::{Doc, Protocol};
use canspec_codegen::syntax::tree::Step;
use canspec_codegen::text::Text;

/// Returns a text of the spec, or nothing.
pub fn words(text: Option<&Text>) -> String {
    text.map_or("", Text::for_people).to_owned()
}

/// Returns the title of an item.
pub fn title(doc: &Doc) -> Option<&str> {
    doc.title.as_ref().map(Text::for_people)
}

/// Returns the section of an item inside another one, unless both have the same.
pub fn own_section(doc: &Doc, outer: &Doc) -> String {
    words(doc.section.as_ref().filter(|_| doc.section != outer.section))
}

/// Names the errata of an item behind it.
pub fn errata(doc: &Doc) -> Option<String> {
    (!doc.errata.is_empty()).then(|| format!("[{}]", texts(&doc.errata)))
}

/// Returns note and errata of an item as sentences.
pub fn sentences(doc: &Doc) -> Vec<String> {
    let note = doc.note.as_ref().map(|note| format!("note: {}", note.for_people()));
    let errata = (!doc.errata.is_empty()).then(|| format!("errata: {}", texts(&doc.errata)));
    note.into_iter().chain(errata).collect()
}

/// Writes texts with commas between them.
pub fn texts(texts: &[Text]) -> String {
    texts.iter().map(Text::for_people).collect::<Vec<_>>().join(", ")
}

/// Returns the last key of an item's place in the spec.
pub fn name_of(doc: &Doc) -> &str {
    match doc.path.split() {
        Some((_, Step::Key(name))) => name,
        _ => "",
    }
}

/// Returns the types, named values, status words and words that have remarks, by name. Kinds of addresses are others.
pub fn types(protocol: &Protocol) -> Vec<(&str, &Doc)> {
    let own = protocol.types.iter().chain(&protocol.words).map(|doc| (name_of(doc), doc));
    let values = protocol.enumerations.iter().map(|known| (known.name.as_str(), &known.doc));
    let status = protocol.status_words.iter().map(|known| (known.name.as_str(), &known.doc));
    let mut seen: HashSet<_> = protocol.address_types.iter().map(|known| &known.doc.path).collect();
    own.chain(values).chain(status).filter(|(_, doc)| is_known(doc) && seen.insert(&doc.path)).collect()
}

/// Tests whether the spec says more of an item than where it stands.
pub fn is_remarked(doc: &Doc) -> bool {
    doc.title.is_some() || doc.note.is_some() || !doc.errata.is_empty()
}

fn is_known(doc: &Doc) -> bool {
    doc.section.is_some() || is_remarked(doc)
}
