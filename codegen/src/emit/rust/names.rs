//! Rust names for the names of a spec; two items never get the same one.

use proc_macro2::{Ident, Span};

use super::exchange::{Shared, shared};
use super::model::{Limits, limits};
use super::set::exchange_name;
use crate::model::{
    Encoding, EnumerationId, ExchangeId, FrameId, FrameLayout, Kind, Message, MessageId, ModeId, ModelId, Protocol,
    Signal, SignalId, StatusWordId, Table,
};

/// Types that generated code takes from the runtime or the prelude, or that every module has.
const TAKEN: [&str; 75] = [
    "Address",
    "AddressType",
    "Addressing",
    "AnySignal",
    "Bits",
    "Clone",
    "Continuation",
    "Copy",
    "Data",
    "Debug",
    "Decode",
    "Default",
    "Destination",
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
    "None",
    "Number",
    "Ok",
    "Option",
    "PartialEq",
    "PackedText",
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
    "Some",
    "StatusBit",
    "String",
    "Sync",
    "Target",
    "Task",
    "Text",
    "Who",
    "Within",
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
pub fn model_variants(protocol: &Protocol) -> Table<ModelId, Ident> {
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
    pub enumerations: Table<EnumerationId, Ident>,
    pub status_words: Table<StatusWordId, Ident>,
    pub messages: Table<MessageId, MessageNames>,
    /// Variants of `Message`.
    pub variants: Table<FrameId, Ident>,
    /// Variants of `Target`.
    pub targets: Table<ModeId, Ident>,
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
    pub constants: Table<SignalId, Ident>,
    /// Fields of the signals.
    pub fields: Table<SignalId, Ident>,
    /// Types of the packed values.
    pub packed: Table<SignalId, Option<Ident>>,
    /// Constants of the exchanges.
    pub exchanges: Table<ExchangeId, Ident>,
    /// Methods that build requests.
    pub methods: Table<ExchangeId, Ident>,
}

/// A struct and the signals it has.
pub struct Struct {
    pub name: Ident,
    pub signals: Vec<SignalId>,
}

impl MessageNames {
    /// Returns the struct that a kind of frame carries.
    pub fn carried(&self, frame: &FrameLayout) -> Option<&Struct> {
        self.structs.iter().find(|known| known.signals == frame.signals).filter(|known| !known.signals.is_empty())
    }
}

impl Names {
    pub fn new(protocol: &Protocol) -> Self {
        let mut types = Pool::new(&TAKEN);
        let structs: Vec<_> = protocol.messages.iter().map(|message| structs(protocol, message, &mut types)).collect();
        let mut named = |name: &str, suffix| types.take(camel_case(name), suffix);
        let enumerations = protocol.enumerations.iter().map(|known| named(&known.name, "Value")).collect();
        let status_words = protocol.status_words.iter().map(|word| named(&word.name, "Word")).collect();
        let mut variants = Pool::default();
        variants.taken.extend(structs.iter().flatten().map(|known| known.name.to_string()));
        let messages = protocol.messages.iter().zip(structs);
        let messages = messages.map(|(message, structs)| message_names(protocol, message, structs, &mut types));
        let messages: Table<MessageId, MessageNames> = messages.collect();
        let frames = protocol.frames.iter();
        let variants = frames.map(|frame| variant(protocol, &messages[frame.message], frame, &mut variants)).collect();
        Self {
            enumerations,
            status_words,
            messages,
            variants,
            targets: targets(protocol),
            limits: limits(protocol),
            shared: shared(protocol),
        }
    }
}

/// Names a struct for each set of signals, the largest first; a message without signals has an empty struct.
fn structs(protocol: &Protocol, message: &Message, types: &mut Pool) -> Vec<Struct> {
    let mut sets: Vec<&FrameLayout> = Vec::new();
    for frame in protocol.frames_of(message) {
        if !frame.signals.is_empty() && !sets.iter().any(|known| known.signals == frame.signals) {
            sets.push(frame);
        }
    }
    sets.sort_by_key(|frame| std::cmp::Reverse(frame.signals.len()));
    let first = sets.first().map(|frame| frame.signals.clone()).unwrap_or_default();
    let own = Struct { name: types.take(camel_case(&message.name), "Message"), signals: first };
    let others = sets.iter().skip(1).map(|frame| {
        let name = format!("{}{}", camel_case(&message.name), camel_case(frame.kind.name()));
        Struct { name: types.take(name, "Message"), signals: frame.signals.clone() }
    });
    std::iter::once(own).chain(others).collect()
}

fn message_names(protocol: &Protocol, message: &Message, structs: Vec<Struct>, types: &mut Pool) -> MessageNames {
    let (mut members, mut fields) = (Pool::new(&OF_MESSAGES), Pool::default());
    let constants =
        message.signals.iter().map(|signal| members.take(signal.name.to_ascii_uppercase(), "_SIGNAL")).collect();
    let fields = message.signals.iter().map(|signal| fields.take(member(signal), "_")).collect();
    let packed = message.signals.iter().map(|signal| packed(message, signal, types)).collect();
    let ways = message.exchanges.iter();
    let ways = ways.map(|exchange| exchange_name(protocol, &protocol[exchange.access].name, exchange.set));
    let exchanges = ways.clone().map(|way| members.take(way.to_ascii_uppercase(), "_EXCHANGE")).collect();
    let methods = ways.map(|way| members.take(way, "_request")).collect();
    MessageNames { structs, constants, fields, packed, exchanges, methods }
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
fn variant(protocol: &Protocol, names: &MessageNames, frame: &FrameLayout, variants: &mut Pool) -> Ident {
    if let Some(carried) = names.carried(frame) {
        return carried.name.clone();
    }
    let access = camel_case(&protocol[frame.access].name);
    let message = camel_case(&protocol[frame.message].name);
    let name = match frame.kind {
        Kind::Request => format!("{access}{message}"),
        kind @ (Kind::Reply | Kind::Report) => format!("{message}{access}{}", camel_case(kind.name())),
    };
    variants.take(name, "Frame")
}

fn targets(protocol: &Protocol) -> Table<ModeId, Ident> {
    let mut variants = Pool::default();
    protocol.modes.map(|mode| variants.take(camel_case(protocol.target_name(mode)), "Mode"))
}
