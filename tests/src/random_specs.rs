//! Random specs that follow the language reference, with names and texts as hostile as they may be.
//!
//! What the compiler accepts must give Rust that compiles: [`compiled`] compiles many at a time, and [`keys`] counts
//! which keys the specs set where.

pub mod compiled;
mod draft;
mod examples;
mod fields;
mod identifier;
pub mod keys;
mod messages;
mod names;
mod numbers;
mod quantities;
pub mod run;
pub mod yaml;

use canspec_codegen::model::{Protocol, Symbol};
use canspec_codegen::source::Source;
use canspec_codegen::{Outcome, compile};
use serde_yaml::Value;

use draft::Draft;
use messages::Traffic;
use names::Scope;
use yaml::{Map, list, written};

/// A random spec, the same for the same seed.
#[derive(Clone, Debug)]
pub struct Spec {
    /// Where its randomness starts.
    pub seed: u64,
    /// The spec as it is written.
    pub text: String,
    /// The same as a tree.
    pub tree: Value,
}

impl Spec {
    /// Returns the spec of a seed. The compiler reads it once without examples, to make some.
    pub fn new(seed: u64) -> Self {
        let mut draft = Draft::new(seed);
        let mut root = draft.spec();
        if let Ok(protocol) = protocol(&written(&root)) {
            draft.add_examples(&mut root, &protocol);
            draft.add_quantities(&mut root, &protocol);
        }
        Self { seed, text: written(&root), tree: root }
    }

    /// Returns what the compiler makes of it, or its errors in a line each.
    ///
    /// # Errors
    ///
    /// The errors of a spec that is rejected.
    pub fn protocol(&self) -> Result<Protocol, String> {
        protocol(&self.text)
    }
}

fn protocol(text: &str) -> Result<Protocol, String> {
    let source = Source::new("spec.yaml", text.as_bytes().to_vec()).map_err(|errors| errors.concise())?;
    let Outcome { protocol, diagnostics, .. } = compile(source);
    protocol.ok_or_else(|| diagnostics.concise())
}

impl Draft {
    /// Writes a whole spec, without examples of frames.
    fn spec(&mut self) -> Value {
        let mut root = Map::of([("canspec", "1")]);
        root.put("protocol", self.names.plain(&mut Scope::default()));
        root.put("title", self.text());
        let documents = self.named_documents();
        if documents.is_empty() || self.chance(50) {
            root.put("document", self.document());
        }
        if !documents.is_empty() {
            root.put("documents", documents);
        }
        if self.chance(15) {
            let sides = self.some(&[("module", "battery"), ("controller", "inverter")]);
            root.put("sides", Map::of(sides));
        }
        root.put("length", "8");
        if self.chance(20) {
            root.put("bit_rates", self.one(&[list(["125 kbit/s"]), list(["125 kbit/s", "1 Mbit/s"])]));
        }
        if self.chance(15) {
            let reserved = self.reserved();
            root.put("reserved", reserved);
        }
        if self.chance(15) {
            root.put("absent", "none");
        }
        let errata = self.all_errata();
        if self.chance(20) {
            let after_silence = self.after_silence();
            root.put("after_silence", after_silence);
        }
        let timing = self.timing();
        self.name_models();
        let units = self.own_units();
        let bus = self.bus();
        let mut traffic = self.traffic(&bus);
        self.exampled_types();
        let procedures = self.procedures(&traffic.messages);
        let models = self.device_models();
        let allow = self.allow(&traffic.messages);
        self.by_isotp(&bus, &mut traffic);
        let timing = self.roles(timing, &traffic);
        let maps = [
            ("units", units),
            ("identifier", bus.identifier),
            ("header", bus.header),
            ("types", std::mem::take(&mut self.types)),
            ("addressing", bus.addressing),
            ("access", traffic.access),
            ("foreign", traffic.foreign),
            ("transports", traffic.transports),
            ("messages", traffic.messages),
            ("models", models),
            ("timing", timing),
            ("procedures", procedures),
            ("errata", errata),
        ];
        maps.into_iter().filter(|(_, map)| !map.is_empty()).for_each(|(key, map)| root.put(key, map));
        if let Some(allow) = allow {
            root.put("allow", allow);
        }
        root.into()
    }

    /// Makes documents with names, in few specs.
    fn named_documents(&mut self) -> Map {
        let (mut documents, mut scope) = (Map::default(), Scope::default());
        let count = if self.chance(15) { self.random.u8(1..=3) } else { 0 };
        for _ in 0..count {
            let name = self.names.of_document(&mut scope);
            self.documents.push(name.clone());
            documents.put(name, self.document());
        }
        documents
    }

    fn document(&mut self) -> Map {
        let mut document = Map::of([("title", self.text()), ("version", self.text())]);
        for key in ["date", "file"] {
            if self.chance(30) {
                let text = self.text();
                document.put(key, text);
            }
        }
        document
    }

    /// Declares units, each with a short name.
    fn own_units(&mut self) -> Map {
        let (mut units, mut scope) = (Map::default(), Scope::default());
        for symbol in ["l/min", "kg", "N·m", "$&<|>"] {
            let name = self.names.name(&mut scope);
            if self.chance(20) && name.len() <= Symbol::LONGEST {
                units.put(name, symbol);
                self.units.push(symbol.to_owned());
            }
        }
        units
    }

