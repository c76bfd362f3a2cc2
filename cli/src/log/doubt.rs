//! Whether an input is what it should be at all: a log, or lines of another kind.

use crate::log::Reader;
use crate::log::signature;

/// As many unreadable lines before the first one that can be read show that the input is something else.
const MOST: usize = 100;

/// In as many bytes a log has a frame, even if a serial line begins with noise.
const BEGINNING: usize = 1 << 12;

/// What should stand in the lines of an input.
#[derive(Clone)]
enum Wanted {
    Frames(Reader),
    /// Says whether a line holds what is wanted or nothing, or why it cannot be read.
    Others(fn(&str) -> Result<bool, String>),
}

impl Wanted {
    /// Tests whether it stands in a line.
    fn is_in(&mut self, line: &str) -> Result<bool, String> {
        match self {
            Self::Frames(reader) => reader.read(line).map(|frame| frame.is_some()),
            Self::Others(read) => read(line),
        }
    }

    /// Says what bytes are that are no text.
    fn binary(&self) -> &'static str {
        match self {
            Self::Frames(_) => "the file is binary, and no log that is known",
            Self::Others(_) => "the file is binary",
        }
    }

    /// Says what the lines are instead.
    fn missing(&self, line: Option<&str>, first: &str) -> String {
        match self {
            Self::Frames(_) => line.and_then(signature::foreign_line).unwrap_or_else(|| {
                format!("{MOST} lines cannot be read, and no frame comes before them; the first: {first}")
            }),
            Self::Others(_) => format!("{MOST} lines cannot be read, and none before them can; the first: {first}"),
        }
    }
}

/// The lines of an input up to the first that holds what is wanted.
#[derive(Clone)]
pub struct Doubt {
    wanted: Wanted,
    unreadable: usize,
    /// What is wrong with the first unreadable line.
    first: String,
    is_over: bool,
}

impl Doubt {
    /// Doubts whether the lines are those of a log.
    pub fn of_log() -> Self {
        Self::new(Wanted::Frames(Reader::default()))
    }

    /// Doubts whether `read` can read the lines. It says whether a line has something in it, or why it is unreadable.
    pub fn of_lines(read: fn(&str) -> Result<bool, String>) -> Self {
        Self::new(Wanted::Others(read))
    }

    fn new(wanted: Wanted) -> Self {
        Self { wanted, unreadable: 0, first: String::new(), is_over: false }
    }

    /// Looks at the whole lines among the bytes that have come, before anything is said of them.
    ///
    /// # Errors
    ///
    /// Says what they are if they are no log.
    pub fn foresee(&self, start: &[u8]) -> Result<(), String> {
        let mut ahead = self.clone();
        for line in start.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n")) {
            ahead.look(str::from_utf8(line).map_err(|_| "it is no text"))?;
        }
        let is_binary = start.len() >= BEGINNING && start.contains(&0) && !ahead.is_over;
        if is_binary { Err(self.wanted.binary().to_owned()) } else { Ok(()) }
    }

    /// Takes a line, or why it is no text.
    ///
    /// # Errors
    ///
    /// It is one unreadable line too many.
    pub fn look(&mut self, line: Result<&str, &str>) -> Result<(), String> {
        if self.is_over {
            return Ok(());
        }
        match line.map_err(str::to_owned).and_then(|line| self.wanted.is_in(line)) {
            Ok(is_there) => self.is_over = is_there,
            Err(why) if self.unreadable == 0 => (self.unreadable, self.first) = (1, why),
            Err(_) => self.unreadable += 1,
        }
        if self.unreadable < MOST { Ok(()) } else { Err(self.wanted.missing(line.ok(), &self.first)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn foreseen(line: &str, count: usize, rest: &str) -> Result<(), String> {
        Doubt::of_log().foresee(format!("{}{rest}", format!("{line}\n").repeat(count)).as_bytes())
    }

    #[test]
    fn a_hundred_unreadable_lines_before_the_first_frame_are_no_log() {
        let frame = "(1.0) can0 123#00\n";
        let why = foreseen("hello", MOST, frame).expect_err("it is no log");
        let start = "100 lines cannot be read, and no frame comes before them; the first: `hello` is of no known log;";
        assert!(why.starts_with(start), "{why}");
        assert_eq!(foreseen("hello", MOST - 1, frame), Ok(()));
        assert_eq!(foreseen("hello", MOST - 1, ""), Ok(()));
        // The last line has not come whole.
        assert_eq!(foreseen("hello", MOST - 1, "hello"), Ok(()));
    }

    #[test]
    fn a_hundred_lines_that_a_command_cannot_read_are_not_what_it_wants() {
        let doubt = Doubt::of_lines(|line| match line.trim_end() {
            "bad" => Err("it is bad".to_owned()),
            line => Ok(line == "good"),
        });
        let foreseen = |text: &str| doubt.foresee(text.as_bytes());
        let why = "100 lines cannot be read, and none before them can; the first: it is bad";
        assert_eq!(foreseen(&"bad\n".repeat(MOST)), Err(why.to_owned()));
        assert_eq!(foreseen(&"bad\n\n".repeat(MOST)), Err(why.to_owned()));
        assert_eq!(foreseen(&"bad\n".repeat(MOST - 1)), Ok(()));
        assert_eq!(foreseen(&format!("\ngood\n{}", "bad\n".repeat(MOST))), Ok(()));
        assert_eq!(foreseen(&"\0".repeat(BEGINNING)), Err("the file is binary".to_owned()));
    }

    #[test]
    fn lines_without_a_frame_are_not_unreadable() {
        for line in ["", "# a comment", "base hex  timestamps absolute"] {
            assert_eq!(foreseen(line, 3 * MOST, "hello\n(1.0) can0 123#00\n"), Ok(()), "{line}");
        }
    }

    #[test]
    fn unreadable_lines_behind_a_frame_are_those_of_a_log() {
        let mut doubt = Doubt::of_log();
        assert_eq!(doubt.look(Ok("(1.0) can0 123#00")), Ok(()));
        assert!((0..2 * MOST).all(|_| doubt.look(Ok("hello")).is_ok() && doubt.look(Err("it is no text")).is_ok()));
    }

    #[test]
    fn zero_bytes_and_no_frame_are_no_log_but_noise_may_come_before_one() {
        let why = Err("the file is binary, and no log that is known".to_owned());
        let foreseen =
            |frame: &str, zeros| Doubt::of_log().foresee(format!("{frame}{}", "\0".repeat(zeros)).as_bytes());
        assert_eq!(foreseen("", BEGINNING), why);
        assert_eq!(foreseen("", BEGINNING - 1), Ok(()));
        assert_eq!(foreseen("(1.0) can0 123#00\n", BEGINNING), Ok(()));
        assert_eq!(foreseen(&" ".repeat(BEGINNING), 0), Ok(()));
    }
}
