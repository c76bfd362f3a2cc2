//! Rust: a `no_std` codec on the runtime.

mod address;
mod choice;
mod derives;
mod dispatch;
mod doc;
mod entries;
mod exchange;
mod identifier;
mod lines;
mod literal;
mod message;
mod model;
mod names;
mod parts;
mod place;
mod protocol;
mod rows;
mod set;
mod spacing;
mod word;

use proc_macro2::TokenStream;
use quote::quote;

use super::Options;
use crate::files::MARK;
use crate::model::Protocol;
use derives::Derives;
use message::Emitter;
use names::Names;
use set::SetEmitter;

pub use names::is_word_of_rust;
pub(crate) use names::{camel_case, member};

/// Returns the content of a module that encodes and decodes the protocol, as text to be included as it is.
pub fn rust(protocol: &Protocol, options: &Options) -> String {
    let header = format!("{MARK} from {}; do not edit.\n\n", protocol.file);
    header + &formatted(&tokens(protocol, options))
}

/// Returns the same content as tokens, for macros and for build scripts that go on with it.
pub fn tokens(protocol: &Protocol, options: &Options) -> TokenStream {
    let items = items(protocol, options);
    let optional = Derives::new(options).imports();
    quote! {
        pub use canspec_runtime::prelude::*;
        use canspec_runtime::plumbing::prelude::*;
        #optional
        #items
    }
}

/// Lays the code out; if it is no Rust it stays as it is, so that its compiler can say why.
fn formatted(code: &TokenStream) -> String {
    let file = syn::parse2(code.clone());
    file.map_or_else(|_| code.to_string(), |file| spacing::spaced(&lines::joined(&prettyplease::unparse(&file))))
}

fn items(protocol: &Protocol, options: &Options) -> TokenStream {
    let (names, derives) = (Names::new(protocol), Derives::new(options));
    let frame = protocol::frame(protocol);
    let identifier = identifier::identifier(protocol, &names, derives);
    let target = address::target(protocol, &names, derives);
    let addressing = address::addressing(protocol);
    let continuation = set::continuation(protocol);
    let models = model::models(protocol, &names, derives, options.float);
    let accesses = exchange::accesses(protocol, &names);
    let words = words(protocol, &names, derives);
    let messages = protocol.messages.iter().zip(&names.messages);
    let messages = messages.map(|(message, known)| {
        let emitter = Emitter { protocol, all: &names, names: known, message, derives, float: options.float };
        SetEmitter::new(&emitter).map_or_else(|| emitter.items(), |set| set.items())
    });
    let last = protocol::protocol(protocol, &names, derives);
    quote!(#frame #identifier #continuation #target #addressing #accesses #models #words #(#messages)* #last)
}

fn words(protocol: &Protocol, names: &Names, derives: Derives) -> TokenStream {
    let enumerations = protocol.enumerations.iter().zip(&names.enumerations);
    let enumerations = enumerations.map(|(known, name)| word::enumeration(protocol, name, known, derives));
    let status_words = protocol.status_words.iter().zip(&names.status_words);
    let status_words = status_words.map(|(known, name)| word::status_word(protocol, name, known, derives));
    let signals = protocol.messages.iter().zip(&names.messages).flat_map(|(message, known)| {
        message.signals.iter().zip(&known.packed).map(move |(signal, name)| (message, signal, name))
    });
    let packed =
        signals.filter_map(|(message, signal, name)| word::packed(protocol, name.as_ref()?, message, signal, derives));
    quote!(#(#enumerations)* #(#status_words)* #(#packed)*)
}

#[cfg(test)]
mod tests {
    use crate::source::Source;

    const SPEC: &str = r#"
canspec: 1
protocol: heater
title: Heaters
document: {title: Heaters, version: "1"}
length: 8
identifier: {command: {bits: 28..16}, target: {bits: 15..8}, source: {bits: 7..0}}
types:
  controller: {range: 0xF0..0xF0, outside: refused, send: 0xF0, section: "1"}
  module: {range: 0..0x3F, section: "1"}
  power: {scale: 10, unit: W, note: never above the rating, section: "3"}
  mode: {values: {0: eco, 1: boost}, note: eco by default, section: "3"}
addressing:
  module:
    title: One heater
    note: heaters of a group too
    section: "4"
    erratum: E1
    request: {target: module, source: controller}
    one: {target: controller, source: module}
access:
  set: {request: {}, reply: {}, answers: {module: one}, note: the reply carries the values now in effect, section: "5"}
messages:
  heat:
    section: "2"
    match: {command: 7}
    access: [set]
    erratum: [E1, E2, E3]
    fields: {power: {bytes: 0..1, type: power}, mode: {bytes: 2, type: mode}}
    examples:
      - {request: 000703F0#0001010000000000, means: {power: 10 W, mode: boost}}
      - {reply: 0007F003#0001010000000000, means: {power: 10 W, mode: boost}}
errata:
  E1: {kind: vendor, section: "2", prints: kilowatts, uses: watts, because: the examples are in watts}
  E2: {kind: ocr, section: "2", prints: k11owatts, uses: kilowatts, because: the scan is blurred}
  E3: {kind: note, section: "2", prints: two units, uses: both, because: they do not contradict}
"#;

    #[test]
    fn the_tokens_are_the_items_of_the_text() {
        let outcome = crate::compile(Source::new("heater.yaml", SPEC.into()).expect("plain text"));
        let protocol = outcome.protocol.expect("a spec without errors");
        let options = super::Options::default();
        let tokens = syn::parse2::<syn::File>(super::tokens(&protocol, &options)).expect("the tokens are Rust");
        assert!(super::rust(&protocol, &options).ends_with(&super::formatted(&quote::quote!(#tokens))));
        assert!(tokens.items.iter().any(|item| matches!(item, syn::Item::Struct(known) if known.ident == "Heat")));
    }

    #[test]
    fn notes_and_sections_stand_in_the_docs_and_of_the_errata_those_that_are_not_about_the_scan() {
        let outcome = crate::compile(Source::new("heater.yaml", SPEC.into()).expect("plain text"));
        let code = super::rust(&outcome.protocol.expect("a spec without errors"), &super::Options::default());
        for part in [
            "/// Set. Section 5.\n///\n/// The reply carries the values now in effect.\n///\n/// `module`: the module answers.\npub const SET_ACCESS",
            "    /// Builds the request [`set`](SET_ACCESS) with these values.\n",
            "    /// One heater: `0x00..=0x3F`. Section 4.\n    ///\n    /// Heaters of a group too.\n    Module(u8),\n",
            "steps of 10 W.\n    ///\n    /// Never above the rating.\n    pub power_w: f64,\n",
            "    /// Mode: byte 2.\n    pub mode: Mode",
            "/// Heat. Section 2.\n///\n/// Erratum E1: printed is \"kilowatts\", used is \"watts\".\n#[derive",
            "    /// A value without a name; it is sent as it is.\n    Unknown(u8),\n",
        ] {
            assert!(code.contains(part), "{part:?} is not in\n{code}");
        }
    }
}
