//! The text of a spec file, and the places of its lines.

use std::ops::Range;

/// Bytes between two entries of the character index.
const BLOCK: usize = 32;

pub(super) const BYTE_ORDER_MARK: char = '\u{FEFF}';

/// The text of a spec file and its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    name: String,
    text: String,
    /// Offset of the first byte of each line.
    lines: Vec<usize>,
    /// Number of characters that start before each block of bytes.
    blocks: Vec<usize>,
}

impl Source {
    /// Returns the name of the file, without characters that begin a line or act on a terminal.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the text without a byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the line and the column of a byte offset. Both count from 1, and columns count
    /// characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = offset.min(self.text.len());
        let line = self.lines.partition_point(|&start| start <= offset).max(1);
        let column = self.characters_before(offset) - self.characters_before(self.lines[line - 1]) + 1;
        (line, column)
    }

    /// Returns the bytes from the start of the first line of a span to the end of its last line.
    pub fn whole_lines(&self, span: &Range<usize>) -> Range<usize> {
        let first = self.lines.partition_point(|&start| start <= span.start).max(1);
        let next = self.lines.partition_point(|&start| start <= span.end);
        self.lines[first - 1]..self.lines.get(next).copied().unwrap_or(self.text.len())
    }

    /// Returns the byte offset of the character at a position.
    pub(crate) fn byte_of_character(&self, position: usize) -> usize {
        let block = self.blocks.partition_point(|&before| before <= position).max(1) - 1;
        let start = block * BLOCK;
        let starts = self.text.as_bytes()[start..].iter().enumerate().filter(|(_, byte)| starts_character(**byte));
        starts.map(|(at, _)| start + at).nth(position - self.blocks[block]).unwrap_or(self.text.len())
    }

    /// Makes a source of a text, and finds its lines.
    pub(super) fn index(name: &str, text: String) -> Self {
        let line_ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let lines = std::iter::once(0).chain(line_ends.map(|(at, _)| at + 1)).collect();
        let blocks = std::iter::once(0)
            .chain(text.as_bytes().chunks_exact(BLOCK).scan(0, |characters, block| {
                *characters += count_characters(block);
                Some(*characters)
            }))
            .collect();
        Self { name: visible(name), text, lines, blocks }
    }

    fn characters_before(&self, offset: usize) -> usize {
        let block = offset / BLOCK;
        self.blocks[block] + count_characters(&self.text.as_bytes()[block * BLOCK..offset])
    }
}

/// Names the kind of a character that specs, file names and channel names must not hold.
pub fn forbidden(character: char) -> Option<&'static str> {
    match character {
        ' '..='~' | '\t' | '\n' => None,
        '\r' => Some("carriage return that ends no line"),
        BYTE_ORDER_MARK => Some("byte order mark"),
        '\u{85}' | '\u{2028}' | '\u{2029}' => Some("line separator that not every reader takes for one"),
        '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => Some("mark that reverses the direction of text"),
        '\u{AD}'
        | '\u{61C}'
        | '\u{180E}'
        | '\u{200B}'..='\u{200F}'
        | '\u{2060}'..='\u{206F}'
        | '\u{FFF9}'..='\u{FFFB}'
        | '\u{E0000}'..='\u{E007F}' => Some("character that nobody sees"),
        '\u{FFFE}' | '\u{FFFF}' => Some("code point that is no character"),
        _ if character.is_control() => Some("control character"),
        _ => None,
    }
}

/// Replaces characters that begin a line or act on a terminal.
pub(crate) fn visible(text: &str) -> String {
    text.replace(|character: char| character.is_control() || forbidden(character).is_some(), "\u{FFFD}")
}

fn starts_character(byte: u8) -> bool {
    byte & 0xC0 != 0x80
}

fn count_characters(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| starts_character(**byte)).count()
}
