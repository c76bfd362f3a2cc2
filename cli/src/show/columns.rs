//! Plain text in aligned columns. The last column is wrapped.

use std::io::{self, Write};

use crate::output;

/// The width that lines keep to where they are not shown on a terminal, if the left columns leave room.
const WIDTH: usize = 140;
/// The last column is never narrower.
const NARROWEST: usize = 40;
/// Where the last column begins if a terminal has no room for it beside the others.
const INDENT: usize = 4;
/// A column is never wider for a cell, which then moves the rest of its own row alone.
const WIDEST: usize = 80;
const GAP: &str = "  ";

/// The columns of a table.
#[derive(Clone)]
pub struct Columns {
    /// The widths of all columns but the last.
    widths: Vec<usize>,
    /// The width of a whole line.
    line: usize,
}

impl Columns {
    /// Makes columns as wide as their headings.
    pub fn new(headings: &[&str]) -> Self {
        let mut columns = Self { widths: vec![0; headings.len()], line: WIDTH };
        columns.widen(headings);
        columns
    }

    /// Keeps to the width of a terminal, if there is one.
    #[must_use]
    pub fn within(self, terminal: Option<usize>) -> Self {
        Self { line: terminal.unwrap_or(self.line), ..self }
    }

    /// Makes room for these cells.
    pub fn widen(&mut self, cells: &[&str]) {
        for (column, cell) in self.widths.iter_mut().zip(cells) {
            // There are at least as many bytes as characters.
            if cell.len() > *column {
                *column = (*column).max(width(cell.as_bytes())).min(WIDEST);
            }
        }
    }

    /// Tests whether all columns have the same widths.
    pub fn is_like(&self, other: &Self) -> bool {
        self.widths == other.widths
    }

    /// Begins a row behind a text, with its cells, and makes room for them. What is added to it stands in the last
    /// column.
    pub fn row<'a>(&mut self, text: &'a mut Vec<u8>, cells: &[&str]) -> Lines<'a> {
        let line = text.len();
        self.fill(text, 0, cells);
        self.lines(text, line)
    }

    /// Adds cells from a column on, and makes room for them.
    pub fn fill(&mut self, text: &mut Vec<u8>, first: usize, cells: &[impl AsRef<str>]) {
        let mut place = text.len();
        let columns = &mut self.widths[first..];
        // To write into blanks costs less than to add cells and blanks by turns.
        let cells = || cells.iter().map(AsRef::as_ref);
        let room = |(column, cell): (&usize, &str)| column + cell.len() + GAP.len();
        text.resize(place + columns.iter().zip(cells()).map(room).sum::<usize>(), b' ');
        for (column, cell) in columns.iter_mut().zip(cells()) {
            let width = width(cell.as_bytes());
            *column = (*column).max(width.min(WIDEST));
            text[place..place + cell.len()].copy_from_slice(cell.as_bytes());
            place += cell.len() + column.saturating_sub(width) + GAP.len();
        }
        text.truncate(place);
    }

    /// Begins the last column of a row whose cells are filled. `line` is where it begins in the text.
    pub fn lines<'a>(&self, text: &'a mut Vec<u8>, line: usize) -> Lines<'a> {
        let beside = self.left();
        let is_beside = beside + NARROWEST <= self.line || self.line >= WIDTH;
        let (left, first) = if is_beside { (beside, Some(text.len())) } else { (INDENT, None) };
        Lines { left, room: self.line.saturating_sub(left).max(NARROWEST), line, first, width: None, text }
    }

    /// Returns the widths of all columns but the last.
    pub fn widths(&self) -> &[usize] {
        &self.widths
    }

    /// Returns the width of the columns before the last one.
    fn left(&self) -> usize {
        self.widths.iter().map(|width| width + GAP.len()).sum()
    }
}

/// Returns the number of characters of a text.
fn width(text: &[u8]) -> usize {
    let begins = |byte: &&u8| **byte & 0xC0 != 0x80;
    if text.is_ascii() { text.len() } else { text.iter().filter(begins).count() }
}

/// A row whose last column is filled item by item.
pub struct Lines<'a> {
    text: &'a mut Vec<u8>,
    /// The width of the columns before the last one.
    left: usize,
    /// The width of the last column.
    room: usize,
    /// Where the last line begins in the text.
    line: usize,
    /// Where the last column begins in the text, if it stands beside the others.
    first: Option<usize>,
    /// The width of the last line in that column, unless the next item begins a new one.
    width: Option<usize>,
}

