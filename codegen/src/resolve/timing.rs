//! Resolves times: how long they are, and what they are for.

use super::Resolver;
use super::texts::remarks;
use crate::model::{Quantity, Table, TimeRole, Timing, TimingId, Unit, nanoseconds};
use crate::read::syntax::ast;
use crate::report::diagnostic::Diagnostic;
use crate::report::tree::Path;
use crate::resolve::rules;
use crate::words::number::Rational;

/// The most nanoseconds of a time, as Rust counts them.
const LONGEST: i128 = u64::MAX as i128;

impl Resolver<'_> {
    pub fn timing(&mut self) -> Table<TimingId, Timing> {
        let root = Path::default().key("timing");
        let entries = self.spec.timing.iter();
        entries.filter_map(|(name, timing)| self.one_timing(&root.key(name), name, timing)).collect()
    }

    fn one_timing(&mut self, path: &Path, name: &str, timing: &ast::Timing) -> Option<Timing> {
        self.check_name(path, name);
        self.check_not_empty(path, &["messages"]);
        let role = timing.role.as_ref().and_then(|word| self.time_role(&path.key("role"), word));
        let tries = timing.tries.as_ref().and_then(|text| self.integer(&path.key("tries"), text, 1, u8::MAX));
        let known = self.spec.messages.keys().map(String::as_str);
        let messages = self.each_named(&path.key("messages"), "message", &timing.messages, &known);
        self.check_belongs(path, timing, role);
        let at = path.key("time");
        let Some((numbers, symbol)) = timing.time.split_once(' ') else {
            let message = format!("the time `{}` has no unit", timing.time);
            self.error_with_help(&rules::UNIT, at.at_value(), message, "write `10 s` or `50..200 ms`");
            return None;
        };
        let unit = self.time_unit(&at, symbol)?;
        let ends = if numbers.contains("..") { numbers.to_owned() } else { format!("{numbers}..{numbers}") };
        let range = self.range(&at, &ends)?;
        self.check_time(&at, range.minimum, unit)?;
        self.check_time(&at, range.maximum, unit)?;
        let minimum = timing.minimum.as_ref().and_then(|text| self.minimum(&path.key("minimum"), text));
        let (name, doc) = (name.to_owned(), remarks!(timing).doc(path, None));
        Some(Timing { name, doc, range, unit, minimum, role, tries, messages })
    }

    fn time_role(&mut self, path: &Path, word: &str) -> Option<TimeRole> {
        let known = TimeRole::ALL.into_iter();
        self.lookup(path, "role of a time", word, known.map(TimeRole::name)).map(|index| TimeRole::ALL[index])
    }

    /// Refuses keys that mean nothing without a role, or beside another one.
    fn check_belongs(&mut self, path: &Path, timing: &ast::Timing, role: Option<TimeRole>) {
        let is_about_all = timing.role.is_none() || role == Some(TimeRole::Boot);
        let is_no_wait = timing.role.is_none() || role.is_some_and(|role| role != TimeRole::ReplyTimeout);
        let misplaced = [
            ("messages", is_about_all && !timing.messages.is_empty(), "a time without a role, or from power-on"),
            ("tries", is_no_wait && timing.tries.is_some(), "a time without `role: reply_timeout`"),
        ];
        for (key, _, what) in misplaced.into_iter().filter(|(_, is_misplaced, _)| *is_misplaced) {
            let text = format!("`{key}` means nothing for {what}");
            let help = "take it out, or write the `role` of the time";
            self.error_with_help(&rules::MISPLACED_KEY, path.key(key).at_key(), text, help);
        }
    }

    /// Reads a unit of time.
    fn time_unit(&mut self, path: &Path, symbol: &str) -> Option<Unit> {
        let unit = self.unit(path, symbol)?;
        if matches!(&*unit.symbol, "s" | "ms" | "min" | "h") {
            return Some(unit);
        }
        let message = format!("`{symbol}` is not a unit of time");
        self.error_with_help(&rules::UNIT, path.at_value(), message, "the units of time are s ms min h");
        None
    }

    /// Reads the shortest time.
    fn minimum(&mut self, path: &Path, text: &str) -> Option<Quantity> {
        let quantity = self.quantity(path, text)?;
        let unit = self.time_unit(path, &quantity.unit.map_or_else(String::new, |unit| unit.symbol.to_string()))?;
        self.check_time(path, quantity.value, unit)?;
        Some(quantity)
    }

    /// Refuses a time that lies in the past, or that is longer than Rust can count.
    fn check_time(&mut self, path: &Path, value: Rational, unit: Unit) -> Option<()> {
        let time = nanoseconds(value, unit).filter(|time| (0..=LONGEST).contains(&time.floor()));
        if time.is_none() {
            let text = format!("`{value} {}` is no time from 0 to 584 years", unit.symbol);
            self.diagnostics.push(Diagnostic::error(&rules::NUMBER, path.at_value(), text));
        }
        time.map(|_| ())
    }
}
