//! Goes through the fields of a message: takes words, groups and packed values apart, and makes
//! signals and constants of the rest.

use super::Resolver;
use super::arrays::Row;
use super::keys::{Role, Site};
use super::leaves::Leaves;
use super::parts::{COUNTER, DATA, LENGTH, PART};
use super::runs::is_run;
use super::texts::{self, remarks};
use super::types::Merged;
use super::window::Windowed;
use crate::model::{ByteRun, Doc, Encoding, Kind, PartId, Signal, Table};
use crate::read::syntax::ast::{self, Field, Key, PartData};
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;

/// Largest number of fields of a message, counting those of words, packed values and their types.
const FIELD_LIMIT: usize = 256;

/// What is around a field.
#[derive(Clone, Copy)]
struct Outer<'a> {
    site: Site,
    /// The word whose bits the field's `bits` count.
    word: Option<Windowed>,
    /// Whether `bytes` count in the data of several frames.
    is_long: bool,
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
        Self {
            site: Site::Message,
            word: None,
            is_long: false,
            doc,
            owner,
            around: &[],
            row: Row::ALONE,
            group: Group::NONE,
        }
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
    pub fn message_leaves(
        &mut self,
        path: &Path,
        fields: &ast::Map<Field>,
        doc: &Doc,
        owner: &str,
        is_long: bool,
    ) -> Leaves {
        let mut leaves = Leaves::default();
        self.tables.fields = 0;
        self.leaves(path, fields, Outer { is_long, ..Outer::of_message(doc, owner) }, &mut leaves);
        leaves.signals.sort_by_key(|signal| signal.bytes().start);
        leaves
    }

    /// Resolves the fields of a frame that carries a part of a long message: its number and the counter of messages.
    /// Data that say nothing alone are a field, too.
    pub fn part_leaves(&mut self, path: &Path, parts: &ast::Parts, doc: &Doc, owner: &str) -> Leaves {
        let mut leaves = Leaves::default();
        self.tables.fields = 0;
        let outer = Outer::of_message(doc, owner);
        self.number_of_parts((&path.key("number"), PART), &parts.number, outer, &mut leaves);
        if let Some(counter) = &parts.counter {
            self.number_of_parts((&path.key("counter"), COUNTER), counter, outer, &mut leaves);
        }
        if let PartData::Bytes(place) = &parts.data {
            let data =
                Field { bytes: Some(place.clone()), format_of_number: Some("bytes".to_owned()), ..Field::default() };
            self.leaf(&path.key("data"), DATA, &data, outer, &mut leaves);
        }
        leaves
    }

    /// Resolves the field of the first part that says how many data bytes there are.
    pub fn length_leaf(&mut self, path: &Path, field: &Field, doc: &Doc, owner: &str) -> Option<Signal> {
        let mut leaves = Leaves::default();
        self.number_of_parts((path, LENGTH), field, Outer::of_message(doc, owner), &mut leaves);
        leaves.signals.pop().filter(|_| leaves.given_up.is_empty())
    }

    /// Resolves a number beside the data of a part. `bits` beside `bytes` are those of a word in which it is alone.
    fn number_of_parts(&mut self, (path, name): (&Path, &str), field: &Field, outer: Outer, leaves: &mut Leaves) {
        // It is always there, so all ones are a number, too.
        let are_ones = std::mem::take(&mut self.tables.absent_are_ones);
        match (&field.bytes, &field.bits) {
            (Some(bytes), Some(_)) => match self.bytes(&path.key("bytes"), bytes) {
                Some(word) => {
                    let inside = Field { bytes: None, ..field.clone() };
                    self.leaf(path, name, &inside, Outer { word: Some((0, word)), ..outer }, leaves);
                }
                None => give_up(name, field, outer.group.prefix, leaves),
            },
            _ => self.leaf(path, name, field, outer, leaves),
        }
        self.tables.absent_are_ones = are_ones;
    }

    fn leaves(&mut self, path: &Path, fields: &ast::Map<Field>, outer: Outer, leaves: &mut Leaves) {
        for (name, field) in fields {
            self.leaf(&path.key(name), &format!("{}{name}", outer.group.prefix), field, outer, leaves);
        }
    }

    /// Resolves the only field of a message.
    pub fn value_leaf(&mut self, path: &Path, field: &Field, doc: &Doc, owner: &str, is_long: bool) -> Leaves {
        let mut leaves = Leaves::default();
        self.tables.fields = 0;
        self.leaf(path, "value", field, Outer { is_long, ..Outer::of_message(doc, owner) }, &mut leaves);
        leaves.signals.sort_by_key(|signal| signal.bytes().start);
        leaves
    }

    fn leaf(&mut self, path: &Path, name: &str, field: &Field, outer: Outer, leaves: &mut Leaves) {
        if self.count_field(path, outer.owner).is_none() {
            return give_up(name, field, outer.group.prefix, leaves);
        }
        self.check_name(path, outer.own_name(name));
        let Some(merged) = self.merged(path, field) else { return give_up(name, field, outer.group.prefix, leaves) };
        let fields = merged.path(self.diagnostics, Key::Fields);
        let prefix = format!("{name}_");
        // Patterns name the fields of the header, and `value` is no name that the spec has written.
        let is_group = outer.site == Site::Message && name != "value";
        let kind = merged.type_at(&fields).filter(|_| is_group);
        let group = kind.map_or(outer.group, |kind| Group { name: kind, prefix: &prefix });
        if self.read_leaf(path, name, &merged, (outer, group), leaves).is_none() {
            give_up(name, &merged.field, group.prefix, leaves);
        }
    }

    /// Resolves a field, a word or a packed value. `group` is that of the fields inside. It returns
    /// nothing if the field must be given up.
    fn read_leaf(
        &mut self,
        path: &Path,
        name: &str,
        merged: &Merged,
        (outer, group): (Outer, Group),
        leaves: &mut Leaves,
    ) -> Option<()> {
        let fields = merged.path(self.diagnostics, Key::Fields);
        self.check_not_around(path, outer.own_name(name), &fields, outer.around)?;
        let around = [outer.around, std::slice::from_ref(&fields)].concat();
        let outer = Outer { around: &around, ..outer };
        let field = &merged.field;
        let doc = remarks!(field).doc(path, Some(outer.doc));
        let doc = Doc { title: texts::text(field.title.as_ref()), ..doc };
        leaves.replies.push((merged.path(self.diagnostics, Key::Reply), field.reply.clone()));
        if field.format.is_some() {
            self.check_keys(merged, Role::of_packed(outer.site));
            self.check_in_no_array(path, "a packed value", outer.row)?;
            if outer.is_long {
                self.refuse_in_long(path, ("a packed value", "make fields of its parts"));
                return None;
            }
            leaves.signals.push(self.packed(name, merged, doc, outer)?);
            return Some(());
        }
        if is_run(merged) {
            let run = self.run(merged, outer.is_long)?;
            return self.long_text(path, name, merged, (run, doc), outer, leaves);
        }
        let place = self.place(path, name, merged, outer.word, outer.is_long)?;
        if field.fields.is_empty() {
            return self.value(path, name, merged, (place, doc), outer, leaves);
        }
        self.check_keys(merged, Role::of_word(outer.site));
        self.tables.words.push(doc.clone());
        let row = self.row_in(path, merged, place, outer)?;
        let inside = Outer { word: Some(place), doc: &doc, row, group, ..outer };
        self.leaves(&fields, &field.fields, inside, leaves);
        Some(())
    }

    /// Resolves a field without fields inside: a signal, an array or a constant.
    fn value(
        &mut self,
        path: &Path,
        name: &str,
        merged: &Merged,
        (placed, doc): (Windowed, Doc),
        outer: Outer,
        leaves: &mut Leaves,
    ) -> Option<()> {
        let (window, place) = placed;
        // Each use of a group has the same types of named values.
        let owner = if outer.group.name.is_empty() { outer.owner } else { outer.group.name };
        let signal = self.signal(outer.own_name(name), merged, place, doc, owner)?;
        let around = outer.word.filter(|_| merged.field.bits.is_some());
        let word = around.map_or(place, |(_, word)| word);
        let signal = signal.changed(|signal| {
            (signal.name, signal.window, signal.word) = (name.to_owned(), window, word);
        });
        let is_sound = self.is_sound(merged);
        let constant = &merged.field.constant;
        let role = if constant.is_some() { Role::Constant } else { Role::of_field(outer.site, &signal.encoding) };
        self.check_keys(merged, role);
        let Some(text) = constant else {
            let row = self.row_in(path, merged, placed, outer)?;
            self.add_signal(signal, row, leaves)?;
            let names_another = self.diagnostics.has_errors_in(&path.key("type"));
            return (is_sound && !names_another).then_some(());
        };
        self.check_in_no_array(path, "a constant", outer.row)?;
        let value = self.integer(&merged.path(self.diagnostics, Key::Const), text, 0, place.max())?;
        leaves.constants.push((signal, value));
        self.is_sound(merged).then_some(())
    }

    /// Resolves a text that no eight bytes can hold.
    fn long_text(
        &mut self,
        path: &Path,
        name: &str,
        merged: &Merged,
        (((window, place), run), doc): ((Windowed, ByteRun), Doc),
        outer: Outer,
        leaves: &mut Leaves,
    ) -> Option<()> {
        self.check_in_no_array(path, "a text of more than eight bytes, or without an end,", outer.row)?;
        let signal = self.signal(outer.own_name(name), merged, place, doc, outer.owner)?;
        self.check_keys(merged, Role::of_run(&signal.encoding));
        leaves.signals.push(Signal { name: name.to_owned(), window, run: Some(run), ..signal });
        self.is_sound(merged).then_some(())
    }

    /// Returns the row of elements that a field makes, or is a part of.
    fn row_in(&mut self, path: &Path, merged: &Merged, place: Windowed, outer: Outer) -> Option<Row> {
        if outer.site != Site::Message {
            return Some(Row::ALONE);
        }
        if merged.field.repeat.is_some() {
            self.check_in_no_array(path, "an array", outer.row)?;
        }
        let row = self.row(merged, place, outer.word, outer.is_long)?;
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
        let models = self.models_named(&merged.path(self.diagnostics, Key::Models), &merged.field.models);
        let (range_path, default_path) = (doc.path.key("range"), doc.path.key("default"));
        Some(Signal {
            name: name.to_owned(),
            doc,
            types: merged.types.clone(),
            window: 0,
            place,
            word: place,
            run: None,
            encoding: Encoding::Packed { pieces, parts },
            unit: None,
            range: None,
            range_path,
            specials: Vec::new(),
            has_absent: false,
            default: None,
            default_path,
            model_ranges: Vec::new(),
            limit: None,
            model_defaults: Vec::new(),
            conduct: self.conduct(merged, Role::Packed),
            kinds,
            models,
            element: None,
        })
    }
}

/// Lets examples name a field, or the fields inside it, although it has no signals. `prefix` is that of
/// the fields inside.
fn give_up(name: &str, field: &Field, prefix: &str, leaves: &mut Leaves) {
    leaves.given_up.push(name.to_owned());
    for (inner, field) in &field.fields {
        give_up(&format!("{prefix}{inner}"), field, prefix, leaves);
    }
}
