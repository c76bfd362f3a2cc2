//! The identifier's fields, which together fill 11 or 29 bits.

use super::Resolver;
use super::keys::Role;
use super::texts::remarks;
use crate::diagnostic::Diagnostic;
use crate::model::{Identifier, IdentifierField};
use crate::syntax::ast::{Field, IdentifierEntry};
use crate::syntax::tree::Path;

/// The widest identifier.
const EXTENDED: u8 = 29;
/// The other one.
const STANDARD: u8 = 11;

/// A run of identifier bits and the entry that takes it.
struct Run {
    high: u8,
    low: u8,
    path: Path,
}

impl Resolver<'_> {
    pub fn identifier(&mut self) -> Option<Identifier> {
        let root = Path::default().key("identifier");
        let spec = self.spec;
        let mut identifier = Identifier { extended: false, fields: Vec::new(), mask: 0, value: 0 };
        let entries = spec.identifier.iter();
        let runs: Vec<_> =
            entries.map(|(name, entry)| self.entry(&root.key(name), name, entry, &mut identifier)).collect();
        let runs: Vec<_> = runs.into_iter().collect::<Option<_>>()?;
        identifier.fields.sort_by_key(|field| std::cmp::Reverse(field.shift));
        identifier.extended = self.check_layout(&root, runs);
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
                Some(Run { high, low, path: path.clone() })
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
        self.check_keys(&merged, Role::IDENTIFIER);
        let Some(text) = &merged.field.bits else {
            let help = "say which bits, for instance `bits: 28..26`";
            self.error_with_help("place", path.at_key(), format!("the field `{name}` has no place"), help);
            return None;
        };
        let (high, low) = self.bits(&path.key("bits"), text, EXTENDED)?;
        let width = high - low + 1;
        let greatest = u32::MAX >> (32 - width);
        let mut number = |key: &str, text: &Option<String>| {
            text.as_ref().and_then(|text| self.integer(&merged.path(self.diagnostics, key), text, 0, greatest))
        };
        let constant = number("const", &merged.field.constant);
        let send = number("send", &merged.field.send);
        let normal = number("normal", &merged.field.normal);
        let continues = number("continues", &merged.field.continues);
        let doc = remarks!(field).doc(path, None);
        let enumeration = self.enumeration(&merged, &format!("{name}_code"), width, &doc);
        let run = Run { high, low, path: path.clone() };
        let name = name.to_owned();
        Some((IdentifierField { name, doc, shift: low, width, constant, send, normal, continues, enumeration }, run))
    }

    /// Tests that the entries leave no gap and share no bit; tells whether the identifier is the widest one.
    fn check_layout(&mut self, root: &Path, mut runs: Vec<Run>) -> bool {
        runs.sort_by_key(|run| run.low);
        let mut next = 0;
        for (index, run) in runs.iter().enumerate() {
            if run.low != next {
                self.report_layout(run, index.checked_sub(1).map(|below| &runs[below]), next);
                return run.high >= STANDARD;
            }
            next = run.high + 1;
        }
        if next != STANDARD && next != EXTENDED {
            let message = format!("the identifier's fields take {next} bits");
            self.error_with_help("identifier_layout", root.at_key(), message, "an identifier has 11 or 29 bits");
        }
        next == EXTENDED
    }

    /// Reports a run that does not start at bit `next`, where the one below it ends.
    fn report_layout(&mut self, run: &Run, below: Option<&Run>, next: u8) {
        let gap = run.low > next;
        let (high, low) = if gap { (run.low - 1, next) } else { (run.high.min(next - 1), run.low) };
        let bits = if high == low { format!("bit {low} is") } else { format!("bits {high}..{low} are") };
        let what = if gap { "in no field" } else { "in two fields" };
        let message = format!("{bits} {what} of the identifier");
        let diagnostic = Diagnostic::error("identifier_layout", run.path.key("bits").at_value(), message);
        let diagnostic = diagnostic.help("give every bit to one field, to `ones` or to `zeros`");
        self.diagnostics.push(match below {
            Some(below) => diagnostic.other(below.path.key("bits").at_value(), "the bits below"),
            None => diagnostic,
        });
    }
}

/// Returns the bits from `high` down to `low`.
fn bits_mask(high: u8, low: u8) -> u32 {
    (u32::MAX >> (31 - (high - low))) << low
}
