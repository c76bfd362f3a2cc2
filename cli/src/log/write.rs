//! Lines of a log, as `candump -L` writes them.

use std::io::{self, Write};

use canspec_codegen::interpret::{Form, Frame};

use super::part::ERROR_FLAG;

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
pub fn write_identifier(out: &mut Vec<u8>, frame: &Frame) {
    if frame.extended && frame.form != Form::Error {
        out.extend_from_slice(&eight_digits(frame.id.to_be_bytes()));
    } else {
        out.extend_from_slice(identifier_text(frame).as_bytes());
    }
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
pub fn write_hexadecimal(out: &mut Vec<u8>, bytes: &[u8]) {
    let (whole, rest) = bytes.as_chunks();
    for bytes in whole {
        out.extend_from_slice(&eight_digits(*bytes));
    }
    for byte in rest {
        out.extend_from_slice(&digits(*byte));
    }
}

/// Returns the digits of four bytes, which are made all at once.
fn eight_digits(bytes: [u8; 4]) -> [u8; 8] {
    const ONES: u64 = 0x0101_0101_0101_0101;
    // Half a byte goes into each byte.
    let halves = u64::from(u32::from_be_bytes(bytes));
    let halves = (halves << 16 | halves) & 0x0000_FFFF_0000_FFFF;
    let halves = (halves << 8 | halves) & 0x00FF_00FF_00FF_00FF;
    let halves = (halves << 4 | halves) & 0x0F0F_0F0F_0F0F_0F0F;
    // Six more than 10 or above has bit 4 set.
    let letters = (halves + 6 * ONES) >> 4 & ONES;
    (halves + u64::from(b'0') * ONES + letters * u64::from(b'A' - b'9' - 1)).to_be_bytes()
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
    fn bytes_have_the_digits_that_the_standard_library_writes() {
        let bytes: Vec<u8> = (0..=u8::MAX).chain([7, 0xA9, 0xFE]).collect();
        for length in [0, 1, 3, 4, 5, 8, 64, bytes.len()] {
            let mut out = Vec::new();
            write_hexadecimal(&mut out, &bytes[..length]);
            let expected: Vec<_> = bytes[..length].iter().map(|byte| format!("{byte:02X}")).collect();
            assert_eq!(String::from_utf8(out), Ok(expected.concat()));
        }
    }

    #[test]
    fn an_error_frame_keeps_its_flag() {
        let frame = Frame { id: 4, extended: true, data: Vec::new(), form: Form::Error };
        assert_eq!(identifier_text(&frame), "20000004");
    }
}
