#![doc = include_str!("../../docs/rules/no_model.md")]

use crate::model::{ModelId, Protocol};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    NO_MODEL "no_model" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    for message in &protocol.messages {
        for signal in &message.signals {
            let name = format!("{}.{}", message.name, signal.name);
            if is_nowhere(&signal.models, |model| message.is_of(model)) {
                diagnostics.push_first(nowhere(&signal.doc.path.key("models"), &name));
            }
            let is_around = |model| message.is_of(model) && signal.is_of(model);
            let word = signal.encoding.status_word().map(|word| &protocol[word]);
            for bit in word.into_iter().flat_map(|word| &word.bits) {
                if is_nowhere(&bit.models, is_around) {
                    diagnostics.push_first(nowhere(&bit.doc.path.key("models"), &format!("{name}.{}", bit.name)));
                }
            }
            for value in protocol.named_values(signal).iter().filter(|value| is_nowhere(&value.models, is_around)) {
                diagnostics.push_first(nowhere(&value.models_path, &format!("{name}.{}", value.name)));
            }
        }
    }
}

/// Tests whether none of the models in a list has what is around.
fn is_nowhere(models: &[ModelId], is_around: impl Fn(ModelId) -> bool) -> bool {
    !models.is_empty() && !models.iter().any(|model| is_around(*model))
}

fn nowhere(models: &Path, name: &str) -> Diagnostic {
    let text = format!("no device model has `{name}`: none of these models has what is around it");
    let help = "correct the list, or that of the message or the field";
    Diagnostic::error(&NO_MODEL, models.at_key(), text).help(help)
}
