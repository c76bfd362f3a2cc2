//! Turns bytes into text, and tests size, encoding and characters.

pub(crate) mod rules;

use std::fs::{self, File};
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;
use std::string::FromUtf8Error;

use crate::report::diagnostic::{At, Diagnostic, Diagnostics};
pub use crate::report::lines::Source;
use crate::words::visible::BYTE_ORDER_MARK;
pub use crate::words::visible::forbidden;

/// Largest spec file that is read, in bytes.
pub const SIZE_LIMIT: usize = 4 << 20;

/// Largest number of forbidden characters that are reported for one file.
const REPORTED_CHARACTERS: usize = 100;

impl Source {
    /// Accepts the bytes of a spec file: UTF-8 with or without a byte order mark, lines ending in LF or CRLF.
    ///
    /// # Errors
    ///
    /// There are more than [`SIZE_LIMIT`] bytes, they are not UTF-8, or hold a control character
    /// other than tab and line end.
    pub fn new(name: impl Into<String>, bytes: Vec<u8>) -> Result<Self, Diagnostics> {
        let name = name.into();
        if bytes.len() > SIZE_LIMIT {
            return Err(unreadable(&name, &too_large(SIZE_LIMIT)));
        }
        let mut text = String::from_utf8(bytes).map_err(|error| not_utf8(&name, &error))?;
        if text.starts_with(BYTE_ORDER_MARK) {
            text.remove(0);
        }
        let source = Self::index(&name, text);
        let problems = source.forbidden_characters();
        if problems.is_empty() { Ok(source) } else { Err(Diagnostics::new(source).with(problems)) }
    }

    /// Reads a spec file alone. [`Bases::read`](crate::Bases::read) also finds the specs that it is
    /// based on.
    ///
    /// # Errors
    ///
    /// [`read_whole`] refuses the file, or [`Source::new`] its content.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Diagnostics> {
        let path = path.as_ref();
        let name = path.display().to_string();
        match read_whole(path, SIZE_LIMIT) {
            Ok(bytes) => Self::new(name, bytes).map(|source| source.at_path(path)),
            Err(error) => Err(unreadable(&name, &error)),
        }
    }

    fn forbidden_characters(&self) -> Vec<Diagnostic> {
        let bytes = self.text().as_bytes();
        let ends_line = |at: usize| bytes[at] == b'\r' && bytes.get(at + 1) == Some(&b'\n');
        let found =
            self.text().char_indices().filter_map(|(at, character)| Some((at, character, forbidden(character)?)));
        found
            .filter(|(at, ..)| !ends_line(*at))
            .take(REPORTED_CHARACTERS)
            .map(|(at, character, what)| forbidden_character(at..at + character.len_utf8(), character, what))
            .collect()
    }
}

/// Reads a file of at most `limit` bytes, which are whole MiB.
///
/// # Errors
///
/// The file does not exist, is a folder, a pipe or a device, is larger, or cannot be read. What the
/// caller has open already, as `/dev/stdin`, may be a pipe, because it ends when its writer does.
pub fn read_whole(path: &Path, limit: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let most = u64::try_from(limit).unwrap_or(u64::MAX);
    open_whole(path)?.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() > limit { Err(too_large(limit)) } else { Ok(bytes) }
}

/// Opens a file that has an end. Nobody waits for a pipe to which nobody writes.
pub(crate) fn open_whole(path: &Path) -> io::Result<File> {
    let found = fs::metadata(path)?;
    if found.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "this is a folder, not a file"));
    }
    if !found.is_file() && !is_open_already(path) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "this is a pipe or a device, not a file"));
    }
    File::open(path)
}

/// Tests for what the caller has open. A shell names so what it writes as `<(COMMAND)`.
fn is_open_already(path: &Path) -> bool {
    ["/dev/stdin", "/dev/fd", "/proc/self/fd"].iter().any(|open| path.starts_with(open))
}

fn too_large(limit: usize) -> io::Error {
    io::Error::new(io::ErrorKind::FileTooLarge, format!("the file is larger than {} MiB", limit >> 20))
}

fn unreadable(name: &str, error: &io::Error) -> Diagnostics {
    #[expect(clippy::wildcard_enum_match_arm, reason = "the standard library's enum is open")]
    let (message, help) = match error.kind() {
        io::ErrorKind::FileTooLarge => (error.to_string(), "check that this is the spec you mean"),
        io::ErrorKind::NotFound => ("there is no such file".to_owned(), "check the path and the folder it starts from"),
        io::ErrorKind::IsADirectory => ("this is a folder, not a spec".to_owned(), "name a YAML file in it"),
        io::ErrorKind::InvalidInput => ("this is a pipe or a device, not a spec".to_owned(), "put a file in its place"),
        io::ErrorKind::PermissionDenied => ("the file may not be read".to_owned(), "change its permissions"),
        _ => (format!("the file cannot be read: {error}"), "check that the file is there and complete"),
    };
    refused(name, String::new(), Diagnostic::error(&rules::FILE, At::File, message).help(help))
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