    fn all_errata(&mut self) -> Map {
        let (mut errata, mut scope) = (Map::default(), Scope::default());
        for _ in 0..self.random.u8(1..=3) {
            let kind = self.one(&["vendor", "translation", "ocr", "unclear", "gap", "note"]);
            let mut erratum = Map::of([("kind", kind)]);
            for key in ["prints", "uses", "because"] {
                let text = self.text();
                erratum.put(key, text);
            }
            if self.chance(30) {
                let section = self.section();
                erratum.put("section", section);
            }
            let name = self.names.of_document(&mut scope);
            self.errata.push(name.clone());
            errata.put(name, erratum);
        }
        errata
    }

    fn after_silence(&mut self) -> Map {
        let output = self.one(&["off", "resumes", "starts", "keeps", "unknown"]);
        let mut after_silence = Map::of([("output", output)]);
        self.remark(&mut after_silence);
        after_silence
    }

    fn timing(&mut self) -> Map {
        let (mut timing, mut scope) = (Map::default(), Scope::default());
        for _ in 0..self.random.u8(..3) {
            let mut time = Map::of([("time", self.one(&["10 s", "50..200 ms", "1.5 min", "0.5..1 h"]))]);
            if self.chance(30) {
                time.put("minimum", self.one(&["20 ms", "1 s"]));
            }
            self.remark(&mut time);
            let name = self.names.name(&mut scope);
            self.times.push(name.clone());
            timing.put(name, time);
        }
        timing
    }

    /// Says what times are for, and sometimes which message they are about.
    fn roles(&mut self, mut timing: Map, traffic: &Traffic) -> Map {
        let asked = traffic.asked();
        let mut roles = vec!["request_gap", "reply_timeout", "watchdog", "boot", "settling"];
        for time in timing.0.values_mut().filter_map(Value::as_mapping_mut) {
            if self.chance(40) {
                continue;
            }
            let role = roles.swap_remove(self.random.usize(..roles.len()));
            time.insert("role".into(), role.into());
            if role == "reply_timeout" && self.random.bool() {
                time.insert("tries".into(), self.one(&["1", "2", "0xFF"]).into());
            }
            if role != "boot" && !asked.is_empty() && self.random.bool() {
                time.insert("messages".into(), list(self.some(&asked)));
            }
        }
        timing
    }

    /// Names the device models: mostly few, and sometimes more than a byte counts.
    fn name_models(&mut self) {
        let mut scope = Scope::default();
        let count = match self.random.u16(..200) {
            0 => 255 + self.random.usize(..4),
            1..=70 => self.random.usize(1..=4),
            _ => 0,
        };
        for index in 0..count {
            let name = if index < 4 { self.names.of_document(&mut scope) } else { format!("Q{index}_{count}") };
            self.models.push(name);
        }
    }

    fn device_models(&mut self) -> Map {
        let names = self.models.clone();
        Map::of(names.into_iter().map(|name| (name, self.device_model())).collect::<Vec<_>>())
    }

    fn device_model(&mut self) -> Map {
        let mut model = Map::default();
        if self.chance(30) {
            let items = self.texts(1..=3);
            model.put("items", items);
        }
        if self.chance(30) {
            model.put("max_parallel", self.one(&["1", "60", "0xFFFF"]));
        }
        if self.chance(30) {
            model.put("bit_rates", list(["125 kbit/s"]));
        }
        if self.chance(30) {
            let name = self.names.name(&mut Scope::default());
            model.put("facts", Map::of([(name, self.one(&["20 A", "1/3", "-40 °C"]))]));
        }
        let types = self.types_of_model();
        if !types.is_empty() {
            model.put("types", types);
        }
        self.remark(&mut model);
        model
    }

    fn types_of_model(&mut self) -> Map {
        let mut types = Map::default();
        for index in 0..self.limited.len() {
            if self.random.bool() {
                let known = self.limited[index].name.clone();
                let mut change = self.one(&self.limited[index].changes.clone());
                self.refer(&mut change);
                types.put(known, change);
            }
        }
        types
    }

    /// Adds types with examples of their bytes.
    fn exampled_types(&mut self) {
        if !self.chance(30) {
            return;
        }
        let scope = &mut Scope::default();
        let name = self.names.name(scope);
        let (mut keys, bytes, means) = match self.random.u8(..4) {
            0 => (Map::of([("as", "float")]), "43FA0000", "500".to_owned()),
            1 => (Map::of([("scale", "1/10"), ("unit", "V")]), "0A", "1 V".to_owned()),
            2 => (Map::of([("as", "text")]), "4131", "A1".to_owned()),
            _ => (Map::of([("values", Map::of([("0xFF", name.clone())]))]), "FF", name),
        };
        let mut example = Map::of([("bytes", bytes.to_owned()), ("means", means)]);
        self.refer(&mut example);
        keys.put("examples", list([example]));
        self.add_type(keys);
    }

    fn procedures(&mut self, messages: &Map) -> Map {
        let (mut procedures, mut scope) = (Map::default(), Scope::default());
        for _ in 0..self.random.u8(..2) {
            let message = messages.0.keys().next().and_then(Value::as_str).unwrap_or_default();
            let mut procedure = Map::of([("steps", list(["Wait 10 s".to_owned(), format!("Read `{message}`")]))]);
            self.remark(&mut procedure);
            procedures.put(self.names.name(&mut scope), procedure);
        }
        procedures
    }

    fn allow(&mut self, messages: &Map) -> Option<Value> {
        let message = messages.0.keys().next().and_then(Value::as_str).filter(|_| self.chance(15))?.to_owned();
        let rule = self.one(&["section", "spelling", "no_unit", "unused_type"]);
        let because = self.text();
        let allowance = [("rule", rule.to_owned()), ("at", format!("messages.{message}")), ("because", because)];
        Some(list([Map::of(allowance)]))
    }
}
