//! Rust names for the names of a spec; two items never get the same one.

use proc_macro2::{Ident, Span};

use super::exchange::{Shared, shared};
use super::model::{Limits, limits};
use super::set::exchange_name;
use crate::model::{Encoding, Kind, Message, Protocol, Shape, Signal};

/// Types that generated code takes from the runtime or the prelude, or that every module has.
const TAKEN: [&str; 79] = [
    "Address",
    "AddressType",
    "Addressing",
    "AnySignal",
    "BitOr",
    "Bits",
    "Clone",
    "Continuation",
    "Copy",
    "Data",
    "Debug",
    "Decode",
    "Default",
    "Destination",
    "Display",
    "Drop",
    "Encode",
    "Entry",
    "Eq",
    "Err",
    "Error",
    "Exchange",
    "Failure",
    "Filter",
    "Fn",
    "Formatter",
    "Frame",
    "FrameSet",
    "From",
    "Hash",
    "Identifier",
    "IdentifierFields",
    "Into",
    "Iterator",
    "Kind",
    "Layout",
    "Legend",
    "Message",
    "Meaning",
    "Mode",
    "Model",
    "Named",
    "None",
    "Number",
    "Ok",
    "Option",
    "Packed",
    "PartialEq",
    "Pattern",
    "Payload",
    "Piece",
    "Place",
    "Problem",
    "Protocol",
    "Raw",
    "Reading",
    "Received",
    "Recognised",
    "Replies",
    "Reply",
    "Report",
    "Request",
    "Result",
    "Route",
    "Selector",
    "Self",
    "Send",
    "Severity",
    "Signal",
    "Single",
    "Some",
    "StatusBit",
    "StatusWord",
    "String",
    "Sync",
    "Target",
    "Text",
    "Who",
    "Word",
];

/// Methods and constants that every message has.
const OF_MESSAGES: [&str; 13] = [
    "RESERVED",
    "decode",
    "encode",
    "signals",
    "within",
    "clone",
    "eq",
    "hash",
    "fmt",
    "from",
    "into",
    "clone_from",
    "borrow",
];

/// Gives every name once.
#[derive(Default)]
struct Pool {
    taken: Vec<String>,
}

impl Pool {
    fn new(taken: &[&str]) -> Self {
        Self { taken: taken.iter().map(|name| (*name).to_owned()).collect() }
    }

    /// Takes a name, with the suffix if it is taken already, and with as many more as it needs.
    fn take(&mut self, name: String, suffix: &str) -> Ident {
        let mut name = name;
        while self.taken.contains(&name) {
            name.push_str(suffix);
        }
        self.taken.push(name.clone());
        ident(&name)
    }
}

/// Tests whether a name is a word of the language, so that nothing can be called so.
pub fn is_word_of_rust(name: &str) -> bool {
    syn::parse_str::<Ident>(name).is_err()
}

/// Makes an identifier; a word of the language becomes a raw identifier.
pub fn ident(name: &str) -> Ident {
    match syn::parse_str::<Ident>(name) {
        Ok(ident) => ident,
        Err(_) if matches!(name, "self" | "super" | "crate" | "Self" | "_") => {
            Ident::new(&format!("{name}_"), Span::call_site())
        }
        Err(_) => Ident::new_raw(name, Span::call_site()),
    }
}

/// Converts `set_output` to `SetOutput`.
pub fn camel_case(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(letters).collect::<String>()
    };
    name.split('_').map(capital).collect()
}

/// Names the variants of an enum, and the one that keeps values without a name.
pub fn variants<'a>(names: impl Iterator<Item = &'a str>) -> (Vec<Ident>, Ident) {
    let mut pool = Pool::default();
    let variants = names.map(|name| pool.take(camel_case(name), "_")).collect();
    (variants, pool.take("Unknown".to_owned(), "Value"))
}

/// Names a variant for each device model: `SM_750_30A` becomes `Sm750_30a`.
pub fn model_variants(protocol: &Protocol) -> Vec<Ident> {
    let mut variants = Pool::default();
    protocol.models.iter().map(|model| variants.take(model_variant(&model.name), "_")).collect()
}

/// Keeps `_` between two digits alone.
fn model_variant(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    words.fold(String::new(), |known, word| {
        let word = camel_case(&word.to_ascii_lowercase());
        let digits = known.ends_with(|last: char| last.is_ascii_digit())
            && word.starts_with(|first: char| first.is_ascii_digit());
        format!("{known}{}{word}", if digits { "_" } else { "" })
    })
}

/// Converts `set_output` to `SET_OUTPUT`.
pub fn screaming(name: &str) -> Ident {
    ident(&name.to_ascii_uppercase())
}

/// The names of a protocol's items.
pub struct Names {
    pub enumerations: Vec<Ident>,
    pub status_words: Vec<Ident>,
    pub messages: Vec<MessageNames>,
    /// Variants of `Target`, by mode.
    pub targets: Vec<Ident>,
    /// Limits by device model.
    pub limits: Vec<Limits>,
    /// What messages share of each access.
    pub shared: Vec<Shared>,
}

/// The names of a message's items.
pub struct MessageNames {
    /// The structs: one for each set of signals that some frame carries; the first one is the message's own.
    pub structs: Vec<Struct>,
    /// Constants of the signals.
    pub constants: Vec<Ident>,
    /// Fields of the signals.
    pub fields: Vec<Ident>,
    /// Types of the packed values, by signal.
    pub packed: Vec<Option<Ident>>,
    /// Constants of the exchanges.
    pub exchanges: Vec<Ident>,
    /// Methods that build requests, by access.
    pub methods: Vec<Ident>,
    /// Variants of `Message`, by shape.
    pub variants: Vec<Ident>,
}

