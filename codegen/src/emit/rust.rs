//! Emits Rust: a `no_std` codec on the runtime.

mod about;
mod address;
mod carrier;
mod choice;
mod derives;
mod dispatch;
mod entries;
mod exchange;
mod filter;
mod identifier;
mod layout;
mod long;
mod manual;
mod message;
mod model;
mod parts;
mod pattern;
mod plan;
mod protocol;
mod quantity;
mod request;
mod scales;
mod set;
mod signal;
mod timing;
mod transport;
mod way;
mod word;

use std::iter;

use proc_macro2::TokenStream;
use quote::quote;

use super::Options;
use crate::emit::MARK;
use crate::model::Protocol;
use derives::Derives;
use layout::formatted;
use plan::Plan;

pub use plan::naming::is_word_of_rust;
pub(crate) use plan::naming::{camel_case, member};

/// Returns the content of a module that encodes and decodes the protocol, as text to include.
pub fn rust(protocol: &Protocol, options: &Options) -> String {
    content(protocol, options, &Plan::new(protocol, options))
}

/// Returns the documentation of that module, as inner doc comments to stand before its content.
pub fn manual(protocol: &Protocol, options: &Options) -> String {
    documentation(protocol, options, &Plan::new(protocol, options))
}

/// Returns both, the documentation first. They share a plan, which takes long to make for many messages.
pub fn module(protocol: &Protocol, options: &Options) -> (String, String) {
    let plan = Plan::new(protocol, options);
    (documentation(protocol, options, &plan), content(protocol, options, &plan))
}

fn content(protocol: &Protocol, options: &Options, plan: &Plan) -> String {
    let header = format!("{MARK} from {}; do not edit.\n\n", protocol.file.for_people());
    header + &formatted(items(plan, Derives::new(options)))
}

fn documentation(protocol: &Protocol, options: &Options, plan: &Plan) -> String {
    manual::Manual { protocol, plan, scaled: options.scaled }.text()
}

/// Returns the same content as tokens, for macros and for build scripts that go on with it.
pub fn tokens(protocol: &Protocol, options: &Options) -> TokenStream {
    items(&Plan::new(protocol, options), Derives::new(options)).collect()
}

/// Emits the items in their order, those of one message after the other.
fn items(plan: &Plan, derives: Derives) -> impl Iterator<Item = TokenStream> {
    let enumerations = plan.enumerations.iter().map(move |known| word::enumeration(known, derives));
    let status_words = plan.status_words.iter().map(move |known| word::status_word(known, derives));
    let packed = plan.packed.iter().map(move |known| word::packed(known, derives));
    let messages = plan.messages.iter().zip(&plan.sets).map(move |(message, set)| match set {
        None => {
            let carrier = message.long.as_ref().and_then(|long| plan.carriers[long.id].as_ref()).map(carrier::carrier);
            let message = message::message(message, derives);
            quote!(#message #carrier)
        }
        Some(set) => set::set(message, set, derives),
    });
    let types = enumerations.chain(status_words).chain(packed);
    let transports = plan.transports.iter().map(transport::transport);
    let protocol = iter::once_with(move || protocol::protocol(plan, derives)).flatten();
    let quantities = plan.quantities.iter().map(quantity::quantities);
    let entries = iter::once_with(|| entries::entries(&plan.messages));
    iter::once(head(plan, derives))
        .chain(types)
        .chain(messages)
        .chain(transports)
        .chain(protocol)
        .chain(quantities)
        .chain(entries)
}

/// Emits what comes before the types and messages: imports, identifier, addresses, accesses and device models.
fn head(plan: &Plan, derives: Derives) -> TokenStream {
    let optional = derives.imports(!plan.messages.is_empty());
    let about = about::about(&plan.about);
    let frame = filter::base(&plan.base);
    let selectors = plan.in_data.iter().map(filter::in_data);
    let identifier = identifier::identifier(&plan.identifier, derives);
    let continuation = plan.continuation.as_ref().map(filter::continuation);
    let targets = plan.targets.as_ref().map(|targets| address::targets(targets, &plan.ways, derives));
    let addresses = plan.address_types.iter().map(address::address_type);
    let modes = plan.modes.iter().map(address::mode);
    let timing = plan.timing.as_ref().map(timing::timing);
    let (accesses, of_models) = (plan.accesses.iter().map(exchange::access), model::models(&plan.models, derives));
    quote! {
        use canspec_runtime::plumbing::prelude::*;
        #[doc(no_inline)]
        pub use canspec_runtime::prelude::*;
        #optional
        #about #frame #(#selectors)* #identifier #continuation #targets #(#addresses)* #(#modes)* #timing #(#accesses)* #of_models
    }
}

#[cfg(test)]
mod tests {
    use crate::read::source::Source;

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
        assert!(super::rust(&protocol, &options).ends_with(&super::formatted([quote::quote!(#tokens)])));
        assert!(tokens.items.iter().any(|item| matches!(item, syn::Item::Struct(known) if known.ident == "Heat")));
    }

    #[test]
    fn foreign_identifiers_have_a_test_of_their_own_only_if_they_can_show_what_chooses_a_message() {
        // The command has the bits 28..16, and the message the command 7.
        for (foreign, is_like_own) in [
            ("command: 8", false),
            ("command: 7..8, source: 0", true),
            ("source: 0", true),
            ("command: 8, source: 0", false),
            ("identifier: 0x75000..0x75FFF", true),
            ("identifier: 0x80000..0x8FFFF", false),
            ("identifier: 0x6FFFF..0x70100", true),
        ] {
            let spec = format!("{SPEC}foreign: {{neighbour: {{match: {{{foreign}}}, section: \"6\"}}}}\n");
            let outcome = crate::compile(Source::new("heater.yaml", spec.into()).expect("plain text"));
            let code = super::rust(&outcome.protocol.expect("a spec without errors"), &super::Options::default());
            assert_eq!(code.contains("const FOREIGN_LIKE_OWN: bool = true;"), is_like_own, "{foreign}");
        }
    }

    #[test]
    fn notes_and_sections_stand_in_the_docs_and_of_the_errata_those_that_are_not_about_the_scan() {
        let outcome = crate::compile(Source::new("heater.yaml", SPEC.into()).expect("plain text"));
        let code = super::rust(&outcome.protocol.expect("a spec without errors"), &super::Options::default());
        for part in [
            "/// Set. Section 5.\n///\n/// The reply carries the values now in effect.\npub const SET_ACCESS",
            "    /// Builds the request [`set`](SET_ACCESS) with these values. Refuses values outside their limits,",
            "    /// One heater: `0x00..=0x3F`. Section 4.\n    ///\n    /// Heaters of a group too.\n    Module(u8),\n",
            "steps of 10 W.\n    ///\n    /// Never above the rating.\n    pub power_w: f64,\n",
            "    /// Mode: byte 2.\n    pub mode: Mode",
            "/// Heat: `command` 0x0007. Section 2.\n\
             /// - [`set`](SET_ACCESS): the module answers (`module`).\n\
             /// - Request `000703F0#0001010000000000`: `power` 10 W, `mode` boost.\n\
             /// - Reply `0007F003#0001010000000000`: `power` 10 W, `mode` boost.\n///\n\
             /// Erratum E1: printed is \"kilowatts\", used is \"watts\", because the examples are in watts.\n#[derive",
            "    /// A value without a name; it is sent as it is.\n    Unknown(u8),\n",
        ] {
            assert!(code.contains(part), "{part:?} is not in\n{code}");
        }
    }
}
