//! Reads the texts of a spec: numbers, ranges, quantities, places and names.

use std::fmt::Display;

use canspec_runtime::Place;

use super::Resolver;
use crate::model::unit_prefixes;
use crate::model::{Doc, Id, Kind, Quantity, Range, Table, Unit};
use crate::read::syntax::ast::{Field, Names, Words};
use crate::report::diagnostic::At;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::nearest::nearest;
use crate::words::number::Rational;
use crate::words::text::Text;

/// The keys that say something to readers, not to the codec.
#[derive(Clone, Copy)]
pub struct Remarks<'a> {
    pub title: &'a Option<Words>,
    pub note: &'a Option<Words>,
    pub section: &'a Option<Words>,
    pub erratum: &'a Names,
}

/// Borrows the remarks of an item as it is written.
macro_rules! remarks {
    ($item:expr) => {
        $crate::resolve::texts::Remarks {
            title: &$item.title,
            note: &$item.note,
            section: &$item.section,
            erratum: &$item.erratum,
        }
    };
}
pub(super) use remarks;

impl Remarks<'_> {
    /// Makes the model's remarks. An item without a section has that of `outer`.
    pub fn doc(&self, path: &Path, outer: Option<&Doc>) -> Doc {
        let inherited = || outer.and_then(|outer| outer.section.clone());
        Doc {
            title: text(self.title.as_ref()),
            note: text(self.note.as_ref()),
            section: text(self.section.as_ref()).or_else(inherited),
            errata: self.erratum.0.iter().map(|name| Text::new(name)).collect(),
            path: path.clone(),
        }
    }
}

/// Reads a text that may be missing.
pub fn text(written: Option<&Words>) -> Option<Text> {
    written.map(|words| Text::new(&words.0))
}

