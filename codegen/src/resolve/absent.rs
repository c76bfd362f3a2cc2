//! Resolves which raw value says that a device does not have the value.

use super::Resolver;
use super::types::Merged;
use crate::model::keywords::ABSENT;
use crate::model::{NamedValue, Numeral};
use crate::read::syntax::ast::Key;
use crate::report::tree::Path;
use crate::resolve::rules;

/// The name of that raw value.
const NOT_AVAILABLE: &str = "not_available";

impl Resolver<'_> {
    /// Reads what all fields have that do not say it themselves.
    pub fn absent_of_protocol(&mut self) -> bool {
        let written = self.spec.absent.as_ref();
        written.and_then(|word| self.means_ones(&Path::default().key("absent"), word)).unwrap_or(false)
    }

    /// Returns the raw value that says that there is no value, unless it has a name already.
    ///
    /// A single bit has no room for it, and a constant is always there.
    pub fn absent(&mut self, merged: &Merged, numeral: Numeral, width: u8, named: &[NamedValue]) -> Option<NamedValue> {
        let are_ones = match &merged.field.absent {
            Some(word) => self.own_absent(merged, word, width)?,
            None => self.tables.absent_are_ones,
        };
        let (_, raw) = numeral.raw_limits(width);
        let is_free = width > 1 && merged.field.constant.is_none() && named.iter().all(|known| known.raw != raw);
        if !(are_ones && is_free) {
            return None;
        }
        if let Some(known) = named.iter().find(|known| known.name == NOT_AVAILABLE) {
            let text = format!("raw {} and all ones would both be called `{NOT_AVAILABLE}`", known.raw);
            let help = "give the value another name, or write `absent: none`";
            let at = merged.path(self.diagnostics, Key::Values);
            self.error_with_help(&rules::NAMED_VALUE, at.at_key(), text, help);
            return None;
        }
        let (name, models, models_path) = (NOT_AVAILABLE.to_owned(), Vec::new(), Path::default());
        Some(NamedValue { raw, name, title: None, models, models_path })
    }

    /// Reads what a field or its type says, which must make a difference.
    fn own_absent(&mut self, merged: &Merged, word: &str, width: u8) -> Option<bool> {
        let at = merged.path(self.diagnostics, Key::Absent);
        let are_ones = self.means_ones(&at, word)?;
        let types = merged.types.iter().filter_map(|name| self.spec.types.get(name));
        let has_type = types.into_iter().any(|known| known.absent.as_deref() == Some("ones"));
        let why = if are_ones && width == 1 {
            "a single bit has no room for it"
        } else if !are_ones && !self.tables.absent_are_ones && !has_type {
            "neither a type nor the protocol has `absent: ones`"
        } else {
            return Some(are_ones);
        };
        let text = format!("`absent: {word}` says nothing here: {why}");
        self.error_with_help(&rules::MISPLACED_KEY, at.at_key(), text, "take it out");
        None
    }

    /// Tests that `absent` stands where the named values do, since they are one type for all fields.
    pub fn check_beside_values(&mut self, merged: &Merged, source: &Path) {
        let at = merged.path(self.diagnostics, Key::Absent);
        if merged.field.absent.is_some() && at != source.key(Key::Absent) {
            let text = "`absent` stands apart from the `values` that it adds to".to_owned();
            self.error_with_help(&rules::MISPLACED_KEY, at.at_key(), text, "write it where the `values` are");
        }
    }

    fn means_ones(&mut self, path: &Path, word: &str) -> Option<bool> {
        let index = self.lookup(path, "way to be absent", word, ABSENT.iter().map(|(word, _)| *word))?;
        Some(ABSENT[index].1)
    }
}
