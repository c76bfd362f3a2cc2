//! Turns what is written into what is meant: names become references, places masks, and texts
//! numbers.
//!
//! This stage makes the model: types, addresses and modes first, then fields and messages, their
//! frames, and what depends on all of them, such as sets, examples and the plan by which frames are
//! recognised. Each file reads the keys of one part of the language, and reports what it cannot
//! read; a part with an error is given up, so that the others are still looked at.

mod absent;
mod access;
mod addressing;
mod arrays;
mod data;
mod derivation;
mod direction;
mod encodings;
mod examples;
mod fields;
mod format;
mod head;
mod identifier;
mod keys;
mod leaves;
mod lengths;
mod long;
mod messages;
mod parts;
mod patterns;
mod printed;
mod product;
mod quantities;
pub(crate) mod rules;
mod runs;
mod scales;
mod sending;
mod sets;
mod sides;
mod signals;
mod silence;
mod status;
mod texts;
mod timing;
mod transports;
mod types;
mod units;
mod window;

use std::collections::{HashMap, HashSet};

use indexmap::{IndexMap, IndexSet};

use crate::encoding::Words;
use crate::model::{
    self, Allowance, EnumerationId, LongMessageId, ModelId, Protocol, Recognition, SelectorId, StatusWordId, Table,
    TransportId,
};
use crate::read::syntax::ast;
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
use crate::report::rule::Rule;
use crate::report::tree::Path;
use crate::words::text::Text;

/// Resolves a spec. `file` is its name without folders, and `rules` are the rules that it can
/// allow.
///
/// The protocol is `None` if something that it needs is missing. If there are errors, the protocol
/// is only good for further checks.
pub fn resolve(
    spec: &ast::Spec,
    file: Text,
    rules: &[&'static Rule],
    diagnostics: &mut Diagnostics,
) -> Option<Protocol> {
    let with_frames = (!spec.transports.is_empty()).then(|| transports::expanded(spec));
    let spec = with_frames.as_ref().unwrap_or(spec);
    let widest_uses = types::widest_uses(spec);
    Resolver { spec, rules, diagnostics, widest_uses, tables: Tables::default() }.protocol(file)
}

/// The state of the stage.
struct Resolver<'a> {
    spec: &'a ast::Spec,
    rules: &'a [&'static Rule],
    diagnostics: &'a mut Diagnostics,
    /// How many bits the widest field of each type has.
    widest_uses: HashMap<&'a str, u8>,
    tables: Tables,
}

/// Tables of the model that grow while messages are resolved.
#[derive(Default)]
struct Tables {
    selectors: Table<SelectorId, model::Selector>,
    /// The selectors that the header declares.
    header: Vec<SelectorId>,
    enumerations: Table<EnumerationId, model::Enumeration>,
    /// Named values by their name, and by where they are written.
    enumerations_made: HashMap<(String, Path), EnumerationId>,
    status_words: Table<StatusWordId, model::StatusWord>,
    /// Status words, in the same way.
    status_words_made: HashMap<(String, Path), StatusWordId>,
    /// Where the spec says how wide the widest place of each status word is.
    widest_words: Table<StatusWordId, At>,
    /// The bits that are named by their byte, each in all words that have it.
    bits_by_byte: IndexMap<Path, status::BitByByte>,
    /// Remarks of words. Words are no signals themselves.
    words: Vec<model::Doc>,
    /// Fields that were given up because of an error, by message. What examples say about them is
    /// not tested.
    given_up: HashMap<String, IndexSet<String>>,
    /// The same for the header.
    given_up_header: Vec<String>,
    /// Types that a field names.
    used_types: HashSet<String>,
    models: Table<ModelId, model::DeviceModel>,
    /// How often device models change fields so far.
    changes_by_models: usize,
    transports: Table<TransportId, model::Transport>,
    long_messages: Table<LongMessageId, model::LongMessage>,
    long_examples: Vec<model::LongExample>,
    /// The units that the spec declares, and whether something has them.
    units: Vec<(model::Unit, bool)>,
    /// Number of fields in the current message so far.
    fields: usize,
    /// Whether all ones mean that there is no value, unless a field says otherwise.
    absent_are_ones: bool,
}

impl Resolver<'_> {
    fn protocol(mut self, file: Text) -> Option<Protocol> {
        self.version();
        let name = self.protocol_name();
        let bit_rates = self.bit_rates(&Path::default().key("bit_rates"), &self.spec.bit_rates.clone());
        let sides = self.sides();
        self.tables.units = self.units();
        let timing = self.timing();
        self.tables.models = self.models();
        let after_silence = self.after_silence();
        let procedures = self.procedures();
        let errata = self.errata();
        self.tables.absent_are_ones = self.absent_of_protocol();
        let identifier = self.identifier()?;
        self.header_selectors();
        self.transports(&identifier);
        let address_types = self.address_types();
        let modes = self.modes(&identifier, &address_types);
        let directions = direction::directions(&identifier, &address_types, &modes);
        let accesses = self.accesses(&modes, &timing);
        let (mut messages, frames) = self.messages(&identifier, &modes, &accesses, &timing);
        self.check_width_of_words();
        self.check_bits_by_byte();
        let foreign = self.foreign(&identifier);
        let quantities = self.quantities(&messages);
        let limits = self.limits(&quantities, &mut messages);
        let examples = self.examples(&identifier, &messages);
        let value_examples = self.value_examples();
        let (sequences, types, documents) = (self.sequences(), self.named_types(), self.documents());
        self.check_types_used();
        self.check_units_used();
        self.check_allowances();
        let (derivation, allowances) = (self.derivation(&messages), self.allowances());
        Some(Protocol {
            name,
            file,
            derivation,
            title: Text::new(&self.spec.title.0),
            documents,
            sides,
            bit_rates,
            identifier,
            address_types,
            modes,
            accesses,
            foreign,
            quantities,
            limits,
            messages,
            transports: self.tables.transports,
            long_messages: self.tables.long_messages,
            recognition: Recognition::new(directions, &frames, &self.tables.selectors),
            frames,
            timing,
            after_silence,
            procedures,
            examples,
            long_examples: self.tables.long_examples,
            value_examples,
            sequences,
            types,
            errata,
            allowances,
            models: self.tables.models,
            words: self.tables.words,
            selectors: self.tables.selectors,
            enumerations: self.tables.enumerations,
            status_words: self.tables.status_words,
        })
    }

    /// Returns the tables that encodings refer to, as far as they are known.
    fn words(&self) -> Words<'_> {
        Words {
            enumerations: &self.tables.enumerations,
            statuses: &self.tables.status_words,
            models: &self.tables.models,
        }
    }

    /// Returns the warnings that the spec accepts.
    fn allowances(&self) -> Vec<Allowance> {
        let allowance = |ast::Allowance { rule, at, because }: &ast::Allowance| Allowance {
            rule: Text::new(rule),
            at: Text::new(at),
            because: Text::new(&because.0),
        };
        self.spec.allow.iter().map(allowance).collect()
    }

    /// Tests that the allowances name rules.
    fn check_allowances(&mut self) {
        let root = Path::default().key("allow");
        for (index, allowance) in self.spec.allow.iter().enumerate() {
            let names = self.rules.iter().map(|rule| rule.name);
            self.lookup(&root.index(index).key("rule"), "rule", &allowance.rule, names);
        }
    }

    /// Reports an error and what to do about it.
    fn error_with_help(&mut self, rule: &'static Rule, at: At, message: String, help: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(rule, at, message).help(help));
    }
}
