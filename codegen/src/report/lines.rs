//! The text of a spec file, and the places of its lines.

use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::words::visible::visible;

/// Bytes between two entries of the character index.
const BLOCK: usize = 32;

/// The text of a spec file and its name, and behind it those of the specs that it is based on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// The spec's own file, then its base, then the base of that one, and so on.
    files: Vec<File>,
    text: String,
    /// Offset of the first byte of each line.
    lines: Vec<usize>,
    /// Number of characters that start before each block of bytes.
    blocks: Vec<usize>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct File {
    name: String,
    /// Where it was read from, if it was.
    path: Option<PathBuf>,
    /// Offset of its first byte.
    start: usize,
}

impl Source {
    /// Returns the name of the file, without characters that begin a line or act on a terminal.
    pub fn name(&self) -> &str {
        self.file_name(0)
    }

    /// Returns the text without a byte order mark. Those of the bases follow it, each on a new line.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the name of the file in which a byte stands.
    pub fn file_name(&self, offset: usize) -> &str {
        &self.files[self.file_of(offset)].name
    }

    /// Returns the line and the column of a byte in its file. Both count from 1, and columns count
    /// characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = offset.min(self.text.len());
        let line = self.line_of(offset);
        let column = self.characters_before(offset) - self.characters_before(self.lines[line - 1]) + 1;
        (line + 1 - self.line_of(self.files[self.file_of(offset)].start), column)
    }

    /// Returns the paths of the bases that were read from files.
    pub fn paths_of_bases(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().skip(1).filter_map(|file| file.path.as_deref())
    }

    /// Returns which file a byte stands in: 0 for the spec's own one, 1 for its base, and so on.
    pub(crate) fn file_of(&self, offset: usize) -> usize {
        self.files.partition_point(|file| file.start <= offset).max(1) - 1
    }

    /// Tests whether it was read from a file.
    pub(crate) fn is_file(&self) -> bool {
        self.files[0].path.is_some()
    }

    /// Returns the bytes of each file.
    pub(crate) fn parts(&self) -> impl ExactSizeIterator<Item = Range<usize>> {
        (0..self.files.len()).map(|number| self.part(number))
    }

    /// Returns the bytes of the last file.
    pub(crate) fn last_part(&self) -> Range<usize> {
        self.part(self.files.len() - 1)
    }

    /// Tests whether it holds the one file of another source.
    pub(crate) fn holds(&self, other: &Self) -> bool {
        self.files
            .iter()
            .zip(self.parts())
            .any(|(file, part)| file.name == other.name() && self.text[part] == other.text)
    }

    /// Sets where it was read from.
    pub(crate) fn at_path(mut self, path: &Path) -> Self {
        self.files[0].path = Some(path.to_owned());
        self
    }

    /// Adds the spec on which the last one is based.
    pub(crate) fn with_base(mut self, base: Self) -> Self {
        let start = self.text.len() + 1;
        self.files.extend(base.files.into_iter().map(|file| File { start: start + file.start, ..file }));
        Self::of(self.files, format!("{}\n{}", self.text, base.text))
    }

    /// Returns the bytes from the start of the first line of a span to the end of its last line.
    pub fn whole_lines(&self, span: &Range<usize>) -> Range<usize> {
        let first = self.lines.partition_point(|&start| start <= span.start).max(1);
        let next = self.lines.partition_point(|&start| start <= span.end);
        self.lines[first - 1]..self.lines.get(next).copied().unwrap_or(self.text.len())
    }

    /// Returns the byte offset of the character at a position in the whole text.
    pub(crate) fn byte_of_character(&self, position: usize) -> usize {
        let block = self.blocks.partition_point(|&before| before <= position).max(1) - 1;
        let start = block * BLOCK;
        let starts = self.text.as_bytes()[start..].iter().enumerate().filter(|(_, byte)| starts_character(**byte));
        starts.map(|(at, _)| start + at).nth(position - self.blocks[block]).unwrap_or(self.text.len())
    }

    /// Makes a source of a text, and finds its lines.
    pub(crate) fn index(name: &str, text: String) -> Self {
        Self::of(vec![File { name: visible(name), path: None, start: 0 }], text)
    }

    fn of(files: Vec<File>, text: String) -> Self {
        let line_ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let lines = std::iter::once(0).chain(line_ends.map(|(at, _)| at + 1)).collect();
        let blocks = std::iter::once(0)
            .chain(text.as_bytes().chunks_exact(BLOCK).scan(0, |characters, block| {
                *characters += count_characters(block);
                Some(*characters)
            }))
            .collect();
        Self { files, text, lines, blocks }
    }

    fn part(&self, number: usize) -> Range<usize> {
        let end = self.files.get(number + 1).map_or(self.text.len(), |next| next.start - 1);
        self.files[number].start..end
    }

    /// Returns the number of a line in the whole text, counted from 1.
    fn line_of(&self, offset: usize) -> usize {
        self.lines.partition_point(|&start| start <= offset).max(1)
    }

    /// Counts the characters before a byte of the whole text.
    pub(crate) fn characters_before(&self, offset: usize) -> usize {
        let block = offset / BLOCK;
        self.blocks[block] + count_characters(&self.text.as_bytes()[block * BLOCK..offset])
    }
}

fn starts_character(byte: u8) -> bool {
    byte & 0xC0 != 0x80
}

fn count_characters(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| starts_character(**byte)).count()
}
