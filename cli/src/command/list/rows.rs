//! Rows and tables of items with remarks.

use std::io::{self, Write};

use canspec_codegen::model::Doc;

use super::remarks::{sentences, title};
use crate::show::columns::{self, Row};

/// Writes a table with a blank line above it, if it has rows.
pub fn table(out: &mut impl Write, headings: &[&str], rows: &[Row]) -> io::Result<()> {
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out)?;
    columns::write(out, headings, "MEANING", rows)
}

/// Returns the row of an item: title and facts, and its remarks below them.
pub fn row(cells: Vec<String>, doc: &Doc, facts: Vec<String>) -> Row {
    Row { cells, last: titled(title(doc), facts), separator: ", ", below: sentences(doc) }
}

/// Writes a title before the first item.
pub fn titled(title: Option<&str>, mut items: Vec<String>) -> Vec<String> {
    match (title, items.first_mut()) {
        (Some(title), Some(first)) => *first = format!("{title}: {first}"),
        (Some(title), None) => items.push(title.to_owned()),
        (None, _) => {}
    }
    items
}
