//! Fields take keys from the types they name; named values and status words become types of their own.

use super::Resolver;
use super::texts::remarks;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{Doc, Enumeration, NamedValue, Severity, StatusBit, StatusWord, raw_limits};
use crate::syntax::ast::{self, Field};
use crate::syntax::tree::Path;

/// A field together with the keys of its types.
pub struct Merged {
    pub field: Field,
    /// Where a key can stand: the field itself, then its types from the last to the first.
    pub sources: Vec<Path>,
    /// Names of the types, in the same order.
    pub types: Vec<String>,
}

impl Merged {
    /// Returns where `key` is written.
    pub fn path(&self, diagnostics: &Diagnostics, key: &str) -> Path {
        let written = self
            .sources
            .iter()
            .map(|source| source.key(key))
            .find(|path| diagnostics.tree().is_some_and(|tree| tree.get(path).is_some()));
        written.unwrap_or_else(|| self.sources[0].clone())
    }
}

/// Takes a key from a type where the field does not have it.
macro_rules! take {
    ($field:expr, $other:expr, $($option:ident)*; $($map:ident)*) => {
        $(if $field.$option.is_none() { $field.$option.clone_from(&$other.$option); })*
        $(if $field.$map.is_empty() { $field.$map.clone_from(&$other.$map); })*
    };
}

