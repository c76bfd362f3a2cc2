//! Logs of several programs, told apart by their lines.

use std::io::{self, Write};

use canspec_codegen::interpret::{Form, Frame};
use canspec_codegen::source::forbidden;
use serde_json::value::RawValue;

/// Set in the printed identifier of an error frame.
const ERROR_FLAG: u32 = 1 << 29;
const LARGEST_EXTENDED: u32 = 0x1FFF_FFFF;
const LARGEST_STANDARD: u32 = 0x7FF;
/// Characters of the name of an interface, which has 15 on Linux, and of a stamp.
const LONGEST_NAME: usize = 64;
/// Data bytes of a classic and of an FD frame.
const CLASSIC: usize = 8;
const FLEXIBLE: usize = 64;

/// A readable line of a log.
#[derive(Debug)]
pub struct Entry<'a> {
    /// The stamp as written, but for leading zeros.
    pub time: Option<Box<RawValue>>,
    /// The name of the interface.
    pub channel: Option<&'a str>,
    pub frame: Frame,
    /// The number of bytes that a remote frame asks for, or the flags of an FD frame.
    pub digit: u8,
}

/// Reads a line of a log, `None` from a blank one.
///
/// # Errors
///
/// Says why the line is unreadable.
pub fn read(line: &str) -> Result<Option<Entry<'_>>, String> {
    let mut words = line.split_ascii_whitespace().peekable();
    if words.peek().is_none() {
        return Ok(None);
    }
    let time = words.next_if(|word| word.starts_with('(')).map(stamp).transpose()?;
    let channel = words.next_if(|word| !word.contains('#')).map(channel).transpose()?;
    let frame = words.next().ok_or("no frame in the form ID#DATA; `candump -L` writes it")?;
    let (frame, digit) = read_frame(frame)?;
    words.next_if(|word| ["R", "T"].contains(word));
    match words.next() {
        None => Ok(Some(Entry { time, channel, frame, digit })),
        Some(word) => Err(format!("{} after the frame", quoted(word))),
    }
}

/// Reads `(SECONDS)`.
fn stamp(word: &str) -> Result<Box<RawValue>, String> {
    let refusal = || format!("the stamp {} is no number in parentheses", quoted(word));
    let seconds = word.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).ok_or_else(refusal)?;
    short("stamp", word, LONGEST_NAME + "()".len())?;
    let number = without_leading_zeros(seconds);
    let value = RawValue::from_string(number.to_owned()).ok().filter(|value| is_number(value));
    let value = value.ok_or_else(refusal)?;
    if is_finite(&value) {
        Ok(value)
    } else {
        Err(format!("the stamp {} is larger than any number of JSON", quoted(word)))
    }
}

/// Tests whether JSON is a number.
pub fn is_number(value: &RawValue) -> bool {
    value.get().starts_with(|first: char| first == '-' || first.is_ascii_digit())
}

/// Tests whether a number is one for readers of JSON that know doubles alone.
pub fn is_finite(number: &RawValue) -> bool {
    number.get().parse().is_ok_and(f64::is_finite)
}

/// candump fills up seconds with zeros, which JSON does not allow.
fn without_leading_zeros(number: &str) -> &str {
    let significant = number.trim_start_matches('0');
    match number.strip_suffix(significant) {
        Some(zeros) if !zeros.is_empty() && !significant.starts_with(|next: char| next.is_ascii_digit()) => {
            &number[zeros.len() - 1..]
        }
        _ => significant,
    }
}

/// Returns the name of an interface if it can stand in a log line.
///
/// # Errors
///
/// Says why it cannot.
pub fn channel(name: &str) -> Result<&str, String> {
    let plain = |letter: char| !letter.is_whitespace() && forbidden(letter).is_none() && letter != '#';
    if name.is_empty() || name.starts_with('(') || !name.chars().all(plain) {
        return Err(format!("the channel {} is no name", quoted(name)));
    }
    short("channel", name, LONGEST_NAME)?;
    Ok(name)
}

/// Refuses what is longer than anybody writes it.
fn short(what: &str, text: &str, most: usize) -> Result<(), String> {
    let count = text.chars().count();
    if count > most {
        return Err(format!("the {what} {} has {count} characters, more than {most}", quoted(text)));
    }
    Ok(())
}

/// Reads `ID#DATA`, and the forms of remote, error and FD frames.
fn read_frame(word: &str) -> Result<(Frame, u8), String> {
    let (id, data) =
        word.split_once('#').ok_or_else(|| format!("{} is no ID#DATA; `candump -L` writes it", quoted(word)))?;
    let (id, extended, error) = identifier(id)?;
    let (form, data, digit) = match (error, data.strip_prefix('#')) {
        (true, _) => (Form::Error, bytes(data, CLASSIC)?, 0),
        (false, Some(rest)) => (Form::Fd, bytes(without_flags(rest)?, FLEXIBLE)?, digit(rest.get(..1))),
        (false, None) if is_remote(data) => (Form::Remote, Vec::new(), digit(data.get(1..))),
        (false, None) => (Form::Data, bytes(data, CLASSIC)?, 0),
    };
    Ok((Frame { id, extended, data, form }, digit))
}

