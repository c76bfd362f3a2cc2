//! Lines of `candump -L` and frames of `cansend`: `(SECONDS) CHANNEL ID#DATA`.

use canspec_codegen::interpret::{Form, Frame};

use super::Entry;
use super::part::{
    CLASSIC, FLEXIBLE, LARGEST_EXTENDED, LONGEST_NAME, bytes, channel, even_bytes, fewer, hexadecimal, identifier,
    is_hexadecimal, is_usual_stamp, quoted, stamp,
};

/// Tests for a stamp as candump writes it.
pub fn has_stamp(line: &str) -> bool {
    line.trim_ascii_start().starts_with('(')
}

/// Reads a line exactly as candump writes a data frame with 29 bits; `None` from any other line.
pub fn usual(line: &str) -> Option<Entry<'_>> {
    let (time, rest) = split(line.strip_prefix('(')?, b')')?;
    let (channel, frame) = split(rest.strip_prefix(' ')?, b' ')?;
    let (id, data) = frame.split_at_checked(8)?;
    let is_name = !channel.is_empty() && channel.bytes().all(|byte| byte.is_ascii_alphanumeric());
    let is_short = time.len().max(channel.len()) <= LONGEST_NAME;
    if !is_name || !is_short || !is_usual_stamp(time) {
        return None;
    }
    let id = hexadecimal(id).filter(|id| *id <= LARGEST_EXTENDED)?;
    let data = data.strip_prefix('#').filter(|data| data.len() <= 2 * CLASSIC)?;
    let frame = Frame { id, extended: true, data: even_bytes(data)?, form: Form::Data };
    Some(Entry { time: Some(time.into()), channel: Some(channel), frame, digit: 0 })
}

/// Splits a word off a text, as `split_once` does, which costs more.
fn split(text: &str, separator: u8) -> Option<(&str, &str)> {
    let end = memchr::memchr(separator, text.as_bytes())?;
    Some((&text[..end], &text[end + 1..]))
}

/// Reads a line that is not blank.
pub fn read(line: &str) -> Result<Option<Entry<'_>>, String> {
    let mut words = line.split_ascii_whitespace().peekable();
    let time = words.next_if(|word| word.starts_with('(')).map(stamp).transpose()?;
    let channel = words.next_if(|word| !word.contains('#')).map(channel).transpose()?;
    let frame = words.next().ok_or("no frame in the form ID#DATA; `candump -L` writes it")?;
    let (mut frame, digit) = read_frame(frame)?;
    while let Some(byte) = words.next_if(|word| has_further(&frame, word)) {
        frame.data.extend(bytes(byte, 1)?);
    }
    fewer(frame.data.len(), if frame.form == Form::Fd { FLEXIBLE } else { CLASSIC })?;
    words.next_if(|word| ["R", "T"].contains(word));
    match words.next() {
        None => Ok(Some(Entry { time, channel, frame, digit })),
        Some(word) => Err(format!("{} after the frame", quoted(word))),
    }
}

/// Tests for a byte of data behind a blank.
fn has_further(frame: &Frame, word: &str) -> bool {
    frame.form != Form::Remote && word.len() == 2 && is_hexadecimal(word)
}

/// Reads `ID#DATA`, and the forms of remote, error and FD frames.
fn read_frame(word: &str) -> Result<(Frame, u8), String> {
    let (id, data) =
        word.split_once('#').ok_or_else(|| format!("{} is no ID#DATA; `candump -L` writes it", quoted(word)))?;
    let (id, extended, error) = identifier(id.strip_prefix("0x").unwrap_or(id))?;
    let (form, data, digit) = match (error, data.strip_prefix('#')) {
        (true, _) => (Form::Error, dotted(data, CLASSIC)?, 0),
        (false, Some(rest)) => (Form::Fd, dotted(without_flags(rest)?, FLEXIBLE)?, digit(rest.get(..1))),
        (false, None) if is_remote(data) => (Form::Remote, Vec::new(), digit(data.get(1..))),
        (false, None) => (Form::Data, dotted(data, CLASSIC)?, 0),
    };
    Ok((Frame { id, extended, data, form }, digit))
}

