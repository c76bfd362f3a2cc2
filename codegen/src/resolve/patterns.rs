//! Resolves constants that choose a message or a kind of frame, and identifiers of other devices.

use super::Resolver;
use super::texts::remarks;
use crate::model::{Constant, FieldId, Foreign, Id, Identifier, Selector, SelectorId, SelectorPlace, Signal, submasks};
use crate::read::syntax::ast::{self, Field, Key, Pattern};
use crate::report::tree::{Path, Step};
use crate::resolve::rules;

impl Resolver<'_> {
    /// Makes a selector of every field of the header.
    pub fn header_selectors(&mut self) {
        let path = Path::default().key("header");
        let spec = self.spec;
        let leaves = self.header_leaves(&path, &spec.header);
        self.tables.given_up_header = leaves.given_up;
        for signal in leaves.signals {
            let [normal, starting, continues] = self.header_values(&signal).unwrap_or_default();
            let index = self.add_selector(signal, normal);
            let selector = &mut self.tables.selectors[index];
            (selector.starting, selector.continues) = (starting, continues);
            self.tables.header.push(index);
        }
    }

    /// Returns the raw values of `normal`, `starting` and `continues` of a field.
    fn header_values(&mut self, signal: &Signal) -> Option<[Option<u64>; 3]> {
        let field = ast_field(self.spec, &signal.doc.path)?.clone();
        let merged = self.merged(&signal.doc.path, &field)?;
        let mut value = |key: Key, text: &Option<String>| {
            let path = merged.path(self.diagnostics, key);
            text.as_ref().and_then(|text| self.integer(&path, text, 0, signal.place.max()))
        };
        let Field { normal, starting, continues, .. } = &merged.field;
        Some(
            [(Key::Normal, normal), (Key::Starting, starting), (Key::Continues, continues)]
                .map(|(key, text)| value(key, text)),
        )
    }

    /// Adds a payload selector.
    pub fn add_selector(&mut self, signal: Signal, normal: Option<u64>) -> SelectorId {
        let enumeration = signal.encoding.enumeration();
        let place = SelectorPlace::Payload(signal.place);
        let known = self.tables.selectors.position(|known| known.name == signal.name && known.place == place);
        known.unwrap_or_else(|| {
            let Signal { name, doc, .. } = signal;
            self.tables.selectors.push(Selector {
                name,
                doc,
                place,
                normal,
                starting: None,
                continues: None,
                enumeration,
            })
        })
    }

    /// Reads a pattern of numbers.
    pub fn constants(&mut self, path: &Path, entries: Entries<'_>, identifier: &Identifier) -> Vec<Constant> {
        let entries = entries.into_iter();
        entries.filter_map(|(name, values)| self.constant(&path.key(name), name, values, identifier)).collect()
    }

    fn constant(&mut self, path: &Path, name: &str, values: &[String], identifier: &Identifier) -> Option<Constant> {
        let selector = self.selector(path, name, identifier)?;
        let Selector { place, normal, continues, .. } = self.tables.selectors[selector];
        let greatest = match place {
            SelectorPlace::Identifier(field) => u64::from(u32::MAX >> (32 - identifier.fields[field].width)),
            SelectorPlace::Payload(place) => place.max(),
        };
        let mut numbers = Vec::new();
        for (index, text) in values.iter().enumerate() {
            let at = if values.len() > 1 { path.index(index) } else { path.clone() };
            let help = || room(name, place, greatest, identifier);
            numbers.push(self.integer_or(&at, text, (0, greatest), help)?);
        }
        let (value, open) = self.alternatives(path, (name, place), &numbers)?;
        let tells = [(Key::Normal, normal), (Key::Continues, continues)].into_iter().find(|(_, value)| value.is_some());
        if let Some((key, _)) = tells.filter(|_| open != 0) {
            let text = format!("`{name}` has `{}`, so it can have no list of values", key.name());
            self.error_with_help(
                &rules::MATCH,
                path.at_value(),
                text,
                "take the list out; the field may then have any value",
            );
            return None;
        }
        Some(Constant { selector, place, value, open })
    }

    /// Finds the bits that a field leaves open if it can have one of several values. They are the bits in which these
    /// differ, so every combination of them has to be a value.
    fn alternatives(
        &mut self,
        path: &Path,
        (name, place): (&str, SelectorPlace),
        numbers: &[u64],
    ) -> Option<(u64, u64)> {
        let value = numbers.iter().copied().reduce(|all, number| all & number);
        let Some(value) = value else {
            let help = "write the values that it can have, or take the field out";
            self.error_with_help(&rules::MATCH, path.at_value(), format!("`{name}` has no value"), help);
            return None;
        };
        let open = numbers.iter().fold(0, |open, number| open | (number ^ value));
        if open != 0 && matches!(place, SelectorPlace::Identifier(_)) {
            let text = format!("`{name}` is a field of the identifier, which has one value");
            self.error_with_help(&rules::MATCH, path.at_value(), text, "write an access for each value");
            return None;
        }
        let missing = submasks(open).map(|bits| value | bits).find(|number| !numbers.contains(number));
        if let Some(missing) = missing {
            let text = format!("`{name}` can have {missing:#04X}, too: it differs from the others in the same bits");
            let help = format!("add {missing:#04X} to the list, or write an access for each value");
            self.error_with_help(&rules::MATCH, path.at_value(), text, help);
            return None;
        }
        if numbers.len() > submasks(open).count() {
            let text = format!("a value of `{name}` stands there twice");
            self.error_with_help(&rules::MATCH, path.at_value(), text, "write each value once");
            return None;
        }
        Some((value, open))
    }

    /// Finds a selector by name. A field of the identifier becomes a selector on its first use.
    fn selector(&mut self, path: &Path, name: &str, identifier: &Identifier) -> Option<SelectorId> {
        if let Some(id) = self.tables.selectors.position(|known| known.name == name) {
            return Some(id);
        }
        let header = self.tables.selectors.iter().map(|known| &known.name).chain(&self.tables.given_up_header);
        let names: Vec<_> = identifier.fields.iter().map(|field| &field.name).chain(header).cloned().collect();
        let found = self.lookup_key(path, "identifier or header field", name, names.iter().map(String::as_str))?;
        let id = FieldId::new(found);
        let field = identifier.fields.get(id)?;
        Some(self.tables.selectors.push(Selector {
            name: field.name.clone(),
            doc: field.doc.clone(),
            place: SelectorPlace::Identifier(id),
            normal: None,
            starting: None,
            continues: None,
            enumeration: field.enumeration,
        }))
    }

    pub fn foreign(&mut self, identifier: &Identifier) -> Vec<Foreign> {
        let root = Path::default().key("foreign");
        let spec = self.spec;
        let entries = spec.foreign.iter().map(|(name, foreign)| (root.key(name), name, foreign));
        entries
            .map(|(path, name, foreign)| {
                self.check_name(&path, name);
                let ranges = self.foreign_ranges(&path.key("match"), &foreign.pattern, identifier);
                Foreign { name: name.clone(), doc: remarks!(foreign).doc(&path, None), ranges }
            })
            .collect()
    }

    fn foreign_ranges(
        &mut self,
        path: &Path,
        pattern: &Pattern,
        identifier: &Identifier,
    ) -> Vec<(Option<FieldId>, u32, u32)> {
        let entries = pattern.iter();
        entries.filter_map(|(name, text)| self.foreign_range(&path.key(name), name, text, identifier)).collect()
    }

    fn foreign_range(
        &mut self,
        path: &Path,
        name: &str,
        text: &str,
        identifier: &Identifier,
    ) -> Option<(Option<FieldId>, u32, u32)> {
        let names = std::iter::once("identifier").chain(identifier.fields.iter().map(|field| field.name.as_str()));
        let field = self.lookup_key(path, "identifier field", name, names)?.checked_sub(1).map(FieldId::new);
        let width = field.map_or(if identifier.extended { 29 } else { 11 }, |field| identifier.fields[field].width);
        let (first, last) = text.split_once("..").unwrap_or((text, text));
        let greatest = u32::MAX >> (32 - width);
        let (start, end) = (self.integer(path, first, 0, greatest)?, self.integer(path, last, 0, greatest)?);
        if start > end {
            let message = format!("the range `{text}` ends below its start");
            self.error_with_help(&rules::RANGE, path.at_value(), message, format!("write `{last}..{first}`"));
        }
        Some((field, start, end))
    }
}

