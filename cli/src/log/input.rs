//! The lines of a file or of standard input, with their numbers.

mod interrupt;

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::iter;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::failure::{Failure, Finish, escaped, shown, tell};
use crate::log::doubt::Doubt;
use crate::log::progress::Progress;
use crate::log::signature;
use crate::log::{Entry, Reader};

/// Longer lines are unreadable.
pub const LONGEST: usize = 1 << 16;

/// A line that is longer than this beyond what is read of it has no end, as in `/dev/zero`.
const ENDLESS: u64 = 1 << 28;

/// Bytes of a file that are decoded at once, beside what completes their last line.
const PART: u64 = 1 << 18;

/// Some editors put it before the first line.
const BYTE_ORDER_MARK: &str = "\u{FEFF}";

/// What a file has in common with itself alone, whatever path leads to it: its device and number.
#[cfg(unix)]
type Identity = (u64, u64);

#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    let file = path.metadata().ok().filter(std::fs::Metadata::is_file)?;
    Some((file.dev(), file.ino()))
}

#[cfg(not(unix))]
type Identity = std::path::PathBuf;

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    path.canonicalize().ok()
}

/// A text to be read line by line.
pub struct Input {
    name: PathBuf,
    /// Which file it is, if it is one.
    file: Option<Identity>,
    reader: BufReader<Box<dyn Read>>,
    number: usize,
    line: Vec<u8>,
    /// How many bytes there are, where that is known.
    length: Option<u64>,
    /// Whether its lines are what they should be; `None` if nothing says that.
    doubt: Option<Doubt>,
    /// The output comes when all is read.
    is_summed_up: bool,
    /// What somebody at a terminal sees.
    progress: Option<Progress>,
}

/// A line of the input.
pub struct Line<'a> {
    /// Its number, the first being 1.
    pub number: usize,
    /// The line without its end, or why it is unreadable.
    pub text: Result<&'a str, String>,
}

impl<'a> Line<'a> {
    fn new(number: usize, line: &'a [u8]) -> Self {
        let line = if number == 1 { line.strip_prefix(BYTE_ORDER_MARK.as_bytes()).unwrap_or(line) } else { line };
        Self { number, text: text(line.strip_suffix(b"\n").unwrap_or(line)) }
    }

    /// Makes a line of what is known to be UTF-8.
    fn of_text(number: usize, line: &'a str) -> Self {
        let line = if number == 1 { line.strip_prefix(BYTE_ORDER_MARK).unwrap_or(line) } else { line };
        let line = line.strip_suffix('\n').unwrap_or(line);
        Self { number, text: short(line.as_bytes()).map(|()| line) }
    }
}

fn text(line: &[u8]) -> Result<&str, String> {
    short(line)?;
    str::from_utf8(line).map_err(|error| format!("byte {} of the line is not UTF-8", error.valid_up_to() + 1))
}

fn short(line: &[u8]) -> Result<(), String> {
    if line.len() > LONGEST { Err(format!("the line is longer than {LONGEST} bytes")) } else { Ok(()) }
}

/// Says which line was refused, and why.
fn complaint(name: &Path, number: usize, why: &str) -> String {
    format!("{}:{number}: {}", shown(name), escaped(why))
}

/// Returns where the lines of a text stand, with their ends.
fn lines(text: &[u8]) -> impl Iterator<Item = Range<usize>> {
    let (mut start, mut ends) = (0, memchr::memchr_iter(b'\n', text));
    iter::from_fn(move || {
        let line = start..ends.next().map_or(text.len(), |end| end + 1);
        start = line.end;
        (!line.is_empty()).then_some(line)
    })
}

impl Input {
    /// Opens a file; without one, or for `-`, standard input.
    ///
    /// # Errors
    ///
    /// Where the file cannot be opened.
    fn open(path: Option<&Path>) -> Result<Self, Failure> {
        match path.filter(|path| *path != Path::new("-")) {
            None => Ok(Self {
                file: identity(Path::new("/dev/stdin")),
                ..Self::new(Path::new("<stdin>"), Box::new(io::stdin()))
            }),
            Some(path) => {
                let file = File::open(path).map_err(|error| Failure::input(path, &error))?;
                let length = file.metadata().ok().filter(std::fs::Metadata::is_file).map(|file| file.len());
                Ok(Self { file: identity(path), length, ..Self::new(path, Box::new(file)) })
            }
        }
    }

    /// Opens a log.
    ///
    /// # Errors
    ///
    /// Where the file cannot be opened.
    pub fn open_log(path: Option<&Path>) -> Result<Self, Failure> {
        Ok(Self { doubt: Some(Doubt::of_log()), ..Self::open(path)? })
    }