/// Tests for `R`, and the number of bytes asked for.
fn is_remote(data: &str) -> bool {
    data.strip_prefix(['R', 'r']).is_some_and(|length| matches!(length.as_bytes(), [] | [b'0'..=b'8']))
}

/// Reads a hexadecimal digit, 0 without one.
fn digit(text: Option<&str>) -> u8 {
    text.and_then(|text| u8::from_str_radix(text, 16).ok()).unwrap_or(0)
}

/// Takes the digit of flags from the data of an FD frame.
fn without_flags(data: &str) -> Result<&str, String> {
    data.strip_prefix(|flags: char| flags.is_ascii_hexdigit())
        .ok_or_else(|| "an FD frame needs one digit of flags after `##`".to_owned())
}

/// Reads bytes that points may part, without a length code above 8 as in `_E`.
fn dotted(data: &str, most: usize) -> Result<Vec<u8>, String> {
    if let Ok(bytes) = bytes(data, most) {
        return Ok(bytes);
    }
    let data = match data.rsplit_once('_') {
        Some((bytes, "9" | "A" | "B" | "C" | "D" | "E" | "F")) if most == CLASSIC => bytes,
        _ => data,
    };
    let pieces: Vec<Vec<u8>> = data.split('.').map(|piece| bytes(piece, most)).collect::<Result<_, _>>()?;
    let bytes = pieces.concat();
    fewer(bytes.len(), most).map(|()| bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::part::Stamp;

    fn entry(line: &str) -> Entry<'_> {
        read(line).expect("the line is readable").expect("the line is not blank")
    }

    fn frame(line: &str) -> Frame {
        entry(line).frame
    }

    fn time(line: &str) -> Option<String> {
        entry(line).time.map(Stamp::into_owned)
    }

    fn why(line: &str) -> String {
        read(line).expect_err("the line is unreadable")
    }

    #[test]
    fn a_line_of_candump_is_stamp_channel_and_frame() {
        let entry = entry("(1700000000.000000) can0 029C03F0#000B71B000003A98");
        assert_eq!(entry.time.expect("it has a stamp"), "1700000000.000000");
        assert_eq!(entry.channel, Some("can0"));
        let data = vec![0x00, 0x0B, 0x71, 0xB0, 0x00, 0x00, 0x3A, 0x98];
        assert_eq!(entry.frame, Frame { id: 0x029C_03F0, extended: true, data, form: Form::Data });
    }

    #[test]
    fn stamp_and_channel_may_be_missing() {
        let bare = entry("1a5#0aFf");
        assert!(bare.time.is_none() && bare.channel.is_none());
        assert_eq!(bare.frame, Frame { id: 0x1A5, extended: false, data: vec![0x0A, 0xFF], form: Form::Data });
        assert_eq!(entry("vcan1 123#").channel, Some("vcan1"));
    }

    #[test]
    fn identifiers_and_bytes_are_read_as_cansend_and_people_write_them() {
        // The forms of `cansend` in its own help, and what documents print.
        let data = vec![0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88];
        let forms = [
            "123#1122334455667788",
            "123#11.22.33.44.55.66.77.88",
            "123#11.2233.44556677.88",
            "123#1122334455667788_E",
            "0x123#1122334455667788",
            "123#11 22 33 44 55 66 77 88",
            "can0 0x123#11 22 33 44 55 66 77 88 T",
        ];
        for line in forms {
            assert_eq!(
                frame(line),
                Frame { id: 0x123, extended: false, data: data.clone(), form: Form::Data },
                "{line}"
            );
        }
        assert_eq!(frame("0x18FF50E5#").id, 0x18FF_50E5);
        assert_eq!(frame("123##1 0A 0B").data, [0x0A, 0x0B]);
        assert_eq!(why("123#1122334455667788 99"), "the data have 9 bytes, more than 8");
        assert_eq!(why("123#11..22.3"), "the data have an odd number of digits, 1");
        assert_eq!(why("123#11_8"), "the data `11_8` are not hexadecimal");
        assert_eq!(why("123#R 11"), "`11` after the frame");
        assert_eq!(why("0x12#11"), "the identifier 12 has 2 digits instead of 3 or 8");
    }

    #[test]
    fn direction_letters_and_line_ends_are_accepted() {
        for line in ["(1.5) can0 123#00 R", "(1.5) can0 123#00 T\r", " (1.5)  can0\t123#00\r\n"] {
            assert_eq!(frame(line), Frame { id: 0x123, extended: false, data: vec![0], form: Form::Data });
        }
        assert_eq!(why("(1.5) can0 123#00 X"), "`X` after the frame");
        assert_eq!(why("(1.5) can0 123#00 R T"), "`T` after the frame");
    }

    #[test]
    fn a_stamp_is_kept_as_it_is_written() {
        for stamp in ["1700000000.000000", "0", "0.10", "12", "-3.5", "1e9", "123456789012345678901234567890.000000001"]
        {
            assert_eq!(time(&format!("({stamp}) can0 123#")).as_deref(), Some(stamp));
        }
    }

    #[test]
    fn a_stamp_loses_leading_zeros_only() {
        for (stamp, kept) in [("0012.5", "12.5"), ("0000000000.000010", "0.000010"), ("00", "0"), ("007", "7")] {
            assert_eq!(time(&format!("({stamp}) can0 123#")).as_deref(), Some(kept));
        }
    }

    #[test]
    fn a_stamp_that_is_no_number_makes_the_line_unreadable() {
        for stamp in
            ["(x)", "()", "(1.)", "(.5)", "(1,5)", "(NaN)", "(\"1\")", "([1])", "(null)", "(1.5", "(+1)", "(0x10)"]
        {
            let expected = format!("the stamp `{}` is no number in parentheses", stamp.escape_debug());
            assert_eq!(why(&format!("{stamp} can0 123#00")), expected);
        }
    }

    #[test]
    fn remote_error_and_fd_frames_are_told_apart() {
        let forms = [
            ("12345678#R", Form::Remote, 0x1234_5678, 0),
            ("123#R8", Form::Remote, 0x123, 0),
            ("20000004#0004000000000000", Form::Error, 4, 8),
            ("123##1", Form::Fd, 0x123, 0),
            ("12345678##5001122334455667788", Form::Fd, 0x1234_5678, 9),
        ];
        for (line, form, id, length) in forms {
            let frame = frame(line);
            assert_eq!((frame.form, frame.id, frame.data.len()), (form, id, length), "{line}");
        }
    }

    #[test]
    fn an_unreadable_frame_says_why() {
        let reasons = [
            ("can0", "no frame in the form ID#DATA; `candump -L` writes it"),
            ("can0 can1 123#00", "`can1` is no ID#DATA; `candump -L` writes it"),
            (
                "(1) (2) 123#00",
                "the channel `(2)` is no name; a name has no blanks, no `#` and nothing invisible, and does not begin \
                 with `(`",
            ),
            (
                "\u{1b}[2J 123#00",
                "the channel `\\u{1b}[2J` is no name; a name has no blanks, no `#` and nothing invisible, and does not \
                 begin with `(`",
            ),
            ("20000000G#00", "the identifier `20000000G` is not hexadecimal"),
            ("#00", "the identifier `` is not hexadecimal"),
            ("+12#00", "the identifier `+12` is not hexadecimal"),
            ("1234#00", "the identifier 1234 has 4 digits instead of 3 or 8"),
            ("800#00", "the identifier 800 is above 7FF, the largest of 11 bits"),
            ("40000000#00", "the identifier 40000000 is above 1FFFFFFF, the largest of 29 bits"),
            ("FFFFFFFF#00", "the identifier FFFFFFFF is above 1FFFFFFF, the largest of 29 bits"),
            ("123#0", "the data have an odd number of digits, 1"),
            ("123#112233445566778899", "the data have 9 bytes, more than 8"),
            ("123#0G", "the data `0G` are not hexadecimal"),
            ("123#R9", "the data `R9` are not hexadecimal"),
            ("123##", "an FD frame needs one digit of flags after `##`"),
        ];
        for (line, reason) in reasons {
            assert_eq!(why(line), reason, "{line}");
        }
    }
}
