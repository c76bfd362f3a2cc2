//! A table of the frames of a message: who sends each, and what its identifier and its first bytes show.

use std::collections::HashSet;
use std::io::{self, Write};

use canspec_codegen::model::{
    AddressPattern, FieldId, FrameLayout, IdentifierField, LongMessage, Message, Protocol, SelectorId, SelectorPlace,
    Travel,
};

use super::words;
use crate::show::columns::{self, Row};

/// Writes the table, if the message has frames of its own.
pub fn write(out: &mut impl Write, protocol: &Protocol, message: &Message) -> io::Result<()> {
    let of_long = protocol.long_message(message).map_or(&[][..], |(_, long): (_, &LongMessage)| &long.frames);
    let is_long = |frame: &FrameLayout| of_long.iter().any(|known| known.is_kind_of(frame));
    let frames = of_long.iter().chain(protocol.frames_of(message).filter(|frame| !is_long(frame)));
    let mut rows: Vec<Row> = frames.flat_map(|frame| rows(protocol, frame, frame.kind.name())).collect();
    rows.extend(message.refusals.iter().flat_map(|frame| self::rows(protocol, frame, "refusal")));
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out)?;
    columns::write(out, &["FRAME", "FROM", "MODE", "ANSWERS", "LENGTH"], "IDENTIFIER AND CONTENT", &rows)
}

/// Returns a row for each addressing mode of a frame.
fn rows(protocol: &Protocol, frame: &FrameLayout, kind: &str) -> Vec<Row> {
    let travels = frame.travels.iter().filter_map(|travel| {
        let pattern = protocol[travel.mode].pattern(frame.is_to_module(), travel.who)?;
        Some((*travel, pattern))
    });
    travels.map(|(travel, pattern)| row(protocol, frame, kind, (travel, pattern))).collect()
}

fn row(protocol: &Protocol, frame: &FrameLayout, kind: &str, (travel, pattern): (Travel, &AddressPattern)) -> Row {
    let set = frame.set.map_or(String::new(), |set| format!(" in {}", protocol[set].name));
    let cells = vec![
        format!("{} {kind}{set}", protocol[frame.access].name),
        protocol.sides.name(frame.sender).to_owned(),
        protocol[travel.mode].name.clone(),
        words::who(travel.who).to_owned(),
        lengths(&frame.lengths),
    ];
    let mut last = shown(protocol, frame, pattern);
    last.extend(selectors(protocol, frame));
    last.extend(fields(protocol, frame));
    Row { cells, last, separator: ", ", ..Row::default() }
}

/// Names the fields that a frame carries.
fn fields(protocol: &Protocol, frame: &FrameLayout) -> Vec<String> {
    let content = protocol.content_of(frame);
    let mut names: Vec<_> =
        protocol.signals_of(frame).map(|(_, signal)| content.field_name(signal).to_owned()).collect();
    let mut seen = HashSet::new();
    names.retain(|name| seen.insert(name.clone()));
    names
}

/// Writes numbers of data bytes.
pub fn lengths(lengths: &[u8]) -> String {
    lengths.iter().map(u8::to_string).collect::<Vec<_>>().join(" or ")
}

/// Returns the bits of the identifier that each frame has in an addressing mode, and their values.
pub fn identifier(protocol: &Protocol, frame: &FrameLayout, pattern: &AddressPattern) -> (u32, u32) {
    let constants = frame.constants.iter().filter_map(|constant| {
        let (field, _) = constant.in_identifier()?;
        let open = u32::try_from(constant.open).unwrap_or(0);
        Some(protocol[field].mask() & !(open << protocol[field].shift))
    });
    let mask = constants.fold(protocol.identifier.mask | pattern.mask, |mask, constant| mask | constant);
    (mask, protocol.base_identifier(frame, pattern) & mask)
}

/// Says what the fields of the identifier show that are not always the same.
fn shown(protocol: &Protocol, frame: &FrameLayout, pattern: &AddressPattern) -> Vec<String> {
    let (mask, value) = identifier(protocol, frame, pattern);
    let fields = protocol.identifier.fields.entries().filter(|(_, field)| field.constant.is_none());
    fields.filter_map(|(id, field)| in_field((id, field), protocol, frame, pattern, (mask, value))).collect()
}

fn in_field(
    (id, field): (FieldId, &IdentifierField),
    protocol: &Protocol,
    frame: &FrameLayout,
    pattern: &AddressPattern,
    (mask, value): (u32, u32),
) -> Option<String> {
    if let Some(address) = pattern.addresses.iter().find(|address| address.field == id) {
        return Some(format!("{} = {}", field.name, protocol[address.address_type].name));
    }
    let is_here = |place: SelectorPlace| place == SelectorPlace::Identifier(id);
    if let Some(constant) = frame.constants.iter().find(|constant| is_here(constant.place)) {
        let values: Vec<_> = constant.values().map(|value| protocol.selector_value(constant.selector, value)).collect();
        return Some(format!("{} = {}", field.name, values.join(" or ")));
    }
    let digits = usize::from(field.width.div_ceil(4));
    let is_fixed = mask & field.mask() == field.mask();
    is_fixed.then(|| format!("{} = 0x{:0digits$X}", field.name, field.get(value)))
}

/// Names the fields of the data bytes that choose the message, with their values.
fn selectors(protocol: &Protocol, frame: &FrameLayout) -> Vec<String> {
    let value = |selector: SelectorId| {
        let constant = frame.constants.iter().find(|constant| constant.selector == selector)?;
        let values: Vec<_> = constant.values().map(|value| protocol.selector_value(selector, value)).collect();
        Some(format!(" = {}", values.join(" or ")))
    };
    let named = |selector: SelectorId| format!("{}{}", protocol[selector].name, value(selector).unwrap_or_default());
    frame.selectors.iter().map(|selector| named(*selector)).collect()
}
