//! Resolves addressing modes and address types.

use super::Resolver;
use super::keys::Role;
use super::patterns::{is_address_type, patterns};
use super::texts::remarks;
use crate::model::keywords::OUTSIDE;
use crate::model::{
    Address, AddressPattern, AddressType, AddressTypeId, Identifier, IdentifierField, Mode, ModeId, Numeral, Table,
};
use crate::read::syntax::ast::{self, Pattern};
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;

/// The kinds of addresses.
type AddressTypes = Table<AddressTypeId, AddressType>;

/// Numbers of addresses and their names.
type Names = Vec<(i64, String)>;

impl Resolver<'_> {
    /// Reads the types that addressing patterns name.
    pub fn address_types(&mut self) -> Table<AddressTypeId, AddressType> {
        let spec = self.spec;
        let types = spec.types.iter().filter(|(name, _)| is_address_type(spec, name));
        types.filter_map(|(name, field)| self.address_type(name, field)).collect()
    }

    fn address_type(&mut self, name: &str, field: &ast::Field) -> Option<AddressType> {
        let path = Path::default().key("types").key(name);
        self.check_own_keys(&path, field, Role::Address);
        let (first, last, names) = self.numbers(&path, name, field)?;
        let sign = match field.scale.as_deref() {
            None | Some("1") => 1,
            Some("-1") => -1,
            Some(other) => {
                let message = format!("an address cannot be scaled by `{other}`");
                self.error_with_help(
                    &rules::ADDRESSING,
                    path.key("scale").at_value(),
                    message,
                    "write `scale: -1`, or leave `scale` out",
                );
                return None;
            }
        };
        let mut whole = |key: &str, text: &Option<String>| {
            text.as_ref().and_then(|text| self.integer(&path.key(key), text, -1_000_000_i64, 1_000_000))
        };
        let offset = whole("offset", &field.offset).unwrap_or(0);
        let send = whole("send", &field.send);
        let strict = self.strict(&path, field.outside.as_deref());
        let doc = remarks!(field).doc(&path, None);
        let known = AddressType { name: name.to_owned(), doc, first, last, names, offset, sign, strict, send };
        if send.is_some_and(|number| !known.has(number)) {
            self.diagnostics.push(unnamed_sender(&path, &known));
        }
        Some(known)
    }

    /// Reads the first and the last number of an address type, and the names of single ones.
    fn numbers(&mut self, path: &Path, name: &str, field: &ast::Field) -> Option<(i64, i64, Names)> {
        match (&field.range, field.values.is_empty()) {
            (Some(text), true) => {
                self.whole_range(&path.key("range"), text).map(|(first, last)| (first, last, Vec::new()))
            }
            (None, false) => {
                let names = self.named_numbers(path, field);
                Some((names.first()?.0, names.last()?.0, names))
            }
            (None, true) => {
                let text = format!("the address type `{name}` has neither a range nor values");
                let help = "say which numbers the document names, for instance `range: 0..0x3B`";
                self.error_with_help(&rules::ADDRESSING, path.at_key(), text, help);
                None
            }
            (Some(_), false) => {
                let text = format!("the address type `{name}` has both a range and values");
                let help = "keep `values` if the document names only these numbers, and else `range`";
                self.error_with_help(&rules::ADDRESSING, path.key("values").at_key(), text, help);
                None
            }
        }
    }

    /// Reads the names of addresses, in the order of their numbers.
    fn named_numbers(&mut self, path: &Path, field: &ast::Field) -> Names {
        let named = self.values(&path.key("values"), &field.values, 32, Numeral::Signed);
        let numbers = named.into_iter().filter_map(|value| Some((i64::try_from(value.raw).ok()?, value.name)));
        let mut numbers: Vec<_> = numbers.collect();
        numbers.sort_unstable();
        numbers
    }

    /// Reads a range of whole numbers.
    fn whole_range(&mut self, path: &Path, text: &str) -> Option<(i64, i64)> {
        let range = self.range(path, text)?;
        let mut whole = |end: Rational| {
            let number = end.to_integer().and_then(|number| i32::try_from(number).ok()).map(i64::from);
            if number.is_none() {
                let message = format!("the addresses `{text}` end in {end}, which no identifier can hold");
                let help = "write whole numbers that fit the field, as in `range: 0..0x3B`";
                self.error_with_help(&rules::ADDRESSING, path.at_value(), message, help);
            }
            number
        };
        whole(range.minimum).zip(whole(range.maximum))
    }

    fn strict(&mut self, path: &Path, outside: Option<&str>) -> bool {
        outside.is_some_and(|word| self.lookup(&path.key("outside"), "rule", word, OUTSIDE.into_iter()).is_some())
    }

    /// Tests that the field holds all addresses that can be sent.
    fn check_address_width(&mut self, at: &Path, address_type: &AddressType, field: &IdentifierField) {
        let ends = [address_type.first, address_type.last].map(|number| (number, address_type.key()));
        let numbers = ends.into_iter().chain(address_type.send.map(|number| (number, "send")));
        let mut raw = numbers.map(|(number, key)| (address_type.raw(number), key));
        if let Some((raw, key)) = raw.find(|(raw, _)| *raw < 0 || *raw >> field.width != 0) {
            let AddressType { name, doc, .. } = address_type;
            let (bits, last) = (field.width, field.mask() >> field.shift);
            let message = format!(
                "an address of `{name}` is {raw} in the identifier, but `{}` has {bits} bits: 0 to {last}",
                field.name
            );
            let help = format!("correct the addresses, or give `{}` more bits", field.name);
            let diagnostic = Diagnostic::error(&rules::ADDRESSING, doc.path.key(key).at_value(), message).help(help);
            self.diagnostics.push_first(diagnostic.other(at.at_value(), format!("here `{}` holds them", field.name)));
        }
    }

    pub fn modes(&mut self, identifier: &Identifier, types: &AddressTypes) -> Table<ModeId, Mode> {
        let root = Path::default().key("addressing");
        let spec = self.spec;
        spec.addressing.iter().map(|(name, mode)| self.mode(&root.key(name), name, mode, identifier, types)).collect()
    }

    fn mode(
        &mut self,
        path: &Path,
        name: &str,
        mode: &ast::Mode,
        identifier: &Identifier,
        types: &AddressTypes,
    ) -> Mode {
        self.check_name(path, name);
        let mut pattern = |key: &'static str, pattern: &Option<Pattern>| {
            let pattern = pattern.as_ref()?;
            Some(self.address_pattern(&path.key(key), key == "request", pattern, identifier, types))
        };
        let request = pattern("request", &mode.request);
        let one = pattern("one", &mode.one);
        let each = pattern("each", &mode.each);
        let coordinator = pattern("coordinator", &mode.coordinator);
        let target = request.as_ref().and_then(|request| self.target(&path.key("request"), request, types));
        let is_whole = |one: &AddressPattern, written: &Pattern| one.constants + one.addresses.len() == written.len();
        if let (Some(target), Some(one), Some(written)) = (target, &one, &mode.one)
            && is_whole(one, written)
        {
            self.check_answerer(path, name, target, one, types);
        }
        Mode { name: name.to_owned(), doc: remarks!(mode).doc(path, None), request, one, each, coordinator, target }
    }

    fn address_pattern(
        &mut self,
        path: &Path,
        request: bool,
        pattern: &Pattern,
        identifier: &Identifier,
        types: &AddressTypes,
    ) -> AddressPattern {
        let mut resolved = AddressPattern::default();
        for (name, what) in pattern {
            let at = path.key(name);
            let found = self.lookup_key_in(&at, "identifier field", name, &identifier.fields, |field| &field.name);
            let Some(id) = found else { continue };
            let field = &identifier.fields[id];
            if what.starts_with(|digit: char| digit.is_ascii_digit()) {
                if let Some(value) = self.integer(&at, what, 0, field.mask() >> field.shift) {
                    resolved.mask |= field.mask();
                    resolved.value |= value << field.shift;
                    resolved.constants += 1;
                }
            } else if let Some(address_type) = self.lookup_address_type(&at, what, types) {
                self.check_address_width(&at, &types[address_type], field);
                let excluded = self.excluded(request, name, identifier, types);
                resolved.addresses.push(Address { field: id, address_type, excluded });
            }
        }
        resolved
    }

    /// Warns of a reply that does not show whether the module that was asked sends it.
    fn check_answerer(
        &mut self,
        path: &Path,
        mode: &str,
        target: AddressTypeId,
        one: &AddressPattern,
        types: &AddressTypes,
    ) {
        if one.addresses.iter().any(|address| address.address_type == target) {
            return;
        }
        let name = &types[target].name;
        let text = format!("`{mode}` asks one `{name}`, but the reply does not show which `{name}` sends it");
        let help = format!(
            "name `{name}` here for the field that holds the sender; \
             without it, the reply of any `{name}` counts as the answer"
        );
        self.diagnostics.push(Diagnostic::warning(&rules::ADDRESSING, path.key("one").at_key(), text).help(help));
    }

    /// Finds an address type. It does not report one that was refused before.
    fn lookup_address_type(&mut self, at: &Path, name: &str, types: &AddressTypes) -> Option<AddressTypeId> {
        let spec = self.spec;
        if !spec.types.contains_key(name) {
            let offered =
                spec.types.iter().filter(|(name, field)| is_address_type(spec, name) || could_be_address(field));
            let offered: Vec<_> = offered.map(|(name, _)| name.as_str()).collect();
            self.report_name(at.at_value(), "address type", name, &offered, Some("write a number for a constant"));
        }
        types.position(|known| known.name == name)
    }

    /// Returns the raw values of a field that are no tolerated addresses: those of strict types,
    /// and constants of the same direction.
    fn excluded(&self, request: bool, field: &str, identifier: &Identifier, types: &AddressTypes) -> Vec<(u32, u32)> {
        let mut excluded = claimed(self.spec, field, types);
        let width = identifier.fields.iter().find(|known| known.name == field).map_or(32, |known| known.width);
        let same = patterns(self.spec).filter(|(key, _)| (*key == "request") == request);
        let constants = same.filter_map(|(_, pattern)| Rational::parse(pattern.get(field)?)?.to_integer());
        let constants =
            constants.filter_map(|value| u32::try_from(value).ok()).filter(|value| value >> (width - 1) < 2);
        excluded.extend(constants.map(|value| (value, value)));
        excluded.sort_unstable();
        excluded.dedup();
        excluded
    }

    /// Returns the address that a request leaves to the caller.
    fn target(&mut self, path: &Path, request: &AddressPattern, types: &AddressTypes) -> Option<AddressTypeId> {
        let free = request.addresses.iter().filter(|address| types[address.address_type].send.is_none());
        let free: Vec<_> = free.map(|address| address.address_type).collect();
        if free.len() > 1 {
            let names: Vec<_> = free.iter().map(|index| format!("`{}`", types[*index].name)).collect();
            let message = format!("this request leaves {} addresses open: {}", free.len(), names.join(" and "));
            let help = "give all but one of these types a `send`, the address that all requests carry";
            let diagnostic = Diagnostic::error(&rules::ADDRESSING, path.at_key(), message).help(help);
            let open = free.iter().map(|index| types[*index].doc.path.at_key());
            self.diagnostics.push(open.fold(diagnostic, |known, at| known.other(at, "has no `send`")));
        }
        free.first().copied()
    }
}