/// Says which numbers a field can have, and how wide the identifiers are if a number has more than all of their bits.
fn room(name: &str, place: SelectorPlace, greatest: u64, identifier: &Identifier) -> String {
    let numbers = format!("a whole number from 0 to {greatest}");
    match place {
        SelectorPlace::Identifier(field) if !identifier.extended => {
            let width = identifier.fields[field].width;
            format!(
                "`{name}` has {width} of the identifier's 11 bits: write {numbers}; \
                 for 29 bits, write `{name}: {{bits: 28..0}}` in `identifier`"
            )
        }
        SelectorPlace::Identifier(_) | SelectorPlace::Payload(_) => format!("write {numbers}"),
    }
}

/// What the fields of a pattern can be, by name.
pub type Entries<'a> = Vec<(&'a str, &'a [String])>;

/// Returns the entries of a pattern in which each field has one value.
pub fn entries(pattern: &Pattern) -> Entries<'_> {
    pattern.iter().map(|(name, text)| (name.as_str(), std::slice::from_ref(text))).collect()
}

/// Finds a field by its place. The place is in a type if the word around the field takes its fields
/// from there.
fn ast_field<'a>(spec: &'a ast::Spec, path: &Path) -> Option<&'a ast::Field> {
    let (map, Step::Key(name)) = path.split()? else { return None };
    let root = Path::default();
    if *map == root.key("header") {
        return spec.header.get(name);
    }
    if *map == root.key("types") {
        return spec.types.get(name);
    }
    let (word, _) = map.split()?;
    ast_field(spec, word)?.fields.get(name)
}

/// Returns every addressing pattern, and its key.
pub fn patterns(spec: &ast::Spec) -> impl Iterator<Item = (&'static str, &Pattern)> {
    spec.addressing.values().flat_map(|mode| {
        let keys = [("request", &mode.request), ("one", &mode.one), ("each", &mode.each)];
        let keys = keys.into_iter().chain([("coordinator", &mode.coordinator)]);
        keys.filter_map(|(key, pattern)| Some((key, pattern.as_ref()?)))
    })
}

/// Tests whether an addressing pattern names a type.
pub fn is_address_type(spec: &ast::Spec, name: &str) -> bool {
    patterns(spec).any(|(_, pattern)| pattern.values().any(|what| what == name))
}

/// Leaves out repeated constants.
pub fn distinct(constants: Vec<Constant>) -> Vec<Constant> {
    constants.into_iter().fold(Vec::new(), |mut known, constant| {
        if !known.contains(&constant) {
            known.push(constant);
        }
        known
    })
}
