//! The text of a spec file, and where its lines are.

use std::fs::File;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;
use std::string::FromUtf8Error;

use crate::diagnostic::{At, Diagnostic, Diagnostics};
use crate::rules;

/// Largest spec file that is read, in bytes.
pub const SIZE_LIMIT: usize = 4 << 20;

/// Bytes between two entries of the character index.
const BLOCK: usize = 256;

/// Most forbidden characters that are reported of one file.
const REPORTED_CHARACTERS: usize = 100;

const BYTE_ORDER_MARK: char = '\u{FEFF}';

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
    /// Accepts the bytes of a spec file: UTF-8 with or without a byte order mark, lines ending in LF or CRLF.
    ///
    /// # Errors
    ///
    /// The bytes are more than [`SIZE_LIMIT`], are not UTF-8, or hold a control character other than tab and line end.
    pub fn new(name: impl Into<String>, bytes: Vec<u8>) -> Result<Self, Diagnostics> {
        let name = name.into();
        if bytes.len() > SIZE_LIMIT {
            return Err(too_large(&name));
        }
        let mut text = String::from_utf8(bytes).map_err(|error| not_utf8(&name, &error))?;
        if text.starts_with(BYTE_ORDER_MARK) {
            text.remove(0);
        }
        let source = Self::index(&name, text);
        let problems = source.forbidden_characters();
        if problems.is_empty() { Ok(source) } else { Err(Diagnostics::new(source).with(problems)) }
    }

    /// Reads a spec file.
    ///
    /// # Errors
    ///
    /// The file does not exist, is a folder, cannot be read, or [`Source::new`] refuses what is in it.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Diagnostics> {
        let path = path.as_ref();
        let name = path.display().to_string();
        match read_limited(path) {
            Ok(bytes) => Self::new(name, bytes),
            Err(error) => Err(unreadable(&name, &error)),
        }
    }

    /// Returns the name of the file, without what would begin a line or act on a terminal.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the text without a byte order mark.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the line and the column of a byte offset, both counted from 1, columns in characters.
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

    /// Returns the byte offset of a character of which the position in the text is known.
    pub(crate) fn byte_of_character(&self, position: usize) -> usize {
        let block = self.blocks.partition_point(|&before| before <= position).max(1) - 1;
        let start = block * BLOCK;
        let starts = self.text.as_bytes()[start..].iter().enumerate().filter(|(_, byte)| starts_character(**byte));
        starts.map(|(at, _)| start + at).nth(position - self.blocks[block]).unwrap_or(self.text.len())
    }

    fn index(name: &str, text: String) -> Self {
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

    fn forbidden_characters(&self) -> Vec<Diagnostic> {
        let bytes = self.text.as_bytes();
        let ends_line = |at: usize| bytes[at] == b'\r' && bytes.get(at + 1) == Some(&b'\n');
        let found = self.text.char_indices().filter_map(|(at, character)| Some((at, character, forbidden(character)?)));
        found
            .filter(|(at, ..)| !ends_line(*at))
            .take(REPORTED_CHARACTERS)
            .map(|(at, character, what)| forbidden_character(at..at + character.len_utf8(), character, what))
            .collect()
    }
}

/// Names what a character is if a spec may not hold it.
pub(crate) fn forbidden(character: char) -> Option<&'static str> {
    match character {
        '\t' | '\n' => None,
        '\r' => Some("carriage return without a line feed"),
        BYTE_ORDER_MARK => Some("byte order mark"),
        '\u{85}' | '\u{2028}' | '\u{2029}' => Some("line separator that not every reader takes for one"),
        '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => Some("mark that reverses the direction of text"),
        '\u{FFFE}' | '\u{FFFF}' => Some("code point that is no character"),
        _ if character.is_control() => Some("control character"),
        _ => None,
    }
}

/// Replaces what would begin a line or act on a terminal.
pub(crate) fn visible(text: &str) -> String {
    text.replace(|character: char| character.is_control() || forbidden(character).is_some(), "\u{FFFD}")
}

fn starts_character(byte: u8) -> bool {
    byte & 0xC0 != 0x80
}

fn count_characters(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| starts_character(**byte)).count()
}

fn read_limited(path: &Path) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if metadata.len() > SIZE_LIMIT as u64 {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    let mut bytes = Vec::new();
    file.take(SIZE_LIMIT as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn unreadable(name: &str, error: &io::Error) -> Diagnostics {
    #[expect(clippy::wildcard_enum_match_arm, reason = "the standard library's enum is open")]
    let (message, help) = match error.kind() {
        io::ErrorKind::FileTooLarge => return too_large(name),
        io::ErrorKind::NotFound => ("there is no such file".to_owned(), "check the path and the folder it starts from"),
        io::ErrorKind::IsADirectory => ("this is a folder, not a spec".to_owned(), "name a YAML file in it"),
        io::ErrorKind::PermissionDenied => ("the file may not be read".to_owned(), "change its permissions"),
        _ => (format!("the file cannot be read: {error}"), "check that the file is there and complete"),
    };
    refused(name, String::new(), Diagnostic::error(&rules::FILE, At::File, message).help(help))
}

fn too_large(name: &str) -> Diagnostics {
    let message = format!("the file is larger than {} MiB", SIZE_LIMIT >> 20);
    refused(
        name,
        String::new(),
        Diagnostic::error(&rules::FILE, At::File, message).help("check that this is the spec you mean"),
    )
}

fn not_utf8(name: &str, error: &FromUtf8Error) -> Diagnostics {
    let at = error.utf8_error().valid_up_to();
    let message = format!("byte {at} of the file, 0x{:02X}, is not UTF-8", error.as_bytes()[at]);
    let problem = Diagnostic::error(&rules::ENCODING, at..at + char::REPLACEMENT_CHARACTER.len_utf8(), message);
    let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
    refused(name, text, problem.help("save the file as UTF-8"))
}

fn forbidden_character(span: Range<usize>, character: char, what: &str) -> Diagnostic {
    let message = format!("the {what} U+{:04X} may not stand in a spec", u32::from(character));
    Diagnostic::error(&rules::ENCODING, span, message).help("remove it")
}

/// Reports a problem with a file that is not read any further.
pub(crate) fn refused(name: &str, text: String, problem: Diagnostic) -> Diagnostics {
    Diagnostics::new(Source::index(name, text)).with([problem])
}
