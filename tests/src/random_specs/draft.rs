//! What the parts of a random spec have in common: chance, names, remarks and types.

use std::ops::RangeInclusive;

use fastrand::Rng;
use serde_yaml::Value;

use super::names::{Names, Scope};
use super::yaml::{Map, list};

/// Keys that a field keeps for itself: no type passes them on.
const OWN: [&str; 4] = ["note", "section", "erratum", "type"];

/// A spec in the making.
pub struct Draft {
    pub random: Rng,
    pub names: Names,
    /// Names that begin sections.
    pub documents: Vec<String>,
    pub errata: Vec<String>,
    pub types: Map,
    /// Names of types.
    pub type_scope: Scope,
    /// Letters of what becomes a type in Rust.
    pub letters: Scope,
    /// Types that say all of a field but its place.
    pub whole: Vec<Whole>,
    /// Types that device models can limit.
    pub limited: Vec<Limited>,
    /// Units that the spec declares.
    pub units: Vec<String>,
    /// Names of device models.
    pub models: Vec<String>,
    /// Names of times.
    pub times: Vec<String>,
}

/// A type that says all of a field but its place.
#[derive(Clone)]
pub struct Whole {
    pub name: String,
    pub bits: u8,
}

/// A type, and what device models can say of it.
pub struct Limited {
    pub name: String,
    /// What each of them can say.
    pub changes: Vec<Map>,
}

impl Draft {
    pub fn new(seed: u64) -> Self {
        let mut random = Rng::with_seed(seed);
        let names = Names::new(random.fork());
        Self {
            random,
            names,
            documents: Vec::new(),
            errata: Vec::new(),
            types: Map::default(),
            type_scope: Scope::default(),
            letters: Scope::default(),
            whole: Vec::new(),
            limited: Vec::new(),
            units: Vec::new(),
            models: Vec::new(),
            times: Vec::new(),
        }
    }

    /// Is true in `percent` of a hundred cases.
    pub fn chance(&mut self, percent: u8) -> bool {
        self.random.u8(..100) < percent
    }

    /// Returns one of some things.
    pub fn one<T: Clone>(&mut self, of: &[T]) -> T {
        of[self.random.usize(..of.len())].clone()
    }

    /// Returns some of some things, at least one, in their order.
    pub fn some<T: Clone>(&mut self, of: &[T]) -> Vec<T> {
        let sure = self.random.usize(..of.len());
        let chosen = of.iter().enumerate().filter(|(index, _)| *index == sure || self.random.bool());
        chosen.map(|(_, item)| item.clone()).collect()
    }

    /// Returns a number as a spec can write it.
    pub fn number(&mut self, number: impl Into<i128>) -> String {
        let number = number.into();
        if number >= 0 && self.chance(40) { format!("0x{number:X}") } else { number.to_string() }
    }

    pub fn text(&mut self) -> String {
        self.names.text()
    }

    pub fn texts(&mut self, count: RangeInclusive<usize>) -> Value {
        let count = self.random.usize(count);
        list((0..count).map(|_| self.names.text()))
    }

    /// Adds remarks, a title and a note among them.
    pub fn remark(&mut self, item: &mut Map) {
        if self.chance(20) {
            let title = self.text();
            item.put("title", title);
        }
        if self.chance(15) {
            let note = self.text();
            item.put("note", note);
        }
        self.refer(item);
    }

    /// Adds the remarks that refer to something.
    pub fn refer(&mut self, item: &mut Map) {
        if self.chance(15) {
            let section = self.section();
            item.put("section", section);
        }
        if self.chance(10) {
            let erratum = self.erratum();
            item.put("erratum", erratum);
        }
    }

    /// Returns a section, in one of the documents if they have names.
    pub fn section(&mut self) -> String {
        let (documents, text) = (self.documents.clone(), self.text());
        if documents.is_empty() { text } else { format!("{} {}", self.one(&documents), text.replace(';', ",")) }
    }

    fn erratum(&mut self) -> Value {
        let errata = self.errata.clone();
        if self.random.bool() { self.one(&errata).into() } else { list(self.some(&errata)) }
    }

    /// Returns the name of a new type; one that becomes a type in Rust too stays apart from others.
    pub fn type_name(&mut self, becomes_type: bool) -> String {
        let Self { names, type_scope, letters, .. } = self;
        if becomes_type {
            return names.apart(type_scope, letters);
        }
        if self.random.bool() { names.of_document(type_scope) } else { names.name(type_scope) }
    }

    /// Moves some keys of a field into types, never those that have to stay.
    pub fn with_types(&mut self, field: Map, staying: &[&str], bits: u8) -> Map {
        if !self.chance(35) {
            return field;
        }
        let stays = |key: &str| OWN.contains(&key) || staying.contains(&key);
        let (mut own, mut moved) = (Map::default(), Map::default());
        let all = self.random.bool();
        for (key, value) in field.0 {
            let name = key.as_str().unwrap_or_default().to_owned();
            let into = if stays(&name) || !(all || self.random.bool()) { &mut own } else { &mut moved };
            into.put(name, value);
        }
        if moved.is_empty() {
            return own;
        }
        let is_whole = all
            && ["in", "models", "reply", "bytes", "bits", "repeat", "fields", "const"]
                .iter()
                .all(|key| !moved.has(key));
        let name = self.add_types(moved);
        if is_whole {
            self.whole.push(Whole { name: name.clone(), bits });
        }
        let named = if self.chance(30) { list([name]) } else { name.into() };
        own.put("type", named);
        own
    }

    /// Adds a type, or two types where one takes keys from the other. Returns the name of the last
    /// one.
    fn add_types(&mut self, keys: Map) -> String {
        if keys.0.len() < 2 || !self.chance(30) {
            return self.add_type(keys);
        }
        let (mut first, mut second) = (Map::default(), Map::default());
        for (index, (key, value)) in keys.0.into_iter().enumerate() {
            let into = if index % 2 == 0 { &mut first } else { &mut second };
            into.put(key.as_str().unwrap_or_default(), value);
        }
        let base = self.add_type(first);
        let named = if self.chance(30) { list([base]) } else { base.into() };
        second.put("type", named);
        self.add_type(second)
    }

    /// Adds a type.
    pub fn add_type(&mut self, mut keys: Map) -> String {
        let name = self.type_name(keys.has("values") || keys.has("status"));
        if self.chance(15) {
            let note = self.text();
            keys.put("note", note);
        }
        if (keys.has("fields") && !keys.has("format")) || keys.has("note") && self.random.bool() {
            keys.0.remove("note");
        }
        self.refer(&mut keys);
        self.types.put(name.clone(), keys);
        name
    }
}