/// Returns the identifier, whether it has 29 bits, and whether it is that of an error frame.
fn identifier(digits: &str) -> Result<(u32, bool, bool), String> {
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| is_hexadecimal(digits));
    let number = number.ok_or_else(|| format!("the identifier {} is not hexadecimal", quoted(digits)))?;
    match digits.len() {
        8 if number <= LARGEST_EXTENDED => Ok((number, true, false)),
        8 if number & !LARGEST_EXTENDED == ERROR_FLAG => Ok((number & LARGEST_EXTENDED, true, true)),
        8 => Err(format!("the identifier {digits} is above 1FFFFFFF, the largest of 29 bits")),
        3 if number <= LARGEST_STANDARD => Ok((number, false, false)),
        3 => Err(format!("the identifier {digits} is above 7FF, the largest of 11 bits")),
        count => Err(format!("the identifier {digits} has {count} digits instead of 3 or 8")),
    }
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

fn bytes(digits: &str, most: usize) -> Result<Vec<u8>, String> {
    if !is_hexadecimal(digits) {
        return Err(format!("the data {} are not hexadecimal", quoted(digits)));
    }
    if !digits.len().is_multiple_of(2) {
        return Err(format!("the data have an odd number of digits, {}", digits.len()));
    }
    if digits.len() / 2 > most {
        return Err(format!("the data have {} bytes, more than {most}", digits.len() / 2));
    }
    let digit = |digit: u8| (digit & 0x0F) + if digit.is_ascii_digit() { 0 } else { 9 };
    let pairs = digits.as_bytes().chunks_exact(2);
    Ok(pairs.map(|pair| pair.iter().fold(0, |byte, &next| byte << 4 | digit(next))).collect())
}

fn is_hexadecimal(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// Shows a text of the log in a message: no control characters, and not too much of it.
fn quoted(text: &str) -> String {
    let shown: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    let more = if text.chars().nth(40).is_some() { "..." } else { "" };
    format!("`{shown}{more}`")
}

/// Writes a data frame as a line of a log, with what it has of stamp and channel.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn write(out: &mut impl Write, time: Option<&str>, channel: Option<&str>, frame: &Frame) -> io::Result<()> {
    if let Some(time) = time {
        write!(out, "({time}) ")?;
    }
    if let Some(channel) = channel {
        write!(out, "{channel} ")?;
    }
    writeln!(out, "{}#{}", identifier_text(frame), hexadecimal(&frame.data))
}

/// Returns the identifier as candump prints it.
pub fn identifier_text(frame: &Frame) -> String {
    let flag = if frame.form == Form::Error { ERROR_FLAG } else { 0 };
    identifier_digits(frame.id | flag, frame.extended)
}

/// Returns an identifier in 8 digits if it has 29 bits, else in 3.
pub fn identifier_digits(id: u32, extended: bool) -> String {
    let width = if extended { 8 } else { 3 };
    format!("{id:0width$X}")
}

/// Returns bytes in upper-case hexadecimal digits.
pub fn hexadecimal(bytes: &[u8]) -> String {
    const DIGITS: [char; 16] = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'A', 'B', 'C', 'D', 'E', 'F'];
    let digits = bytes.iter().flat_map(|byte| [byte >> 4, byte & 0x0F]);
    digits.filter_map(|digit| DIGITS.get(usize::from(digit))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(line: &str) -> Entry<'_> {
        read(line).expect("the line is readable").expect("the line is not blank")
    }

    fn frame(line: &str) -> Frame {
        entry(line).frame
    }

    fn time(line: &str) -> Option<String> {
        entry(line).time.map(|time| time.get().to_owned())
    }

    fn why(line: &str) -> String {
        read(line).expect_err("the line is unreadable")
    }

    #[test]
    fn a_line_of_candump_is_stamp_channel_and_frame() {
        let entry = entry("(1700000000.000000) can0 029C03F0#000B71B000003A98");
        assert_eq!(entry.time.expect("it has a stamp").get(), "1700000000.000000");
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
    fn direction_letters_and_line_ends_are_accepted() {
        for line in ["(1.5) can0 123#00 R", "(1.5) can0 123#00 T\r", " (1.5)  can0\t123#00\r\n"] {
            assert_eq!(frame(line), Frame { id: 0x123, extended: false, data: vec![0], form: Form::Data });
        }
        assert_eq!(why("(1.5) can0 123#00 X"), "`X` after the frame");
        assert_eq!(why("(1.5) can0 123#00 R T"), "`T` after the frame");
    }

    #[test]
    fn blank_lines_are_no_entries() {
        for line in ["", "   ", "\t\r"] {
            assert!(read(line).expect("a blank line is readable").is_none());
        }
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
            ("(1) (2) 123#00", "the channel `(2)` is no name"),
            ("\u{1b}[2J 123#00", "the channel `\\u{1b}[2J` is no name"),
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

    #[test]
    fn a_message_shows_no_control_characters_and_not_too_much() {
        assert_eq!(quoted("\u{1b}[2J"), "`\\u{1b}[2J`");
        assert_eq!(quoted(&"x".repeat(41)), format!("`{}...`", "x".repeat(40)));
    }

    #[test]
    fn a_frame_is_written_as_it_was_read() {
        for line in ["(1.50) can0 029C03F0#000B71B000003A98", "can0 1A5#0AFF", "(7) 00000001#", "7FF#00"] {
            let entry = entry(line);
            let mut out = Vec::new();
            let time = entry.time.as_ref().map(|time| time.get());
            write(&mut out, time, entry.channel, &entry.frame).expect("a vector takes everything");
            assert_eq!(String::from_utf8(out), Ok(format!("{line}\n")));
        }
    }

    #[test]
    fn an_error_frame_keeps_its_flag() {
        assert_eq!(identifier_text(&frame("20000004#00")), "20000004");
    }
}
