#![doc = include_str!("../../docs/rules/role.md")]

use crate::model::{Kind, Message, MessageId, Protocol, TimeRole, Timing};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    ROLE "role" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let times: Vec<(TimeRole, &Timing)> = protocol.timing.iter().filter_map(|time| Some((time.role?, time))).collect();
    for (index, (role, time)) in times.iter().enumerate() {
        let mut earlier = times[..index].iter().filter(|(other, _)| other == role);
        if let Some((earlier, about)) =
            earlier.find_map(|(_, earlier)| Some((*earlier, shared(protocol, earlier, time)?)))
        {
            diagnostics.push(twice(earlier, time, &format!("`{}`{about}", role.name())));
        }
        for (index, id) in time.messages.iter().enumerate() {
            let mut needed = needed(*role).iter();
            if let Some(kind) = needed.find(|kind| !travels_as(protocol, &protocol[*id], **kind)) {
                diagnostics.push(without(protocol, time, (index, *id), *kind, *role));
            }
        }
    }
}

/// Names the message that both times are about, or nothing if both are about every message.
fn shared(protocol: &Protocol, one: &Timing, other: &Timing) -> Option<String> {
    if one.messages.is_empty() && other.messages.is_empty() {
        return Some(String::new());
    }
    let shared = one.messages.iter().find(|message| other.messages.contains(message))?;
    Some(format!(" of `{}`", protocol[*shared].name))
}

fn twice(earlier: &Timing, time: &Timing, role: &str) -> Diagnostic {
    let text = format!("both `{}` and `{}` are the {role}", earlier.name, time.name);
    let at = |timing: &Timing| timing.doc.path.key("role").at_value();
    let help = "take one of the two roles out, or name the messages that each time is about in `messages`";
    Diagnostic::error(&ROLE, at(time), text).help(help).other(at(earlier), "the other time")
}

/// Returns the kinds of frames without which a role means nothing for a message.
fn needed(role: TimeRole) -> &'static [Kind] {
    match role {
        TimeRole::RequestGap | TimeRole::Settling => &[Kind::Request],
        TimeRole::ReplyTimeout => &[Kind::Request, Kind::Reply],
        TimeRole::Watchdog | TimeRole::Boot => &[],
    }
}

fn travels_as(protocol: &Protocol, message: &Message, kind: Kind) -> bool {
    message.exchanges.iter().any(|exchange| protocol[exchange.access].kinds.contains(&kind))
}

fn without(
    protocol: &Protocol,
    time: &Timing,
    (index, id): (usize, MessageId),
    kind: Kind,
    role: TimeRole,
) -> Diagnostic {
    let (name, kind, role) = (&protocol[id].name, kind.name(), role.name());
    let text = format!("`{name}` has no {kind}, and so no `{role}`");
    let at = time.doc.path.key("messages").index(index).at_value();
    Diagnostic::error(&ROLE, at, text).help(format!("name a message with a {kind}, or give the time another role"))
}