    /// Opens a file of lines that `read` can read, as [`Doubt::of_lines`] says.
    ///
    /// # Errors
    ///
    /// Where the file cannot be opened.
    pub fn open_lines(path: Option<&Path>, read: fn(&str) -> Result<bool, String>) -> Result<Self, Failure> {
        Ok(Self { doubt: Some(Doubt::of_lines(read)), ..Self::open(path)? })
    }

    /// Opens a log that is shown when all is read. Ctrl-C ends standard input, as its end does.
    ///
    /// # Errors
    ///
    /// Where the file cannot be opened.
    pub fn open_whole(path: Option<&Path>) -> Result<Self, Failure> {
        let input = Self::open_log(path)?.summed_up();
        if path.is_some_and(|path| path != Path::new("-")) {
            return Ok(input);
        }
        let stdin = interrupt::stdin().map_err(|error| Failure::input(&input.name, &error))?;
        Ok(Self { reader: BufReader::with_capacity(LONGEST, Box::new(stdin)), ..input })
    }

    /// Tests whether a path leads to the file that is read, so that writing there would destroy it.
    pub fn is_at(&self, path: &Path) -> bool {
        self.file.is_some() && self.file == identity(path)
    }

    fn new(name: &Path, reader: Box<dyn Read>) -> Self {
        let reader = BufReader::with_capacity(LONGEST, reader);
        let (name, line) = (name.to_owned(), Vec::new());
        let (file, length, doubt, progress) = (None, None, None, None);
        Self { name, file, reader, number: 0, line, length, doubt, is_summed_up: false, progress }
    }

    /// Says that nothing is written before all is read.
    pub fn summed_up(self) -> Self {
        Self { is_summed_up: true, ..self }
    }

