//! Plain text in aligned columns. The last column is wrapped.

use std::io::{self, Write};
use std::iter;

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
    /// The width of the terminal, if there is one.
    terminal: Option<usize>,
}

impl Columns {
    /// Makes columns as wide as their headings.
    pub fn new(headings: &[&str]) -> Self {
        let mut columns = Self { widths: vec![0; headings.len()], terminal: None };
        columns.widen(headings);
        columns
    }

    /// Keeps to the width of a terminal, if there is one.
    #[must_use]
    pub fn within(self, terminal: Option<usize>) -> Self {
        Self { terminal, ..self }
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
        let (beside, whole) = (self.left(), self.terminal.unwrap_or(WIDTH));
        let line = match self.terminal {
            Some(terminal) if beside > terminal + GAP.len() => self.fold(text, line, terminal),
            _ => line,
        };
        let is_beside = beside == 0 || beside + NARROWEST <= whole || self.terminal.is_none();
        let (left, first) = if is_beside { (beside, Some(text.len())) } else { (INDENT, None) };
        let room = whole.saturating_sub(left).max(NARROWEST);
        Lines { left, room, is_on_terminal: self.terminal.is_some(), line, first, width: None, text }
    }

    /// Parts the cells of a row into lines of a terminal, and returns where the last one begins.
    fn fold(&self, text: &mut Vec<u8>, line: usize, terminal: usize) -> usize {
        let row = String::from_utf8_lossy(&text.split_off(line)).into_owned();
        let (mut rest, mut line, mut place) = (row.as_str(), line, 0);
        for column in &self.widths {
            let (cell, others) = rest.split_at(cell_end(rest, column + GAP.len()));
            if place > INDENT && place + column > terminal {
                line = end_line(text, line);
                text.resize(line + INDENT, b' ');
                place = INDENT;
            }
            text.extend_from_slice(cell.as_bytes());
            (rest, place) = (others, place + width(cell.as_bytes()));
        }
        line
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

/// Returns where a cell ends that is `width` characters wide, or wider without a blank there.
fn cell_end(row: &str, width: usize) -> usize {
    let mut last = ' ';
    let mut letters = row.char_indices().enumerate();
    let next = letters.find(|(count, (_, letter))| {
        let is_after = *count >= width && last == ' ' && (*count == width || *letter != ' ');
        last = *letter;
        is_after
    });
    next.map_or(row.len(), |(_, (place, _))| place)
}

/// Ends a line of a text without the blanks at its end, and returns where the next one begins.
fn end_line(text: &mut Vec<u8>, line: usize) -> usize {
    let length = text[line..].trim_ascii_end().len();
    text.truncate(line + length);
    text.push(b'\n');
    text.len()
}

/// A row whose last column is filled item by item.
pub struct Lines<'a> {
    text: &'a mut Vec<u8>,
    /// The width of the columns before the last one.
    left: usize,
    /// The width of the last column.
    room: usize,
    /// An item that is wider than the column is parted.
    is_on_terminal: bool,
    /// Where the last line begins in the text.
    line: usize,
    /// Where the last column begins in the text, if it stands beside the others.
    first: Option<usize>,
    /// The width of the last line in that column, unless the next item begins a new one.
    width: Option<usize>,
}

impl Lines<'_> {
    /// Adds an item to the last line, or a new line if it would become wider than the column. On a terminal, an item that
    /// is wider than the column is parted into its words.
    pub fn add(&mut self, item: &str, separator: &str) {
        let needs_line = self.first.is_none() && self.width.is_none();
        if needs_line && item.is_empty() {
            return;
        }
        let behind = if self.is_on_terminal { width(separator.trim_end().as_bytes()) } else { 0 };
        let room = self.room - behind;
        let is_parted = self.is_on_terminal && width(item.as_bytes()) > room;
        let words = item.splitn(if is_parted { usize::MAX } else { 1 }, ' ');
        for (word, separator) in words.zip(iter::once(separator).chain(iter::repeat(" "))) {
            if let Some(line) = &mut self.width {
                *line += width(separator.as_bytes());
                self.text.extend_from_slice(separator.as_bytes());
            }
            self.place(room, |text| text.extend_from_slice(word.as_bytes()));
        }
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
        self.line = end_line(self.text, self.line);
    }

