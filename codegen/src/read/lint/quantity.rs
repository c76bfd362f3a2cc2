#![doc = include_str!("../../../docs/rules/quantity.md")]

mod phrase;

use super::Written;
use super::table::Table;
use crate::model::Unit;
use crate::report::diagnostic::Diagnostic;
use crate::report::rule::rules;
use crate::report::tree::{Node, Path};
use phrase::{Reading, read};

rules! {
    QUANTITY "quantity" Lint WARNING;
}

/// The unit of a share of any quantity.
const PERCENT: &str = "%";

/// Something with a unit.
struct Measured<'a> {
    name: &'a str,
    title: Option<&'a str>,
    unit: &'a str,
    /// The text with the unit.
    path: Path,
}

pub fn lint(written: &Written) -> Vec<Diagnostic> {
    let definitions = written.tables.iter().filter(|table| table.is_definition());
    definitions.flat_map(measured).filter_map(|measured| contradiction(&measured)).collect()
}

/// Finds the entries of a map that have a unit of the language.
fn measured<'a>(table: &Table<'a>) -> impl Iterator<Item = Measured<'a>> {
    let found = table.entries.iter().filter_map(|(name, entry)| {
        let path = table.path.key(name);
        match table.kind {
            "facts" => fact(name, entry.value.text()?, path),
            "messages" => field(name, entry.value.child_at("value")?, &path.key("value"))
                .map(|value| Measured { title: value.title.or_else(|| entry.value.text_at("title")), ..value }),
            _ => field(name, &entry.value, &path),
        }
    });
    found.filter(|measured| Unit::find(measured.unit).is_some())
}

fn field<'a>(name: &'a str, field: &'a Node, path: &Path) -> Option<Measured<'a>> {
    Some(Measured { name, title: field.text_at("title"), unit: field.text_at("unit")?, path: path.key("unit") })
}

fn fact<'a>(name: &'a str, text: &'a str, path: Path) -> Option<Measured<'a>> {
    let (_, unit) = text.rsplit_once(' ')?;
    Some(Measured { name, title: None, unit, path })
}

/// Finds a unit that contradicts the name, or the title if the name says no quantity.
fn contradiction(measured: &Measured) -> Option<Diagnostic> {
    let Measured { name, title, unit, path } = measured;
    let (quantity, source) = match (read(name), title.map_or(Reading::Unknown, read)) {
        (Reading::Of(quantity), Reading::Of(other)) if other != quantity => return None,
        (Reading::Of(quantity), _) => (quantity, "name"),
        (Reading::Unknown, Reading::Of(quantity)) => (quantity, "title"),
        _ => return None,
    };
    if *unit == PERCENT || quantity.units.contains(unit) {
        return None;
    }
    let text = format!("`{name}` is in `{unit}`, but its {source} says {}", quantity.name);
    let units = quantity.units.join("`, `");
    let help = format!("{} is in `{units}`: correct the unit, or the name and the title", quantity.name);
    Some(Diagnostic::warning(&QUANTITY, path.at_value(), text).help(help))
}
