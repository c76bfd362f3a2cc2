//! What is made of a spec without errors: other languages, and frames.

use std::collections::BTreeSet;

use can_dbc::MessageId;
use canspec_codegen::emit::{self, Dbc, Goal, Options, Scaled, Switch};
use canspec_codegen::interpret::{Content, Frame, decode, encode};
use canspec_codegen::model::{ModelId, Protocol, Side};

use super::names;
use crate::{Frames, models};

/// How many random frames of a protocol are decoded.
const FRAMES: usize = 16;

/// Tests that every emitter makes what its language allows, and that frames come back.
pub fn check(protocol: &Protocol) {
    let ends = [(Scaled::F64, Goal::Speed, Switch::Never), (Scaled::Steps, Goal::Size, Switch::Always)];
    for (scaled, goal, switch) in ends {
        let options = Options { scaled, goal, serde: switch.clone(), defmt: switch.clone(), arbitrary: switch };
        let code = emit::manual(protocol, &options) + &emit::rust(protocol, &options);
        names::check(&syn::parse_file(&code).unwrap_or_else(|error| panic!("{error}\n{code}")));
    }
    for nodes in [None, Some(0..=3)] {
        readable(protocol, &emit::dbc(protocol, nodes));
    }
    assert!(emit::wireshark(protocol).starts_with("-- @generated"));
    frames(protocol);
}

/// Tests that another reader finds every frame in a DBC, and no identifier twice.
fn readable(protocol: &Protocol, dbc: &Dbc) {
    let read = can_dbc::Dbc::try_from(dbc.text.as_str()).unwrap_or_else(|error| panic!("{error}\n{}", dbc.text));
    let extended = protocol.identifier.extended;
    let ids: BTreeSet<_> = read.messages.iter().map(|message| number(message.id, extended) & dbc.mask).collect();
    assert_eq!((ids.len(), read.messages.len()), (dbc.counts.1, dbc.counts.1), "{}", dbc.text);
}

/// Returns the number of an identifier of the width that the protocol has.
fn number(id: MessageId, extended: bool) -> u32 {
    match id {
        MessageId::Standard(id) if !extended => id.into(),
        MessageId::Extended(id) if extended => id,
        _ => panic!("{id:?} has the wrong width"),
    }
}

/// Tests that frames which nobody may refuse encode to what they were.
fn frames(protocol: &Protocol) {
    if protocol.modes.is_empty() || protocol.frames.is_empty() {
        return;
    }
    let mut random = Frames::new(protocol, 0xF0);
    for model in models(protocol).cycle().take(FRAMES) {
        comes_back(protocol, model, &random.next_frame());
    }
    for example in &protocol.examples {
        comes_back(protocol, example.model, &Frame::of(protocol, example));
    }
}

fn comes_back(protocol: &Protocol, model: Option<ModelId>, frame: &Frame) {
    let Ok(decoded) = decode(protocol, model, frame) else { return };
    if decoded.sender == Side::Module {
        let encoded = encode(protocol, model, &Content::of(protocol, &decoded));
        assert_eq!(encoded.as_ref(), Ok(frame), "{decoded:?}");
    }
}
