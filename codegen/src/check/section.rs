#![doc = include_str!("../../docs/rules/section.md")]

use crate::model::{AfterSilence, Protocol};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;

rules! {
    SECTION "section" Check WARNING;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let messages = protocol.messages.iter().map(|message| ("message", &message.name, &message.doc));
    let models = protocol.models.iter().map(|model| ("model", &model.name, &model.doc));
    let timing = protocol.timing.iter().map(|timing| ("timing", &timing.name, &timing.doc));
    let procedures = protocol.procedures.iter().map(|known| ("procedure", &known.name, &known.doc));
    let silent = ["after_silence".to_owned()];
    let stated = protocol.after_silence.iter().filter(|silence| silence.output != AfterSilence::Unknown);
    let silence = stated.zip(&silent).map(|(silence, name)| ("entry", name, &silence.doc));
    for (what, name, doc) in messages.chain(models).chain(timing).chain(procedures).chain(silence) {
        if doc.section.is_none() {
            let text = format!("the {what} `{name}` has no section");
            let help =
                "say where the document has it, for instance `section: \"2.4\"`, or allow it with a reason in `allow`";
            diagnostics.push(Diagnostic::warning(&SECTION, doc.path.at_key(), text).help(help));
        }
    }
}
