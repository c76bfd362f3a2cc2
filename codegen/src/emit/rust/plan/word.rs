//! Named values, status words and packed values.

use proc_macro2::{Ident, Literal, TokenStream};

use super::doc::{self, Comment};
use super::encoding::Part;
use super::limits::Limits;
use super::literal::{decimal, hexadecimal};
use super::naming::{ident, screaming, variants};
use super::place::Written;
use super::raw::integer;
use super::types::Types;
use crate::model::{self, Message, ModelId, NamedValue, Numeral, PartId, Protocol, Severity, Signal, Table};
use crate::words::text::code;

/// Named values.
pub struct Enumeration {
    /// The type.
    pub name: Ident,
    /// Comment of the type.
    pub comment: Comment,
    /// Type of the raw value.
    pub raw: TokenStream,
    /// The values that have names.
    pub values: Vec<Value>,
    /// Variant of the other values.
    pub unknown: Ident,
}

/// A value with a name.
pub struct Value {
    /// Its variant.
    pub variant: Ident,
    /// Comment of the variant.
    pub comment: Comment,
    /// The raw value.
    pub raw: TokenStream,
    /// The name in the spec.
    pub name: String,
}

impl Enumeration {
    /// Plans all named values.
    pub fn all(protocol: &Protocol, types: &Types) -> Vec<Self> {
        let known = protocol.enumerations.iter().zip(&types.enumerations);
        known.map(|(known, name)| Self::new(protocol, name, known)).collect()
    }

    fn new(protocol: &Protocol, name: &Ident, known: &model::Enumeration) -> Self {
        let sentence = doc::sentence_of(&doc::title(&known.doc, &known.name));
        let (variants, unknown) = variants(known.values.iter().map(|value| value.name.as_str()));
        let values = known.values.iter().zip(variants).map(|(value, variant)| Value {
            variant,
            comment: Comment::line(described(protocol, value)),
            raw: decimal(value.raw),
            name: value.name.clone(),
        });
        Self {
            name: name.clone(),
            comment: Comment::item(protocol, &known.doc, &sentence, None),
            raw: integer(known.width, Numeral::Unsigned),
            values: values.collect(),
            unknown,
        }
    }
}

/// Says what a named value is.
fn described(protocol: &Protocol, value: &NamedValue) -> String {
    let (raw, name, only) = (value.raw, &value.name, only(protocol, &value.models));
    match &value.title {
        Some(title) => doc::sentence_of(&format!("{}: {raw}, `{name}`{only}", title.in_rust_doc())),
        None => format!("{raw}: `{name}`{only}."),
    }
}

/// A status word.
pub struct StatusWord {
    /// The type.
    pub name: Ident,
    /// Comment of the type.
    pub comment: Comment,
    /// Type of the raw value.
    pub raw: TokenStream,
    /// The bits that have names.
    pub bits: Vec<StatusBit>,
}

/// A bit of a status word.
pub struct StatusBit {
    /// Its constant.
    pub constant: Ident,
    /// Comment of the constant.
    pub comment: Comment,
    /// The word with only this bit set.
    pub mask: TokenStream,
    /// The function that makes its row of the legend.
    pub constructor: Ident,
    /// Its number.
    pub number: Literal,
    /// The name in the spec.
    pub name: String,
    /// Its title.
    pub title: String,
}

impl StatusWord {
    /// Plans all status words.
    pub fn all(protocol: &Protocol, types: &Types) -> Vec<Self> {
        let known = protocol.status_words.iter().zip(&types.status_words);
        known.map(|(known, name)| Self::new(protocol, name, known)).collect()
    }

    fn new(protocol: &Protocol, name: &Ident, word: &model::StatusWord) -> Self {
        let sentence = doc::sentence_of(&doc::title(&word.doc, &word.name));
        Self {
            name: name.clone(),
            comment: Comment::item(protocol, &word.doc, &sentence, None),
            raw: integer(word.width, Numeral::Unsigned),
            bits: word.bits.iter().map(|bit| StatusBit::new(protocol, word, bit)).collect(),
        }
    }
}

impl StatusBit {
    fn new(protocol: &Protocol, word: &model::StatusWord, bit: &model::StatusBit) -> Self {
        Self {
            constant: screaming(&bit.name),
            comment: Comment::item(protocol, &bit.doc, &bit_sentence(protocol, bit), Some(&word.doc)),
            mask: hexadecimal(1_u64 << bit.bit, word.width.next_power_of_two().max(8)),
            constructor: ident(bit.severity.map_or("new", severity_name)),
            number: Literal::u8_unsuffixed(bit.bit),
            name: bit.name.clone(),
            title: doc::plain_title(&bit.doc, &bit.name),
        }
    }
}

fn bit_sentence(protocol: &Protocol, bit: &model::StatusBit) -> String {
    let only = only(protocol, &bit.models);
    let severity = bit.severity.map_or_else(String::new, |severity| format!(", {}", severity_name(severity)));
    let title = doc::title(&bit.doc, &bit.name);
    let remarks =
        [("Set when", &bit.set_when), ("Cleared when", &bit.clear_when), ("Effect:", &bit.effect), ("LED:", &bit.led)];
    let remarks =
        remarks.into_iter().filter_map(|(word, remark)| Some(format!("{word} {}", remark.as_ref()?.in_rust_doc())));
    let sentences = std::iter::once(format!("{title}: bit {}{severity}{only}", bit.bit)).chain(remarks);
    sentences.map(|text| doc::sentence_of(&text)).collect::<Vec<_>>().join(" ")
}

