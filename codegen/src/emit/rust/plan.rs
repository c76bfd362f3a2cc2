//! The plan of generated Rust: every item with its names, types, comments and relations.

pub mod about;
pub mod address;
pub mod carrier;
pub mod comparison;
pub mod doc;
pub mod documented;
mod encoding;
pub mod exchange;
pub mod heading;
pub mod identifier;
mod limits;
pub mod literal;
pub mod long;
pub mod message;
pub mod models;
pub mod naming;
pub mod place;
pub mod quantity;
mod raw;
pub mod recognition;
pub mod request;
pub mod rows;
pub mod scales;
pub mod selector;
pub mod set;
pub mod signal;
pub mod timing;
pub mod transport;
mod types;
mod unit;
pub mod usage;
pub mod variant;
pub mod way;
pub mod word;

use proc_macro2::{Ident, TokenStream};
use quote::format_ident;

use crate::emit::Options;
use crate::model::{AfterSilence, LongMessageId, MessageId, Protocol, SelectorPlace, Table};
use about::About;
use address::{AddressType, Mode, Targets};
use carrier::Carrier;
use exchange::{Access, Accesses};
use identifier::{Base, Identifier};
use message::Message;
use models::Models;
use naming::Pool;
use quantity::Quantities;
use recognition::Recognition;
use selector::{InData, Selectors, Source};
use set::Set;
use signal::Context;
use timing::Timing;
use transport::Transport;
use types::Types;
use variant::Variant;
use way::Way;
use word::{Enumeration, Packed, StatusWord};

/// A whole module.
pub struct Plan {
    /// What the spec says about the protocol as a whole.
    pub about: About,
    /// What every frame shows.
    pub base: Base,
    /// Every selector.
    pub selectors: Selectors,
    /// The constants of the selectors in the data.
    pub in_data: Vec<InData>,
    /// The identifier.
    pub identifier: Identifier,
    /// The field that says whether more frames of a set or parts of a message follow, and the value that says so.
    pub continuation: Option<(Source, TokenStream)>,
    /// The targets of requests.
    pub targets: Option<Targets>,
    /// The ways through addressing modes.
    pub ways: Vec<Way>,
    /// Kinds of addresses.
    pub address_types: Vec<AddressType>,
    /// Addressing modes.
    pub modes: Vec<Mode>,
    /// The error code of replies while a device starts, if there is one.
    pub starting: Option<u64>,
    /// The times that have a role, if there are any.
    pub timing: Option<Timing>,
    /// The variant of what devices do after silence, if the document says it.
    pub after_silence: Option<Ident>,
    /// The parts of accesses that messages share.
    pub accesses: Vec<Access>,
    /// Device models.
    pub models: Models,
    /// Named values.
    pub enumerations: Vec<Enumeration>,
    /// Status words.
    pub status_words: Vec<StatusWord>,
    /// Packed values.
    pub packed: Vec<Packed>,
    /// Messages.
    pub messages: Table<MessageId, Message>,
    /// The messages that are sets.
    pub sets: Table<MessageId, Option<Set>>,
    /// How frames carry long messages.
    pub carriers: Table<LongMessageId, Option<Carrier>>,
    /// Transports of long messages.
    pub transports: Vec<Transport>,
    /// The variants of the enum of all messages.
    pub variants: Vec<Variant>,
    /// How frames are recognised.
    pub recognition: Recognition,
    /// Where quantities are read and set, if there are any.
    pub quantities: Option<Quantities>,
    /// Whether foreign identifiers can show what chooses a message.
    pub foreign_like_own: bool,
}

impl Plan {
    /// Plans the module of a protocol.
    pub fn new(protocol: &Protocol, options: &Options) -> Self {
        let (types, mut constants) = (&Types::new(protocol), Pool::of_constants());
        let selectors = selector::selectors(protocol, &mut constants);
        let addresses = &address::addresses(protocol, &mut constants);
        let mode = |known| Mode::new(protocol, addresses, known, &mut constants);
        let addressing = protocol.modes.iter().map(mode).collect();
        let accesses = Accesses::new(protocol, &selectors, &mut constants);
        let models = Models::new(protocol, options.scaled, &mut constants);
        let context = &Context { protocol, types, models: &models, scaled: options.scaled };
        let planner = message::Planner { context, selectors: &selectors, accesses: &accesses };
        let messages = protocol.messages.ids().map(|id| planner.message(id)).collect();
        let planner = recognition::Planner { protocol, types, messages: &messages };
        let variants = variant::variants(protocol, types);
        let set = |id| Set::new(protocol, types, &messages, addresses, &variants, id);
        let sets = protocol.messages.ids().map(set).collect();
        let planner_of_parts =
            carrier::Planner { protocol, types, models: &models, messages: &messages, variants: &variants };
        let carriers = protocol.long_messages.ids().map(|id| planner_of_parts.carrier(id)).collect();
        let transports = protocol.transports.ids();
        let transports = transports.map(|id| Transport::new(protocol, types, &messages, id)).collect();
        let address_types = protocol.address_types.iter().zip(addresses);
        Self {
            about: About::new(protocol),
            base: Base::new(&protocol.identifier),
            in_data: selector::in_data(protocol, &selectors),
            identifier: Identifier::new(protocol, types),
            continuation: continuation(protocol, &selectors),
            targets: Targets::new(protocol, addresses),
            ways: Way::all(protocol, addresses),
            address_types: address_types
                .map(|(known, name)| AddressType::new(protocol, name, known, &mut constants))
                .collect(),
            modes: addressing,
            starting: protocol.error_codes().find_map(|code| code.starting),
            timing: Timing::new(protocol),
            after_silence: after_silence(protocol),
            enumerations: Enumeration::all(protocol, types),
            status_words: StatusWord::all(protocol, types),
            packed: Packed::all(protocol, types),
            sets,
            carriers,
            transports,
            variants,
            recognition: planner.recognition(),
            foreign_like_own: identifier::foreign_like_own(protocol),
            quantities: Quantities::new(protocol, &messages),
            accesses: accesses.shared,
            models,
            messages,
            selectors,
        }
    }
}

/// Returns the variant of what devices do after silence, if the document says it.
fn after_silence(protocol: &Protocol) -> Option<Ident> {
    let output = protocol.after_silence.as_ref()?.output;
    (output != AfterSilence::Unknown).then(|| format_ident!("{output:?}"))
}

/// Finds the field that says whether more frames follow, if there are sets or messages in parts.
fn continuation(protocol: &Protocol, selectors: &Selectors) -> Option<(Source, TokenStream)> {
    protocol.messages.iter().find(|message| message.set.is_some() || protocol.in_parts(message).is_some())?;
    let continuation = protocol.continuation()?;
    let raw = |width| literal::hexadecimal(continuation.raw, width);
    match continuation.place {
        SelectorPlace::Identifier(field) => {
            let (place, width) = comparison::field_place(protocol, field);
            Some((Source::Identifier(place), raw(width)))
        }
        SelectorPlace::Payload(place) => {
            let id = protocol.selectors.position(|selector| selector.place == continuation.place)?;
            Some((selectors[id].source.clone(), raw(place.width())))
        }
    }
}
