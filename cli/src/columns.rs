//! Plain text in aligned columns. The last column is wrapped.

use std::io::{self, Write};

/// The width that lines keep to, if the left columns leave room.
const WIDTH: usize = 140;
/// The last column is never narrower.
const NARROWEST: usize = 40;
/// A column is never wider for a cell, which then moves the rest of its own row alone.
const WIDEST: usize = 80;
const GAP: &str = "  ";

/// The widths of all columns but the last.
pub struct Columns(Vec<usize>);

impl Columns {
    /// Makes columns as wide as their headings.
    pub fn new(headings: &[&str]) -> Self {
        let mut columns = Self(vec![0; headings.len()]);
        columns.widen(headings);
        columns
    }

    /// Makes room for these cells.
    pub fn widen(&mut self, cells: &[&str]) {
        for (width, cell) in self.0.iter_mut().zip(cells) {
            *width = (*width).max(cell.chars().count()).min(WIDEST);
        }
    }

    /// Returns the width of the last column.
    pub fn room(&self) -> usize {
        let left: usize = self.0.iter().map(|width| width + GAP.len()).sum();
        WIDTH.saturating_sub(left).max(NARROWEST)
    }

    /// Writes cells, and beside and below them the lines of the last column.
    ///
    /// # Errors
    ///
    /// Where `out` cannot be written.
    pub fn write(&mut self, out: &mut impl Write, cells: &[&str], last: &[String]) -> io::Result<()> {
        self.widen(cells);
        self.line(out, cells, last.first().map_or("", String::as_str))?;
        last.iter().skip(1).try_for_each(|line| self.line(out, &[], line))
    }

    fn line(&self, out: &mut impl Write, cells: &[&str], last: &str) -> io::Result<()> {
        let mut line = String::new();
        let blanks = std::iter::repeat("");
        for (width, cell) in self.0.iter().zip(cells.iter().copied().chain(blanks)) {
            let blank = width.saturating_sub(cell.chars().count());
            line.extend([cell, &" ".repeat(blank), GAP]);
        }
        line.push_str(last);
        writeln!(out, "{}", line.trim_end())
    }
}

/// Joins items with a separator into lines of at most `width` characters, unless an item alone is longer.
pub fn wrap<S: AsRef<str>>(items: impl IntoIterator<Item = S>, separator: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let length = |text: &str| text.chars().count();
    for item in items {
        let item = item.as_ref();
        match lines.last_mut() {
            Some(line) if length(line) + length(separator) + length(item) <= width => line.extend([separator, item]),
            Some(line) => {
                line.push_str(separator.trim_end());
                lines.push(item.to_owned());
            }
            None => lines.push(item.to_owned()),
        }
    }
    lines
}

/// Writes rows of cells, the last cell of each in lines, under their headings.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn write(out: &mut impl Write, headings: &[&str], last: &str, rows: &[Row]) -> io::Result<()> {
    let mut columns = Columns::new(headings);
    for row in rows {
        columns.widen(&row.cells());
    }
    columns.write(out, headings, &[last.to_owned()])?;
    let room = columns.room();
    rows.iter().try_for_each(|row| columns.write(out, &row.cells(), &wrap(&row.last, row.separator, room)))
}

/// A row of a table that is known as a whole.
pub struct Row {
    pub cells: Vec<String>,
    /// What the last column shows.
    pub last: Vec<String>,
    /// What stands between the items of the last column.
    pub separator: &'static str,
}

impl Row {
    fn cells(&self) -> Vec<&str> {
        self.cells.iter().map(String::as_str).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(rows: &[Row]) -> String {
        let mut out = Vec::new();
        write(&mut out, &["A", "NAME"], "REST", rows).expect("a vector takes everything");
        String::from_utf8(out).expect("columns are text")
    }

    fn row(cells: [&str; 2], last: &[&str]) -> Row {
        let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
        Row { cells: owned(&cells), last: owned(last), separator: " " }
    }

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let text = written(&[row(["1", "x"], &["a", "b"]), row(["22", "longer"], &[])]);
        assert_eq!(text, "A   NAME    REST\n1   x       a b\n22  longer\n");
    }

    #[test]
    fn a_cell_that_is_too_wide_moves_its_own_row_alone() {
        let wide = "w".repeat(WIDEST + 9);
        let text = written(&[row([&wide, "x"], &["a"]), row(["1", "x"], &["a"])]);
        let blank = " ".repeat(WIDEST - 1);
        assert_eq!(text, format!("A{blank}  NAME  REST\n{wide}  x     a\n1{blank}  x     a\n"));
    }

    #[test]
    fn the_last_column_is_wrapped_below_itself() {
        let word = "w".repeat(70);
        let text = written(&[row(["1", "x"], &[&word, &word])]);
        assert_eq!(text, format!("A  NAME  REST\n1  x     {word}\n         {word}\n"));
    }

    #[test]
    fn items_share_a_line_as_long_as_they_fit() {
        assert_eq!(wrap(["aa", "bb", "cc"], ", ", 6), ["aa, bb,", "cc"]);
        assert_eq!(wrap(["°C°C", "m"], "  ", 7), ["°C°C  m"]);
        assert_eq!(wrap(["too long", "m"], " ", 3), ["too long", "m"]);
    }
}