/// A struct and the signals it has.
pub struct Struct {
    pub name: Ident,
    /// Indices into [`Message::signals`].
    pub signals: Vec<usize>,
}

impl MessageNames {
    /// Returns the struct that a kind of frame carries.
    pub fn carried(&self, shape: &Shape) -> Option<&Struct> {
        self.structs.iter().find(|known| known.signals == shape.signals).filter(|known| !known.signals.is_empty())
    }
}

impl Names {
    pub fn new(protocol: &Protocol) -> Self {
        let mut types = Pool::new(&TAKEN);
        let structs: Vec<_> = protocol.messages.iter().map(|message| structs(message, &mut types)).collect();
        let mut named = |name: &str, suffix| types.take(camel_case(name), suffix);
        let enumerations = protocol.enumerations.iter().map(|known| named(&known.name, "Value")).collect();
        let status_words = protocol.status_words.iter().map(|word| named(&word.name, "Word")).collect();
        let mut variants = Pool::default();
        variants.taken.extend(structs.iter().flatten().map(|known| known.name.to_string()));
        let messages = protocol.messages.iter().zip(structs);
        let messages =
            messages.map(|(message, structs)| message_names(protocol, message, structs, &mut types, &mut variants));
        Self {
            enumerations,
            status_words,
            messages: messages.collect(),
            targets: targets(protocol),
            limits: limits(protocol),
            shared: shared(protocol),
        }
    }
}

/// Names a struct for each set of signals, the largest first; a message without signals has an empty struct.
fn structs(message: &Message, types: &mut Pool) -> Vec<Struct> {
    let mut sets: Vec<&Shape> = Vec::new();
    for shape in &message.shapes {
        if !shape.signals.is_empty() && !sets.iter().any(|known| known.signals == shape.signals) {
            sets.push(shape);
        }
    }
    sets.sort_by_key(|shape| std::cmp::Reverse(shape.signals.len()));
    let first = sets.first().map(|shape| shape.signals.clone()).unwrap_or_default();
    let own = Struct { name: types.take(camel_case(&message.name), "Message"), signals: first };
    let others = sets.iter().skip(1).map(|shape| {
        let name = format!("{}{}", camel_case(&message.name), camel_case(shape.kind.name()));
        Struct { name: types.take(name, "Message"), signals: shape.signals.clone() }
    });
    std::iter::once(own).chain(others).collect()
}

fn message_names(
    protocol: &Protocol,
    message: &Message,
    structs: Vec<Struct>,
    types: &mut Pool,
    variants: &mut Pool,
) -> MessageNames {
    let (mut members, mut fields) = (Pool::new(&OF_MESSAGES), Pool::default());
    let constants =
        message.signals.iter().map(|signal| members.take(signal.name.to_ascii_uppercase(), "_SIGNAL")).collect();
    let fields = message.signals.iter().map(|signal| fields.take(member(signal), "_")).collect();
    let packed = message.signals.iter().map(|signal| packed(message, signal, types)).collect();
    let accesses = message.accesses.iter();
    let accesses = accesses.map(|access| exchange_name(protocol, &protocol.accesses[access.access].name, access.set));
    let exchanges = accesses.clone().map(|access| members.take(access.to_ascii_uppercase(), "_EXCHANGE")).collect();
    let methods = accesses.map(|access| members.take(access, "_request")).collect();
    let mut names = MessageNames { structs, constants, fields, packed, exchanges, methods, variants: Vec::new() };
    names.variants = message.shapes.iter().map(|shape| variant(protocol, message, &names, shape, variants)).collect();
    names
}

/// Names the member of a signal: with the unit behind it, if there is one.
pub fn member(signal: &Signal) -> String {
    signal.unit.map_or_else(|| signal.name.clone(), |unit| format!("{}_{}", signal.name, unit.suffix))
}

fn packed(message: &Message, signal: &Signal, types: &mut Pool) -> Option<Ident> {
    let name = if signal.name == "value" { message.name.clone() } else { format!("{}_{}", message.name, signal.name) };
    matches!(signal.encoding, Encoding::Packed { .. }).then(|| types.take(camel_case(&name), "Value"))
}

/// Names a variant after the struct it carries, else after the frame.
fn variant(protocol: &Protocol, message: &Message, names: &MessageNames, shape: &Shape, variants: &mut Pool) -> Ident {
    if let Some(carried) = names.carried(shape) {
        return carried.name.clone();
    }
    let access = camel_case(&protocol.accesses[message.accesses[shape.access].access].name);
    let message = camel_case(&message.name);
    let name = match shape.kind {
        Kind::Request => format!("{access}{message}"),
        kind => format!("{message}{access}{}", camel_case(kind.name())),
    };
    variants.take(name, "Frame")
}

fn targets(protocol: &Protocol) -> Vec<Ident> {
    let mut variants = Pool::default();
    let alone = |index: &usize| protocol.modes.iter().filter(|other| other.target == Some(*index)).count() == 1;
    let names = protocol.modes.iter().map(|mode| {
        let address = mode.target.filter(alone).map(|index| &protocol.address_types[index].name);
        variants.take(camel_case(address.unwrap_or(&mode.name)), "Mode")
    });
    names.collect()
}
