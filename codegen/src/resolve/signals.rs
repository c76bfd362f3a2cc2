//! Makes a signal of a field: its place, its limits and what stands for no value.

use canspec_runtime::Place;

use super::Resolver;
use super::keys::{Role, Site};
use super::types::Merged;
use super::window::Windowed;
use crate::model::keywords::{OUT_OF_RANGE, POWER_OFF};
use crate::model::{Conduct, DeviceModel, Doc, Misfit, ModelId, OfModel, Range, Signal, TypeOfModel};
use crate::read::syntax::ast::{Field, Key};
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::tree::Path;
use crate::resolve::rules;

/// Most fields that device models change in a spec, each counted for each model.
const MOST_CHANGES: usize = 1 << 16;

/// What a device model can change of a type.
const OF_MODELS: [Key; 5] = [Key::Range, Key::Default, Key::Scale, Key::Offset, Key::Unit];

impl TypeOfModel {
    /// Tests whether the device model changes a key.
    fn changes(&self, key: Key) -> bool {
        let changed = [
            (Key::Range, self.range.is_some()),
            (Key::Default, self.default.is_some()),
            (Key::Scale, self.scale.is_some()),
            (Key::Offset, self.offset.is_some()),
            (Key::Unit, self.unit.is_some()),
        ];
        changed.contains(&(key, true))
    }
}

