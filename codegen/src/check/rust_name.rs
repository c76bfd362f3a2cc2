#![doc = include_str!("../../docs/rules/rust_name.md")]

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::emit::{Scaled, camel_case, is_word_of_rust, member};
use crate::model::{Doc, Id, ModelId, Protocol};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::rule::rules;
use crate::report::tree::Path;

rules! {
    RUST_NAME "rust_name" Check ERROR;
}

/// The most device models that a byte numbers.
const MOST_MODELS: usize = 256;

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    check_types(protocol, diagnostics);
    check_count(protocol, diagnostics);
    let module = Doc { path: Path::default().key("protocol"), ..Doc::default() };
    check_names("module", std::iter::once((protocol.name.clone(), protocol.name.as_str(), &module)), diagnostics);
    for message in &protocol.messages {
        let fields = message.signals.iter().filter(|signal| signal.element.is_none_or(|element| element.index == 0));
        let names =
            fields.map(|signal| (member(message, signal, Scaled::default()), message.field_name(signal), &signal.doc));
        check_names("member", names, diagnostics);
    }
    let accesses = protocol.accesses.iter().map(|access| (access.name.clone(), access.name.as_str(), &access.doc));
    check_names("access", accesses, diagnostics);
}

fn check_types(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    let messages = protocol.messages.iter().map(|message| (message.name.as_str(), &message.doc));
    let enumerations = protocol.enumerations.iter().map(|known| (known.name.as_str(), &known.doc));
    let words = protocol.status_words.iter().map(|word| (word.name.as_str(), &word.doc));
    let types: Vec<_> = messages.chain(enumerations).chain(words).collect();
    let names = types.iter().map(|(name, doc)| (camel_case(name), *name, *doc));
    check_names("type", names, diagnostics);
}

/// Tests that a byte numbers all device models.
fn check_count(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    if let Some(first) = protocol.models.get(ModelId::new(MOST_MODELS)) {
        let count = protocol.models.len();
        let text = format!("there are {count} device models, and Rust numbers them from 0 to {}", MOST_MODELS - 1);
        let help = "give models that differ in nothing but their item number one name, and list the numbers in `items`";
        diagnostics.push(Diagnostic::error(&RUST_NAME, first.doc.path.at_key(), text).help(help));
    }
}

/// Reports names that are reserved, or equal after conversion.
fn check_names<'a>(what: &str, names: impl Iterator<Item = (String, &'a str, &'a Doc)>, diagnostics: &mut Diagnostics) {
    let mut seen: HashMap<String, (&str, &Doc)> = HashMap::new();
    for (rust, name, doc) in names {
        if is_word_of_rust(&rust) {
            let text = format!("`{name}` is a keyword of Rust");
            diagnostics.push(Diagnostic::error(&RUST_NAME, doc.path.at_key(), text).help("choose another name"));
        }
        match seen.entry(rust) {
            Entry::Vacant(free) => {
                free.insert((name, doc));
            }
            Entry::Occupied(taken) => {
                let (other, earlier) = taken.get();
                let text = format!("`{other}` and `{name}` are one {what} in Rust: `{}`", taken.key());
                let diagnostic = Diagnostic::error(&RUST_NAME, doc.path.at_key(), text).help("rename one of the two");
                diagnostics.push(diagnostic.other(earlier.path.at_key(), "the other name"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::read::source::Source;
    use crate::{Outcome, compile};

    /// Compiles a spec of `count` device models.
    fn models(count: usize) -> Outcome {
        let models: Vec<_> = (0..count).map(|number| format!("M{number}: {{section: \"1\"}}")).collect();
        let spec = format!(
            "canspec: 1\nprotocol: p\ntitle: T\ndocument: {{title: T, version: V}}\nlength: 8\n\
             identifier: {{command: {{bits: 10..0}}}}\naccess: {{read: {{request: {{}}}}}}\nmodels: {{{}}}\n",
            models.join(", ")
        );
        compile(Source::new("models.yaml", spec.into()).expect("plain text"))
    }

    #[test]
    fn a_byte_numbers_256_device_models_and_no_more() {
        assert!(models(256).protocol.is_some());
        let errors = models(257).diagnostics.concise();
        assert!(errors.contains("error[rust_name]: there are 257 device models, and Rust numbers them from 0 to 255"));
    }
}
