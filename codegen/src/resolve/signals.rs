//! Turns fields into signals: words are taken apart, places become masks, and keys become an
//! encoding.

use canspec_runtime::Place;

use super::Resolver;
use super::arrays::Row;
use super::keys::{Role, Site};
use super::texts::{self, remarks};
use super::types::Merged;
use crate::diagnostic::{At, Diagnostic};
use crate::model::{
    Array, ArrayId, DeviceModel, Doc, Encoding, Kind, Misfit, ModelId, Numeral, OfModel, PartId, Signal, Table,
    TextForm, TypeOfModel,
};
use crate::number::Rational;
use crate::resolve::rules;
use crate::syntax::ast::{self, Field, Key};
use crate::syntax::tree::Path;
use crate::words::{NUMBER_FORMATS, NumberFormat};

/// Largest number of fields of a message, counting those of words, packed values and their types.
const FIELD_LIMIT: usize = 256;

/// The result of resolving the fields of a message.
#[derive(Default)]
pub struct Leaves {
    pub signals: Vec<Signal>,
    /// Arrays without their elements, which are signals.
    pub arrays: Table<ArrayId, Array>,
    /// Constant fields of the payload and their values.
    pub constants: Vec<(Signal, u64)>,
    /// Constants that a reply shows because of the fields, each with its place in the spec.
    pub replies: Vec<(Path, ast::Pattern)>,
    /// Names of fields with an error of their own.
    pub given_up: Vec<String>,
}

impl Leaves {
    /// Returns the names of all fields, also of those with an error.
    pub fn names(self) -> impl Iterator<Item = String> {
        let constants = self.constants.into_iter().map(|(signal, _)| signal);
        self.signals.into_iter().chain(constants).map(|signal| signal.name).chain(self.given_up)
    }
}

/// What is around a field.
#[derive(Clone, Copy)]
struct Outer<'a> {
    site: Site,
    /// The word whose bits the field's `bits` count.
    word: Option<Place>,
    doc: &'a Doc,
    /// Name of the message, for types without a name of their own.
    owner: &'a str,
    /// Places of the fields around it, from the outermost on.
    around: &'a [Path],
    /// The array whose elements the fields are parts of.
    row: Row,
    /// The group of fields that they belong to.
    group: Group<'a>,
}

impl<'a> Outer<'a> {
    /// Returns what is around the fields of a message.
    fn of_message(doc: &'a Doc, owner: &'a str) -> Self {
        Self { site: Site::Message, word: None, doc, owner, around: &[], row: Row::ALONE, group: Group::NONE }
    }

    /// Returns the name of a field as the spec writes it, without that of its group.
    fn own_name<'n>(&self, name: &'n str) -> &'n str {
        name.strip_prefix(self.group.prefix).unwrap_or(name)
    }
}

/// Fields of a type, which are used under the name of the field that has the type.
#[derive(Clone, Copy)]
struct Group<'a> {
    /// The type; empty outside of groups.
    name: &'a str,
    /// What the names of its signals begin with.
    prefix: &'a str,
}

impl Group<'_> {
    /// Fields that belong to no group.
    const NONE: Self = Self { name: "", prefix: "" };
}