impl Resolver<'_> {
    /// Reads `bytes` or `bits`. `word` is the word around the field.
    pub fn place(
        &mut self,
        path: &Path,
        name: &str,
        merged: &Merged,
        word: Option<Windowed>,
        is_long: bool,
    ) -> Option<Windowed> {
        let (bytes, bits) = (merged.path(self.diagnostics, Key::Bytes), merged.path(self.diagnostics, Key::Bits));
        match (&merged.field.bytes, &merged.field.bits, word) {
            (Some(text), None, _) if is_long => self.window(&bytes, text),
            (Some(text), None, _) => Some((0, self.bytes(&bytes, text)?)),
            (None, Some(text), Some((window, word))) => {
                let (high, low) = self.bits(&bits, text, word.width())?;
                Some((window, word.bits(high, low)))
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
        let models = self.models_named(&merged.path(self.diagnostics, Key::Models), &field.models);
        let conduct = self.conduct(merged, Role::of_field(Site::Message, &encoding));
        let mut signal = Signal {
            name: name.to_owned(),
            doc,
            types: merged.types.clone(),
            window: 0,
            place,
            word: place,
            run: None,
            encoding,
            unit,
            range,
            range_path,
            default,
            specials,
            has_absent,
            default_path: default_path.clone(),
            model_ranges: Vec::new(),
            limit: None,
            model_defaults: Vec::new(),
            conduct,
            kinds,
            models,
            element: None,
        };
        let is_judged = field.values.is_empty() || !self.diagnostics.has_errors_in(&values);
        let default = field.default.as_ref().filter(|_| is_judged);
        for key in OF_MODELS {
            self.warn_of_hidden(merged, key);
        }
        if self.is_scaled_by_models(merged) {
            self.scale_by_models(merged, &mut signal, default)?;
            return Some(signal);
        }
        if let Some(text) = default {
            signal.default = self.default(&default_path, &signal, text);
        }
        self.limit_by_models(merged, &mut signal);
        Some(signal)
    }

    /// Adds the limits and defaults of device models that replace those of the signal's types.
    fn limit_by_models(&mut self, merged: &Merged, signal: &mut Signal) {
        for model in self.tables.models.ids() {
            let (range, default) = (self.range_of_model(merged, model), self.default_of_model(merged, model));
            if (range.is_some() || default.is_some()) && !self.may_change(merged) {
                return;
            }
            signal.model_ranges.extend(range.map(|(path, value)| OfModel { model, value, path }));
            if let Some((path, text)) = default {
                let raw = self.default(&path, signal, &text);
                signal.model_defaults.extend(raw.map(|value| OfModel { model, value, path }));
            }
        }
    }

    /// Counts a field that a device model changes, and refuses the first one beyond the most. Returns whether it may.
    pub fn may_change(&mut self, merged: &Merged) -> bool {
        self.tables.changes_by_models += 1;
        if self.tables.changes_by_models == MOST_CHANGES + 1 {
            let text = format!("device models change fields more than {MOST_CHANGES} times from here on");
            let help =
                "each field counts once for each model that changes its type; write a spec for some of the models";
            self.error_with_help(&rules::MODEL_RANGE, merged.sources[0].at_key(), text, help);
        }
        self.tables.changes_by_models <= MOST_CHANGES
    }

    /// Returns the limits that a device model has of its own, and their place.
    pub fn range_of_model(&self, merged: &Merged, model: ModelId) -> Option<(Path, Range)> {
        let known = self.changed(merged, model, Key::Range)?;
        Some((known.doc.path.key(Key::Range), known.range?))
    }

    /// Returns the default that a device model has of its own, and its place.
    pub fn default_of_model(&self, merged: &Merged, model: ModelId) -> Option<(Path, String)> {
        let known = self.changed(merged, model, Key::Default)?;
        Some((known.doc.path.key(Key::Default), known.default?.to_string()))
    }

    /// Finds what a device model changes of the type from which a field would take a key.
    pub fn changed(&self, merged: &Merged, model: ModelId, key: Key) -> Option<TypeOfModel> {
        let writes = |source: &Path| self.diagnostics.has(&source.key(key));
        if writes(&merged.sources[0]) {
            return None;
        }
        for (name, source) in merged.types.iter().zip(&merged.sources[1..]) {
            let known = self.tables.models[model].types.iter().find(|known| known.name == *name && known.changes(key));
            if known.is_some() || writes(source) {
                return known.cloned();
            }
        }
        None
    }

    /// Warns of a key of the field that hides what device models change in its types.
    fn warn_of_hidden(&mut self, merged: &Merged, key: Key) {
        for name in &merged.types {
            let models = self.hidden(merged, name, key);
            if !models.is_empty() {
                let at = merged.path(self.diagnostics, key).at_value();
                let warning = hidden_by(at, key, name, &models);
                self.diagnostics.push(warning);
            }
        }
    }

    /// Finds the device models that change a key of a type, but not the field.
    fn hidden(&self, merged: &Merged, name: &str, key: Key) -> Vec<&DeviceModel> {
        let models = self.tables.models.entries();
        let changing =
            models.filter(|(_, model)| model.types.iter().any(|known| known.name == name && known.changes(key)));
        let hidden = changing.filter(|(id, _)| self.changed(merged, *id, key).is_none());
        hidden.map(|(_, model)| model).collect()
    }

    /// Reads what a device does with the value.
    pub fn conduct(&mut self, merged: &Merged, role: Role) -> Conduct {
        let Field { out_of_range, power_off, range, .. } = &merged.field;
        let at = merged.path(self.diagnostics, Key::OutOfRange);
        let is_limited =
            range.is_some() || self.tables.models.ids().any(|model| self.range_of_model(merged, model).is_some());
        if out_of_range.is_some() && role.reads(Key::OutOfRange) && !is_limited {
            let text = "`out_of_range` says nothing here: no range says what the document allows".to_owned();
            self.error_with_help(&rules::MISPLACED_KEY, at.at_key(), text, "write the `range`, or take it out");
        }
        let out_of_range = self.one_of(&at, "answer to a value out of range", out_of_range.as_ref(), &OUT_OF_RANGE);
        let at = merged.path(self.diagnostics, Key::PowerOff);
        Conduct { out_of_range, keeps: self.one_of(&at, "fate of a value", power_off.as_ref(), &POWER_OFF) }
    }

    /// Reads one of a few words.
    fn one_of<T: Copy>(
        &mut self,
        at: &Path,
        what: &str,
        word: Option<&String>,
        words: &[(&'static str, T)],
    ) -> Option<T> {
        let index = self.lookup(at, what, word?, words.iter().map(|(word, _)| *word))?;
        Some(words[index].1)
    }

    pub fn default(&mut self, path: &Path, signal: &Signal, text: &str) -> Option<i128> {
        match self.words().with(signal, |room| room.parse(text, false)) {
            Ok(bits) => Some(signal.raw_of(bits)),
            Err(Misfit { why, help }) => {
                let misfit = Diagnostic::error(&rules::VALUE, path.at_value(), why);
                self.diagnostics.push_first(misfit.help_if(help));
                None
            }
        }
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
