//! Refuses keys that mean nothing in their place.

use super::Resolver;
use super::types::Merged;
use crate::model::{Encoding, Numeral, TextForm};
use crate::read::syntax::ast::{Field, Key};
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::{Node, Path};
use crate::resolve::rules;

/// Where a field stands. This decides which keys it reads.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Site {
    Header,
    Message,
    Packed,
}

/// What a field is used as. This decides which keys it reads.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Identifier,
    IdentifierConstant,
    Address,
    OfModel,
    Header,
    HeaderWord,
    Word,
    Constant,
    Number,
    Decimal,
    Float,
    Named,
    Status,
    Text,
    Bytes,
    LongText,
    LongBytes,
    Packed,
    PackedWord,
    PackedNumber,
    PackedDecimal,
    PackedText,
}

/// Numbers with a unit.
const QUANTITIES: &[Role] = &[Role::Number, Role::Decimal, Role::Float];

/// Signals that have no parts.
const SIGNALS: &[&[Role]] = &[QUANTITIES, &[Role::Named, Role::Status, Role::Text, Role::Bytes]];

/// Texts that no eight bytes can hold.
const RUNS: &[Role] = &[Role::LongText, Role::LongBytes];

/// Numbers in a packed value.
const PACKED_NUMBERS: &[Role] = &[Role::PackedNumber, Role::PackedDecimal];

/// Fields of the identifier.
const IDENTIFIER: &[Role] = &[Role::Identifier, Role::IdentifierConstant];

/// Roles with other fields inside.
const WORDS: &[Role] = &[Role::Word, Role::HeaderWord, Role::PackedWord];

/// Roles that are one range of bits in the data bytes, beside signals and words.
const PLACED: &[Role] = &[Role::Header, Role::Constant, Role::PackedNumber, Role::PackedDecimal, Role::PackedText];

