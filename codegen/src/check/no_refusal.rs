#![doc = include_str!("../rules/no_refusal.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Exchange, ExchangeId, Kind, Message, Protocol};
use crate::rule::rules;
use crate::syntax::tree::Path;

rules! {
    NO_REFUSAL "no_refusal" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        let is_refused = |id: ExchangeId| message.refusals.iter().any(|refusal| refusal.exchange == id);
        let Some((_, refused)) = message.exchanges.entries().find(|(id, _)| is_refused(*id)) else { continue };
        for (id, exchange) in message.exchanges.entries() {
            if is_answered(protocol, message, id) && !is_refused(id) {
                diagnostics.push_first(never_refused(protocol, message, exchange, refused));
            }
        }
    }
}

/// Tests whether a request of the message's own has a reply.
fn is_answered(protocol: &Protocol, message: &Message, id: ExchangeId) -> bool {
    let frames = || protocol.layouts_of(message).filter(|frame| frame.exchange == id && frame.set.is_none());
    [Kind::Request, Kind::Reply].iter().all(|kind| frames().any(|frame| frame.kind == *kind))
}

fn never_refused(protocol: &Protocol, message: &Message, exchange: &Exchange, refused: &Exchange) -> Diagnostic {
    let [name, other] = [exchange, refused].map(|known| &protocol[known.access].name);
    let text = format!("`{name}` has no `refusal`, but `{other}` of the same message `{}` has one", message.name);
    let help = format!("write the `refusal` of `{name}`; if no device refuses it so, `allow` the warning");
    let at = |access: &str| Path::default().key("access").key(access);
    let warning = Diagnostic::warning(&NO_REFUSAL, at(name).at_key(), text).help(help);
    warning.other(at(other).key("refusal").at_key(), "the other refusal")
}
