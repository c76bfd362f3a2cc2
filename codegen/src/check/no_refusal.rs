#![doc = include_str!("../../docs/rules/no_refusal.md")]

use crate::model::{ExchangeId, Kind, Message, Protocol};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    NO_REFUSAL "no_refusal" Check WARNING;
}

/// An exchange of a message.
type Way<'a> = (&'a Message, ExchangeId);

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let ways = ways(protocol, message);
        let Some(refused) = ways.iter().find(|way| is_refused(**way)) else { continue };
        for way in ways.iter().filter(|way| !is_refused(**way) && is_answered(protocol, **way)) {
            diagnostics.push_first(never_refused(protocol, *way, *refused));
        }
    }
}

/// Returns the exchanges of a message's own, and those of its members if it is a set.
fn ways<'a>(protocol: &'a Protocol, message: &'a Message) -> Vec<Way<'a>> {
    let members = message.set.iter().flat_map(|set| &set.members).map(|member| &protocol[*member]);
    let own = |message: &'a Message| {
        let own = message.exchanges.entries().filter(|(_, exchange)| exchange.set.is_none());
        own.map(move |(id, _)| (message, id))
    };
    std::iter::once(message).chain(members).flat_map(own).collect()
}

fn is_refused((message, id): Way) -> bool {
    message.refusals.iter().any(|refusal| refusal.exchange == id)
}

/// Tests whether a request has a reply.
fn is_answered(protocol: &Protocol, (message, id): Way) -> bool {
    let frames = || protocol.layouts_of(message).filter(|frame| frame.exchange == id && frame.set.is_none());
    let is_of_set = |kind| kind == Kind::Reply && message.set.as_ref().is_some_and(|set| set.kinds.contains(&kind));
    [Kind::Request, Kind::Reply].iter().all(|kind| is_of_set(*kind) || frames().any(|frame| frame.kind == *kind))
}

fn never_refused(protocol: &Protocol, (message, way): Way, (other, refused): Way) -> Diagnostic {
    let [name, access] = [message[way].access, other[refused].access].map(|id| &protocol[id].name);
    let [whose, set] = if message.name == other.name { ["the same message ", ""] } else { ["", " in the same set"] };
    let text = format!("`{name}` has no `refusal`, but `{access}` of {whose}`{}`{set} has one", other.name);
    let help = format!("write the `refusal` of `{name}`; if no device refuses it so, `allow` the warning");
    let at = |access: &str| Path::default().key("access").key(access);
    let warning = Diagnostic::warning(&NO_REFUSAL, at(name).at_key(), text).help(help);
    warning.other(at(access).key("refusal").at_key(), "the other refusal")
}
