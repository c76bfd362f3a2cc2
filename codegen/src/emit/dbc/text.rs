//! Texts of a DBC.

use std::ops::RangeInclusive;

use crate::model::{Doc, Document, Protocol, Sides, Unit};
use crate::words::text::Text;

/// Returns the symbol of a unit, in ASCII.
pub fn unit(unit: Unit) -> String {
    match &*unit.symbol {
        "°C" => "degC".to_owned(),
        "Ω" => "Ohm".to_owned(),
        symbol => Text::new(symbol).in_dbc(),
    }
}

/// Returns what the spec says beside an item.
pub fn remarks(doc: &Doc) -> String {
    let section = doc.section.as_ref().map(|section| format!("section {}", section.in_dbc()));
    shown([&doc.title, &doc.note].into_iter().flatten()).chain(section).collect::<Vec<_>>().join("; ")
}

/// Writes the texts that are not blank in ASCII.
fn shown<'a>(texts: impl Iterator<Item = &'a Text>) -> impl Iterator<Item = String> {
    texts.map(Text::in_dbc).filter(|text| !text.is_empty())
}

/// Returns the comment of the whole file.
pub fn header(protocol: &Protocol, mask: u32, losses: &[String]) -> String {
    let mut lines = vec![format!("{}: {}", protocol.name, protocol.title.in_dbc())];
    lines.extend(protocol.documents.iter().map(document));
    lines.extend([
        format!("Made by canspec from {}", protocol.file.in_dbc()),
        format!("Frame-id mask: {mask:#010X}. Compare only these bits of an identifier; the other ones vary"),
    ]);
    lines.extend(protocol.sides.sentence());
    if !losses.is_empty() {
        lines.push("What a DBC cannot say:".to_owned());
        lines.extend(losses.iter().map(|loss| format!("- {loss}")));
    }
    lines.join("\n")
}

/// Says which document it is.
fn document(document: &Document) -> String {
    let Document { name, title, version, date, file } = document;
    let printed = shown([Some(title), Some(version), date.as_ref(), file.as_ref()].into_iter().flatten());
    let name = name.as_ref().map_or(String::new(), |name| format!(" {name}"));
    format!("Document{name}: {}", printed.collect::<Vec<_>>().join(", "))
}

/// Returns the name of a module, or of all.
pub fn module(sides: &Sides, node: Option<i64>) -> String {
    let name = &sides.module;
    node.map_or_else(|| name.clone(), |node| format!("{name}_{node}"))
}

/// Returns everybody on the bus.
pub fn nodes(sides: &Sides, nodes: Option<RangeInclusive<i64>>) -> Vec<String> {
    let modules = nodes.into_iter().flatten().map(|node| module(sides, Some(node)));
    [sides.controller.clone(), module(sides, None)].into_iter().chain(modules).collect()
}
