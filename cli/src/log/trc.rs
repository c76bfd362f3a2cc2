//! Traces of PEAK's programs (TRC): comments behind `;`, which say what the columns hold, then a frame or an event a line.

use canspec_codegen::interpret::{Form, Frame};

use super::Entry;
use super::part::{CLASSIC, FLEXIBLE, as_many, bytes, channel, fewer, fitting, is_hexadecimal, moved, quoted};

/// The columns of each version that has always the same ones, by the letters of version 2.
const VERSIONS: [(&str, &str); 4] =
    [("1.0", "N,O,I,l,D"), ("1.1", "N,O,T,I,l,D"), ("1.2", "N,O,B,T,I,l,D"), ("1.3", "N,O,B,T,I,R,l,D")];

/// What version 1.0 has for the identifier of an event.
const NO_IDENTIFIER: &str = "FFFFFFFF";

/// The data bytes that codes of a length above 8 stand for, in FD frames.
const LONG: [usize; 7] = [12, 16, 20, 24, 32, 48, 64];

/// The letters of the columns before the data.
#[derive(Clone, Debug)]
pub struct Columns(Vec<String>);

impl Default for Columns {
    fn default() -> Self {
        Self::of(VERSIONS[0].1)
    }
}

/// The cells of a line before its data.
#[derive(Default)]
struct Cells<'a> {
    time: &'a str,
    kind: &'a str,
    bus: Option<&'a str>,
    identifier: &'a str,
    length: &'a str,
    /// The length is a code rather than a number of bytes.
    is_code: bool,
}

/// Tests for the first line of a trace. One of version 1.0 begins with a rule of `#`.
pub fn begins(line: &str) -> bool {
    line.starts_with(";$FILEVERSION=") || line.starts_with(";##")
}

/// Reads a line that is not blank; comments and events have no frame.
pub fn read<'a>(columns: &mut Columns, line: &'a str) -> Result<Option<Entry<'a>>, String> {
    let line = line.trim_ascii();
    if let Some(comment) = line.strip_prefix(';') {
        columns.learn(comment);
        return Ok(None);
    }
    let mut words = line.split_ascii_whitespace();
    let cells = columns.cells(&mut words)?;
    let data: Vec<&str> = words.collect();
    let Some((frame, digit)) = cells.frame(&data)? else { return Ok(None) };
    let time = (!cells.time.is_empty()).then(|| moved(cells.time, 3)).transpose()?;
    Ok(Some(Entry { time, channel: cells.bus.map(channel).transpose()?, frame, digit }))
}

impl Columns {
    fn of(letters: &str) -> Self {
        Self(letters.split(',').map(str::trim).take_while(|letter| *letter != "D").map(str::to_owned).collect())
    }

    /// Takes the columns from a comment that says them, or the version.
    fn learn(&mut self, comment: &str) {
        if let Some(version) = comment.strip_prefix("$FILEVERSION=") {
            let known = VERSIONS.iter().find(|(known, _)| *known == version.trim_ascii());
            *self = known.map_or(Self(Vec::new()), |(_, letters)| Self::of(letters));
        } else if let Some(letters) = comment.strip_prefix("$COLUMNS=") {
            *self = Self::of(letters);
        }
    }

    fn cells<'a>(&self, words: &mut impl Iterator<Item = &'a str>) -> Result<Cells<'a>, String> {
        if self.0.is_empty() {
            return Err("no line `;$COLUMNS=` above says what the columns of this trace hold".to_owned());
        }
        let mut cells = Cells { kind: "DT", ..Cells::default() };
        for (letter, word) in self.0.iter().zip(words) {
            match letter.as_str() {
                "O" => cells.time = word,
                "T" => cells.kind = word,
                "B" => cells.bus = Some(word),
                "I" => cells.identifier = word,
                "l" | "L" => (cells.length, cells.is_code) = (word, letter == "L"),
                _ => {}
            }
        }
        Ok(cells)
    }
}

