#![doc = include_str!("../rules/nobody_replies.md")]

use crate::diagnostic::{At, Diagnostic, Diagnostics};
use crate::model::{Kind, Message, MessageAccess, Protocol, Who};

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for travelling in &message.accesses {
            let access = &protocol.accesses[travelling.access];
            let mut answers = travelling.answers.iter().flatten().peekable();
            let is_silent = answers.peek().is_some() && answers.all(|who| *who == Who::Nobody);
            if !is_silent || !access.kinds.contains(&Kind::Reply) {
                continue;
            }
            let text =
                format!("`{}` has a reply by `{}`, but `answers` says that nobody answers", message.name, access.name);
            let help = "say who answers, or use an access without `reply`";
            diagnostics
                .push_first(Diagnostic::error("nobody_replies", at(protocol, message, travelling), text).help(help));
        }
    }
}

/// Returns the place of the answers: the message's own, or those of its access.
fn at(protocol: &Protocol, message: &Message, travelling: &MessageAccess) -> At {
    let access = &protocol.accesses[travelling.access];
    let doc = if access.answers == travelling.answers { &access.doc } else { &message.doc };
    doc.path.key("answers").at_key()
}
