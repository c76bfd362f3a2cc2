#![doc = include_str!("../../docs/rules/reply.md")]

use crate::interpret::{Decoded, Frame, decode};
use crate::model::{
    AddressPattern, AddressTypeId, Constant, Example, FrameLayout, Kind, Message, MessageId, Mode, Protocol,
    SelectorId, SelectorPlace, Who,
};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    REPLY "reply" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let mut latest: Option<(&Example, Decoded)> = None;
    for example in protocol.examples.iter().filter(|example| example.fails.is_none() || example.position == 0) {
        if example.position == 0 {
            latest = None;
        }
        let decoded = decoded(protocol, example);
        if decoded.is_none() && example.kind == Kind::Request {
            latest = None;
        }
        let Some(decoded) = decoded else { continue };
        match (example.kind, &latest) {
            (Kind::Request, _) => latest = Some((example, decoded)),
            (Kind::Reply, Some((request, asked))) => {
                if let Some(why) = mismatch(protocol, asked, &decoded) {
                    let help = "correct the frame, or put the request that it answers before it";
                    let diagnostic =
                        Diagnostic::error(&REPLY, example.doc.path.key("reply").at_value(), why).help(help);
                    diagnostics.push(diagnostic.other(request.doc.path.key("request").at_value(), "the request"));
                }
            }
            _ => {}
        }
    }
}

/// Decodes an example that must not fail, and does not.
fn decoded(protocol: &Protocol, example: &Example) -> Option<Decoded> {
    if example.fails.is_some() {
        return None;
    }
    let decoded = decode(protocol, example.model, &Frame::of(protocol, example)).ok()?;
    (decoded.kind == example.kind && Some(decoded.message) == example.message).then_some(decoded)
}

/// Says why a reply does not answer a request.
fn mismatch(protocol: &Protocol, asked: &Decoded, reply: &Decoded) -> Option<String> {
    let message = &protocol.messages[reply.message];
    let request = &protocol.messages[asked.message];
    if whole(asked) != whole(reply) && !refuses(protocol, request, asked, reply) {
        let (found, other) = (shown(protocol, reply), shown(protocol, asked));
        let why = difference(protocol, request, asked, reply).unwrap_or_default();
        return Some(format!("a reply of {found} follows a request of {other}{why}"));
    }
    let addressing = asked.addressing?;
    let mode = &protocol[addressing.mode];
    match request[protocol[asked.frame].exchange].answers[addressing.mode] {
        Some(Who::Nobody) | None => {
            Some(format!("nobody answers `{}` in the addressing mode `{}`", message.name, mode.name))
        }
        Some(who) => unbound(protocol, mode, who, asked, reply),
    }
}

/// Tests whether a reply shows that a request is refused.
fn refuses(protocol: &Protocol, request: &Message, asked: &Decoded, reply: &Decoded) -> bool {
    let shows = |known: &Constant| value_of(protocol, reply, known.selector) == Some(known.value);
    let is_of_access = |refusal: &&FrameLayout| refusal.access == asked.access;
    request.refusals.iter().filter(is_of_access).any(|refusal| refusal.constants.iter().all(shows))
}

/// Returns what a frame shows in the place of a selector.
fn value_of(protocol: &Protocol, frame: &Decoded, selector: SelectorId) -> Option<u64> {
    match protocol[selector].place {
        SelectorPlace::Identifier(field) => Some(protocol[field].get(frame.id).into()),
        SelectorPlace::Payload(_) => {
            frame.selectors.iter().find(|(known, _)| *known == selector).map(|(_, value)| *value)
        }
    }
}

/// Names the constants that differ between a reply and the nearest answer or refusal.
fn difference(protocol: &Protocol, request: &Message, asked: &Decoded, reply: &Decoded) -> Option<String> {
    let answers = |frame: &&FrameLayout| frame.is_exchanged_with(&protocol[asked.frame]) && frame.kind == Kind::Reply;
    let frames = protocol.frames_of(request).chain(&request.refusals).filter(answers);
    let of_set = asked.set.map_or(request, |set| &protocol.messages[set]).set.iter().map(|set| &set.replies);
    let departures = frames.map(|frame| &frame.constants).chain(of_set).map(|constants| {
        let found = constants.iter().filter_map(|constant| {
            let found = value_of(protocol, reply, constant.selector).filter(|found| !constant.admits(*found))?;
            let (name, wanted) = (&protocol[constant.selector].name, constant.text());
            Some(format!("`{name}` is {found:#04X} here, and {wanted} in an answer"))
        });
        found.collect::<Vec<_>>()
    });
    let nearest = departures.filter(|found| !found.is_empty()).min_by_key(Vec::len)?;
    Some(format!(": {}", nearest.join(", ")))
}

/// Returns the set that a frame belongs to, or else its message.
fn whole(decoded: &Decoded) -> MessageId {
    decoded.set.unwrap_or(decoded.message)
}

/// Names the message of a frame, its access, and its set if it has one.
fn shown(protocol: &Protocol, decoded: &Decoded) -> String {
    let (name, access) = (&protocol.messages[decoded.message].name, &protocol.accesses[decoded.access].name);
    let set = decoded.set.map(|set| format!(" in `{}`", protocol.messages[set].name));
    format!("`{name}` by `{access}`{}", set.unwrap_or_default())
}

/// Says which address of the reply differs from that of the request.
fn unbound(protocol: &Protocol, mode: &Mode, who: Who, asked: &Decoded, reply: &Decoded) -> Option<String> {
    let (request, pattern) = (mode.request.as_ref()?, mode.reply(who)?);
    let numbers = numbers(protocol, request, asked.id);
    for address in &pattern.addresses {
        let number = protocol.address_types[address.address_type].number(protocol[address.field].get(reply.id));
        let bound = numbers.iter().find(|(known, _)| *known == address.address_type);
        if let Some((_, wanted)) = bound.filter(|(_, wanted)| *wanted != number) {
            let name = &protocol.address_types[address.address_type].name;
            return Some(format!("the reply's `{name}` is {number:#04X}, the request's is {wanted:#04X}"));
        }
    }
    (reply.id & pattern.mask != pattern.value).then(|| format!("the reply's identifier is not that of `{}`", mode.name))
}

/// Returns the numbers that a pattern binds, by address type.
fn numbers(protocol: &Protocol, pattern: &AddressPattern, id: u32) -> Vec<(AddressTypeId, i64)> {
    let addresses = pattern.addresses.iter();
    addresses
        .map(|address| {
            let number = protocol.address_types[address.address_type].number(protocol[address.field].get(id));
            (address.address_type, number)
        })
        .collect()
}
