//! Gives fields the keys of their types, and makes types of named values.

use std::collections::HashMap;

use super::Resolver;
use super::texts::{remarks, text};
use crate::model::{Doc, Enumeration, EnumerationId, NamedType, NamedValue, Numeral};
use crate::read::syntax::ast::{self, Field, Key};
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;
use crate::words::text::Text;

/// Largest number of types in a chain, in which each takes keys from the next.
const CHAIN_LIMIT: usize = 64;

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
    pub fn path(&self, diagnostics: &Diagnostics, key: Key) -> Path {
        let written = self.sources.iter().map(|source| source.key(key)).find(|path| diagnostics.has(path));
        written.unwrap_or_else(|| self.sources[0].clone())
    }
}

impl Merged {
    /// Returns the type that a key is written in, or nothing if the field itself has it.
    pub fn type_at(&self, key: &Path) -> Option<&String> {
        let outer = key.split().map(|(outer, _)| outer);
        let types = self.types.iter().zip(&self.sources[1..]);
        types.into_iter().find(|(_, source)| Some(*source) == outer).map(|(name, _)| name)
    }
}

/// Returns what a type says of bits, as it is written.
fn keys(field: &Field) -> Vec<(String, Text)> {
    let types = (!field.types.0.is_empty()).then(|| field.types.0.join(", "));
    let Field { bytes, bits, format_of_number, scale, offset, unit, range, .. } = field;
    let of_type = std::iter::once((Key::Type, types.as_ref()));
    let keys = [
        (Key::Bytes, bytes),
        (Key::Bits, bits),
        (Key::As, format_of_number),
        (Key::Scale, scale),
        (Key::Offset, offset),
        (Key::Unit, unit),
        (Key::Range, range),
    ];
    let keys = of_type.chain(keys.map(|(key, text)| (key, text.as_ref())));
    keys.filter_map(|(key, text)| Some((key.name().to_owned(), Text::new(text?)))).collect()
}