impl Role {
    /// Returns the role in a sentence: "`scale` means nothing for ...".
    fn name(self) -> &'static str {
        match self {
            Self::Identifier => "a field of the identifier",
            Self::IdentifierConstant => "a constant field of the identifier",
            Self::Address => "an address type",
            Self::OfModel => "a type of a model",
            Self::Header => "a field of the header",
            Self::HeaderWord => "a word of the header",
            Self::Word => "a word of fields",
            Self::Constant => "a constant field",
            Self::Number => "a number",
            Self::Decimal => "a number in decimal digits",
            Self::Float => "a float",
            Self::Named => "a signal of named values",
            Self::Status => "a status word",
            Self::Text => "a text",
            Self::Bytes => "a field of raw bytes",
            Self::LongText => "a text of more than eight bytes",
            Self::LongBytes => "a field of more than eight raw bytes",
            Self::Packed => "a packed value",
            Self::PackedWord => "a word of a packed value",
            Self::PackedNumber => "a number of a packed value",
            Self::PackedDecimal => "a number in decimal digits of a packed value",
            Self::PackedText => "a text of a packed value",
        }
    }

    /// Tests whether the role reads a key.
    pub fn reads(self, key: Key) -> bool {
        let signal = self.is_signal();
        let among = |roles: &[Self]| roles.contains(&self);
        match key {
            Key::Section | Key::Erratum => true,
            Key::Title | Key::Note => !among(WORDS) && self != Self::OfModel,
            Key::Repeat | Key::Step | Key::First => signal || self == Self::Word,
            Key::Type => !among(&[Self::Address, Self::OfModel]),
            Key::Bytes => signal || among(RUNS) || among(WORDS) || among(PLACED),
            Key::Bits => signal || among(WORDS) || among(PLACED) || among(IDENTIFIER),
            Key::As => {
                among(QUANTITIES)
                    || among(RUNS)
                    || among(&[Self::Text, Self::Bytes, Self::PackedDecimal, Self::PackedText])
            }
            Key::Fill => among(&[Self::Text, Self::LongText]),
            Key::Scale | Key::Offset => among(&[Self::Number, Self::Decimal, Self::Address, Self::OfModel]),
            Key::Unit => among(QUANTITIES) || self == Self::OfModel,
            Key::Range => among(QUANTITIES) || among(PACKED_NUMBERS) || among(&[Self::Address, Self::OfModel]),
            Key::Values => {
                among(IDENTIFIER)
                    || among(&[Self::Address, Self::Header, Self::Constant])
                    || among(&[Self::Number, Self::Decimal, Self::Named])
            }
            Key::Absent => among(&[Self::Number, Self::Decimal, Self::Named]),
            Key::Fields => among(WORDS) || self == Self::Packed,
            Key::Status => self == Self::Status,
            Key::Format => self == Self::Packed,
            Key::Const => among(&[Self::IdentifierConstant, Self::Constant]),
            Key::Send => among(&[Self::Identifier, Self::Address]),
            Key::Normal | Key::Starting | Key::Continues => among(&[Self::Identifier, Self::Header]),
            Key::Default => among(QUANTITIES) || among(&[Self::Named, Self::Text, Self::Bytes, Self::OfModel]),
            Key::OutOfRange => among(QUANTITIES),
            Key::Outside | Key::Examples => self == Self::Address,
            Key::Reply => signal || among(RUNS) || among(&[Self::Word, Self::Packed]),
            Key::In => signal || among(RUNS) || among(&[Self::Constant, Self::Packed]),
            Key::PowerOff | Key::Models => signal || among(RUNS) || self == Self::Packed,
        }
    }

    /// Tests whether it is a signal without parts.
    fn is_signal(self) -> bool {
        SIGNALS.concat().contains(&self)
    }

    /// Returns the keys that the role reads, without those that almost every role reads.
    fn keys(self) -> Vec<&'static str> {
        let anywhere = [Key::Type, Key::Title, Key::Note, Key::Section, Key::Erratum];
        let keys = Key::ALL.iter().filter(|key| self.reads(**key) && !anywhere.contains(key));
        keys.map(|key| key.name()).collect()
    }

    /// Returns the role of a field of the identifier.
    pub fn of_identifier(field: &Field) -> Self {
        if field.constant.is_some() { Self::IdentifierConstant } else { Self::Identifier }
    }

    /// Returns the role of a word.
    pub fn of_word(site: Site) -> Self {
        match site {
            Site::Message => Self::Word,
            Site::Header => Self::HeaderWord,
            Site::Packed => Self::PackedWord,
        }
    }

    /// Returns the role of a packed value.
    pub fn of_packed(site: Site) -> Self {
        match site {
            Site::Message => Self::Packed,
            Site::Header => Self::Header,
            Site::Packed => Self::PackedNumber,
        }
    }

    /// Returns the role of a field that is neither a word nor a packed value.
    pub fn of_field(site: Site, encoding: &Encoding) -> Self {
        match site {
            Site::Message => Self::of_signal(encoding),
            Site::Header => Self::Header,
            Site::Packed if encoding.text_form().is_some() => Self::PackedText,
            Site::Packed => match encoding.numeral() {
                Numeral::Unsigned | Numeral::Signed => Self::PackedNumber,
                Numeral::Bcd => Self::PackedDecimal,
            },
        }
    }

    /// Returns the role of a text that no eight bytes can hold.
    pub fn of_run(encoding: &Encoding) -> Self {
        match encoding.text_form() {
            Some(TextForm::Hexadecimal) => Self::LongBytes,
            Some(TextForm::Ascii { .. }) | None => Self::LongText,
        }
    }

    fn of_signal(encoding: &Encoding) -> Self {
        match encoding {
            Encoding::Number { numeral: Numeral::Bcd, .. } => Self::Decimal,
            Encoding::Number { numeral: Numeral::Unsigned | Numeral::Signed, .. } | Encoding::ByModel { .. } => {
                Self::Number
            }
            Encoding::Float => Self::Float,
            Encoding::Named(_) => Self::Named,
            Encoding::Status(_) => Self::Status,
            Encoding::Text(TextForm::Ascii { .. }) => Self::Text,
            Encoding::Text(TextForm::Hexadecimal) => Self::Bytes,
            Encoding::Packed { .. } => Self::Packed,
        }
    }
}

