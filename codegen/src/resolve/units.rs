//! Resolves the units that a spec declares.

use super::Resolver;
use crate::model::unit_prefixes;
use crate::model::{Symbol, Unit};
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;

impl Resolver<'_> {
    /// Reads the units that the spec declares beside those of the language.
    pub fn units(&mut self) -> Vec<(Unit, bool)> {
        self.check_not_empty(&Path::default(), &["units"]);
        let root = Path::default().key("units");
        let spec = self.spec;
        let mut units: Vec<Unit> = Vec::new();
        for (name, symbol) in &spec.units {
            let path = root.key(name);
            self.check_name(&path, name);
            if let Some(unit) = self.declared(&path, name, symbol, &units) {
                units.push(unit);
            }
        }
        units.into_iter().map(|unit| (unit, false)).collect()
    }

    /// Finds a declared unit by its symbol.
    pub fn declared_unit(&mut self, symbol: &str) -> Option<Unit> {
        let (unit, is_used) = self.tables.units.iter_mut().find(|(unit, _)| *unit.symbol == *symbol)?;
        *is_used = true;
        Some(*unit)
    }

    /// Tests that each declared unit is used.
    pub fn check_units_used(&mut self) {
        if self.diagnostics.has_errors() {
            return;
        }
        for (unit, _) in self.tables.units.iter().filter(|(_, is_used)| !is_used) {
            let at = Path::default().key("units").key(&*unit.suffix).at_key();
            let text = format!("nothing has the unit `{}`", unit.symbol);
            let warning = Diagnostic::warning(&rules::UNIT, at, text);
            self.diagnostics.push(warning.help("give it to a field, or take it out"));
        }
    }

    fn declared(&mut self, path: &Path, name: &str, symbol: &str, known: &[Unit]) -> Option<Unit> {
        let unit = Unit::declared(symbol, name);
        let (text, help) = if !is_symbol(symbol) {
            (format!("`{symbol}` is no symbol of a unit"), "write it without blanks, and not with a number in front")
        } else if Unit::find(symbol).or_else(|| unit_prefixes::respelled(symbol)).is_some() {
            (format!("`{symbol}` is a unit of the language"), "take it out")
        } else if unit_prefixes::prefixed(symbol).is_some() {
            (format!("`{symbol}` is a multiple of a unit of the language"), "write the unit, with a scale")
        } else if known.iter().any(|known| *known.symbol == *symbol) {
            (format!("`{symbol}` is declared twice"), "take one of the two out")
        } else if Unit::ALL.iter().any(|known| *known.suffix == *name) {
            (format!("`{name}` is the name of another unit"), "give it a name of its own")
        } else if unit.is_none() {
            (format!("`{name}` or `{symbol}` is too long"), "write at most 23 bytes")
        } else {
            return unit;
        };
        debug_assert_eq!(Symbol::LONGEST, 23, "the help says so");
        self.error_with_help(&rules::UNIT, path.at_value(), text, help);
        None
    }
}

/// Tests whether a text can stand behind a number.
fn is_symbol(text: &str) -> bool {
    let is_of_number = |letter: char| letter.is_ascii_digit() || matches!(letter, '-' | '.' | '/' | '~');
    let is_plain = |letter: char| !letter.is_whitespace() && !letter.is_control() && !"\"'`\\,;[]{}".contains(letter);
    !text.is_empty() && !text.starts_with(is_of_number) && text.chars().all(is_plain)
}
