//! What stands above the messages of a protocol.

use std::io::{self, Write};

use canspec_codegen::model::{Document, Identifier, IdentifierField, Protocol};

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
    let fields = protocol.identifier.fields.iter().map(|known| (known.shift, field(known)));
    let nameless = nameless(&protocol.identifier).into_iter();
    let nameless = nameless.map(|(low, high, value)| (low, format!("{} always {value}", span(low, high))));
    let mut all: Vec<_> = fields.chain(nameless).collect();
    all.sort_by_key(|(low, _)| std::cmp::Reverse(*low));
    let all: Vec<_> = all.into_iter().map(|(_, text)| text).collect();
    format!("Identifier of {bits} bits: {}.", all.join(", "))
}

/// Returns the bits that nothing names and that never change: the least and the most significant one, and their value.
pub fn nameless(identifier: &Identifier) -> Vec<(u8, u8, u8)> {
    let named = identifier.fields.iter().fold(0, |named, field| named | field.mask());
    let mut all: Vec<(u8, u8, u8)> = Vec::new();
    for bit in (0..29).filter(|bit| (identifier.mask & !named) >> bit & 1 == 1) {
        let value = u8::from(identifier.value >> bit & 1 == 1);
        match all.last_mut().filter(|(_, high, last)| high + 1 == bit && *last == value) {
            Some((_, high, _)) => *high = bit,
            None => all.push((bit, bit, value)),
        }
    }
    all
}

fn field(field: &IdentifierField) -> String {
    let constant = field.constant.map_or(String::new(), |value| format!(" = {value:#X}"));
    format!("{} {}{constant}", bits(field), field.name)
}

/// Writes the bits of a field of the identifier.
pub fn bits(field: &IdentifierField) -> String {
    span(field.shift, field.shift + field.width - 1)
}

/// Writes bits as a spec does.
pub fn span(low: u8, high: u8) -> String {
    if high == low { high.to_string() } else { format!("{high}..{low}") }
}
