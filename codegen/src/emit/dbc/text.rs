//! Texts of a DBC, in ASCII, since no two tools agree on another encoding.

use std::ops::RangeInclusive;

use crate::model::{Doc, Protocol, Unit};

/// Returns a text in the characters that every tool reads alike.
pub fn ascii(text: &str) -> String {
    let plain = text.chars().map(|letter| match letter {
        '"' => "'".to_owned(),
        '\\' => "/".to_owned(),
        '°' => "deg".to_owned(),
        '–' | '—' => "-".to_owned(),
        '×' => "x".to_owned(),
        'µ' | 'μ' => "u".to_owned(),
        'Ω' => "ohm".to_owned(),
        letter if letter.is_ascii() => letter.into(),
        _ => String::new(),
    });
    plain.collect::<String>().trim().to_owned()
}

/// Returns the symbol of a unit.
pub fn unit(unit: Unit) -> &'static str {
    if unit.symbol.is_ascii() { unit.symbol } else { "degC" }
}

/// Returns what the spec says beside an item.
pub fn remarks(doc: &Doc) -> String {
    let section = doc.section.as_ref().map(|section| format!("section {section}"));
    let parts = [doc.title.clone(), doc.note.clone(), section];
    parts.iter().flatten().map(|text| ascii(text)).collect::<Vec<_>>().join("; ")
}

/// Returns the comment of the whole file.
pub fn header(protocol: &Protocol, mask: u32, losses: &[String]) -> String {
    let document = &protocol.document;
    let printed = [Some(&document.title), Some(&document.version), document.date.as_ref(), document.file.as_ref()];
    let printed: Vec<_> = printed.into_iter().flatten().map(|text| ascii(text)).collect();
    let mut lines = vec![
        format!("{}: {}", protocol.name, ascii(&protocol.title)),
        format!("Document: {}", printed.join(", ")),
        format!("Made by canspec from {}", ascii(&protocol.file)),
        format!("Frame-id mask: {mask:#010X}. Compare only these bits of an identifier; the other ones vary"),
    ];
    if !losses.is_empty() {
        lines.push("What a DBC cannot say:".to_owned());
        lines.extend(losses.iter().map(|loss| format!("- {loss}")));
    }
    lines.join("\n")
}

/// Who sends frames towards a module.
pub const CONTROLLER: &str = "controller";

/// Returns the name of a module, or of all.
pub fn module(node: Option<i64>) -> String {
    node.map_or_else(|| "module".to_owned(), |node| format!("module_{node}"))
}

/// Returns everybody on the bus.
pub fn nodes(nodes: Option<RangeInclusive<i64>>) -> Vec<String> {
    let modules = nodes.into_iter().flatten().map(|node| module(Some(node)));
    [CONTROLLER.to_owned(), module(None)].into_iter().chain(modules).collect()
}
