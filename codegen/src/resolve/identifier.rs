//! Resolves the identifier's fields, which together fill 11 or 29 bits.

use super::Resolver;
use super::keys::Role;
use super::texts::{self, remarks};
use crate::model::{Doc, Identifier, IdentifierField, Table};
use crate::read::syntax::ast::{Field, IdentifierEntry, Key};
use crate::report::claims::{Claim, misplaced};
use crate::report::diagnostic::{At, Diagnostic};
use crate::report::tree::Path;
use crate::resolve::rules;

/// The widest identifier.
const EXTENDED: u8 = 29;
/// The other width.
const STANDARD: u8 = 11;

/// A run of identifier bits and the entry that takes it.
struct Run {
    high: u8,
    low: u8,
    place: Path,
}

impl Run {
    fn claim(&self) -> Claim {
        Claim { first: self.low, last: self.high }
    }

    /// Tests whether its width is no power of two.
    fn is_odd(&self) -> bool {
        !(self.high - self.low + 1).is_power_of_two()
    }
}

impl Resolver<'_> {
    pub fn identifier(&mut self) -> Option<Identifier> {
        let root = Path::default().key("identifier");
        let spec = self.spec;
        let mut identifier = Identifier { extended: false, fields: Table::default(), mask: 0, value: 0 };
        let entries = spec.identifier.iter();
        let runs: Vec<_> =
            entries.map(|(name, entry)| self.entry(&root.key(name), name, entry, &mut identifier)).collect();
        let runs: Vec<_> = runs.into_iter().collect::<Option<_>>()?;
        identifier.fields.sort_by_key(|field| std::cmp::Reverse(field.shift));
        identifier.extended = self.check_layout(&root, &runs);
        Some(identifier)
    }

    /// Adds an entry to the identifier.
    fn entry(&mut self, path: &Path, name: &str, entry: &IdentifierEntry, identifier: &mut Identifier) -> Option<Run> {
        match entry {
            IdentifierEntry::Place(text) => {
                let ones = self.are_ones(path, name);
                let (high, low) = self.bits(path, text, EXTENDED)?;
                identifier.mask |= bits_mask(high, low);
                identifier.value |= if ones? { bits_mask(high, low) } else { 0 };
                Some(Run { high, low, place: path.clone() })
            }
            IdentifierEntry::Field(field) => {
                let (field, run) = self.identifier_field(path, name, field)?;
                if let Some(constant) = field.constant {
                    identifier.mask |= field.mask();
                    identifier.value |= constant << field.shift;
                }
                identifier.fields.push(field);
                Some(run)
            }
        }
    }

    /// Tells `ones` from `zeros`.
    fn are_ones(&mut self, path: &Path, name: &str) -> Option<bool> {
        self.lookup(path, "fill", name, ["ones", "zeros"].into_iter()).map(|index| index == 0)
    }

    fn identifier_field(&mut self, path: &Path, name: &str, field: &Field) -> Option<(IdentifierField, Run)> {
        self.check_name(path, name);
        let merged = self.merged(path, field)?;
        self.check_keys(&merged, Role::of_identifier(&merged.field));
        let Some(text) = &merged.field.bits else {
            let help = "say which bits, for instance `bits: 28..26`";
            self.error_with_help(&rules::PLACE, path.at_key(), format!("the field `{name}` has no place"), help);
            return None;
        };
        let (high, low) = self.bits(&path.key("bits"), text, EXTENDED)?;
        let width = high - low + 1;
        let greatest = u32::MAX >> (32 - width);
        let mut number = |key: Key, text: &Option<String>| {
            text.as_ref().and_then(|text| self.integer(&merged.path(self.diagnostics, key), text, 0, greatest))
        };
        let constant = number(Key::Const, &merged.field.constant);
        let send = number(Key::Send, &merged.field.send);
        let normal = number(Key::Normal, &merged.field.normal);
        let starting = number(Key::Starting, &merged.field.starting);
        let continues = number(Key::Continues, &merged.field.continues);
        let doc = Doc { title: texts::text(merged.field.title.as_ref()), ..remarks!(field).doc(path, None) };
        let enumeration = self.enumeration(&merged, &format!("{name}_code"), width, &doc);
        let run = Run { high, low, place: path.key("bits") };
        let name = name.to_owned();
        let field =
            IdentifierField { name, doc, shift: low, width, constant, send, normal, starting, continues, enumeration };
        Some((field, run))
    }

    /// Tests that the entries leave no gap and share no bit. Returns whether the identifier is the
    /// widest one.
    fn check_layout(&mut self, root: &Path, runs: &[Run]) -> bool {
        let top = runs.iter().map(|run| run.high).max().unwrap_or_default();
        let width = if top < STANDARD { STANDARD } else { EXTENDED };
        if !self.check_shared(runs, width) {
            self.check_gaps(root, runs, width);
        }
        width == EXTENDED
    }

    /// Reports the first bits that two entries share. Returns whether there are any.
    fn check_shared(&mut self, runs: &[Run], width: u8) -> bool {
        let shares = |one: &Run, other: &Run| one.low <= other.high && other.low <= one.high;
        let earlier = |later: usize| runs[..later].iter().position(|run| shares(run, &runs[later]));
        let Some((earlier, later)) = (0..runs.len()).find_map(|later| Some((earlier(later)?, later))) else {
            return false;
        };
        // The first entry cannot have been meant for bits above the identifier.
        let above = Claim { first: width, last: width };
        let claims: Vec<_> = std::iter::once(above).chain(runs.iter().map(Run::claim)).collect();
        let wrong = misplaced(&claims, earlier + 1, later + 1) - 1;
        let right = if wrong == later { earlier } else { later };
        let (one, other) = (&runs[wrong], &runs[right]);
        let message =
            format!("{} in two fields of the identifier", named_bits(one.high.min(other.high), one.low.max(other.low)));
        self.report_layout(one.place.at_value(), message, Some((other, "the other field")));
        true
    }

    /// Reports the first bits that no entry takes, from the least significant on.
    fn check_gaps(&mut self, root: &Path, runs: &[Run], width: u8) {
        let mut runs: Vec<_> = runs.iter().collect();
        runs.sort_by_key(|run| run.low);
        let mut below: Option<&Run> = None;
        for run in runs {
            let next = below.map_or(0, |below| below.high + 1);
            if run.low != next {
                let message = format!("{} in no field of the identifier", named_bits(run.low - 1, next));
                return match below {
                    Some(below) if below.is_odd() && !run.is_odd() => {
                        self.report_layout(below.place.at_value(), message, Some((run, "the bits above")));
                    }
                    _ => {
                        let below = below.map(|below| (below, "the bits below"));
                        self.report_layout(run.place.at_value(), message, below);
                    }
                };
            }
            below = Some(run);
        }
        let at = below.map_or(root.at_key(), |top| top.place.at_value());
        let next = below.map_or(0, |top| top.high + 1);
        if next != width {
            let message = format!("the identifier's fields take {next} bits, and an identifier has 11 or 29");
            self.report_layout(at, message, None);
        }
    }

    fn report_layout(&mut self, at: At, message: String, other: Option<(&Run, &str)>) {
        let help = "give every bit to one field, to `ones` or to `zeros`";
        let diagnostic = Diagnostic::error(&rules::IDENTIFIER_LAYOUT, at, message).help(help);
        self.diagnostics.push(match other {
            Some((run, text)) => diagnostic.other(run.place.at_value(), text),
            None => diagnostic,
        });
    }
}

fn named_bits(high: u8, low: u8) -> String {
    if high == low { format!("bit {low} is") } else { format!("bits {high}..{low} are") }
}

/// Returns the bits from `high` down to `low`.
fn bits_mask(high: u8, low: u8) -> u32 {
    (u32::MAX >> (31 - (high - low))) << low
}