impl Resolver<'_> {
    /// Reads a number.
    pub fn number(&mut self, path: &Path, text: &str) -> Option<Rational> {
        let number = Rational::parse(text);
        if number.is_none() {
            let is_hexadecimal = !text.is_empty() && text.chars().all(|digit| digit.is_ascii_hexdigit());
            let help = if is_hexadecimal {
                format!("a hexadecimal number begins with `0x`: `0x{text}`")
            } else {
                "write `12`, `-40`, `0x1F`, `41.5` or `1/1024`".to_owned()
            };
            self.error_with_help(&rules::NUMBER, path.at_value(), format!("`{text}` is not a number"), help);
        }
        number
    }

    /// Reads a whole number between two limits.
    pub fn integer<N>(&mut self, path: &Path, text: &str, first: N, last: N) -> Option<N>
    where
        N: Copy + Display + Into<i128> + TryFrom<i128>,
    {
        self.integer_or(path, text, (first, last), || format!("write a whole number from {first} to {last}"))
    }

    /// Reads a whole number between two limits, or says what to write instead.
    pub fn integer_or<N>(
        &mut self,
        path: &Path,
        text: &str,
        (first, last): (N, N),
        help: impl Fn() -> String,
    ) -> Option<N>
    where
        N: Copy + Display + Into<i128> + TryFrom<i128>,
    {
        let number = self.number(path, text)?;
        let whole = number.to_integer().filter(|whole| (first.into()..=last.into()).contains(whole));
        let fitting = whole.and_then(|whole| N::try_from(whole).ok());
        if fitting.is_none() {
            let is_whole = number.to_integer().is_some();
            let what =
                if is_whole { format!("lies outside {first}..{last}") } else { "is not a whole number".to_owned() };
            self.error_with_help(&rules::NUMBER, path.at_value(), format!("`{text}` {what}"), help());
        }
        fitting
    }

    /// Reads `minimum..maximum`.
    pub fn range(&mut self, path: &Path, text: &str) -> Option<Range> {
        let Some((minimum, maximum)) = text.split_once("..") else {
            let help = "write both ends with `..` between them, as in `0..100`";
            self.error_with_help(&rules::RANGE, path.at_value(), format!("`{text}` is not a range"), help);
            return None;
        };
        let range = Range { minimum: self.number(path, minimum)?, maximum: self.number(path, maximum)? };
        if range.minimum > range.maximum {
            let help = format!("write `{}..{}`", maximum.trim(), minimum.trim());
            self.error_with_help(
                &rules::RANGE,
                path.at_value(),
                format!("the range `{text}` ends below its start"),
                help,
            );
            return None;
        }
        Some(range)
    }

    /// Reads a range whose numbers may have the unit of their signal: `200..750` or `0.2..0.75 kV`.
    pub fn range_of(&mut self, path: &Path, text: &str, unit: Option<Unit>) -> Option<Range> {
        let Some((ends, symbol)) = text.split_once(' ').filter(|_| unit.is_some()) else {
            return self.range(path, text);
        };
        let Range { minimum, maximum } = self.range(path, ends)?;
        let factor = unit.and_then(|unit| unit_prefixes::exact_factor(symbol, unit));
        let scaled =
            factor.and_then(|factor| Some(Range { minimum: minimum.times(factor)?, maximum: maximum.times(factor)? }));
        if scaled.is_none() {
            let known = unit.map_or_else(String::new, |unit| unit.symbol.to_string());
            let message = format!("the limits `{text}` are not in {known}, the unit of the signal");
            self.error_with_help(&rules::RANGE, path.at_value(), message, format!("write `{ends} {known}`"));
        }
        scaled
    }

    /// Reads `high..low` or one number: bits of a word of `width` bits. Bit 0 is the least
    /// significant.
    pub fn bits(&mut self, path: &Path, text: &str, width: u8) -> Option<(u8, u8)> {
        let (high, low) = self.ends(path, text, "7..4")?;
        let high = self.integer(path, high, 0, width - 1)?;
        let low = self.integer(path, low, 0, width - 1)?;
        if high < low {
            let message = format!("bits run from the most to the least significant, `{text}` runs up");
            self.error_with_help(&rules::PLACE, path.at_value(), message, format!("write `{low}..{high}`"));
            return None;
        }
        Some((high, low))
    }

    /// Reads `first..last` or one number: bytes of the payload, the most significant first.
    pub fn bytes(&mut self, path: &Path, text: &str) -> Option<Place> {
        let (first, last) = self.ends(path, text, "0..3")?;
        Some(Place::bytes(self.integer(path, first, 0, 7)?, self.integer(path, last, 0, 7)?))
    }

    /// Splits a place into its two ends, which are one if it is a number. A range has two, so that an end that is wrong
    /// does not pass for a single place.
    pub fn ends<'t>(&mut self, path: &Path, text: &'t str, form: &str) -> Option<(&'t str, &'t str)> {
        let ends = text.split_once("..").unwrap_or((text, text));
        if ends.0 == ends.1 && ends.0 != text {
            let help = format!("write `{}`, or correct one of the ends", ends.0);
            self.error_with_help(&rules::PLACE, path.at_value(), format!("both ends of `{text}` are the same"), help);
            return None;
        }
        if Rational::parse(ends.0).is_none() || Rational::parse(ends.1).is_none() {
            let parts: Vec<_> = text.trim_matches(['[', ']']).split(['-', ':', ',', '.']).map(str::trim).collect();
            let help = match parts.iter().filter(|part| !part.is_empty()).collect::<Vec<_>>()[..] {
                [first, last] if [first, last].iter().all(|end| Rational::parse(end).is_some()) => {
                    format!("write `{first}..{last}`")
                }
                _ => format!("write `{form}` or one number"),
            };
            self.error_with_help(&rules::PLACE, path.at_value(), format!("`{text}` is not a place"), help);
            return None;
        }
        Some(ends)
    }

    /// Reads a unit of the language.
    pub fn unit(&mut self, path: &Path, symbol: &str) -> Option<Unit> {
        let in_known = |(unit, _): (Unit, Rational)| format!("write the value in {}", unit.symbol);
        self.unit_or(path, symbol, || unit_prefixes::prefixed(symbol).map_or_else(known_units, in_known))
    }

    /// Reads the unit of a field.
    pub fn unit_of_field(&mut self, path: &Path, symbol: &str, field: &Field) -> Option<Unit> {
        self.unit_or(path, symbol, || {
            let otherwise = || format!("{}. Declare another one in `units`", known_units());
            scaled_unit(symbol, field).unwrap_or_else(otherwise)
        })
    }

    fn unit_or(&mut self, path: &Path, symbol: &str, help: impl Fn() -> String) -> Option<Unit> {
        let unit = Unit::find(symbol).or_else(|| self.declared_unit(symbol));
        if unit.is_none() {
            let help = match unit_prefixes::respelled(symbol) {
                Some(unit) => format!("did you mean `{}`?", unit.symbol),
                None => help(),
            };
            self.error_with_help(&rules::UNIT, path.at_value(), format!("there is no unit `{symbol}`"), help);
        }
        unit
    }

    /// Reads a number with an optional unit, such as `20 A`.
    pub fn quantity(&mut self, path: &Path, text: &str) -> Option<Quantity> {
        let (number, unit) = match text.split_once(' ') {
            Some((number, symbol)) => (number, Some(self.unit(path, symbol)?)),
            None => (text, None),
        };
        Some(Quantity { value: self.number(path, number)?, unit })
    }

    /// Finds the name that stands at `path` as a value.
    pub fn lookup<'n>(
        &mut self,
        path: &Path,
        what: &str,
        name: &str,
        names: impl Iterator<Item = &'n str> + Clone,
    ) -> Option<usize> {
        self.find(path.at_value(), what, name, names, None)
    }

    /// Finds the things that a list names, each once.
    pub fn each_named<'n, I: Id + PartialEq>(
        &mut self,
        path: &Path,
        what: &str,
        names: &[String],
        known: &(impl Iterator<Item = &'n str> + Clone),
    ) -> Vec<I> {
        let mut found = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let at = path.index(index);
            let Some(id) = self.lookup(&at, what, name, known.clone()).map(I::new) else { continue };
            if found.contains(&id) {
                let text = format!("the {what} `{name}` is named twice");
                self.error_with_help(&rules::NAME, at.at_value(), text, "take one of the two out");
            } else {
                found.push(id);
            }
        }
        found
    }

    /// Finds the row whose name stands at `path` as a value.
    pub fn lookup_in<I: Id, T>(
        &mut self,
        path: &Path,
        what: &str,
        name: &str,
        table: &Table<I, T>,
        name_of: impl Fn(&T) -> &str + Clone,
    ) -> Option<I> {
        self.find(path.at_value(), what, name, table.iter().map(name_of), None).map(I::new)
    }

    /// Finds the row whose name stands at `path` as a key.
    pub fn lookup_key_in<I: Id, T>(
        &mut self,
        path: &Path,
        what: &str,
        name: &str,
        table: &Table<I, T>,
        name_of: impl Fn(&T) -> &str + Clone,
    ) -> Option<I> {
        self.find(path.at_key(), what, name, table.iter().map(name_of), None).map(I::new)
    }

    /// Finds the name that stands at `path` as a value. `otherwise` says what else can be written.
    pub fn lookup_or<'n>(
        &mut self,
        path: &Path,
        what: &str,
        name: &str,
        names: impl Iterator<Item = &'n str> + Clone,
        otherwise: &str,
    ) -> Option<usize> {
        self.find(path.at_value(), what, name, names, Some(otherwise))
    }

    /// Finds the name that stands at `path` as a key.
    pub fn lookup_key<'n>(
        &mut self,
        path: &Path,
        what: &str,
        name: &str,
        names: impl Iterator<Item = &'n str> + Clone,
    ) -> Option<usize> {
        self.find(path.at_key(), what, name, names, None)
    }

    fn find<'n>(
        &mut self,
        at: At,
        what: &str,
        name: &str,
        names: impl Iterator<Item = &'n str> + Clone,
        otherwise: Option<&str>,
    ) -> Option<usize> {
        let found = names.clone().position(|known| known == name);
        if found.is_none() {
            let offered: Vec<_> = names.collect();
            self.report_name(at, what, name, &offered, otherwise);
        }
        found
    }

    /// Reports a name that does not exist, and names that could be meant.
    pub fn report_name(&mut self, at: At, what: &str, name: &str, offered: &[&str], otherwise: Option<&str>) {
        let help = suggestion(what, name, offered);
        let help = match otherwise {
            None => help,
            Some(otherwise) if offered.is_empty() => format!("{help}; {otherwise}"),
            Some(otherwise) if help.ends_with('?') => format!("{help} otherwise {otherwise}"),
            Some(otherwise) => format!("{help}; otherwise {otherwise}"),
        };
        self.error_with_help(&rules::NAME, at, format!("there is no {what} `{name}`"), help);
    }

    /// Reads a list of `request`, `reply` and `report`.
    pub fn kinds(&mut self, path: &Path, names: &[String]) -> Vec<Kind> {
        let known = || Kind::ALL.into_iter().map(Kind::name);
        let places = names.iter().enumerate();
        places
            .filter_map(|(index, name)| self.lookup(&path.index(index), "kind of frame", name, known()))
            .map(|index| Kind::ALL[index])
            .collect()
    }

    /// Tests that a name can be used unchanged in Rust, in logs and on the command line.
    pub fn check_name(&mut self, path: &Path, name: &str) {
        self.check_name_at(path.at_key(), name);
    }

    /// Tests a name that stands at a place of its own.
    pub fn check_name_at(&mut self, at: At, name: &str) {
        let first = name.starts_with(|letter: char| letter.is_ascii_lowercase());
        let rest = name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_');
        if !(first && rest) || name.ends_with('_') || name.contains("__") {
            let help = "names are lower-case letters, digits and single `_` between them, and start with a letter";
            self.report_form(at, name, help);
        }
    }

    /// Reports a name that does not have the form `form`, and a similar name that does.
    pub fn report_form(&mut self, at: At, name: &str, form: &str) {
        let help = match respelled(name) {
            Some(respelled) => format!("write `{respelled}`: {form}"),
            None => form.to_owned(),
        };
        self.error_with_help(&rules::IDENTIFIER_NAME, at, format!("`{name}` is not a name"), help);
    }
}

