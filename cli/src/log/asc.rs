//! Logs of Vector's programs (ASC): a head, then `SECONDS CHANNEL ID Rx d LENGTH BYTES` among events of many other sorts.

use std::str::SplitAsciiWhitespace;

use canspec_codegen::interpret::{Form, Frame};

use super::Entry;
use super::part::{CLASSIC, FLEXIBLE, as_many, channel, fewer, fitting, quoted, seconds};

const DIRECTIONS: [&str; 3] = ["Rx", "Tx", "TxRq"];

/// In which base the log has identifiers and data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Base(u32);

impl Default for Base {
    fn default() -> Self {
        Self(16)
    }
}

/// Tests for a line of the head.
pub fn begins(line: &str) -> bool {
    let line = line.trim_ascii();
    let starts = |start: &str| line.get(..start.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(start));
    ["date ", "base hex", "base dec", "internal events", "no internal events", "begin triggerblock", "// version"]
        .into_iter()
        .any(starts)
}

/// Tests for a frame below a head that is missing.
pub fn shows(line: &str) -> bool {
    let words: Vec<&str> = line.split_ascii_whitespace().take(5).collect();
    let [time, channel, third, fourth, ..] = words.as_slice() else { return false };
    let has_direction = DIRECTIONS.contains(if *channel == "CANFD" { fourth } else { &words[3] });
    time.contains('.') && seconds(time).is_ok() && (has_direction || *third == "ErrorFrame")
}

/// Reads a line that is not blank; the head, comments and other events have no frame.
pub fn read<'a>(base: &mut Base, line: &'a str) -> Result<Option<Entry<'a>>, String> {
    let mut words = line.split_ascii_whitespace();
    let (first, second) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    if first.eq_ignore_ascii_case("base") {
        *base = Base(if second.eq_ignore_ascii_case("dec") { 10 } else { 16 });
        return Ok(None);
    }
    if first.starts_with("//") || begins(line) || first.eq_ignore_ascii_case("end") {
        return Ok(None);
    }
    let time = Some(seconds(first)?);
    let is_number = |word: &str| word.bytes().all(|digit| digit.is_ascii_digit());
    let (name, read): (_, fn(Base, Words<'_>) -> Read) = match second {
        "CANFD" => (words.next().unwrap_or_default(), flexible),
        name if is_number(name) => (name, classic),
        _ => return event(line),
    };
    let Some((frame, digit)) = read(*base, words)? else { return event(line) };
    Ok(Some(Entry { time, channel: Some(channel(name)?), frame, digit }))
}

/// Passes over an event. A frame with a channel or a direction that nobody knows is none.
fn event(line: &str) -> Result<Option<Entry<'_>>, String> {
    let words: Vec<&str> = line.split_ascii_whitespace().take(5).collect();
    let [_, channel, _, direction, "d" | "r"] = words.as_slice() else { return Ok(None) };
    let found = format!("{} and {}", quoted(channel), quoted(direction));
    Err(format!("a frame has the number of its channel and `Rx`, `Tx` or `TxRq`, and not {found}"))
}

type Words<'a> = SplitAsciiWhitespace<'a>;

/// A frame and its digit, `None` of an event.
type Read = Result<Option<(Frame, u8)>, String>;

/// Reads `ID Rx d LENGTH BYTES`, `ID Rx r` or `ErrorFrame`.
fn classic(base: Base, mut words: Words<'_>) -> Read {
    let id = words.next().unwrap_or_default();
    if id == "ErrorFrame" {
        return Ok(Some(error()));
    }
    if !words.next().is_some_and(|word| DIRECTIONS.contains(&word)) {
        return Ok(None);
    }
    let (id, extended) = base.identifier(id)?;
    match words.next() {
        Some("r") => {
            let digit = words.next().and_then(|digit| u8::from_str_radix(digit, 16).ok()).filter(|digit| *digit <= 8);
            Ok(Some((Frame { id, extended, data: Vec::new(), form: Form::Remote }, digit.unwrap_or_default())))
        }
        Some("d") => {
            // A code above 8 stands for eight bytes.
            let count = base.number("length", words.next().unwrap_or_default(), 15)?.min(8);
            let data = base.data(words, count as usize, CLASSIC)?;
            Ok(Some((Frame { id, extended, data, form: Form::Data }, 0)))
        }
        other => {
            Err(format!("{} is neither `d`, a data frame, nor `r`, a remote frame", quoted(other.unwrap_or_default())))
        }
    }
}

