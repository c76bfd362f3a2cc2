//! Keys that mean nothing where they stand are refused, rather than passed over.

use super::Resolver;
use super::types::Merged;
use crate::diagnostic::Diagnostic;
use crate::model::Encoding;
use crate::rules;
use crate::syntax::ast::Field;
use crate::syntax::tree::{Node, Path};

/// Where a field stands, which decides the keys that it reads.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Site {
    Header,
    Message,
    Packed,
}

/// What a field is used as, with the keys that it reads beside title, note, section, erratum and `type`.
#[derive(Clone, Copy)]
pub struct Role {
    /// The role in a sentence: "`scale` means nothing for ...".
    name: &'static str,
    keys: &'static [&'static str],
}

impl Role {
    pub const IDENTIFIER: Self =
        Self { name: "a field of the identifier", keys: &["bits", "const", "send", "normal", "continues", "values"] };
    pub const ADDRESS: Self =
        Self { name: "an address type", keys: &["range", "scale", "offset", "outside", "send", "examples"] };
    const HEADER: Self =
        Self { name: "a field of the header", keys: &["bytes", "bits", "values", "normal", "continues"] };
    const WORD: Self = Self { name: "a word of fields", keys: &["bytes", "bits", "fields", "reply"] };
    const HEADER_WORD: Self = Self { name: "a word of the header", keys: &["bytes", "bits", "fields"] };
    const PACKED_WORD: Self = Self { name: "a word of a packed value", keys: &["bytes", "bits", "fields"] };
    const PACKED_NUMBER: Self = Self { name: "a number of a packed value", keys: &["bytes", "bits", "range"] };
    const PACKED_TEXT: Self = Self { name: "a text of a packed value", keys: &["bytes", "bits", "as"] };
    const PACKED: Self = Self { name: "a packed value", keys: &["format", "fields", "in", "reply"] };
    pub const CONSTANT: Self = Self { name: "a constant field", keys: &["bytes", "bits", "const", "values", "in"] };
    pub const OF_MODEL: Self = Self { name: "a type of a model", keys: &["range", "default"] };

    /// Tells whether the role reads a key.
    pub fn reads(self, key: &str) -> bool {
        self.keys.contains(&key)
    }

    /// Returns the role of a word.
    pub fn of_word(site: Site) -> Self {
        match site {
            Site::Message => Self::WORD,
            Site::Header => Self::HEADER_WORD,
            Site::Packed => Self::PACKED_WORD,
        }
    }

    /// Returns the role of a packed value.
    pub fn of_packed(site: Site) -> Self {
        match site {
            Site::Message => Self::PACKED,
            Site::Header => Self::HEADER,
            Site::Packed => Self::PACKED_NUMBER,
        }
    }

    /// Returns the role of a field that is neither a word nor a packed value.
    pub fn of_field(site: Site, encoding: &Encoding) -> Self {
        match (site, encoding) {
            (Site::Message, _) => Self::of_signal(encoding),
            (Site::Header, _) => Self::HEADER,
            (Site::Packed, Encoding::Text) => Self::PACKED_TEXT,
            (Site::Packed, _) => Self::PACKED_NUMBER,
        }
    }

    fn of_signal(encoding: &Encoding) -> Self {
        match encoding {
            Encoding::Number { .. } => Self {
                name: "a number",
                keys: &["bytes", "bits", "as", "scale", "offset", "unit", "range", "values", "default", "in", "reply"],
            },
            Encoding::Float => {
                Self { name: "a float", keys: &["bytes", "bits", "as", "unit", "range", "default", "in", "reply"] }
            }
            Encoding::Named(_) => Self {
                name: "a signal of named values",
                keys: &["bytes", "bits", "as", "values", "default", "in", "reply"],
            },
            Encoding::Status(_) => Self { name: "a status word", keys: &["bytes", "bits", "status", "in", "reply"] },
            Encoding::Text => Self { name: "a text", keys: &["bytes", "bits", "as", "default", "in", "reply"] },
            Encoding::Packed { .. } => Self::PACKED,
        }
    }
}

/// Keys that say which values a field has.
const OF_VALUES: [&str; 10] = ["bytes", "bits", "as", "scale", "offset", "unit", "values", "fields", "format", "const"];

/// Keys of a field that would say nothing, or less than their absence, if they were empty.
const NEVER_EMPTY: [&str; 4] = ["values", "fields", "status", "in"];