/// Names the only device models that have a bit or a value.
pub fn only(protocol: &Protocol, models: &[ModelId]) -> String {
    let names: Vec<_> = models.iter().map(|model| format!("`{}`", protocol[*model].name)).collect();
    if names.is_empty() { String::new() } else { format!(", only on {}", names.join(" and ")) }
}

fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::State => "state",
        Severity::Alarm => "alarm",
        Severity::Fault => "fault",
    }
}

/// A packed value.
pub struct Packed {
    /// The type.
    pub name: Ident,
    /// Comment of the type.
    pub comment: Comment,
    /// How many bytes it has.
    pub bytes: Literal,
    /// Its parts.
    pub parts: Vec<PackedPart>,
    /// The pieces of its text.
    pub pieces: Vec<Piece>,
}

/// A part of a packed value.
pub struct PackedPart {
    /// Member of the struct.
    pub member: Ident,
    /// Comment of the member.
    pub comment: Comment,
    /// Type of the member.
    pub kind: TokenStream,
    /// Constant of the place.
    pub constant: Ident,
    /// The place, counted from the first byte of the value.
    pub place: Written,
}

/// A piece of a packed value's text.
pub enum Piece {
    /// A text that stands as it is.
    Literal(String),
    /// The text of the part at this place.
    Text(Ident),
    /// The number of the part at this place.
    Number {
        /// Constant of the place.
        place: Ident,
        /// Type of the raw value.
        kind: TokenStream,
        /// To how many digits it is filled with zeros.
        digits: Option<Literal>,
        /// Its lowest and highest value.
        limits: Option<(TokenStream, TokenStream)>,
    },
}

impl Packed {
    /// Plans all packed values.
    pub fn all(protocol: &Protocol, types: &Types) -> Vec<Self> {
        let messages = protocol.messages.iter().zip(&types.packed);
        let signals = messages.flat_map(|(message, names)| {
            message.signals.iter().zip(names).map(move |(signal, name)| (message, signal, name))
        });
        signals.filter_map(|(message, signal, name)| Self::new(protocol, name.as_ref()?, message, signal)).collect()
    }

    fn new(protocol: &Protocol, name: &Ident, message: &Message, signal: &Signal) -> Option<Self> {
        let (pieces, parts) = signal.encoding.packed()?;
        let titled = if signal.doc.title.is_some() { &signal.doc } else { &message.doc };
        let sentence = doc::sentence_of(&doc::title(titled, &signal.name));
        Some(Self {
            name: name.clone(),
            comment: Comment::line(format!("{sentence} Written as {}.", code(&format(pieces, parts)))),
            bytes: Literal::u8_unsuffixed(signal.place.width() / 8),
            parts: parts.iter().map(|part| PackedPart::new(protocol, part, signal)).collect(),
            pieces: pieces.iter().map(|piece| Piece::new(piece, parts)).collect(),
        })
    }
}

/// Writes the form of the text as in the spec.
fn format(pieces: &[model::Piece], parts: &Table<PartId, Signal>) -> String {
    let piece = |piece: &model::Piece| match piece {
        model::Piece::Literal(literal) => literal.clone(),
        model::Piece::Part { part, digits: None } => format!("{{{}}}", parts[*part].name),
        model::Piece::Part { part, digits: Some(digits) } => format!("{{{}:{digits}}}", parts[*part].name),
    };
    pieces.iter().map(piece).collect()
}

impl PackedPart {
    fn new(protocol: &Protocol, part: &Signal, signal: &Signal) -> Self {
        let title = doc::title(&part.doc, &part.name);
        let range = part.range.map_or_else(String::new, |range| format!(", `{}..={}`", range.minimum, range.maximum));
        let sentence = doc::sentence_of(&format!("{title}: {}{range}", Written::new(part.place).text()));
        let (Part::Number(kind) | Part::Text(kind)) = Part::new(part);
        Self {
            member: ident(&part.name),
            comment: Comment::item(protocol, &part.doc, &sentence, Some(&signal.doc)),
            kind,
            constant: screaming(&part.name),
            place: Written::new(part.place).counted_from(signal.start().into()),
        }
    }
}

impl Piece {
    fn new(piece: &model::Piece, parts: &Table<PartId, Signal>) -> Self {
        let (part, digits) = match piece {
            model::Piece::Literal(literal) => return Self::Literal(literal.clone()),
            model::Piece::Part { part, digits } => (&parts[*part], *digits),
        };
        let place = screaming(&part.name);
        let limits = part.range.map(|range| Limits::Raw.range(part, range));
        let limits = limits.map(|range| (decimal(range.minimum.numerator()), decimal(range.maximum.numerator())));
        match Part::new(part) {
            Part::Text(_) => Self::Text(place),
            Part::Number(kind) => Self::Number { place, kind, digits: digits.map(Literal::usize_unsuffixed), limits },
        }
    }
}