/// Reads `Rx ID [NAME] BRS ESI CODE LENGTH BYTES`, or `Rx ErrorFrame`.
fn flexible(base: Base, mut words: Words<'_>) -> Read {
    if !words.next().is_some_and(|word| DIRECTIONS.contains(&word)) {
        return Ok(None);
    }
    let id = words.next().unwrap_or_default();
    if id == "ErrorFrame" {
        return Ok(Some(error()));
    }
    let (id, extended) = base.identifier(id)?;
    let is_flag = |word: &&str| ["0", "1"].contains(word);
    let mut words = words.skip_while(|word| !is_flag(word));
    let (rate, state, _code) = (words.next(), words.next(), words.next());
    let count = Base(10).number("length", words.next().unwrap_or_default(), 64)?;
    let data = base.data(words, count as usize, FLEXIBLE)?;
    let flag = |word: Option<&str>, bit: u8| if word == Some("1") { bit } else { 0 };
    Ok(Some((Frame { id, extended, data, form: Form::Fd }, flag(rate, 1) | flag(state, 2))))
}

/// Returns an error frame; the log does not say what the error is.
fn error() -> (Frame, u8) {
    (Frame { id: 0, extended: true, data: Vec::new(), form: Form::Error }, 0)
}

impl Base {
    /// Reads an identifier, behind which an `x` stands if it has 29 bits.
    fn identifier(self, word: &str) -> Result<(u32, bool), String> {
        let digits = word.strip_suffix(['x', 'X']).unwrap_or(word);
        let id = fitting(self.number("identifier", digits, u32::MAX)?, digits.len() < word.len(), digits)?;
        Ok((id, digits.len() < word.len()))
    }

    fn number(self, what: &str, digits: &str, most: u32) -> Result<u32, String> {
        let is_plain = digits.bytes().all(|digit| digit.is_ascii_alphanumeric());
        let number = u32::from_str_radix(digits, self.0).ok().filter(|number| is_plain && *number <= most);
        let base = if self.0 == 16 { "hexadecimal" } else { "decimal" };
        number.ok_or_else(|| format!("the {what} {} is no {base} number that fits", quoted(digits)))
    }