/// Writes a name in lower-case letters, digits and single `_`, if anything of it is left.
fn respelled(name: &str) -> Option<String> {
    let words = name.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let respelled = words.collect::<Vec<_>>().join("_").to_ascii_lowercase();
    (name.is_ascii() && respelled.starts_with(|letter: char| letter.is_ascii_lowercase())).then_some(respelled)
}

/// Names the units of the language.
fn known_units() -> String {
    let known: Vec<_> = Unit::ALL.iter().map(|unit| &*unit.symbol).collect();
    format!("the units are {}", known.join(" "))
}

/// Says how a field writes a multiple of a unit with a scale. A float cannot have one.
fn scaled_unit(symbol: &str, field: &Field) -> Option<String> {
    let (unit, factor) =
        unit_prefixes::prefixed(symbol).filter(|_| field.format_of_number.as_deref() != Some("float"))?;
    let step = field.scale.as_deref().map_or(Some(Rational::ONE), Rational::parse)?;
    let scale = step.times(factor)?;
    let scale = scale.fraction();
    Some(format!("write `unit: {}, scale: {scale}`", unit.symbol))
}

/// Names the nearest of the known names, or all of them.
pub fn suggestion(what: &str, name: &str, names: &[&str]) -> String {
    if let Some(nearest) = nearest(name, names.iter().copied()) {
        return format!("did you mean `{nearest}`?");
    }
    let known: Vec<_> = names.iter().map(|known| format!("`{known}`")).collect();
    match known.as_slice() {
        [] => format!("there is no {what} yet"),
        [only] => format!("there is only {only}"),
        _ => format!("there are {}", known.join(", ")),
    }
}