impl Lines<'_> {
    /// Adds an item to the last line, or a new line if it would become wider than the column.
    pub fn add(&mut self, item: &str, separator: &str) {
        if let Some(line) = &mut self.width {
            *line += width(separator.as_bytes());
            self.text.extend_from_slice(separator.as_bytes());
        }
        self.place(self.room, |text| text.extend_from_slice(item.as_bytes()));
    }

    /// Adds the words of a sentence, which begins a line.
    pub fn add_sentence(&mut self, text: &str) {
        self.width = None;
        text.split(' ').for_each(|word| self.add(word, " "));
    }

    /// Adds an item that `write` writes and ends with a blank. Only that may stand beyond the column.
    pub fn add_by(&mut self, write: impl FnOnce(&mut Vec<u8>)) {
        self.place(self.room + 1, write);
    }

    fn place(&mut self, room: usize, write: impl FnOnce(&mut Vec<u8>)) {
        let start = self.text.len();
        write(self.text);
        let item = width(&self.text[start..]);
        match self.width {
            Some(line) if line + item <= room => self.width = Some(line + item),
            None if Some(start) == self.first => self.width = Some(item),
            _ => self.begin_line(start, item),
        }
    }

    /// Begins a line with the last item.
    fn begin_line(&mut self, start: usize, width: usize) {
        let item = self.text.split_off(start);
        self.end_line();
        self.text.resize(self.text.len() + self.left, b' ');
        self.text.extend_from_slice(&item);
        self.width = Some(width);
    }

    /// Ends the last line, without the blanks at its end.
    fn end_line(&mut self) {
        let length = self.text[self.line..].trim_ascii_end().len();
        self.text.truncate(self.line + length);
        self.text.push(b'\n');
        self.line = self.text.len();
    }

    /// Ends the row.
    pub fn end(mut self) {
        self.end_line();
    }
}

/// Writes rows of cells, the last cell of each in lines, under their headings.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn write(out: &mut impl Write, headings: &[&str], last: &str, rows: &[Row]) -> io::Result<()> {
    write_within(output::width(), out, headings, last, rows)
}

fn write_within(
    terminal: Option<usize>,
    out: &mut impl Write,
    headings: &[&str],
    last: &str,
    rows: &[Row],
) -> io::Result<()> {
    let mut columns = Columns::new(headings).within(terminal);
    for row in rows {
        columns.widen(&row.cells());
    }
    let mut text = Vec::new();
    let mut lines = columns.row(&mut text, headings);
    lines.add(last, "");
    lines.end();
    for row in rows {
        let mut lines = columns.row(&mut text, &row.cells());
        row.last.iter().for_each(|item| lines.add(item, row.separator));
        row.below.iter().for_each(|sentence| lines.add_sentence(sentence));
        lines.end();
    }
    out.write_all(&text)
}

/// A row of a table that is known as a whole.
#[derive(Default)]
pub struct Row {
    pub cells: Vec<String>,
    /// What the last column shows.
    pub last: Vec<String>,
    /// What stands between the items of the last column.
    pub separator: &'static str,
    /// Sentences of the last column, each on a line of its own.
    pub below: Vec<String>,
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
        write_within(None, &mut out, &["A", "NAME"], "REST", rows).expect("a vector takes everything");
        String::from_utf8(out).expect("columns are text")
    }

    fn row(cells: [&str; 2], last: &[&str]) -> Row {
        let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
        Row { cells: owned(&cells), last: owned(last), separator: " ", ..Row::default() }
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
    fn a_table_on_a_terminal_is_as_wide_as_that() {
        let words: Vec<_> = (10..40).map(|number| format!("word{number}")).collect();
        let words: Vec<_> = words.iter().map(String::as_str).collect();
        for (terminal, beside) in [(200, true), (100, true), (60, true), (49, true), (48, false), (44, false)] {
            let mut out = Vec::new();
            let rows = [row(["1", "x"], &words)];
            write_within(Some(terminal), &mut out, &["A", "NAME"], "REST", &rows).expect("a vector takes everything");
            let text = String::from_utf8(out).expect("columns are text");
            let widest = text.lines().map(str::len).max().unwrap_or_default();
            assert!((terminal - 6..=terminal).contains(&widest), "{terminal}: {text}");
            assert_eq!(text.lines().nth(1).is_some_and(|line| line.contains("x     word10")), beside, "{text}");
            let found: Vec<_> = text.split_whitespace().filter(|word| word.starts_with("word")).collect();
            assert_eq!(found, words, "{terminal}");
        }
    }

    /// Fills a last column of some width.
    fn filled(room: usize, fill: impl FnOnce(&mut Lines)) -> String {
        let mut text = Vec::new();
        let mut lines = Lines { room, ..Columns::new(&[]).row(&mut text, &[]) };
        fill(&mut lines);
        lines.end();
        String::from_utf8(text).expect("columns are text")
    }

    #[test]
    fn items_share_a_line_as_long_as_they_fit() {
        let joined = |items: &[&str], separator, room| {
            filled(room, |lines| items.iter().for_each(|item| lines.add(item, separator)))
        };
        assert_eq!(joined(&["aa", "bb", "cc"], ", ", 6), "aa, bb,\ncc\n");
        assert_eq!(joined(&["°C°C", "m"], "  ", 7), "°C°C  m\n");
        assert_eq!(joined(&["too long", "m"], " ", 3), "too long\nm\n");
    }

    #[test]
    fn only_the_blank_behind_an_item_may_stand_beyond_the_column() {
        let joined = |room| {
            filled(room, |lines| {
                for item in ["aa ", "°° "] {
                    lines.add_by(|text| text.extend_from_slice(item.as_bytes()));
                }
            })
        };
        assert_eq!([joined(5), joined(4)], ["aa °°\n", "aa\n°°\n"]);
    }

    #[test]
    fn a_sentence_begins_a_line_of_its_own() {
        let text = filled(9, |lines| {
            lines.add("a", " ");
            lines.add("b", " ");
            lines.add_sentence("c d");
        });
        assert_eq!(text, "a b\nc d\n");
        assert_eq!(filled(3, |lines| lines.add_sentence("c d e")), "c d\ne\n");
    }
}