    /// Reads as many bytes as the line says; what follows is about the frame.
    fn data<'a>(self, words: impl Iterator<Item = &'a str>, count: usize, most: usize) -> Result<Vec<u8>, String> {
        fewer(count, most)?;
        let byte = |word| self.number("data byte", word, 0xFF).map(|byte| byte.to_le_bytes()[0]);
        let data: Vec<u8> = words.take(count).map(byte).collect::<Result<_, _>>()?;
        as_many(count, data.len()).map(|()| data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{hexadecimal, identifier_text};

    fn frame(base: u32, line: &str) -> Option<(String, Form, String, String, u8)> {
        let entry = read(&mut Base(base), line).expect("the line is readable")?;
        let Frame { data, form, .. } = &entry.frame;
        let place = format!("{} {}", entry.time?, entry.channel?);
        Some((place, *form, identifier_text(&entry.frame), hexadecimal(data), entry.digit))
    }

    #[test]
    fn frames_stand_among_what_the_log_says_of_them() {
        // Lines of the examples of Vector's and of python-can's tests.
        let lines = [
            (
                16,
                "   2.5010 1  C8              Tx   d 8 09 08 07 06 05 04 03 02",
                Form::Data,
                "0C8",
                "0908070605040302",
                0,
            ),
            (
                16,
                "17.876976 6  6F8x  Rx   d 8 FF 00 0C FE 00 00 00 00  Length = 239910 BitCount = 124 ID = 1784x",
                Form::Data,
                "000006F8",
                "FF000CFE00000000",
                0,
            ),
            (10, "  0.1 1  200             Rx   d 2 09 255", Form::Data, "0C8", "09FF", 0),
            (16, "  0.1 1  1FFFFFFFx       Rx   r", Form::Remote, "1FFFFFFF", "", 0),
            (16, "  0.1 1  123             TxRq r 5", Form::Remote, "123", "", 5),
            (16, "  0.1 1  123             Rx   d F 0 1 2 3 4 5 6 7", Form::Data, "123", "0001020304050607", 0),
            (16, "  0.1 2  ErrorFrame", Form::Error, "20000000", "", 0),
            (16, "30.1 CANFD 3 Rx 50005x 0 0 5 0 140000 73 200050 7a60", Form::Fd, "00050005", "", 0),
            (
                16,
                "30.3 CANFD 2 Tx 1a Name_of_it 1 1 9 12 01 02 03 04 05 06 07 08 09 0a 0b 0c 130000",
                Form::Fd,
                "01A",
                "0102030405060708090A0B0C",
                3,
            ),
        ];
        for (base, line, form, id, data, digit) in lines {
            let place: Vec<&str> = line.split_ascii_whitespace().filter(|word| *word != "CANFD").take(2).collect();
            let expected = (place.join(" "), form, id.to_owned(), data.to_owned(), digit);
            assert_eq!(frame(base, line), Some(expected), "{line}");
        }
    }

    #[test]
    fn head_comments_and_events_have_no_frame() {
        let lines = [
            "date Sam Sep 30 15:06:13.191 2017",
            "internal events logged",
            "// version 9.0.0",
            "Begin Triggerblock Sam Sep 30 15:06:13.191 2017",
            "   0.000000 Start of measurement",
            "   0.015991 CAN 1 Status:chip status error passive - TxErr: 132 RxErr: 0",
            "   1.015991 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%",
            "   2.510001 L1 2b Rx 8 41 6e 67 00 00 00 00 00",
            "   3.098426 2  J1939TP FEE3p 6 0 0 - Rx d 3 A5 66 CC",
            "   4.0 SV: 4 0 1 ::Env::Speed = 5",
            "End TriggerBlock",
        ];
        for line in lines {
            assert_eq!(frame(16, line), None, "{line}");
        }
    }

    #[test]
    fn the_base_holds_for_the_lines_below() {
        let mut base = Base::default();
        read(&mut base, "base dec  timestamps absolute").expect("the head is readable");
        assert_eq!(base, Base(10));
        read(&mut base, "base hex").expect("the head is readable");
        assert_eq!(base, Base(16));
    }

    #[test]
    fn an_unreadable_line_says_why() {
        let reasons = [
            (16, "x 1 123 Rx d 0", "the stamp `x` is no number"),
            (16, "0.1 1 Engine Rx d 0", "the identifier `Engine` is no hexadecimal number that fits"),
            (10, "0.1 1 1A Rx d 0", "the identifier `1A` is no decimal number that fits"),
            (16, "0.1 1 800 Rx d 0", "the identifier 800 is above 7FF, the largest of 11 bits"),
            (16, "0.1 1 20000000x Rx d 0", "the identifier 20000000 is above 1FFFFFFF, the largest of 29 bits"),
            (16, "0.1 1 123 Rx d 2 11", "the line says that there are 2 data bytes, and has 1"),
            (16, "0.1 1 123 Rx d 1 100", "the data byte `100` is no hexadecimal number that fits"),
            (
                16,
                "0.1 CAN12 123 Rx d 0",
                "a frame has the number of its channel and `Rx`, `Tx` or `TxRq`, and not `CAN12` and `Rx`",
            ),
            (
                16,
                "0.1 1 123 Xx r",
                "a frame has the number of its channel and `Rx`, `Tx` or `TxRq`, and not `1` and `Xx`",
            ),
            (16, "0.1 1 123 Rx e 1 10", "`e` is neither `d`, a data frame, nor `r`, a remote frame"),
        ];
        for (base, line, reason) in reasons {
            assert_eq!(read(&mut Base(base), line).expect_err("it is refused"), reason, "{line}");
        }
    }
}
