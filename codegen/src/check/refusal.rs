#![doc = include_str!("../../docs/rules/refusal.md")]

use crate::model::{Constant, FrameLayout, Kind, Message, Protocol};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    REFUSAL "refusal" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for refusal in &message.refusals {
            if let Some((text, help)) = complaint(protocol, message, refusal) {
                let access = &protocol[refusal.access].name;
                let at = Path::default().key("access").key(access).key("refusal").at_key();
                diagnostics.push_first(Diagnostic::error(&REFUSAL, at, text).help(help));
            }
        }
    }
}

/// Says what is wrong with a refusal, and what to do.
fn complaint(protocol: &Protocol, message: &Message, refusal: &FrameLayout) -> Option<(String, String)> {
    let name = &message.name;
    let frames = protocol.layouts_of(message).filter(|frame| frame.exchange == refusal.exchange);
    let own = frames.clone().filter(|frame| frame.kind == Kind::Reply).map(|frame| &frame.constants[..]);
    let of_set = message.set.as_ref().filter(|set| set.kinds.contains(&Kind::Reply)).map(|set| &set.replies[..]);
    let replies: Vec<_> = own.chain(of_set).collect();
    if replies.is_empty() || !frames.clone().any(|frame| frame.kind == Kind::Request) {
        let text =
            format!("a refusal of `{name}` stands in place of the reply to a request, but there is no such reply");
        return Some((text, "add `request:` and `reply:` to the access, or take `refusal` out".to_owned()));
    }
    if !replies.iter().all(|reply| is_apart(reply, refusal)) {
        let help = "give a field one constant in `reply` and another one in `refusal`".to_owned();
        let constants = shown(protocol, refusal);
        return Some((format!("nothing tells a refusal of `{name}` from its reply: both have {constants}"), help));
    }
    let mut all = protocol.messages.iter().flat_map(|message| protocol.layouts_of(message));
    let is_known = all.any(|frame| says_why(frame, refusal));
    (!is_known).then(|| {
        let text =
            format!("no message says why `{name}` is refused: none has a reply with {}", shown(protocol, refusal));
        let help = format!(
            "write a message for the reason, whose access has the constants of this `refusal` in its `reply`; \
             its `match` has only constants of `{name}`"
        );
        (text, help)
    })
}

/// Names the constants of a refusal.
fn shown(protocol: &Protocol, refusal: &FrameLayout) -> String {
    let constants = refusal.constants.iter();
    let texts = constants.map(|known| format!("`{}` {:#04X}", protocol[known.selector].name, known.value));
    texts.collect::<Vec<_>>().join(", ")
}

/// Tests whether one field has different constants in both.
fn is_apart(reply: &[Constant], refusal: &FrameLayout) -> bool {
    let differs = |known: &Constant| refusal.constants.iter().any(|other| other.excludes(known));
    reply.iter().any(differs)
}

/// Tests whether every frame of such a refusal is a reply of this kind.
fn says_why(frame: &FrameLayout, refusal: &FrameLayout) -> bool {
    frame.kind == Kind::Reply
        && frame.constants.iter().all(|constant| refusal.constants.iter().any(|known| constant.covers(known)))
}
