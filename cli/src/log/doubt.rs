//! Whether an input is a log at all.

use crate::log::Reader;
use crate::log::signature;

/// As many unreadable lines before the first frame show that there is no log.
const MOST: usize = 100;

/// In as many bytes a log has a frame, even if a serial line begins with noise.
const BEGINNING: usize = 1 << 12;

/// The lines of an input up to its first frame.
#[derive(Clone, Default)]
pub struct Doubt {
    reader: Reader,
    unreadable: usize,
    /// What is wrong with the first unreadable line.
    first: String,
    is_over: bool,
}

impl Doubt {
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
        if is_binary { Err("the file is binary, and no log that is known".to_owned()) } else { Ok(()) }
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
        match line.map_err(str::to_owned).and_then(|line| self.reader.read(line)) {
            Ok(Some(_)) => self.is_over = true,
            Ok(None) => {}
            Err(why) if self.unreadable == 0 => (self.unreadable, self.first) = (1, why),
            Err(_) => self.unreadable += 1,
        }
        if self.unreadable < MOST {
            return Ok(());
        }
        Err(line.ok().and_then(signature::foreign_line).unwrap_or_else(|| {
            format!("{MOST} lines cannot be read, and no frame comes before them; the first: {}", self.first)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn foreseen(line: &str, count: usize, rest: &str) -> Result<(), String> {
        Doubt::default().foresee(format!("{}{rest}", format!("{line}\n").repeat(count)).as_bytes())
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
    fn lines_without_a_frame_are_not_unreadable() {
        for line in ["", "# a comment", "base hex  timestamps absolute"] {
            assert_eq!(foreseen(line, 3 * MOST, "hello\n(1.0) can0 123#00\n"), Ok(()), "{line}");
        }
    }

    #[test]
    fn unreadable_lines_behind_a_frame_are_those_of_a_log() {
        let mut doubt = Doubt::default();
        assert_eq!(doubt.look(Ok("(1.0) can0 123#00")), Ok(()));
        assert!((0..2 * MOST).all(|_| doubt.look(Ok("hello")).is_ok() && doubt.look(Err("it is no text")).is_ok()));
    }

    #[test]
    fn zero_bytes_and_no_frame_are_no_log_but_noise_may_come_before_one() {
        let why = Err("the file is binary, and no log that is known".to_owned());
        let foreseen =
            |frame: &str, zeros| Doubt::default().foresee(format!("{frame}{}", "\0".repeat(zeros)).as_bytes());
        assert_eq!(foreseen("", BEGINNING), why);
        assert_eq!(foreseen("", BEGINNING - 1), Ok(()));
        assert_eq!(foreseen("(1.0) can0 123#00\n", BEGINNING), Ok(()));
        assert_eq!(foreseen(&" ".repeat(BEGINNING), 0), Ok(()));
    }
}