/// Tests whether a type has the keys of an address type and no others.
fn could_be_address(field: &ast::Field) -> bool {
    field.range.is_some() && field.keys().all(|key| Role::Address.reads(key))
}

/// Returns the raw ranges of the strict types that some pattern puts into this field.
fn claimed(spec: &ast::Spec, field: &str, types: &AddressTypes) -> Vec<(u32, u32)> {
    let strict = types.iter().filter(|known| known.strict);
    let used = strict.filter(|known| patterns(spec).any(|(_, pattern)| pattern.get(field) == Some(&known.name)));
    let mut ranges: Vec<_> = used.flat_map(AddressType::raw_ranges).collect();
    ranges.sort_unstable();
    ranges.dedup();
    ranges
}

/// Refuses requests with an address that the document does not name.
fn unnamed_sender(path: &Path, known: &AddressType) -> Diagnostic {
    let (name, key) = (&known.name, known.key());
    let (message, help) = if known.names.is_empty() {
        (
            format!("requests are sent with an address outside the range of `{name}`"),
            "correct `send`, or widen the range",
        )
    } else {
        (
            format!("requests are sent with an address that `{name}` does not name"),
            "correct `send`, or name the address",
        )
    };
    let error = Diagnostic::error(&rules::ADDRESSING, path.key("send").at_value(), message);
    error.other(path.key(key).at_value(), format!("the {key}")).help(help)
}
