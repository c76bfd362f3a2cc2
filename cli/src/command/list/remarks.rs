//! What a spec says beside an item: title, note, section and errata.

use std::collections::HashSet;

use canspec_codegen::model::{Doc, NamedType, Protocol};
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

/// A type, named values, a status word, or a word.
pub struct Type<'a> {
    pub name: String,
    pub doc: &'a Doc,
    /// What a type says of bits, as the spec writes it, by key.
    pub keys: &'a [(String, Text)],
}

/// Returns the types, named values, status words and words that have remarks, by name. Kinds of addresses are others.
///
/// A word has the keys that lead to it as its name, as `status.value`.
pub fn types(protocol: &Protocol) -> Vec<Type<'_>> {
    let own = protocol.types.iter();
    let own = own.map(|NamedType { doc, keys, .. }| Type { name: name_of(doc).to_owned(), doc, keys });
    let words = protocol.words.iter().map(|doc| (place_of(doc), doc));
    let values = protocol.enumerations.iter().map(|known| (known.name.clone(), &known.doc));
    let status = protocol.status_words.iter().map(|known| (known.name.clone(), &known.doc));
    let others = words.chain(values).chain(status).map(|(name, doc)| Type { name, doc, keys: &[] });
    let mut seen: HashSet<_> = protocol.address_types.iter().map(|known| &known.doc.path).collect();
    let is_shown = |known: &Type| is_known(known.doc) || !known.keys.is_empty();
    own.chain(others).filter(|known| is_shown(known) && seen.insert(&known.doc.path)).collect()
}

/// Returns the keys that lead to an item, without the first one.
fn place_of(doc: &Doc) -> String {
    let place = doc.path.to_string();
    place.split_once('.').map_or(place.clone(), |(_, inner)| inner.to_owned())
}

/// Tests whether the spec says more of an item than where it stands.
pub fn is_remarked(doc: &Doc) -> bool {
    doc.title.is_some() || doc.note.is_some() || !doc.errata.is_empty()
}

fn is_known(doc: &Doc) -> bool {
    doc.section.is_some() || is_remarked(doc)
}