    /// Reads the next line; `None` at the end.
    ///
    /// # Errors
    ///
    /// Where the input cannot be read any further.
    fn next_line(&mut self) -> Result<Option<Line<'_>>, Failure> {
        self.refuse_foreign()?;
        self.line.clear();
        let more = self.fill().map_err(|error| Failure::input(&self.name, &error))?;
        self.number += 1;
        let line = more.then(|| Line::new(self.number, &self.line));
        if let (Some(doubt), Some(line)) = (&mut self.doubt, &line) {
            doubt
                .look(line.text.as_ref().copied().map_err(String::as_str))
                .map_err(|why| Failure::input(&self.name, &why))?;
        }
        Ok(line)
    }

    /// Calls back with each frame in the lines that have come, before the first one is read.
    ///
    /// # Errors
    ///
    /// Where the input cannot be read, or is no log.
    pub fn foresee(&mut self, mut see: impl FnMut(&Entry<'_>)) -> Result<(), Failure> {
        self.refuse_foreign()?;
        let mut reader = Reader::default();
        for line in lines(self.reader.buffer()).map(|place| &self.reader.buffer()[place]) {
            let text = str::from_utf8(line).ok().filter(|line| line.ends_with('\n'));
            if let Some(Ok(Some(entry))) = text.map(|line| reader.read(line)) {
                see(&entry);
            }
        }
        Ok(())
    }

    /// Refuses a file that has no lines, before the first one is read.
    fn refuse_foreign(&mut self) -> Result<(), Failure> {
        if self.number > 0 {
            return Ok(());
        }
        let start = self.reader.fill_buf().map_err(|error| Failure::input(&self.name, &error))?;
        let known = signature::foreign(start).map_or(Ok(()), Err);
        let foreseen = known.and_then(|()| self.doubt.as_ref().map_or(Ok(()), |doubt| doubt.foresee(start)));
        foreseen.map_err(|why| Failure::input(&self.name, &why))
    }

    /// Reads up to the end of a line, and drops what is too much of it.
    fn fill(&mut self) -> io::Result<bool> {
        const MOST: usize = BYTE_ORDER_MARK.len() + LONGEST + 1;
        let limit = u64::try_from(MOST).unwrap_or(u64::MAX);
        let count = self.reader.by_ref().take(limit).read_until(b'\n', &mut self.line)?;
        if count == MOST && self.line.last() != Some(&b'\n') {
            self.skip()?;
        }
        Ok(count > 0)
    }

    /// Drops the rest of a line.
    fn skip(&mut self) -> io::Result<()> {
        let mut rest = self.reader.by_ref().take(ENDLESS);
        rest.skip_until(b'\n')?;
        if rest.limit() > 0 {
            return Ok(());
        }
        let number = self.number + memchr::memchr_iter(b'\n', &self.line).count() + 1;
        let what = format!("line {number} has no end after {} MiB", ENDLESS >> 20);
        Err(io::Error::new(io::ErrorKind::InvalidData, what))
    }

    /// Does `work` on each line; what it refuses is complained about, and the rest goes on.
    ///
    /// # Errors
    ///
    /// Where the input cannot be read, or the output cannot be written.
    pub fn each<W: Write>(
        self,
        mut out: W,
        mut work: impl FnMut(&mut W, Line<'_>) -> Result<io::Result<()>, String>,
    ) -> Result<Finish, Failure> {
        let (mut input, mut finish) = (self.watched(), Finish::Done);
        while let Some(line) = input.next_line()? {
            match work(&mut out, line) {
                Ok(written) => written?,
                Err(why) => {
                    finish = Finish::Errors;
                    out.flush()?;
                    let complaint = complaint(&input.name, input.number, &why);
                    input.tell(&complaint);
                }
            }
            input.advance(input.line.len());
            if input.may_wait() {
                out.flush()?;
            }
        }
        Ok(finish)
    }

    /// Lets somebody at a terminal see how far it is read.
    pub fn watched(self) -> Self {
        let progress = self.length.and_then(|length| Progress::of(length, !self.is_summed_up));
        Self { progress, ..self }
    }

    /// Shows that more bytes are read.
    pub fn advance(&mut self, bytes: usize) {
        self.progress.iter_mut().for_each(|progress| progress.advance(bytes));
    }

    /// Says something on standard error.
    pub fn tell(&mut self, what: &str) {
        self.progress.iter_mut().for_each(Progress::clear);
        tell(what);
    }

    /// Tests whether the next line may have to be waited for, so that what is known should be shown first.
    fn may_wait(&self) -> bool {
        !self.reader.buffer().contains(&b'\n')
    }

    /// Tests for a file of several parts.
    pub fn has_parts(&self) -> bool {
        self.length.is_some_and(|length| length > PART)
    }

    /// Reads the next lines of a file; `None` at the end.
    ///
    /// # Errors
    ///
    /// Where the input cannot be read any further.
    pub fn next_part(&mut self) -> Result<Option<Part>, Failure> {
        self.refuse_foreign()?;
        self.line.clear();
        let read = self.reader.by_ref().take(PART).read_to_end(&mut self.line);
        let ends_line = self.line.last().is_none_or(|byte| *byte == b'\n');
        let read = read.and_then(|_| if ends_line { Ok(false) } else { self.fill() });
        read.map_err(|error| Failure::input(&self.name, &error))?;
        let part = Part { name: self.name.clone(), number: self.number, bytes: self.line.as_slice().into() };
        // The last line has no end if it is too long.
        let unended = usize::from(self.line.last().is_some_and(|byte| *byte != b'\n'));
        self.number += memchr::memchr_iter(b'\n', &self.line).count() + unended;
        Ok(Some(part).filter(|part| part.length() > 0))
    }
}

/// Whole lines of a file.
#[derive(Clone)]
pub struct Part {
    name: PathBuf,
    /// How many lines come before.
    number: usize,
    bytes: Arc<[u8]>,
}

impl Part {
    /// Returns how many bytes there are.
    pub fn length(&self) -> usize {
        self.bytes.len()
    }

    /// Does `work` on each line, and returns what it writes, with the complaints about what it refuses. `text` is an
    /// empty buffer to write into.
    pub fn work(self, text: Vec<u8>, mut work: impl FnMut(&mut Vec<u8>, Line<'_>) -> Result<(), String>) -> Written {
        let mut written = Written { text, complaints: Vec::new() };
        // To test the whole at once costs much less than to test line by line.
        let text = str::from_utf8(&self.bytes).ok();
        for (place, number) in lines(&self.bytes).zip(self.number + 1..) {
            let line = match text {
                Some(text) => Line::of_text(number, &text[place]),
                None => Line::new(number, &self.bytes[place]),
            };
            if let Err(why) = work(&mut written.text, line) {
                written.complaints.push((written.text.len(), complaint(&self.name, number, &why)));
            }
        }
        written
    }
}

/// What was written about a part.
pub struct Written {
    pub text: Vec<u8>,
    /// Complaints, and how many bytes of the text come before each.
    pub complaints: Vec<(usize, String)>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads all lines of a text.
    fn lines(text: Vec<u8>) -> Vec<(usize, Result<String, String>)> {
        let mut input = Input::new(Path::new("test"), Box::new(io::Cursor::new(text)));
        let mut lines = Vec::new();
        while let Ok(Some(Line { number, text })) = input.next_line() {
            lines.push((number, text.map(str::to_owned)));
        }
        lines
    }

    fn good(number: usize, text: &str) -> (usize, Result<String, String>) {
        (number, Ok(text.to_owned()))
    }

    fn bad(number: usize, why: &str) -> (usize, Result<String, String>) {
        (number, Err(why.to_owned()))
    }

    #[test]
    fn the_last_line_needs_no_end() {
        assert_eq!(lines(b"a\n\nb".to_vec()), [good(1, "a"), good(2, ""), good(3, "b")]);
        assert_eq!(lines(b"a\n".to_vec()), [good(1, "a")]);
        assert_eq!(lines(Vec::new()), []);
    }

    #[test]
    fn what_is_not_utf_8_costs_one_line() {
        assert_eq!(lines(b"ab\xFFc\nb".to_vec()), [bad(1, "byte 3 of the line is not UTF-8"), good(2, "b")]);
    }

    #[test]
    fn a_line_too_long_costs_one_line() {
        for surplus in [1, 2, 100, 3 * LONGEST] {
            let text = [vec![b'x'; LONGEST + surplus], b"\nb\n".to_vec()].concat();
            assert_eq!(lines(text), [bad(1, "the line is longer than 65536 bytes"), good(2, "b")], "{surplus}");
        }
    }

    #[test]
    fn a_line_without_end_ends_the_input() {
        let endless = || Box::new(io::Cursor::new("a\n").chain(io::repeat(b'x')));
        let why = "test: line 2 has no end after 256 MiB";
        let said = |failure: Failure| if let Failure::Input(what) = failure { what } else { format!("{failure:?}") };
        let mut input = Input::new(Path::new("test"), endless());
        assert!(input.next_line().is_ok_and(|line| line.is_some()));
        assert_eq!(input.next_line().err().map(said).as_deref(), Some(why));
        let part = Input::new(Path::new("test"), endless()).next_part();
        assert_eq!(part.err().map(said).as_deref(), Some(why));
    }

    #[test]
    fn a_byte_order_mark_belongs_to_no_line() {
        assert_eq!(lines("\u{FEFF}a\n\u{FEFF}b".into()), [good(1, "a"), good(2, "\u{FEFF}b")]);
    }

    #[test]
    fn a_byte_order_mark_takes_nothing_from_the_longest_line() {
        let longest = "x".repeat(LONGEST);
        assert_eq!(lines(format!("\u{FEFF}{longest}\nb").into_bytes()), [good(1, &longest), good(2, "b")]);
        let text = format!("\u{FEFF}{longest}x\nb").into_bytes();
        assert_eq!(lines(text), [bad(1, "the line is longer than 65536 bytes"), good(2, "b")]);
    }

    #[test]
    fn parts_have_the_lines_of_the_whole() {
        let filler = |size: usize| "y".repeat(size);
        let part = usize::try_from(PART).expect("a part fits into memory");
        let ends = [&filler(60_000), "", &filler(LONGEST + 1), "last"].map(str::to_owned);
        for (count, length) in [(8, 40_000), (5, LONGEST), (3, 2 * LONGEST + 1), (2, part), (1, 3 * part)] {
            let lines_before = vec![format!("\u{FEFF}{}", filler(length)); count];
            let text = [lines_before, ends.to_vec()].concat().join("\n").into_bytes();
            let mut input = Input::new(Path::new("test"), Box::new(io::Cursor::new(text.clone())));
            let (mut found, mut parts) = (Vec::new(), 0);
            while let Ok(Some(part)) = input.next_part() {
                part.work(Vec::new(), |_, line| {
                    found.push((line.number, line.text.map(str::to_owned)));
                    Ok(())
                });
                parts += 1;
            }
            assert!(found == lines(text), "{count} {length}");
            assert!(parts > 1, "{count} {length}");
        }
    }

    #[test]
    fn complaints_about_a_part_stand_where_they_came() {
        let mut input = Input::new(Path::new("test"), Box::new(io::Cursor::new(b"a\nbad\nb\n".to_vec())));
        let part = input.next_part().expect("memory is read").expect("it has lines");
        let written = part.work(Vec::new(), |out, line| match line.text? {
            "bad" => Err("it is bad".to_owned()),
            text => {
                out.extend_from_slice(text.as_bytes());
                Ok(())
            }
        });
        assert_eq!((written.text, written.complaints), (b"ab".to_vec(), vec![(1, "test:2: it is bad".to_owned())]));
        assert!(input.next_part().is_ok_and(|part| part.is_none()));
    }

    #[test]
    fn the_longest_line_is_read() {
        let longest = "x".repeat(LONGEST);
        assert_eq!(lines(format!("{longest}\nb").into_bytes()), [good(1, &longest), good(2, "b")]);
    }
}
