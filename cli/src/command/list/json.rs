//! A protocol as one object of JSON, with all that its spec says.
//!
//! What is missing is `null` or an empty list. Numbers that may have a fraction are texts, so nothing rounds them.

mod addressing;
mod examples;
mod frame;
mod identifier;
mod message;
mod remarks;
mod signal;
mod surroundings;

use std::io::{self, Write};

use canspec_codegen::model::{MessageId, Protocol};
use canspec_codegen::text::Text;
use serde::Serialize;

/// A whole protocol, or some of its messages.
#[derive(Serialize)]
struct Object<'a> {
    protocol: &'a str,
    title: &'a Text,
    file: &'a Text,
    documents: Vec<surroundings::Document<'a>>,
    based_on: Option<surroundings::Base<'a>>,
    sides: surroundings::Sides<'a>,
    bit_rates: &'a [u32],
    identifier: identifier::Identifier<'a>,
    header: Vec<identifier::Selector<'a>>,
    addresses: Vec<addressing::AddressType<'a>>,
    modes: Vec<addressing::Mode<'a>>,
    accesses: Vec<addressing::Access<'a>>,
    foreign: Vec<addressing::Foreign<'a>>,
    transports: Vec<surroundings::Transport<'a>>,
    types: Vec<remarks::Type<'a>>,
    messages: Vec<message::Message<'a>>,
    quantities: Vec<surroundings::Quantity<'a>>,
    models: Vec<surroundings::Model<'a>>,
    timing: Vec<surroundings::Timing<'a>>,
    after_silence: Option<surroundings::Silence<'a>>,
    procedures: Vec<surroundings::Procedure<'a>>,
    examples: Vec<examples::Example<'a>>,
    type_examples: Vec<examples::TypeExample<'a>>,
    sequences: Vec<remarks::Named<'a>>,
    errata: Vec<surroundings::Erratum<'a>>,
    allow: Vec<surroundings::Allowance<'a>>,
}

/// Writes a protocol with some of its messages.
pub fn write(out: &mut impl Write, protocol: &Protocol, messages: &[MessageId]) -> io::Result<()> {
    serde_json::to_writer(&mut *out, &object(protocol, messages))?;
    writeln!(out)
}

fn object<'a>(protocol: &'a Protocol, messages: &[MessageId]) -> Object<'a> {
    Object {
        protocol: &protocol.name,
        title: &protocol.title,
        file: &protocol.file,
        documents: protocol.documents.iter().map(surroundings::Document::from).collect(),
        based_on: protocol.derivation.as_ref().map(surroundings::Base::from),
        sides: surroundings::Sides::from(&protocol.sides),
        bit_rates: &protocol.bit_rates,
        identifier: identifier::Identifier::of(protocol),
        header: identifier::Selector::header(protocol),
        addresses: protocol.address_types.iter().map(addressing::AddressType::from).collect(),
        modes: protocol.modes.iter().map(|mode| addressing::Mode::of(protocol, mode)).collect(),
        accesses: protocol.accesses.iter().map(|access| addressing::Access::of(protocol, access)).collect(),
        foreign: protocol.foreign.iter().map(|foreign| addressing::Foreign::of(protocol, foreign)).collect(),
        transports: protocol.transports.iter().map(|known| surroundings::Transport::of(protocol, known)).collect(),
        types: remarks::Type::all(protocol),
        messages: messages.iter().map(|id| message::Message::of(protocol, *id)).collect(),
        quantities: protocol.quantities.iter().map(|known| surroundings::Quantity::of(protocol, known)).collect(),
        models: protocol.models.iter().map(surroundings::Model::from).collect(),
        timing: protocol.timing.iter().map(|timing| surroundings::Timing::of(protocol, timing)).collect(),
        after_silence: protocol.after_silence.as_ref().map(surroundings::Silence::from),
        procedures: protocol.procedures.iter().map(surroundings::Procedure::from).collect(),
        examples: examples::of_messages(protocol, messages),
        type_examples: protocol.value_examples.iter().map(examples::TypeExample::from).collect(),
        sequences: protocol.sequences.iter().map(remarks::Named::from).collect(),
        errata: protocol.errata.iter().map(surroundings::Erratum::from).collect(),
        allow: protocol.allowances.iter().map(surroundings::Allowance::from).collect(),
    }
}