impl Resolver<'_> {
    /// Returns every type.
    pub fn named_types(&self) -> Vec<NamedType> {
        let root = Path::default().key("types");
        let named = |(name, field): (&String, &Field)| NamedType {
            doc: remarks!(field).doc(&root.key(name), None),
            keys: keys(field),
        };
        self.spec.types.iter().map(named).collect()
    }

    /// Tests the names of types, and that each is used.
    pub fn check_types_used(&mut self) {
        let root = Path::default().key("types");
        let spec = self.spec;
        for (name, field) in &spec.types {
            self.check_document_name(&root.key(name), name);
            let is_address = super::patterns::is_address_type(spec, name);
            let is_used = is_address || self.tables.used_types.contains(name) || !field.examples.is_empty();
            if !is_used && !self.diagnostics.has_errors() {
                let diagnostic = Diagnostic::warning(
                    &rules::UNUSED_TYPE,
                    root.key(name).at_key(),
                    format!("nothing uses the type `{name}`"),
                );
                self.diagnostics.push(diagnostic.help("name it in a field or in an addressing mode, or take it out"));
            }
        }
    }

    /// Tests the name of a type or a device model, which may have the document's capital letters.
    pub fn check_document_name(&mut self, path: &Path, name: &str) {
        let plain = name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !plain || !name.starts_with(|letter: char| letter.is_ascii_alphabetic()) {
            let help = "names of types and models are letters, digits and `_`, and start with a letter";
            self.error_with_help(&rules::IDENTIFIER_NAME, path.at_key(), format!("`{name}` is not a name"), help);
        }
    }

    /// Adds the keys of a field's types to its own keys. Its own keys win.
    pub fn merged(&mut self, path: &Path, field: &Field) -> Option<Merged> {
        let mut merged = Merged { field: field.clone(), sources: vec![path.clone()], types: Vec::new() };
        self.merge_types(path, &field.types.0, &mut merged, &[])?;
        Some(merged)
    }

    fn merge_types(&mut self, path: &Path, names: &[String], merged: &mut Merged, outer: &[&str]) -> Option<()> {
        let spec = self.spec;
        for name in names.iter().rev() {
            let at = path.key("type");
            let Some((_, name, other)) = spec.types.get_full(name) else {
                let fields = spec.types.keys().filter(|name| !super::patterns::is_address_type(spec, name));
                let offered: Vec<_> = fields.map(String::as_str).collect();
                self.report_name(at.at_value(), "type", name, &offered, Some("define it in `types`"));
                return None;
            };
            if let Some(first) = outer.iter().position(|known| known == name) {
                self.report_ring(&outer[first..]);
                return None;
            }
            if outer.len() == CHAIN_LIMIT {
                let text = format!("more than {CHAIN_LIMIT} types take keys from one another, down to `{name}`");
                self.error_with_help(&rules::TYPE, at.at_value(), text, "write the keys into fewer types");
                return None;
            }
            if merged.types.contains(name) {
                continue;
            }
            let source = Path::default().key("types").key(name);
            merged.sources.push(source.clone());
            merged.types.push(name.clone());
            self.tables.used_types.insert(name.clone());
            merged.field.inherit(other);
            self.merge_types(&source, &other.types.0, merged, &[outer, &[name.as_str()]].concat())?;
        }
        Some(())
    }

    /// Reports a ring of types once. Each of them names the next, and the last names the first.
    fn report_ring(&mut self, names: &[&str]) {
        let places = names.iter().map(|name| Path::default().key("types").key(*name).key("type"));
        let places: Vec<_> = places.collect();
        if places.iter().any(|place| self.diagnostics.has_errors_in(place)) {
            return;
        }
        let listed: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
        let text = match listed.as_slice() {
            [own] => format!("the type {own} names itself"),
            [one, other] => format!("the types {one} and {other} name each other"),
            _ => format!("each of the types {} names the next, and the last the first", listed.join(", ")),
        };
        let mut places = places.into_iter();
        let Some(first) = places.next() else { return };
        let diagnostic =
            Diagnostic::error(&rules::TYPE, first.at_value(), text).help("take one of these `type` keys out");
        let diagnostic = places.fold(diagnostic, |known, place| known.other(place.at_value(), "and this one"));
        self.diagnostics.push(diagnostic);
    }

    /// Returns the name of the type that has the key, or else `otherwise`.
    pub fn type_name(&self, merged: &Merged, key: Key, otherwise: &str) -> (String, Path) {
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
    pub fn type_doc(&self, name: &str, source: &Path, field: &Doc) -> Doc {
        let known = self.spec.types.get(name).filter(|_| *source == Path::default().key("types").key(name));
        known.map_or_else(|| field.clone(), |known| remarks!(known).doc(source, Some(field)))
    }

    /// Finds or makes the named values of a field, if it has any.
    pub fn enumeration(&mut self, merged: &Merged, otherwise: &str, width: u8, doc: &Doc) -> Option<EnumerationId> {
        if merged.field.values.is_empty() {
            return None;
        }
        let (name, source) = self.type_name(merged, Key::Values, otherwise);
        self.check_beside_values(merged, &source);
        if let Some(&index) = self.tables.enumerations_made.get(&(name.clone(), source.clone())) {
            self.check_same_width(merged, width, index);
            let known = &mut self.tables.enumerations[index];
            known.width = known.width.max(width);
            return Some(index);
        }
        let at = merged.path(self.diagnostics, Key::Values);
        let widest = self.widest_uses.get(name.as_str()).map_or(width, |widest| width.max(*widest));
        if widest > width && self.check_room(merged, &name, width).is_none() {
            self.values(&at, &merged.field.values, widest, Numeral::Unsigned);
            return None;
        }
        let mut values = self.values(&at, &merged.field.values, width, Numeral::Unsigned);
        let absent = self.absent(merged, Numeral::Unsigned, width, &values);
        let has_absent = absent.is_some();
        values.extend(absent);
        let doc = self.type_doc(&name, &source, doc);
        let origin = (name.clone(), doc.path.clone());
        let made = self.tables.enumerations.push(Enumeration { name, doc, width, values, has_absent });
        self.tables.enumerations_made.insert(origin, made);
        Some(made)
    }

    /// Tests that a field has room for the values of its type, which other fields have.
    fn check_room(&mut self, merged: &Merged, name: &str, width: u8) -> Option<()> {
        let greatest = Rational::integer((u64::MAX >> (64 - width)).into());
        let mut numbers = merged.field.values.keys().filter_map(|raw| Rational::parse(raw));
        let Some(beyond) = numbers.find(|raw| *raw > greatest) else { return Some(()) };
        let key = if merged.field.bits.is_some() { Key::Bits } else { Key::Bytes };
        let at = merged.path(self.diagnostics, key).at_value();
        let text = format!("{width} bits have no room for the value {beyond} of the type `{name}`");
        self.error_with_help(
            &rules::VALUE_WIDTH,
            at,
            text,
            "other fields of the type have more bits; correct the place",
        );
        None
    }

    /// Tests that named values with one for "not available" have one width, since it has all ones.
    fn check_same_width(&mut self, merged: &Merged, width: u8, index: EnumerationId) {
        let known = &self.tables.enumerations[index];
        if known.has_absent && known.width != width {
            let text = format!("`{}` has {} bits elsewhere, and here {width}", known.name, known.width);
            let help =
                "all ones are another number in each width; write `absent: none` into the type, and name the value";
            let at = merged.sources[0].key("type").at_value();
            self.error_with_help(&rules::TYPE, at, text, help);
        }
    }

    /// Reads `{raw: name}`.
    pub fn values(
        &mut self,
        path: &Path,
        values: &ast::Map<ast::NamedValue>,
        width: u8,
        numeral: Numeral,
    ) -> Vec<NamedValue> {
        let (first, last) = numeral.raw_limits(width);
        let mut named: Vec<NamedValue> = Vec::new();
        let mut places = Vec::new();
        let (mut of_raw, mut of_name) = (HashMap::new(), HashMap::new());
        for (raw, ast::NamedValue { name, title, models }) in values {
            let at = path.key(raw);
            self.check_value_name(&at, name);
            self.check_not_empty(&at, &["models"]);
            let models_path = at.key("models");
            let models = self.models_named(&models_path, models);
            let Some(number) = self.raw_key(&at, raw, first, last) else { continue };
            let repeated: [Option<usize>; 2] = [of_raw.get(&number).copied(), of_name.get(name).copied()];
            if let Some(index) = repeated.into_iter().flatten().min() {
                let message = if named[index].raw == number {
                    format!("the raw value {number} has two names")
                } else {
                    format!("`{name}` is the name of two raw values")
                };
                let diagnostic = Diagnostic::error(&rules::NAMED_VALUE, at.at_key(), message);
                let diagnostic = diagnostic.help("correct one of the two, or take it out");
                self.diagnostics.push(diagnostic.other(Path::at_key(&places[index]), "the other one"));
                continue;
            }
            of_raw.insert(number, named.len());
            of_name.insert(name, named.len());
            places.push(at);
            let title = text(title.as_ref());
            named.push(NamedValue { raw: number, name: name.clone(), title, models, models_path });
        }
        named
    }

    fn raw_key(&mut self, path: &Path, text: &str, first: i128, last: i128) -> Option<i128> {
        let whole = Rational::parse(text).and_then(Rational::to_integer);
        let fitting = whole.filter(|whole| (first..=last).contains(whole));
        if fitting.is_none() {
            let (message, help) = match whole {
                None => (format!("the raw value `{text}` is not a whole number"), "write the number in the frame"),
                Some(whole) => {
                    let help = if whole < 0 && first == 0 {
                        "only a number with `as: signed` has raw values below 0"
                    } else {
                        "correct the number, or give the field more bits"
                    };
                    (format!("the raw value `{text}` does not fit the field, which holds {first} to {last}"), help)
                }
            };
            self.error_with_help(&rules::VALUE_WIDTH, path.at_key(), message, help);
        }
        fitting
    }

    fn check_value_name(&mut self, path: &Path, name: &str) {
        let own = path.key("name");
        let path = if self.diagnostics.has(&own) { &own } else { path };
        let plain = name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_');
        if !plain || !name.starts_with(|letter: char| letter.is_ascii_lowercase()) {
            self.report_form(
                path.at_value(),
                name,
                "names are lower-case letters, digits and `_`, and start with a letter",
            );
        }
    }
}

/// Returns the greatest number of bits of a field that names each type, as far as it is written plainly.
pub fn widest_uses(spec: &ast::Spec) -> HashMap<&str, u8> {
    let mut open: Vec<&Field> = spec.messages.values().flat_map(|message| message.fields.values()).collect();
    let mut widest = HashMap::new();
    while let Some(field) = open.pop() {
        open.extend(field.fields.values());
        let width = written_width(field).unwrap_or(0);
        for name in &field.types.0 {
            let known = widest.entry(name.as_str()).or_insert(width);
            *known = width.max(*known);
        }
    }
    widest
}

/// Returns the number of bits of a field, if it is written plainly and at most 64.
fn written_width(field: &Field) -> Option<u8> {
    let (text, unit) = field.bits.as_ref().map(|text| (text, 1)).or_else(|| Some((field.bytes.as_ref()?, 8)))?;
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let (first, last): (u8, u8) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
    first.abs_diff(last).checked_add(1)?.checked_mul(unit).filter(|width| *width <= 64)
}