impl Resolver<'_> {
    /// Refuses the keys of a field, and of its types, that its role does not read.
    pub fn check_keys(&mut self, merged: &Merged, role: Role) {
        for key in written(&merged.field).filter(|key| !role.reads(key)) {
            let path = merged.path(self.diagnostics, key);
            match merged.type_at(&path) {
                Some(name) => self.misplaced_by_type(&merged.sources[0], name, &path, key, role),
                None => self.misplaced(&path, key, role),
            }
        }
        for source in &merged.sources {
            self.check_not_empty(source, &NEVER_EMPTY);
        }
        let field = &merged.sources[0];
        if !merged.field.examples.is_empty() && !field.ancestors().any(|outer| *outer == Path::default().key("types")) {
            self.misplaced(&field.key("examples"), "examples", role);
        }
    }

    /// Refuses keys of a field that takes none from types.
    pub fn check_own_keys(&mut self, path: &Path, field: &Field, role: Role) {
        for key in written(field).filter(|key| !role.keys.contains(key)) {
            self.misplaced(&path.key(key), key, role);
        }
        self.check_not_empty(path, &NEVER_EMPTY);
    }

    /// Refuses empty maps and lists after some keys of an item.
    pub fn check_not_empty(&mut self, item: &Path, keys: &[&str]) {
        for key in keys {
            let path = item.key(*key);
            if self.diagnostics.tree().and_then(|tree| tree.get(&path)).is_some_and(Node::is_empty) {
                let text = format!("`{key}` is empty, so it says nothing");
                self.error_with_help(
                    &rules::MISPLACED_KEY,
                    path.at_key(),
                    text,
                    "write what belongs there, or take it out",
                );
            }
        }
    }

    /// Tells whether no key has an error that says which values a field has.
    pub fn is_sound(&self, merged: &Merged) -> bool {
        let keys = written(&merged.field).filter(|key| OF_VALUES.contains(key));
        keys.map(|key| merged.path(self.diagnostics, key)).all(|path| !self.diagnostics.has_errors_in(&path))
    }

    /// Refuses a type of which a field cannot read a key.
    fn misplaced_by_type(&mut self, field: &Path, name: &str, path: &Path, key: &str, role: Role) {
        let what = role.name;
        let (text, help) = if super::addressing::is_address_type(self.spec, name) {
            let text = format!("`{name}` is an address type, and the field that names it is {what}");
            (text, "name another type, or leave `type` out".to_owned())
        } else {
            let text = format!("`{key}` of the type `{name}` means nothing for the field that names it, {what}");
            (text, format!("take `type`, or what makes the field {what}, out of it, or take `{key}` out of the type"))
        };
        let diagnostic = Diagnostic::error(&rules::MISPLACED_KEY, field.key("type").at_value(), text).help(help);
        self.diagnostics.push_first(diagnostic.other(path.at_key(), "the key of the type"));
    }

    fn misplaced(&mut self, path: &Path, key: &str, role: Role) {
        let message = format!("`{key}` means nothing for {}", role.name);
        let help = format!("take it out; {} reads `{}`", role.name, role.keys.join("`, `"));
        self.error_with_help(&rules::MISPLACED_KEY, path.at_key(), message, help);
    }
}

/// Returns the keys that a field writes, without `examples` and what every field may say.
pub fn written(field: &Field) -> impl Iterator<Item = &'static str> + use<> {
    let keys = [
        ("bytes", field.bytes.is_some()),
        ("bits", field.bits.is_some()),
        ("as", field.format_of_number.is_some()),
        ("scale", field.scale.is_some()),
        ("offset", field.offset.is_some()),
        ("unit", field.unit.is_some()),
        ("range", field.range.is_some()),
        ("values", !field.values.is_empty()),
        ("fields", !field.fields.is_empty()),
        ("status", !field.status.is_empty()),
        ("format", field.format.is_some()),
        ("const", field.constant.is_some()),
        ("send", field.send.is_some()),
        ("normal", field.normal.is_some()),
        ("continues", field.continues.is_some()),
        ("default", field.default.is_some()),
        ("outside", field.outside.is_some()),
        ("in", !field.kinds.is_empty()),
        ("reply", !field.reply.is_empty()),
    ];
    keys.into_iter().filter(|(_, is_written)| *is_written).map(|(key, _)| key)
}
