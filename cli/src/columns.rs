//! Plain text in aligned columns. The last column is wrapped.

use std::io::{self, Write};

/// The width that lines keep to, if the left columns leave room.
const WIDTH: usize = 140;
/// The last column is never narrower.
const NARROWEST: usize = 40;
/// A column is never wider for a cell, which then moves the rest of its own row alone.
const WIDEST: usize = 80;
const GAP: &str = "  ";

/// What fills up the widest cell, and the gap behind it.
const BLANKS: &str = match str::from_utf8(&[b' '; WIDEST + GAP.len()]) {
    Ok(blanks) => blanks,
    Err(_) => "",
};

/// The columns of a table.
#[derive(Clone)]
pub struct Columns {
    /// The widths of all columns but the last.
    widths: Vec<usize>,
    /// The row that is being written.
    row: String,
}

impl Columns {
    /// Makes columns as wide as their headings.
    pub fn new(headings: &[&str]) -> Self {
        let mut columns = Self { widths: vec![0; headings.len()], row: String::new() };
        columns.widen(headings);
        columns
    }

    /// Makes room for these cells.
    pub fn widen(&mut self, cells: &[&str]) {
        for (column, cell) in self.widths.iter_mut().zip(cells) {
            // There are at least as many bytes as characters.
            if cell.len() > *column {
                *column = (*column).max(width(cell)).min(WIDEST);
            }
        }
    }

    /// Tests whether all columns have the same widths.
    pub fn is_like(&self, other: &Self) -> bool {
        self.widths == other.widths
    }

    /// Returns the width of the last column.
    pub fn room(&self) -> usize {
        let left: usize = self.widths.iter().map(|width| width + GAP.len()).sum();
        WIDTH.saturating_sub(left).max(NARROWEST)
    }

    /// Writes cells, and beside and below them the lines of the last column.
    ///
    /// # Errors
    ///
    /// Where `out` cannot be written.
    pub fn write(&mut self, out: &mut impl Write, cells: &[&str], last: &Lines) -> io::Result<()> {
        let (mut cells, mut rest) = (cells, last.text.as_str());
        while let Some(end) = memchr::memchr(b'\n', rest.as_bytes()) {
            self.line(out, cells, &rest[..end])?;
            (cells, rest) = (&[], &rest[end + 1..]);
        }
        self.line(out, cells, rest)
    }

    fn line(&mut self, out: &mut impl Write, cells: &[&str], last: &str) -> io::Result<()> {
        let Self { widths, row } = self;
        row.clear();
        let blanks = std::iter::repeat("");
        for (column, cell) in widths.iter().zip(cells.iter().copied().chain(blanks)) {
            row.push_str(cell);
            row.push_str(&BLANKS[..column.saturating_sub(width(cell)) + GAP.len()]);
        }
        row.push_str(last);
        row.truncate(row.trim_end().len());
        row.push('\n');
        out.write_all(row.as_bytes())
    }
}

/// Returns the number of characters of a text.
fn width(text: &str) -> usize {
    if text.is_ascii() { text.len() } else { text.chars().count() }
}

/// Items in lines of the last column.
#[derive(Clone, Default)]
pub struct Lines {
    /// The lines, with a line feed between them.
    text: String,
    /// The width of the last line, unless the next item begins a new one.
    width: Option<usize>,
}

impl Lines {
    /// Takes all lines away.
    pub fn clear(&mut self) {
        self.text.clear();
        self.width = None;
    }

    /// Adds an item to the last line, or a new line if it would become wider than `room`.
    pub fn add(&mut self, item: &str, separator: &str, room: usize) {
        let length = width(item);
        let joined = self.width.map(|line| line + width(separator) + length);
        if let Some(joined) = joined.filter(|joined| *joined <= room) {
            self.text.push_str(separator);
            self.width = Some(joined);
        } else {
            if self.width.is_some() {
                self.text.push_str(separator.trim_end());
            }
            if self.width.is_some() || !self.text.is_empty() {
                self.text.push('\n');
            }
            self.width = Some(length);
        }
        self.text.push_str(item);
    }

    /// Adds the words of a sentence, which begins a line.
    pub fn add_sentence(&mut self, text: &str, room: usize) {
        self.width = None;
        text.split(' ').for_each(|word| self.add(word, " ", room));
    }
}

/// Joins items with a separator into lines of at most `room` characters, unless an item alone is longer.
pub fn wrap<S: AsRef<str>>(items: impl IntoIterator<Item = S>, separator: &str, room: usize) -> Lines {
    let mut lines = Lines::default();
    items.into_iter().for_each(|item| lines.add(item.as_ref(), separator, room));
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
    columns.write(out, headings, &wrap([last], "", 0))?;
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
        assert_eq!(wrap(["aa", "bb", "cc"], ", ", 6).text, "aa, bb,\ncc");
        assert_eq!(wrap(["°C°C", "m"], "  ", 7).text, "°C°C  m");
        assert_eq!(wrap(["too long", "m"], " ", 3).text, "too long\nm");
    }

    #[test]
    fn a_sentence_begins_a_line_of_its_own() {
        let mut lines = wrap(["a", "b"], " ", 9);
        lines.add_sentence("c d", 9);
        assert_eq!(lines.text, "a b\nc d");
        lines.clear();
        lines.add_sentence("c d e", 3);
        assert_eq!(lines.text, "c d\ne");
    }
}