/// Tests whether a key says which values a field has.
fn is_of_values(key: Key) -> bool {
    match key {
        Key::Bytes
        | Key::Bits
        | Key::Repeat
        | Key::Step
        | Key::First
        | Key::As
        | Key::Fill
        | Key::Scale
        | Key::Offset
        | Key::Unit
        | Key::Values
        | Key::Absent
        | Key::Fields
        | Key::Format
        | Key::Const => true,
        Key::Type
        | Key::Range
        | Key::Status
        | Key::Send
        | Key::Normal
        | Key::Starting
        | Key::Continues
        | Key::Default
        | Key::OutOfRange
        | Key::PowerOff
        | Key::Outside
        | Key::Reply
        | Key::In
        | Key::Models
        | Key::Examples
        | Key::Title
        | Key::Note
        | Key::Section
        | Key::Erratum => false,
    }
}

impl Resolver<'_> {
    /// Refuses the keys of a field, and of its types, that its role does not read.
    pub fn check_keys(&mut self, merged: &Merged, role: Role) {
        let field = &merged.sources[0];
        for key in merged.field.keys().filter(|key| !role.reads(*key)) {
            let path = merged.path(self.diagnostics, key);
            match merged.type_at(&path) {
                Some(name) => self.misplaced_by_type(field, name, &path, key, role),
                None => self.misplaced(&path, key, role),
            }
        }
        self.check_values(&merged.path(self.diagnostics, Key::Values), &merged.field, role);
        for source in &merged.sources {
            self.check_nothing_empty(source);
        }
    }

    /// Refuses `models` of a named value whose field is no signal.
    fn check_values(&mut self, path: &Path, field: &Field, role: Role) {
        for (raw, value) in field.values.iter().filter(|(_, value)| !value.models.is_empty() && !role.is_signal()) {
            let text = format!("`models` of a named value means nothing for {}", role.name());
            let help = format!("write the name alone, as in `{raw}: {}`", value.name);
            self.error_with_help(&rules::MISPLACED_KEY, path.key(raw).key("models").at_key(), text, help);
        }
    }

    /// Refuses keys of a field that takes none from types.
    pub fn check_own_keys(&mut self, path: &Path, field: &Field, role: Role) {
        for key in field.keys().filter(|key| !role.reads(*key)) {
            self.misplaced(&path.key(key), key, role);
        }
        self.check_values(&path.key(Key::Values), field, role);
        self.check_nothing_empty(path);
    }

    /// Refuses empty maps and lists of a field.
    fn check_nothing_empty(&mut self, field: &Path) {
        let keys: Vec<_> = Key::ALL.iter().filter(|key| key.can_be_empty()).map(|key| key.name()).collect();
        self.check_not_empty(field, &keys);
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

    /// Tests whether no key that says the values of a field has an error.
    pub fn is_sound(&self, merged: &Merged) -> bool {
        let keys = merged.field.keys().filter(|key| is_of_values(*key));
        keys.map(|key| merged.path(self.diagnostics, key)).all(|path| !self.diagnostics.has_errors_in(&path))
    }

    /// Refuses a type with a key that the field cannot read.
    fn misplaced_by_type(&mut self, field: &Path, name: &str, path: &Path, key: Key, role: Role) {
        let (what, key) = (role.name(), key.name());
        let (text, help) = if super::patterns::is_address_type(self.spec, name) {
            let text = format!("`{name}` is an address type, and the field that names it is {what}");
            (text, "name another type, or leave `type` out".to_owned())
        } else {
            let text = format!("`{key}` of the type `{name}` means nothing for the field that names it, {what}");
            let help =
                format!("take `{key}` out of the type or `type` out of the field, or make it another kind of field");
            (text, help)
        };
        let diagnostic = Diagnostic::error(&rules::MISPLACED_KEY, field.key("type").at_value(), text).help(help);
        self.diagnostics.push_first(diagnostic.other(path.at_key(), "the key of the type"));
    }

    fn misplaced(&mut self, path: &Path, key: Key, role: Role) {
        let message = format!("`{}` means nothing for {}", key.name(), role.name());
        let help = format!("take it out; {} reads `{}`", role.name(), role.keys().join("`, `"));
        self.error_with_help(&rules::MISPLACED_KEY, path.at_key(), message, help);
    }
}
