//! How far a long file is read, for somebody who waits at a terminal.

use std::io::{self, IsTerminal, Stderr, Write};

/// Bytes after which the line is written anew; a shorter file is read in no time.
const STEP: u64 = 1 << 18;

/// A line on a terminal that is written anew again and again.
pub struct Progress<W: Write = Stderr> {
    out: W,
    total: u64,
    read: u64,
    /// How much is to be read before the line is written anew.
    next: u64,
    /// The line that stands on the terminal.
    shown: String,
}

impl Progress {
    /// Returns the progress through a file of `total` bytes, if somebody sees it and it disturbs no
    /// rows of a table.
    pub fn of(total: u64, rows_follow: bool) -> Option<Self> {
        let is_seen = io::stderr().is_terminal() && !(rows_follow && io::stdout().is_terminal());
        is_seen.then(|| Self::new(io::stderr(), total))
    }
}

impl<W: Write> Progress<W> {
    fn new(out: W, total: u64) -> Self {
        Self { out, total, read: 0, next: STEP, shown: String::new() }
    }

    /// Counts bytes that were read.
    pub fn advance(&mut self, bytes: usize) {
        self.read += u64::try_from(bytes).unwrap_or(u64::MAX);
        if self.read >= self.next {
            self.next = self.read + STEP;
            self.show();
        }
    }

    fn show(&mut self) {
        let hundredths = (u128::from(self.read) * 100).checked_div(self.total.into()).unwrap_or(100).min(100);
        let line = format!("{hundredths} % read");
        if line != self.shown {
            let _ = write!(self.out, "\r{line}").and_then(|()| self.out.flush());
            self.shown = line;
        }
    }

    /// Takes the line away, so that others can be written.
    pub fn clear(&mut self) {
        if !self.shown.is_empty() {
            let blank = " ".repeat(self.shown.len());
            let _ = write!(self.out, "\r{blank}\r").and_then(|()| self.out.flush());
            self.shown.clear();
        }
    }
}

impl<W: Write> Drop for Progress<W> {
    fn drop(&mut self) {
        self.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns what is written while a file of some steps is read, and a complaint after the second one.
    fn written(steps: u64, step: u64) -> String {
        let mut out = Vec::new();
        let mut progress = Progress::new(&mut out, step * steps);
        for read in 0..steps {
            if read == 2 {
                progress.clear();
            }
            progress.advance(usize::try_from(step).expect("it is small"));
        }
        drop(progress);
        String::from_utf8(out).expect("it is text")
    }

    #[test]
    fn the_line_is_written_anew_and_taken_away_for_others() {
        let blank = |count: usize| format!("\r{}\r", " ".repeat(count));
        let expected = ["\r25 % read\r50 % read", &blank(9), "\r75 % read\r100 % read", &blank(10)].concat();
        assert_eq!(written(4, STEP), expected);
    }

    #[test]
    fn a_short_file_shows_nothing() {
        assert_eq!(written(3, STEP / 4), "");
    }
}
