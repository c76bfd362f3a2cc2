//! Lines of a log, as `candump -L` writes them.

use std::io::{self, Write};

use canspec_codegen::interpret::{Form, Frame};

use super::part::{CLASSIC, ERROR_FLAG};

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

/// Writes the identifier as candump prints it.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn write_identifier(out: &mut impl Write, frame: &Frame) -> io::Result<()> {
    if frame.extended && frame.form != Form::Error {
        return write_hexadecimal(out, &frame.id.to_be_bytes());
    }
    out.write_all(identifier_text(frame).as_bytes())
}

/// Returns an identifier in 8 digits if it has 29 bits, else in 3.
pub fn identifier_digits(id: u32, extended: bool) -> String {
    if extended { hexadecimal(&id.to_be_bytes()) } else { format!("{id:03X}") }
}

/// Returns bytes in upper-case hexadecimal digits.
pub fn hexadecimal(bytes: &[u8]) -> String {
    String::from_utf8(bytes.iter().flat_map(|byte| digits(*byte)).collect()).unwrap_or_default()
}

/// Writes bytes in upper-case hexadecimal digits.
///
/// # Errors
///
/// Where `out` cannot be written.
pub fn write_hexadecimal(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    for bytes in bytes.chunks(CLASSIC) {
        let mut pairs = [[0; 2]; CLASSIC];
        pairs.iter_mut().zip(bytes).for_each(|(pair, byte)| *pair = digits(*byte));
        out.write_all(&pairs.as_flattened()[..2 * bytes.len()])?;
    }
    Ok(())
}

fn digits(byte: u8) -> [u8; 2] {
    const DIGITS: &[u8; 16] = b"0123456789ABCDEF";
    [byte >> 4, byte & 0x0F].map(|half| DIGITS[usize::from(half)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::Reader;

    #[test]
    fn a_frame_is_written_as_it_was_read() {
        for line in ["(1.50) can0 029C03F0#000B71B000003A98", "can0 1A5#0AFF", "(7) 00000001#", "7FF#00"] {
            let mut reader = Reader::default();
            let entry = reader.read(line).expect("the line is readable").expect("the line is not blank");
            let mut out = Vec::new();
            write(&mut out, entry.time.as_deref(), entry.channel, &entry.frame).expect("a vector takes everything");
            assert_eq!(String::from_utf8(out), Ok(format!("{line}\n")));
        }
    }

    #[test]
    fn an_error_frame_keeps_its_flag() {
        let frame = Frame { id: 4, extended: true, data: Vec::new(), form: Form::Error };
        assert_eq!(identifier_text(&frame), "20000004");
    }
}
