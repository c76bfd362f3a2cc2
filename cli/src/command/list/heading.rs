//! What stands above the messages of a protocol.

use std::io::{self, Write};

use canspec_codegen::model::{Document, IdentifierField, Protocol};

use super::derivation;
use crate::show::columns::text;

/// Writes what is true of all messages: documents, sides, bit rates, and the fields of the identifier.
pub fn write(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    text(out, &format!("{}: {}", protocol.name, protocol.title.for_people()))?;
    protocol.documents.iter().try_for_each(|known| text(out, &document(known)))?;
    protocol.sides.sentence().map_or(Ok(()), |sentence| text(out, &sentence))?;
    derivation::write(out, protocol)?;
    if !protocol.bit_rates.is_empty() {
        text(out, &format!("Bit rate: {} kbit/s.", bit_rates(&protocol.bit_rates)))?;
    }
    text(out, &identifier(protocol))
}

/// Writes bit rates in kbit/s.
pub fn bit_rates(rates: &[u32]) -> String {
    let rate = |rate: &u32| match rate % 1000 {
        0 => (rate / 1000).to_string(),
        rest => format!("{}.{}", rate / 1000, format!("{rest:03}").trim_end_matches('0')),
    };
    rates.iter().map(rate).collect::<Vec<_>>().join(", ")
}

fn document(document: &Document) -> String {
    let date = document.date.as_ref().map_or(String::new(), |date| format!(", {}", date.for_people()));
    let name = document.name.as_ref().map_or(String::new(), |name| format!("{name}: "));
    format!("{name}{}, {}{date}", document.title.for_people(), document.version.for_people())
}

/// Names the fields of the identifier with their bits.
fn identifier(protocol: &Protocol) -> String {
    let bits = if protocol.identifier.extended { 29 } else { 11 };
    let fields: Vec<_> = protocol.identifier.fields.iter().map(field).collect();
    format!("Identifier of {bits} bits: {}.", fields.join(", "))
}

fn field(field: &IdentifierField) -> String {
    let constant = field.constant.map_or(String::new(), |value| format!(" = {value:#X}"));
    format!("{} {}{constant}", bits(field), field.name)
}

/// Writes the bits of a field of the identifier.
pub fn bits(field: &IdentifierField) -> String {
    let (high, low) = (field.shift + field.width - 1, field.shift);
    if high == low { high.to_string() } else { format!("{high}..{low}") }
}