impl Resolver<'_> {
    /// Returns the remarks of every type.
    pub fn type_docs(&self) -> Vec<Doc> {
        let root = Path::default().key("types");
        self.spec.types.iter().map(|(name, field)| remarks!(field).doc(&root.key(name), None)).collect()
    }

    /// Tests the names of types, and that each is used.
    pub fn check_types_used(&mut self) {
        let root = Path::default().key("types");
        let spec = self.spec;
        for (name, field) in &spec.types {
            self.check_document_name(&root.key(name), name);
            let is_address =
                super::addressing::patterns(spec).any(|(_, pattern)| pattern.values().any(|what| what == name));
            if is_address || self.tables.used_types.contains(name) {
                continue;
            }
            if field.examples.is_empty() {
                let diagnostic = Diagnostic::warning(
                    "unused_type",
                    root.key(name).at_key(),
                    format!("nothing uses the type `{name}`"),
                );
                self.diagnostics.push(diagnostic.help("name it in a field or in an addressing mode, or take it out"));
            }
        }
    }

    /// Tests the name of a type or a device model, which may have capitals as documents have them.
    pub fn check_document_name(&mut self, path: &Path, name: &str) {
        let plain = name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !plain || !name.starts_with(|letter: char| letter.is_ascii_alphabetic()) {
            let help = "names of types and models are letters, digits and `_`, and start with a letter";
            self.error_with_help("identifier_name", path.at_key(), format!("`{name}` is not a name"), help);
        }
    }

    /// Adds the keys of a field's types to its own, which win.
    pub fn merged(&mut self, path: &Path, field: &Field) -> Option<Merged> {
        let mut merged = Merged { field: field.clone(), sources: vec![path.clone()], types: Vec::new() };
        self.merge_types(path, &field.types.0, &mut merged, &[])?;
        Some(merged)
    }

    fn merge_types(&mut self, path: &Path, names: &[String], merged: &mut Merged, outer: &[&str]) -> Option<()> {
        let spec = self.spec;
        for name in names.iter().rev() {
            let at = path.key("type");
            let index = self.lookup(&at, "type", name, spec.types.keys().map(String::as_str))?;
            let (name, other) = spec.types.get_index(index)?;
            if outer.contains(&name.as_str()) {
                self.error("type", at.at_value(), format!("the type `{name}` takes keys from itself"));
                return None;
            }
            if merged.types.contains(name) {
                continue;
            }
            let source = Path::default().key("types").key(name);
            merged.sources.push(source.clone());
            merged.types.push(name.clone());
            self.tables.used_types.push(name.clone());
            let field = &mut merged.field;
            take!(field, other, bytes bits format_of_number scale offset unit range format constant send normal continues default outside title;
                values fields status kinds reply);
            self.merge_types(&source, &other.types.0, merged, &[outer, &[name.as_str()]].concat())?;
        }
        Some(())
    }

    /// Returns the type whose key it is, or else the name that the field itself suggests.
    fn type_name(&self, merged: &Merged, key: &str, otherwise: &str) -> (String, Path) {
        let path = merged.path(self.diagnostics, key);
        let own = merged.sources[0].key(key);
        let types = merged.types.iter().zip(&merged.sources[1..]);
        let mut writing = types.filter(|(_, source)| source.key(key) == path);
        match writing.next() {
            Some((name, source)) if path != own => (name.clone(), source.clone()),
            _ => (otherwise.to_owned(), merged.sources[0].clone()),
        }
    }

    /// Returns the remarks of a type, or those of the field if the type is its own.
    fn type_doc(&self, name: &str, source: &Path, field: &Doc) -> Doc {
        let known = self.spec.types.get(name).filter(|_| *source == Path::default().key("types").key(name));
        known.map_or_else(|| field.clone(), |known| remarks!(known).doc(source, Some(field)))
    }

    /// Finds or makes the named values of a field, if it has any.
    pub fn enumeration(&mut self, merged: &Merged, otherwise: &str, width: u8, doc: &Doc) -> Option<usize> {
        if merged.field.values.is_empty() {
            return None;
        }
        let (name, source) = self.type_name(merged, "values", otherwise);
        let made = |known: &Enumeration| known.name == name && known.doc.path == source;
        if let Some(index) = self.tables.enumerations.iter().position(made) {
            let known = &mut self.tables.enumerations[index];
            known.width = known.width.max(width);
            return Some(index);
        }
        let values = self.values(&merged.path(self.diagnostics, "values"), &merged.field.values, width, false);
        let doc = self.type_doc(&name, &source, doc);
        self.tables.enumerations.push(Enumeration { name, doc, width, values });
        Some(self.tables.enumerations.len() - 1)
    }

    /// Reads `{raw: name}`.
    pub fn values(&mut self, path: &Path, values: &ast::Map<String>, width: u8, signed: bool) -> Vec<NamedValue> {
        let (first, last) = raw_limits(width, signed);
        let mut named: Vec<NamedValue> = Vec::new();
        let mut places = Vec::new();
        for (raw, name) in values {
            let at = path.key(raw);
            self.check_value_name(&at, name);
            let Some(number) = self.raw_key(&at, raw, first, last) else { continue };
            let repeats = |earlier: &NamedValue| earlier.raw == number || earlier.name == *name;
            if let Some(index) = named.iter().position(repeats) {
                let message = if named[index].raw == number {
                    format!("the raw value {number} has two names")
                } else {
                    format!("`{name}` is the name of two raw values")
                };
                let diagnostic = Diagnostic::error("named_value", at.at_key(), message);
                self.diagnostics.push(diagnostic.other(Path::at_key(&places[index]), "the other one"));
                continue;
            }
            places.push(at);
            named.push(NamedValue { raw: number, name: name.clone() });
        }
        named
    }

    fn raw_key(&mut self, path: &Path, text: &str, first: i128, last: i128) -> Option<i128> {
        let whole = crate::number::Rational::parse(text).and_then(crate::number::Rational::to_integer);
        let fitting = whole.filter(|whole| (first..=last).contains(whole));
        if fitting.is_none() {
            let message = format!("the raw value `{text}` is not a whole number from {first} to {last}");
            self.error("value_width", path.at_key(), message);
        }
        fitting
    }

    fn check_value_name(&mut self, path: &Path, name: &str) {
        let plain = name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_');
        if !plain || !name.starts_with(|letter: char| letter.is_ascii_lowercase()) {
            let help = "names are lower-case letters, digits and `_`, and start with a letter";
            self.error_with_help("identifier_name", path.at_value(), format!("`{name}` is not a name"), help);
        }
    }

    /// Finds or makes the status word of a field.
    pub fn status_word(&mut self, merged: &Merged, otherwise: &str, width: u8, doc: &Doc) -> usize {
        let (name, source) = self.type_name(merged, "status", otherwise);
        let made = |known: &StatusWord| known.name == name && known.doc.path == source;
        if let Some(index) = self.tables.status_words.iter().position(made) {
            let known = &mut self.tables.status_words[index];
            known.width = known.width.max(width);
            return index;
        }
        let doc = self.type_doc(&name, &source, doc);
        let path = merged.path(self.diagnostics, "status");
        let entries = merged.field.status.iter();
        let mut bits: Vec<_> =
            entries.filter_map(|(name, bit)| self.status_bit(&path.key(name), name, bit, width, &doc)).collect();
        bits.sort_by_key(|bit| bit.bit);
        self.check_status_bits(&bits);
        self.tables.status_words.push(StatusWord { name, doc, width, bits });
        self.tables.status_words.len() - 1
    }

    fn status_bit(
        &mut self,
        path: &Path,
        name: &str,
        bit: &ast::StatusBit,
        width: u8,
        outer: &Doc,
    ) -> Option<StatusBit> {
        const SEVERITIES: [(&str, Severity); 3] =
            [("state", Severity::State), ("alarm", Severity::Alarm), ("fault", Severity::Fault)];
        self.check_name(path, name);
        let severity = bit.severity.as_ref().and_then(|text| {
            self.lookup(&path.key("severity"), "severity", text, SEVERITIES.iter().map(|(name, _)| *name))
        });
        Some(StatusBit {
            name: name.to_owned(),
            doc: remarks!(bit).doc(path, Some(outer)),
            bit: self.bit(&path.key("bit"), &bit.bit, width)?,
            severity: severity.map(|index| SEVERITIES[index].1),
            set_when: bit.set_when.clone(),
            clear_when: bit.clear_when.clone(),
            effect: bit.effect.clone(),
            led: bit.led.clone(),
        })
    }

    /// Reads the number of a bit of a word.
    fn bit(&mut self, path: &Path, text: &str, width: u8) -> Option<u8> {
        let number = self.integer(path, text, 0, u8::MAX)?;
        if number >= width {
            let help = format!("its bits are 0 to {}; correct the bit, or the place of the word", width - 1);
            let message = format!("there is no bit {number} in this word of {width} bits");
            self.error_with_help("number", path.at_value(), message, help);
            return None;
        }
        Some(number)
    }

    fn check_status_bits(&mut self, bits: &[StatusBit]) {
        for pair in bits.windows(2).filter(|pair| pair[0].bit == pair[1].bit) {
            let message = format!("bit {} has two names: `{}` and `{}`", pair[0].bit, pair[0].name, pair[1].name);
            let diagnostic = Diagnostic::error("status_bit", pair[1].doc.path.at_key(), message);
            self.diagnostics.push(diagnostic.other(pair[0].doc.path.at_key(), "the other name"));
        }
    }
}
