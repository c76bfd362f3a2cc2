#![doc = include_str!("../../docs/rules/nobody_replies.md")]

use crate::model::{Exchange, Kind, Message, Protocol, Who};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    NOBODY_REPLIES "nobody_replies" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for exchange in &message.exchanges {
            let access = &protocol[exchange.access];
            let mut answers = exchange.answers.iter().flatten().peekable();
            let is_silent = answers.peek().is_some() && answers.all(|who| *who == Who::Nobody);
            if !is_silent || !access.kinds.contains(&Kind::Reply) {
                continue;
            }
            let text =
                format!("`{}` has a reply by `{}`, but `answers` says that nobody answers", message.name, access.name);
            let help = "say who answers, or use an access without `reply`";
            diagnostics
                .push_first(Diagnostic::error(&NOBODY_REPLIES, at(protocol, message, exchange), text).help(help));
        }
    }
}

/// Returns the place of `answers`, in the message or else in its access.
fn at(protocol: &Protocol, message: &Message, exchange: &Exchange) -> At {
    let access = &protocol[exchange.access];
    let doc = if access.answers == exchange.answers { &access.doc } else { &message.doc };
    doc.path.key("answers").at_key()
}
