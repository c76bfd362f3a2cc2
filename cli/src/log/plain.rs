//! Lines of candump for people: `(STAMP)  CHANNEL  ID   [LENGTH]  BYTES`.

use std::iter::Peekable;
use std::str::SplitAsciiWhitespace;

use canspec_codegen::interpret::{Form, Frame};

use super::Entry;
use super::part::{CLASSIC, FLEXIBLE, Stamp, as_many, bytes, channel, date, fewer, identifier, quoted, stamp};

type Words<'a> = Peekable<SplitAsciiWhitespace<'a>>;

/// Tests for the length in brackets.
pub fn shows(line: &str) -> bool {
    line.split_ascii_whitespace().any(|word| length(word).is_some())
}

/// Returns the number of a word in brackets, and whether it has two digits.
fn length(word: &str) -> Option<(usize, bool)> {
    let digits = word.strip_prefix('[')?.strip_suffix(']')?;
    let is_number = matches!(digits.len(), 1 | 2) && digits.bytes().all(|digit| digit.is_ascii_digit());
    Some((digits.parse().ok().filter(|_| is_number)?, digits.len() == 2))
}

/// Reads a line that is not blank; the explanations that `candump -e` puts below an error frame have no frame.
pub fn read(line: &str) -> Result<Option<Entry<'_>>, String> {
    if line.starts_with('\t') {
        return Ok(None);
    }
    let mut words = line.split_ascii_whitespace().peekable();
    let time = time(&mut words)?;
    let channel = words.next().map(channel).transpose()?;
    if words.next_if(|word| ["RX", "TX"].contains(word)).is_some() {
        let is_flag = |word: &&str| ["-", "B", "E"].contains(word);
        while words.next_if(is_flag).is_some() {}
    }
    let (id, extended, error) = identifier(words.next().unwrap_or_default())?;
    let (count, flexible) =
        words.next().and_then(length).ok_or("no length in brackets, as in `can0  123   [2]  11 22`")?;
    fewer(count, if flexible { FLEXIBLE } else { CLASSIC })?;
    if words.next_if_eq(&"remote").is_some() {
        let frame = Frame { id, extended, data: Vec::new(), form: Form::Remote };
        words.next_if_eq(&"request");
        return finish(words, Entry { time, channel, frame, digit: u8::try_from(count).unwrap_or_default() });
    }
    let data = data(&mut words, count)?;
    words.next_if_eq(&"ERRORFRAME");
    let form = match (error, flexible) {
        (true, _) => Form::Error,
        (false, true) => Form::Fd,
        (false, false) => Form::Data,
    };
    finish(words, Entry { time, channel, frame: Frame { id, extended, data, form }, digit: 0 })
}

/// Reads seconds in parentheses, or a date with a time of day.
fn time<'a>(words: &mut Words<'a>) -> Result<Option<Stamp<'a>>, String> {
    let Some(first) = words.next_if(|word| word.starts_with('(')) else { return Ok(None) };
    if first.ends_with(')') {
        return stamp(first).map(Some);
    }
    let second = words.next_if(|word| word.ends_with(')')).unwrap_or_default();
    date(first.trim_start_matches('('), second.trim_end_matches(')')).map(Some)
}

fn data(words: &mut Words<'_>, count: usize) -> Result<Vec<u8>, String> {
    let mut data = Vec::with_capacity(count);
    while data.len() < count {
        let Some(word) = words.next() else { break };
        match bytes(word, 1) {
            Ok(byte) => data.extend(byte),
            Err(_) => return Err(format!("the data byte {} is not two hexadecimal digits", quoted(word))),
        }
    }
    as_many(count, data.len()).map(|()| data)
}

/// Lets only characters follow, which `candump -a` puts in quotes.
fn finish<'a>(mut words: Words<'a>, entry: Entry<'a>) -> Result<Option<Entry<'a>>, String> {
    match words.next() {
        Some(word) if !word.starts_with('\'') => Err(format!("{} after the frame", quoted(word))),
        _ => Ok(Some(entry)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::identifier_text;

    fn entry(line: &str) -> Entry<'_> {
        read(line).expect("the line is readable").expect("the line has a frame")
    }

    fn time_of(line: &str) -> Option<String> {
        entry(line).time.map(Stamp::into_owned)
    }

    #[test]
    fn every_form_that_candump_prints_is_read() {
        // As `fprint_long_canframe` of can-utils prints them.
        let forms: [(&str, &str, Form, &[u8], u8); 9] = [
            (
                "  can0  123   [8]  11 22 33 44 55 66 77 88",
                "123",
                Form::Data,
                &[0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88],
                0,
            ),
            ("  can0  00000123   [0] ", "00000123", Form::Data, &[], 0),
            ("  can0       123   [1]  00", "123", Form::Data, &[0], 0),
            ("  can0  123   [5]  remote request", "123", Form::Remote, &[], 5),
            ("  can0  20000004   [2]  00 04                     ERRORFRAME", "20000004", Form::Error, &[0, 4], 0),
            ("  can0  123  [08]  01 02 03 04 05 06 07 08", "123", Form::Fd, &[1, 2, 3, 4, 5, 6, 7, 8], 0),
            ("  can0  123   [3]  23 5B 27                  '#['.'", "123", Form::Data, b"#['", 0),
            ("  can0  RX - -  123   [1]  0A", "123", Form::Data, &[10], 0),
            ("  can0  TX B E  123  [01]  0A", "123", Form::Fd, &[10], 0),
        ];
        for (line, id, form, data, digit) in forms {
            let entry = entry(line);
            assert_eq!((entry.channel, identifier_text(&entry.frame).as_str()), (Some("can0"), id), "{line}");
            assert_eq!((entry.frame.form, &entry.frame.data[..], entry.digit), (form, data, digit), "{line}");
        }
    }

    #[test]
    fn stamps_are_kept_and_dates_become_seconds() {
        assert_eq!(time_of(" (1700000000.012500)  can0  123   [0]").as_deref(), Some("1700000000.012500"));
        assert_eq!(time_of(" (000.012500)  can0  123   [0]").as_deref(), Some("0.012500"));
        assert_eq!(time_of(" (2023-11-14 22:13:20.012500)  can0  123   [0]").as_deref(), Some("1700000000.012500"));
        assert_eq!(time_of("  can0  123   [0]"), None);
    }

    #[test]
    fn an_explanation_of_an_error_frame_is_no_frame() {
        assert!(read("\tcontroller-problem{}").expect("it is skipped").is_none());
    }

    #[test]
    fn an_unreadable_line_says_why() {
        let reasons = [
            ("can0 123 [2] 11", "the line says that there are 2 data bytes, and has 1"),
            ("can0 123 [1] 11 22", "`22` after the frame"),
            ("can0 123 [1] 00010001", "the data byte `00010001` is not two hexadecimal digits"),
            ("can0 123 [9] 11", "the data have 9 bytes, more than 8"),
            ("can0 1234 [1] 11", "the identifier 1234 has 4 digits instead of 3 or 8"),
            ("(yesterday 1:2) can0 123 [0]", "the stamp `yesterday 1:2` is no date with a time"),
            ("(x) can0 123 [0]", "the stamp `(x)` is no number in parentheses"),
        ];
        for (line, reason) in reasons {
            assert_eq!(read(line).expect_err("it is refused"), reason, "{line}");
        }
    }
}
