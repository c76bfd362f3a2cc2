//! A table of the device models.

use std::io::{self, Write};

use canspec_codegen::model::{DeviceModel, Protocol, TypeOfModel};

use super::remarks::{sentences, texts, title, words};
use super::rows::{self, titled};
use super::{heading, meaning};
use crate::show::columns::Row;

/// Writes the table, if there are any. With notes it is complete.
pub fn write(out: &mut impl Write, protocol: &Protocol, with_notes: bool) -> io::Result<()> {
    let rows: Vec<Row> = protocol.models.iter().map(|model| row(model, with_notes)).collect();
    rows::table(out, &["MODEL", "ITEM", "IN PARALLEL", "KBIT/S", "SECTION"], &rows)
}

fn row(model: &DeviceModel, with_notes: bool) -> Row {
    let cells = vec![
        model.name.clone(),
        texts(&model.items),
        model.max_parallel.map_or(String::new(), |count| count.to_string()),
        heading::bit_rates(&model.bit_rates),
        words(model.doc.section.as_ref()),
    ];
    let facts = model.facts.iter().map(|(name, fact)| {
        let unit = fact.unit.map_or(String::new(), |unit| format!(" {}", unit.symbol));
        format!("{} {}{unit}", name.for_people(), fact.value)
    });
    let changes = model.types.iter().map(change).filter(|change| !change.is_empty());
    let below = if with_notes { notes(model) } else { Vec::new() };
    Row { cells, last: titled(title(&model.doc), facts.chain(changes).collect()), separator: ", ", below }
}

/// Says what a model changes of a type.
fn change(own: &TypeOfModel) -> String {
    let TypeOfModel { name, range, default, scale, offset, unit, .. } = own;
    let numbers = [("default", default), ("scale", scale), ("offset", offset)];
    let numbers = numbers.iter().filter_map(|(word, number)| number.map(|number| format!("{word} {number}")));
    let unit = unit.map(|unit| format!("unit {}", unit.symbol));
    let facts: Vec<_> = range.map(meaning::limits).into_iter().chain(numbers).chain(unit).collect();
    if facts.is_empty() { String::new() } else { format!("{name} {}", facts.join(" and ")) }
}

/// Returns the remarks of a model, and those of what it changes.
fn notes(model: &DeviceModel) -> Vec<String> {
    let of_type = |own: &TypeOfModel| {
        let section = own.doc.section.as_ref().filter(|_| own.doc.section != model.doc.section);
        let section = section.map(|section| format!("Section {}", section.for_people()));
        let title = title(&own.doc).map(str::to_owned);
        let facts = title.into_iter().chain(section).chain(sentences(&own.doc));
        facts.map(|fact| format!("{}: {fact}", own.name)).collect::<Vec<_>>()
    };
    sentences(&model.doc).into_iter().chain(model.types.iter().flat_map(of_type)).collect()
}