    /// Ends the row.
    pub fn end(mut self) {
        self.end_line();
    }
}

/// Writes a running text, in lines as wide as the terminal if there is one.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn text(out: &mut impl Write, text: &str) -> io::Result<()> {
    text_within(output::width(), out, text)
}

/// Writes a running text, in lines as wide as a terminal if one is given.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn text_within(terminal: Option<usize>, out: &mut impl Write, text: &str) -> io::Result<()> {
    let mut written = Vec::new();
    let mut lines = Columns::new(&[]).within(terminal).row(&mut written, &[]);
    lines.add(text, "");
    lines.end();
    out.write_all(&written)
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

    #[test]
    fn a_table_parts_no_word_on_a_terminal_and_nothing_elsewhere() {
        let long = (0..12).map(|number| format!("word{number}")).collect::<Vec<_>>().join(" ");
        let name = "n".repeat(30);
        let rows = [row([&"f".repeat(25), &name], &[&long, "°C"]), row(["1", "two words"], &[&long])];
        let table = |terminal| {
            let mut out = Vec::new();
            write_within(terminal, &mut out, &["FIRST", "NAME"], "REST", &rows).expect("a vector takes everything");
            String::from_utf8(out).expect("columns are text")
        };
        for terminal in [150, 120, 80, 60, 57, 56, 45] {
            let shown = table(Some(terminal));
            let widest = shown.lines().map(|line| width(line.as_bytes())).max().unwrap_or_default();
            assert!(widest <= terminal, "{terminal}: {shown}");
            let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
            assert_eq!(words(&shown), words(&table(None)), "{terminal}");
        }
        assert_eq!(table(Some(45)).lines().take(3).collect::<Vec<_>>(), ["FIRST", "    NAME", "    REST"]);
        assert_eq!(table(None).lines().count(), 3);
    }

    #[test]
    fn a_word_that_is_wider_than_a_terminal_is_not_parted() {
        let wide = "w".repeat(WIDEST + 9);
        let mut out = Vec::new();
        let rows = [row([&wide, "x"], &["a"])];
        write_within(Some(50), &mut out, &["A", "NAME"], "REST", &rows).expect("a vector takes everything");
        let text = String::from_utf8(out).expect("columns are text");
        assert_eq!(text, format!("A\n    NAME\n    REST\n{wide}\n    x\n    a\n"));
    }

    #[test]
    fn nothing_takes_no_line_below_the_cells() {
        let rows = [row(["1", "x"], &[""]), row(["2", "y"], &["a"])];
        let shown = |terminal| {
            let mut out = Vec::new();
            write_within(Some(terminal), &mut out, &["A", "NAME"], "REST", &rows).expect("a vector takes everything");
            String::from_utf8(out).expect("columns are text")
        };
        assert_eq!(shown(48), "A  NAME\n    REST\n1  x\n2  y\n    a\n");
        assert_eq!(shown(49), "A  NAME  REST\n1  x\n2  y     a\n");
    }

    #[test]
    fn a_running_text_is_as_wide_as_the_terminal() {
        let shown = |terminal, text: &str| {
            let mut out = Vec::new();
            text_within(terminal, &mut out, text).expect("a vector takes everything");
            String::from_utf8(out).expect("it is text")
        };
        let text = "words ".repeat(40);
        assert_eq!(shown(None, &text), format!("{}\n", text.trim_end()));
        let line = "words ".repeat(10);
        assert_eq!(shown(Some(60), &text), format!("{}\n", line.trim_end()).repeat(4));
        // A line is never narrower than 40 characters.
        assert_eq!(shown(Some(20), "words"), "words\n");
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
