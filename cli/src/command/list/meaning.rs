//! What the bits of a signal mean.

use canspec_codegen::model::{
    Encoding, ModelId, NamedValue, Numeral, OfModel, Piece, Protocol, Range, Signal, StatusBit, TextForm, only,
};
use canspec_codegen::number::Rational;

use super::words;
use crate::show::severity::Severity;

/// Returns limits and number format of a signal.
pub fn number(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    let mut items: Vec<String> = signal.range.map(limits).into_iter().collect();
    let has_own = !signal.model_ranges.is_empty() && signal.encoding.by_model().is_empty();
    items.extend(has_own.then(|| "limits by model".to_owned()));
    items.extend(form(protocol, &signal.encoding));
    items.extend(only(&protocol.models, &signal.models));
    items
}

/// Returns the named values and status bits of a signal, each in one item.
pub fn names(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    let bits = status_bits(protocol, signal).map(|bit| {
        let severity = Severity::of(bit).map_or(String::new(), |severity| format!(" ({})", severity.word()));
        format!("{} {}{severity}{}", number_of(signal, bit), bit.name, of_some(protocol, &bit.models))
    });
    bits.chain(values(protocol, signal)).collect()
}

/// Returns the number of a status bit as the spec counts it: in the word, or in its byte.
pub fn number_of(signal: &Signal, bit: &StatusBit) -> String {
    match signal.byte_of(bit) {
        Some((byte, number)) => format!("byte {byte} bit {number}"),
        None => format!("bit {}", bit.bit),
    }
}

/// Returns the status bits that a signal has.
pub fn status_bits<'a>(protocol: &'a Protocol, signal: &Signal) -> impl Iterator<Item = &'a StatusBit> + use<'a> {
    let place = signal.place;
    signal.encoding.status_word().into_iter().flat_map(move |word| protocol[word].bits_in(place))
}

/// Returns the named values of a signal, also those beside a number.
pub fn values(protocol: &Protocol, signal: &Signal) -> Vec<String> {
    let known = protocol.named_values(signal);
    let digits = usize::from(signal.place.width().div_ceil(4));
    let is_hexadecimal = signal.encoding.enumeration().is_some() && known.iter().any(|value| value.raw > 9);
    let shown = |value: &NamedValue| {
        let text = value.text(&protocol.models);
        if is_hexadecimal { format!("0x{:0digits$X} = {text}", value.raw) } else { format!("{} = {text}", value.raw) }
    };
    known.iter().map(shown).collect()
}

/// Returns the name of the value that says that there is none.
pub fn absent<'a>(protocol: &'a Protocol, signal: &'a Signal) -> Option<&'a str> {
    let named = signal.encoding.enumeration().and_then(|known| protocol[known].absent());
    named.or_else(|| signal.absent()).map(|value| value.name.as_str())
}

/// Writes what a raw value stands for.
pub fn raw(protocol: &Protocol, signal: &Signal, raw: i128) -> String {
    if let Some(known) = protocol.named_values(signal).iter().find(|known| known.raw == raw) {
        return known.name.clone();
    }
    match signal.encoding.value_of(raw).filter(|_| signal.encoding.by_model().is_empty()) {
        Some(value) => format!("{value}{}", signal.unit_text()),
        None => format!("raw {raw}"),
    }
}

/// Names the only device models that have an item, behind it.
pub fn of_some(protocol: &Protocol, models: &[ModelId]) -> String {
    only(&protocol.models, models).map_or(String::new(), |only| format!(" ({only})"))
}

/// Writes both ends of limits.
pub fn limits(range: Range) -> String {
    format!("{}..{}", range.minimum, range.maximum)
}

/// Says how bits are a number or a text. Named values and status words have their names.
fn form(protocol: &Protocol, encoding: &Encoding) -> Vec<String> {
    match encoding {
        Encoding::Number { numeral, scale, offset } => linear(*numeral, *scale, *offset),
        Encoding::ByModel { numeral, signals } => {
            let own = signals.iter().map(|own| of_model(protocol, own));
            numeral_word(*numeral).into_iter().chain(own).collect()
        }
        Encoding::Float | Encoding::Text(TextForm::Ascii { fill: 0 } | TextForm::Hexadecimal) => {
            vec![words::encoding(encoding).to_owned()]
        }
        Encoding::Text(TextForm::Ascii { fill }) => vec![format!("text, filled with {fill:#04X}")],
        Encoding::Packed { .. } => format(encoding).into_iter().collect(),
        Encoding::Named(_) | Encoding::Status(_) => Vec::new(),
    }
}

fn linear(numeral: Numeral, scale: Rational, offset: Rational) -> Vec<String> {
    let mut items: Vec<_> = numeral_word(numeral).into_iter().collect();
    items.extend((scale != Rational::ONE).then(|| format!("scale {scale}")));
    items.extend((offset != Rational::ZERO).then(|| format!("offset {offset}")));
    items
}

fn numeral_word(numeral: Numeral) -> Option<String> {
    match numeral {
        Numeral::Unsigned => None,
        Numeral::Signed => Some("signed".to_owned()),
        Numeral::Bcd => Some("bcd".to_owned()),
    }
}

/// Says what a number is on a device model.
fn of_model(protocol: &Protocol, own: &OfModel<Signal>) -> String {
    let Signal { encoding, range, .. } = &own.value;
    let unit = own.value.unit_text();
    let linear = encoding.linear();
    let scale = linear.map(|linear| format!("scale {}{unit}", linear.scale));
    let offset = linear.filter(|linear| linear.offset != Rational::ZERO);
    let offset = offset.map(|linear| format!("offset {}{unit}", linear.offset));
    let range = range.map(|range| format!("{}{unit}", limits(range)));
    let facts: Vec<_> = scale.into_iter().chain(offset).chain(range).collect();
    format!("{} on {}", facts.join(" and "), protocol[own.model].name)
}

/// Returns the format of a packed value as the spec has it.
pub fn format(encoding: &Encoding) -> Option<String> {
    let (pieces, parts) = encoding.packed()?;
    let piece = |piece: &Piece| match piece {
        Piece::Literal(text) => text.clone(),
        Piece::Part { part, digits: Some(digits) } => format!("{{{}:{digits}}}", parts[*part].name),
        Piece::Part { part, digits: None } => format!("{{{}}}", parts[*part].name),
    };
    Some(pieces.iter().map(piece).collect())
}