impl Cells<'_> {
    /// Returns the frame and its digit, `None` of an event.
    fn frame(&self, data: &[&str]) -> Result<Option<(Frame, u8)>, String> {
        let (form, flags) = match self.kind {
            _ if self.identifier == NO_IDENTIFIER => return Ok(None),
            "Warng" | "ST" | "EC" | "EV" => return Ok(None),
            "DT" | "Rx" | "Tx" if data.first() == Some(&"RTR") => (Form::Remote, 0),
            "DT" | "Rx" | "Tx" => (Form::Data, 0),
            "RR" => (Form::Remote, 0),
            "FD" => (Form::Fd, 0),
            "FB" => (Form::Fd, 1),
            "FE" => (Form::Fd, 2),
            "BI" => (Form::Fd, 3),
            "ER" | "Error" => {
                return Ok(Some((Frame { id: 0, extended: true, data: Vec::new(), form: Form::Error }, 0)));
            }
            other => return Err(format!("{} is neither a type of frame of a trace nor one of event", quoted(other))),
        };
        let (id, extended) = self.identifier()?;
        let length = self.length(form)?;
        if form == Form::Remote {
            let digit = u8::try_from(length.min(CLASSIC)).unwrap_or_default();
            return Ok(Some((Frame { id, extended, data: Vec::new(), form }, digit)));
        }
        let data = data.iter().map(|word| bytes(word, FLEXIBLE)).collect::<Result<Vec<_>, _>>()?.concat();
        as_many(length, data.len())?;
        Ok(Some((Frame { id, extended, data, form }, flags)))
    }

    /// Reads an identifier, which has 29 bits if it has more than four digits.
    fn identifier(&self) -> Result<(u32, bool), String> {
        let digits = self.identifier;
        let number = u32::from_str_radix(digits, 16).ok().filter(|_| is_hexadecimal(digits));
        let number = number.ok_or_else(|| format!("the identifier {} is not hexadecimal", quoted(digits)))?;
        Ok((fitting(number, digits.len() > 4, digits)?, digits.len() > 4))
    }

    /// Returns the number of data bytes.
    fn length(&self, form: Form) -> Result<usize, String> {
        let written =
            self.length.parse::<usize>().map_err(|_| format!("the length {} is no number", quoted(self.length)));
        let (written, is_long) = (written?, form == Form::Fd);
        let long = written.checked_sub(CLASSIC + 1).and_then(|index| LONG.get(index)).filter(|_| self.is_code);
        let length = match long {
            Some(bytes) if is_long => *bytes,
            // In other frames such a code stands for eight bytes.
            Some(_) => CLASSIC,
            None => written,
        };
        fewer(length, if is_long { FLEXIBLE } else { CLASSIC }).map(|()| length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{hexadecimal, identifier_text};

    /// Time and channel, form, identifier, data and digit.
    type Shown = (String, Form, String, String, u8);

    /// Reads a line below a head.
    fn read_below(head: &str, line: &str) -> Result<Option<Shown>, String> {
        let mut columns = Columns::default();
        for comment in head.lines() {
            assert!(read(&mut columns, comment).is_ok_and(|entry| entry.is_none()), "{comment}");
        }
        let Some(entry) = read(&mut columns, line)? else { return Ok(None) };
        let time = entry.time.as_deref().unwrap_or_default();
        let place = format!("{time} {}", entry.channel.unwrap_or_default());
        let Frame { data, form, .. } = &entry.frame;
        Ok(Some((place, *form, identifier_text(&entry.frame), hexadecimal(data), entry.digit)))
    }

    const V2: &str = ";$FILEVERSION=2.1\r\n;$COLUMNS=N,O,T,B,I,d,R,L,D";

    #[test]
    fn each_version_has_its_columns() {
        // The columns are those of PEAK's description of the format.
        let frames = [
            (";####", "1)  1841  0300  2  11 22", "1.841 ", "300"),
            (";$FILEVERSION=1.1", "1)  1841.7  Rx  0300  2  11 22", "1.8417 ", "300"),
            (";$FILEVERSION=1.1", "1)  1841.7  Tx  00000300  2  11 22", "1.8417 ", "00000300"),
            (";$FILEVERSION=1.2", "1)  1841.7  1  Rx  0300  2  11 22", "1.8417 1", "300"),
            (";$FILEVERSION=1.3", "1)  1841.7  1  Rx  0300  -  2  11 22", "1.8417 1", "300"),
            (";$FILEVERSION=2.0\n;$COLUMNS=N,O,T,I,d,l,D", "1  1059.9 DT  0300 Rx 2  11 22", "1.0599 ", "300"),
            (V2, "1  0.125 DT 2  283F000 Tx -  2  11 22 ", "0.000125 2", "0283F000"),
        ];
        for (head, line, place, id) in frames {
            let expected = (place.to_owned(), Form::Data, id.to_owned(), "1122".to_owned(), 0);
            assert_eq!(read_below(head, line), Ok(Some(expected)), "{head} {line}");
        }
    }

    #[test]
    fn a_type_says_which_form_a_frame_has() {
        let frames = [
            (";$FILEVERSION=1.1", "1)  1.0  Rx  0300  3  RTR", Form::Remote, 0, 3),
            (";$FILEVERSION=1.1", "1)  1.0  Error  0008  4  00 19 08 08", Form::Error, 0, 0),
            (V2, "1  1.0 RR 1  0300 Rx -  3", Form::Remote, 0, 3),
            (V2, "1  1.0 ER 1  -    Rx -  5  04 00 02 00 00", Form::Error, 0, 0),
            (V2, "1  1.0 FD 1  0300 Rx -  1  11", Form::Fd, 1, 0),
            (V2, "1  1.0 FB 1  0300 Rx -  9  11 22 33 44 55 66 77 88 99 AA BB CC", Form::Fd, 12, 1),
            (V2, "1  1.0 FE 1  0300 Rx -  0", Form::Fd, 0, 2),
            (V2, "1  1.0 BI 1  0300 Rx -  0", Form::Fd, 0, 3),
            (V2, "1  1.0 DT 1  0300 Rx -  15  11 22 33 44 55 66 77 88", Form::Data, 8, 0),
        ];
        for (head, line, form, count, digit) in frames {
            let (_, found, _, data, flags) = read_below(head, line).expect("it is readable").expect("it is a frame");
            assert_eq!((found, data.len() / 2, flags), (form, count, digit), "{line}");
        }
    }

    #[test]
    fn events_are_no_frames() {
        let lines = [
            (";####", "2)  1842  FFFFFFFF  4  00 00 00 08 BUSHEAVY"),
            (";$FILEVERSION=1.1", "2)  1842.0  Warng  FFFFFFFF  4  00 00 00 08  BUSHEAVY"),
            (V2, "2  1842.0 ST 1  -  Rx -  4  00 00 00 08"),
            (V2, "2  1842.0 EV said by somebody # 7"),
        ];
        for (head, line) in lines {
            assert_eq!(read_below(head, line), Ok(None), "{line}");
        }
    }

    #[test]
    fn an_unreadable_line_says_why() {
        let reasons = [
            ("1  1.0 XX 1  0300 Rx -  0", "`XX` is neither a type of frame of a trace nor one of event"),
            ("1  1.0 DT 1  03G0 Rx -  0", "the identifier `03G0` is not hexadecimal"),
            ("1  1.0 DT 1  0800 Rx -  0", "the identifier 0800 is above 7FF, the largest of 11 bits"),
            ("1  1.0 DT 1  0300 Rx -  x", "the length `x` is no number"),
            ("1  1.0 DT 1  0300 Rx -  2  11", "the line says that there are 2 data bytes, and has 1"),
            ("1  1.0 FD 1  0300 Rx -  99", "the data have 99 bytes, more than 64"),
            ("1  x DT 1  0300 Rx -  0", "the stamp `x` is no number"),
        ];
        for (line, reason) in reasons {
            assert_eq!(read_below(V2, line), Err(reason.to_owned()), "{line}");
        }
        let why = "no line `;$COLUMNS=` above says what the columns of this trace hold";
        assert_eq!(read_below(";$FILEVERSION=2.1", "1  1.0 DT 1  0300 Rx -  0"), Err(why.to_owned()));
    }
}