impl Resolver<'_> {
    /// Resolves the fields of the header.
    pub fn header_leaves(&mut self, path: &Path, fields: &ast::Map<Field>) -> Leaves {
        let doc = Doc::default();
        let outer = Outer { site: Site::Header, ..Outer::of_message(&doc, "header") };
        self.free_of_constants(path, fields, outer)
    }

    fn free_of_constants(&mut self, path: &Path, fields: &ast::Map<Field>, outer: Outer) -> Leaves {
        let mut leaves = Leaves::default();
        self.leaves(path, fields, outer, &mut leaves);
        for (constant, _) in &leaves.constants {
            let message = format!("`{}` cannot be constant here", constant.name);
            let help = "write constants of the header in `match` or in the access; parts of a text have none";
            self.error_with_help(&rules::TYPE, constant.doc.path.key("const").at_key(), message, help);
        }
        leaves
    }

    /// Resolves the fields of a message; signals come by first byte, then as written.
    pub fn message_leaves(&mut self, path: &Path, fields: &ast::Map<Field>, doc: &Doc, owner: &str) -> Leaves {
        let mut leaves = Leaves::default();
        self.tables.fields = 0;
        self.leaves(path, fields, Outer::of_message(doc, owner), &mut leaves);
        leaves.signals.sort_by_key(Signal::start);
        leaves
    }

    fn leaves(&mut self, path: &Path, fields: &ast::Map<Field>, outer: Outer, leaves: &mut Leaves) {
        for (name, field) in fields {
            self.leaf(&path.key(name), &format!("{}{name}", outer.group.prefix), field, outer, leaves);
        }
    }

    /// Resolves the only field of a message.
    pub fn value_leaf(&mut self, path: &Path, field: &Field, doc: &Doc, owner: &str) -> Leaves {
        let mut leaves = Leaves::default();
        self.tables.fields = 0;
        self.leaf(path, "value", field, Outer::of_message(doc, owner), &mut leaves);
        leaves.signals.sort_by_key(Signal::start);
        leaves
    }

    fn leaf(&mut self, path: &Path, name: &str, field: &Field, outer: Outer, leaves: &mut Leaves) {
        if self.count_field(path, outer.owner).is_none() {
            return give_up(name, field, leaves);
        }
        self.check_name(path, outer.own_name(name));
        let Some(merged) = self.merged(path, field) else { return give_up(name, field, leaves) };
        if self.read_leaf(path, name, &merged, outer, leaves).is_none() {
            give_up(name, &merged.field, leaves);
        }
    }

    /// Resolves a field, a word or a packed value. It returns nothing if the field must be given
    /// up.
    fn read_leaf(&mut self, path: &Path, name: &str, merged: &Merged, outer: Outer, leaves: &mut Leaves) -> Option<()> {
        let field = &merged.field;
        let fields = merged.path(self.diagnostics, Key::Fields);
        self.check_not_around(path, outer.own_name(name), &fields, outer.around)?;
        let around = [outer.around, std::slice::from_ref(&fields)].concat();
        let outer = Outer { around: &around, ..outer };
        let doc = remarks!(field).doc(path, Some(outer.doc));
        let doc = Doc { title: texts::text(merged.field.title.as_ref()), ..doc };
        leaves.replies.push((merged.path(self.diagnostics, Key::Reply), merged.field.reply.clone()));
        if merged.field.format.is_some() {
            self.check_keys(merged, Role::of_packed(outer.site));
            self.check_in_no_array(path, "a packed value", outer.row)?;
            leaves.signals.push(self.packed(name, merged, doc, outer)?);
            return Some(());
        }
        let place = self.place(path, name, merged, outer.word)?;
        if !merged.field.fields.is_empty() {
            self.check_keys(merged, Role::of_word(outer.site));
            self.tables.words.push(doc.clone());
            let row = self.row_in(path, merged, place, outer)?;
            let prefix = format!("{name}_");
            // Patterns name the fields of the header, and `value` is no name that the spec has written.
            let is_group = outer.site == Site::Message && name != "value";
            let kind = merged.type_at(&fields).filter(|_| is_group);
            let group = kind.map_or(outer.group, |kind| Group { name: kind, prefix: &prefix });
            let inside = Outer { word: Some(place), doc: &doc, row, group, ..outer };
            self.leaves(&fields, &merged.field.fields.clone(), inside, leaves);
            return Some(());
        }
        // Each use of a group has the same types of named values.
        let owner = if outer.group.name.is_empty() { outer.owner } else { outer.group.name };
        let signal = self.signal(outer.own_name(name), merged, place, doc, owner)?;
        let signal = Signal { name: name.to_owned(), ..signal };
        let is_sound = self.is_sound(merged);
        let constant = merged.field.constant.is_some();
        self.check_keys(merged, if constant { Role::Constant } else { Role::of_field(outer.site, &signal.encoding) });
        match &merged.field.constant {
            None => {
                let row = self.row_in(path, merged, place, outer)?;
                self.add_signal(signal, row, leaves)?;
                let names_another = self.diagnostics.has_errors_in(&path.key("type"));
                (is_sound && !names_another).then_some(())
            }
            Some(text) => {
                self.check_in_no_array(path, "a constant", outer.row)?;
                let at = merged.path(self.diagnostics, Key::Const);
                let value = self.integer(&at, text, 0, place.max())?;
                leaves.constants.push((signal, value));
                self.is_sound(merged).then_some(())
            }
        }
    }

    /// Returns the row of elements that a field makes, or is a part of.
    fn row_in(&mut self, path: &Path, merged: &Merged, place: Place, outer: Outer) -> Option<Row> {
        if outer.site != Site::Message {
            return Some(Row::ALONE);
        }
        if merged.field.repeat.is_some() {
            self.check_in_no_array(path, "an array", outer.row)?;
        }
        let row = self.row(merged, place, outer.word)?;
        Some(if row.is_array() { row } else { outer.row })
    }

    /// Counts a field of a message. It reports the limit only once.
    fn count_field(&mut self, path: &Path, owner: &str) -> Option<()> {
        self.tables.fields += 1;
        if self.tables.fields == FIELD_LIMIT + 1 {
            let text = format!("`{owner}` comes to more than {FIELD_LIMIT} fields");
            let help = "a frame has 64 bits; take out fields, or types that bring fields with them";
            self.error_with_help(&rules::TYPE, path.at_key(), text, help);
        }
        (self.tables.fields <= FIELD_LIMIT).then_some(())
    }

    /// Tests that the field is not inside a type that it takes its own fields from.
    fn check_not_around(&mut self, path: &Path, name: &str, fields: &Path, around: &[Path]) -> Option<()> {
        if !around.contains(fields) {
            return Some(());
        }
        let text = format!("`{name}` has a type that brings `{name}` with it");
        let problem = Diagnostic::error(&rules::TYPE, path.key("type").at_value(), text);
        let help = "name another type, or write out the fields that you mean";
        self.diagnostics.push(problem.other(fields.at_key(), "the fields of the type").help(help));
        None
    }

    /// Reads `bytes` or `bits`.
    fn place(&mut self, path: &Path, name: &str, merged: &Merged, word: Option<Place>) -> Option<Place> {
        let (bytes, bits) = (merged.path(self.diagnostics, Key::Bytes), merged.path(self.diagnostics, Key::Bits));
        match (&merged.field.bytes, &merged.field.bits, word) {
            (Some(text), None, _) => self.bytes(&bytes, text),
            (None, Some(text), Some(word)) => {
                let (high, low) = self.bits(&bits, text, word.width())?;
                Some(word.bits(high, low))
            }
            (None, Some(text), None) => {
                let message = format!("`{name}` counts bits, but stands in no word");
                let (high, _) = self.bits(&bits, text, 64)?;
                let word = if high < 8 { "0".to_owned() } else { format!("{}..0", high / 8) };
                let help = format!("write `bytes`, or put it into a word: `word: {{bytes: {word}, fields: {{...}}}}`");
                self.error_with_help(&rules::PLACE, bits.at_key(), message, help);
                None
            }
            (Some(_), Some(_), _) => {
                let help = "keep `bits` in a word, `bytes` elsewhere";
                let message = format!("`{name}` has two places: `bytes` and `bits`");
                self.error_with_help(&rules::PLACE, path.at_key(), message, help);
                None
            }
            (None, None, _) => {
                let help = "say where it stands: `bytes: 0..3`, or `bits: 7..4` in a word";
                self.error_with_help(&rules::PLACE, path.at_key(), format!("`{name}` has no place"), help);
                None
            }
        }
    }

    /// Makes a signal of a field that is no word.
    pub fn signal(&mut self, name: &str, merged: &Merged, place: Place, doc: Doc, owner: &str) -> Option<Signal> {
        let field = &merged.field;
        let encoding = self.encoding(name, merged, place, &doc, owner)?;
        let values = merged.path(self.diagnostics, Key::Values);
        let named = encoding.enumeration().is_some();
        let mut specials =
            if named { Vec::new() } else { self.values(&values, &field.values, place.width(), encoding.numeral()) };
        let absent = encoding.linear().and_then(|linear| self.absent(merged, linear.numeral, place.width(), &specials));
        let has_absent = absent.is_some();
        specials.extend(absent);
        let unavailable = match encoding.enumeration() {
            Some(index) => self.tables.enumerations[index].absent(),
            None => specials.last().filter(|_| has_absent),
        };
        let default = unavailable.map(|value| value.raw);
        let unit = field.unit.as_ref();
        let unit = unit.and_then(|text| self.unit_of_field(&merged.path(self.diagnostics, Key::Unit), text, field));
        let (range_path, default_path) =
            (merged.path(self.diagnostics, Key::Range), merged.path(self.diagnostics, Key::Default));
        let range = field.range.as_ref().and_then(|text| self.range_of(&range_path, text, unit));
        let kinds = self.kinds(&merged.path(self.diagnostics, Key::In), &field.kinds);
        let mut signal = Signal {
            name: name.to_owned(),
            doc,
            types: merged.types.clone(),
            place,
            encoding,
            unit,
            range,
            range_path,
            default,
            specials,
            has_absent,
            default_path: default_path.clone(),
            model_ranges: Vec::new(),
            model_defaults: Vec::new(),
            kinds,
            element: None,
        };
        let is_judged = field.values.is_empty() || !self.diagnostics.has_errors_in(&values);
        if let Some(text) = field.default.as_ref().filter(|_| is_judged) {
            signal.default = self.default(&default_path, &signal, text);
        }
        self.add_what_models_change(merged, &mut signal);
        Some(signal)
    }

    /// Adds the limits and defaults of device models that replace those of the signal's types.
    fn add_what_models_change(&mut self, merged: &Merged, signal: &mut Signal) {
        self.warn_of_hidden(merged, Key::Range, |known| known.range.is_some());
        self.warn_of_hidden(merged, Key::Default, |known| known.default.is_some());
        for model in self.tables.models.ids() {
            if let Some(known) = self.changed(merged, model, Key::Range, |known| known.range.is_some()) {
                let path = known.doc.path.key("range");
                signal.model_ranges.extend(known.range.map(|value| OfModel { model, value, path }));
            }
            if let Some(known) = self.changed(merged, model, Key::Default, |known| known.default.is_some()) {
                let path = known.doc.path.key("default");
                let text = known.default.map(|value| value.to_string()).unwrap_or_default();
                let raw = self.default(&path, signal, &text);
                signal.model_defaults.extend(raw.map(|value| OfModel { model, value, path }));
            }
        }
    }

    /// Finds what a device model changes of the type from which a field would take a key.
    fn changed(
        &self,
        merged: &Merged,
        model: ModelId,
        key: Key,
        has: impl Fn(&TypeOfModel) -> bool,
    ) -> Option<TypeOfModel> {
        let writes = |source: &Path| self.diagnostics.has(&source.key(key));
        if writes(&merged.sources[0]) {
            return None;
        }
        for (name, source) in merged.types.iter().zip(&merged.sources[1..]) {
            let known = self.tables.models[model].types.iter().find(|known| known.name == *name && has(known));
            if known.is_some() || writes(source) {
                return known.cloned();
            }
        }
        None
    }

    /// Warns of a key of the field that hides what device models change in its types.
    fn warn_of_hidden(&mut self, merged: &Merged, key: Key, has: impl Fn(&TypeOfModel) -> bool + Copy) {
        for name in &merged.types {
            let models = self.hidden(merged, name, key, has);
            if !models.is_empty() {
                let at = merged.path(self.diagnostics, key).at_value();
                let warning = hidden_by(at, key, name, &models);
                self.diagnostics.push(warning);
            }
        }
    }

    /// Finds the device models that change a key of a type, but not the field.
    fn hidden(
        &self,
        merged: &Merged,
        name: &str,
        key: Key,
        has: impl Fn(&TypeOfModel) -> bool + Copy,
    ) -> Vec<&DeviceModel> {
        let models = self.tables.models.entries();
        let changing = models.filter(|(_, model)| model.types.iter().any(|known| known.name == name && has(known)));
        let hidden = changing.filter(|(id, _)| self.changed(merged, *id, key, has).is_none());
        hidden.map(|(_, model)| model).collect()
    }

    fn default(&mut self, path: &Path, signal: &Signal, text: &str) -> Option<i128> {
        match self.words().with(signal, |room| room.parse(text, false)) {
            Ok(bits) => Some(signal.raw_of(bits)),
            Err(Misfit { why, help }) => {
                let misfit = Diagnostic::error(&rules::VALUE, path.at_value(), why);
                self.diagnostics.push_first(misfit.help_if(help));
                None
            }
        }
    }

    fn encoding(&mut self, name: &str, merged: &Merged, place: Place, doc: &Doc, owner: &str) -> Option<Encoding> {
        let field = &merged.field;
        let otherwise = if owner.is_empty() { name.to_owned() } else { format!("{owner}_{name}") };
        if field.status.is_some() {
            return Some(Encoding::Status(self.status_word(merged, &otherwise, place, doc)));
        }
        let numeral = match self.number_format(merged)? {
            NumberFormat::Integer(Numeral::Bcd) => self.decimal(name, merged, place)?,
            NumberFormat::Integer(numeral @ (Numeral::Unsigned | Numeral::Signed)) => numeral,
            NumberFormat::Float => return self.float(name, merged, place),
            NumberFormat::Text => return self.text(name, merged, place),
            NumberFormat::Bytes => return self.hexadecimal(name, merged, place),
        };
        let number = field.scale.is_some() || field.offset.is_some() || field.unit.is_some() || field.range.is_some();
        if !field.values.is_empty() && !number {
            return self.enumeration(merged, &otherwise, place.width(), doc).map(Encoding::Named);
        }
        let mut read = |key: Key, text: &Option<String>, otherwise: Rational| match text {
            Some(text) => self.number(&merged.path(self.diagnostics, key), text),
            None => Some(otherwise),
        };
        let scale = read(Key::Scale, &field.scale, Rational::ONE)?;
        let offset = read(Key::Offset, &field.offset, Rational::ZERO)?;
        Some(Encoding::Number { numeral, scale, offset })
    }

    /// Reads `as`.
    fn number_format(&mut self, merged: &Merged) -> Option<NumberFormat> {
        let Some(word) = &merged.field.format_of_number else { return Some(NumberFormat::Integer(Numeral::Unsigned)) };
        let at = merged.path(self.diagnostics, Key::As);
        let index = self.lookup(&at, "number format", word, NUMBER_FORMATS.iter().map(|(word, _)| *word))?;
        Some(NUMBER_FORMATS[index].1)
    }

    fn decimal(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Numeral> {
        if !place.width().is_multiple_of(4) {
            let text = format!("a decimal digit has four bits, the place of `{name}` has {}", place.width());
            let help = "give the field a multiple of four bits, or take `as: bcd` out";
            self.error_with_help(&rules::TYPE, merged.sources[0].key("as").at_value(), text, help);
            return None;
        }
        Some(Numeral::Bcd)
    }

    fn float(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Encoding> {
        let at = merged.sources[0].key("as").at_value();
        if place.width() != 32 {
            let text = format!("a float has 32 bits, the place of `{name}` has {}", place.width());
            self.error_with_help(&rules::TYPE, at, text, "give the field four bytes, or take `as: float` out");
            return None;
        }
        if merged.field.scale.is_some() || merged.field.offset.is_some() {
            let message = format!("`{name}` is a float, which is neither scaled nor offset");
            self.error_with_help(&rules::TYPE, at, message, "take `scale` and `offset` out, or `as: float`");
            return None;
        }
        Some(Encoding::Float)
    }

    fn text(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Encoding> {
        self.whole_bytes(name, merged, place, "a text has")?;
        let fill = match &merged.field.fill {
            Some(text) => self.integer(&merged.path(self.diagnostics, Key::Fill), text, 0, u8::MAX)?,
            None => 0,
        };
        Some(Encoding::Text(TextForm::Ascii { fill }))
    }

    fn hexadecimal(&mut self, name: &str, merged: &Merged, place: Place) -> Option<Encoding> {
        self.whole_bytes(name, merged, place, "raw bytes are")?;
        Some(Encoding::Text(TextForm::Hexadecimal))
    }

    /// Tests that a text has a place of whole bytes.
    fn whole_bytes(&mut self, name: &str, merged: &Merged, place: Place, subject: &str) -> Option<()> {
        if !place.width().is_multiple_of(8) {
            let message = format!("{subject} whole bytes, the place of `{name}` has {} bits", place.width());
            let format = merged.field.format_of_number.as_deref().unwrap_or_default();
            let help = format!("give the field whole bytes, or take `as: {format}` out");
            self.error_with_help(&rules::TYPE, merged.sources[0].key("as").at_value(), message, help);
            return None;
        }
        Some(())
    }

    /// Makes one text signal of several parts.
    fn packed(&mut self, name: &str, merged: &Merged, doc: Doc, outer: Outer) -> Option<Signal> {
        let fields = merged.path(self.diagnostics, Key::Fields);
        let inside = Outer { site: Site::Packed, doc: &doc, group: Group::NONE, ..outer };
        let leaves = self.free_of_constants(&fields, &merged.field.fields.clone(), inside);
        let parts: Table<PartId, Signal> = leaves.given_up.is_empty().then(|| leaves.signals.into_iter().collect())?;
        let format = merged.field.format.clone()?;
        let at = merged.path(self.diagnostics, Key::Format);
        let (pieces, place) = self.format(&at, &format, &parts)?;
        let kinds: Vec<Kind> = self.kinds(&merged.path(self.diagnostics, Key::In), &merged.field.kinds);
        let (range_path, default_path) = (doc.path.key("range"), doc.path.key("default"));
        Some(Signal {
            name: name.to_owned(),
            doc,
            types: merged.types.clone(),
            place,
            encoding: Encoding::Packed { pieces, parts },
            unit: None,
            range: None,
            range_path,
            specials: Vec::new(),
            has_absent: false,
            default: None,
            default_path,
            model_ranges: Vec::new(),
            model_defaults: Vec::new(),
            kinds,
            element: None,
        })
    }
}

/// Makes a warning about a key that hides what device models change in a type.
fn hidden_by(at: At, key: Key, name: &str, models: &[&DeviceModel]) -> Diagnostic {
    let names: Vec<_> = models.iter().map(|model| format!("`{}`", model.name)).collect();
    let word = key.name();
    let text = format!("this {word} leaves the {word} of {} for the type `{name}` without effect", names.join(", "));
    let help = format!("put the general {word} into the type `{name}`, or take a type that no model changes");
    let places = models.iter().map(|model| model.doc.path.key("types").key(name).key(key).at_value());
    places.fold(Diagnostic::warning(&rules::MODEL_RANGE, at, text).help(help), |known, at| {
        known.other(at, "no effect here")
    })
}

/// Lets examples name a field, or the fields inside it, although the signal was given up.
fn give_up(name: &str, field: &Field, leaves: &mut Leaves) {
    leaves.given_up.push(name.to_owned());
    for (inner, field) in &field.fields {
        give_up(inner, field, leaves);
        give_up(&format!("{name}_{inner}"), field, leaves);
    }
}
