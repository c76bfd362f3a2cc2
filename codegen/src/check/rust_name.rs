#![doc = include_str!("../rules/rust_name.md")]

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::emit::{camel_case, is_word_of_rust, member};
use crate::model::{Doc, Protocol};
use crate::rule::rules;
use crate::syntax::tree::Path;

rules! {
    RUST_NAME "rust_name" Check ERROR;
}

pub fn check(protocol: &Protocol, diagnostics: &mut Diagnostics) {
    check_types(protocol, diagnostics);
    let module = Doc { path: Path::default().key("protocol"), ..Doc::default() };
    check_names("module", std::iter::once((protocol.name.clone(), protocol.name.as_str(), &module)), diagnostics);
    for message in &protocol.messages {
        let names = message.signals.iter().map(|signal| (member(signal), signal.name.as_str(), &signal.doc));
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

/// Reports names that are reserved, or equal after conversion.
fn check_names<'a>(what: &str, names: impl Iterator<Item = (String, &'a str, &'a Doc)>, diagnostics: &mut Diagnostics) {
    let mut seen: Vec<(String, &str, &Doc)> = Vec::new();
    for (rust, name, doc) in names {
        if is_word_of_rust(&rust) {
            let text = format!("`{name}` is a keyword of Rust");
            diagnostics.push(Diagnostic::error(&RUST_NAME, doc.path.at_key(), text).help("choose another name"));
        }
        if let Some((_, other, earlier)) = seen.iter().find(|(known, _, _)| *known == rust) {
            let text = format!("`{other}` and `{name}` are one {what} in Rust: `{rust}`");
            let diagnostic = Diagnostic::error(&RUST_NAME, doc.path.at_key(), text).help("rename one of the two");
            diagnostics.push(diagnostic.other(earlier.path.at_key(), "the other name"));
        }
        seen.push((rust, name, doc));
    }
}
