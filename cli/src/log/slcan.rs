//! Lines of SLCAN, the format of serial adapters: `tIIILDD..`, with a stamp of four digits where the adapter gives one.

use canspec_codegen::interpret::{Form, Frame};

use super::Entry;
use super::part::{Stamp, bytes, identifier, is_hexadecimal, moved, owned, quoted};

/// Milliseconds at which the stamps begin anew.
const MINUTE: u32 = 60_000;

/// Tests for a letter with nothing but digits behind it.
pub fn shows(line: &str) -> bool {
    let line = line.split('\r').next().unwrap_or_default().trim_ascii();
    line.len() > 4 && line.strip_prefix(['t', 'T', 'r', 'R']).is_some_and(is_hexadecimal)
}

/// Reads a line that is not blank; the answers of an adapter have no frame.
pub fn read(line: &str) -> Result<Option<Entry<'_>>, String> {
    let line = line.trim_matches([' ', '\r', '\t', '\u{7}']);
    if ["", "z", "Z"].contains(&line) {
        return Ok(None);
    }
    if line.contains('\r') {
        return Err("carriage returns end the frames of this line; make lines of them with `tr '\\r' '\\n'`".to_owned());
    }
    let (letter, rest) = line.split_at_checked(1).unwrap_or_default();
    let (form, width) = match letter {
        "t" => (Form::Data, 3),
        "T" => (Form::Data, 8),
        "r" => (Form::Remote, 3),
        "R" => (Form::Remote, 8),
        _ => return Err(format!("{} is no frame of SLCAN, which begins with t, T, r or R", quoted(line))),
    };
    let (digits, rest) = rest.split_at_checked(width).ok_or_else(|| short(line))?;
    let (id, extended, error) = identifier(digits)?;
    if error {
        return Err(format!("the identifier {digits} is above 1FFFFFFF, the largest of 29 bits"));
    }
    let (count, rest) = rest.split_at_checked(1).ok_or_else(|| short(line))?;
    let count: u8 = count
        .parse()
        .ok()
        .filter(|count| *count <= 8)
        .ok_or_else(|| format!("the length {} is no digit from 0 to 8", quoted(count)))?;
    let (data, time) = if form == Form::Data {
        rest.split_at_checked(usize::from(count) * 2).ok_or_else(|| short(line))?
    } else {
        ("", rest)
    };
    let (data, time) = (bytes(data, 8)?, stamp(time)?);
    let digit = if form == Form::Remote { count } else { 0 };
    Ok(Some(Entry { time, channel: None, frame: Frame { id, extended, data, form }, digit }))
}

fn short(line: &str) -> String {
    format!("{} ends before its data do", quoted(line))
}

/// Reads milliseconds in four digits.
fn stamp(digits: &str) -> Result<Option<Stamp<'static>>, String> {
    if digits.is_empty() {
        return Ok(None);
    }
    let milliseconds = u32::from_str_radix(digits, 16).ok();
    let milliseconds = milliseconds.filter(|time| digits.len() == 4 && is_hexadecimal(digits) && *time < MINUTE);
    let refusal = || format!("{} after the data is no stamp, four hexadecimal digits below EA60", quoted(digits));
    moved(&milliseconds.ok_or_else(refusal)?.to_string(), 3).map(owned).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{hexadecimal, identifier_text};

    #[test]
    fn frames_have_a_letter_an_identifier_a_length_and_data() {
        // Lines of the LAWICEL CAN232 manual and of `slcan.c` of Linux; 0x1234 is 4,660.
        let lines = [
            ("t1234567855AA", Form::Data, "123", "567855AA", None, 0),
            ("t10021133", Form::Data, "100", "1133", None, 0),
            ("T0000010021133\r", Form::Data, "00000100", "1133", None, 0),
            ("T1FFFFFFF0", Form::Data, "1FFFFFFF", "", None, 0),
            ("t12321122EA5F", Form::Data, "123", "1122", Some("59.999"), 0),
            ("t123011A4", Form::Data, "123", "", Some("4.516"), 0),
            ("r1005", Form::Remote, "100", "", None, 5),
            ("R0000010000001", Form::Remote, "00000100", "", Some("0.001"), 0),
        ];
        for (line, form, id, data, time, digit) in lines {
            let entry = read(line).expect("the line is readable").expect("the line has a frame");
            assert_eq!((entry.frame.form, identifier_text(&entry.frame).as_str()), (form, id), "{line}");
            assert_eq!((hexadecimal(&entry.frame.data).as_str(), entry.digit), (data, digit), "{line}");
            assert_eq!(entry.time.as_deref(), time, "{line}");
        }
    }

    #[test]
    fn answers_of_the_adapter_are_no_frames() {
        for line in ["z", "Z\r", "\u{7}"] {
            assert!(read(line).expect("it is skipped").is_none(), "{line:?}");
        }
    }

    #[test]
    fn an_unreadable_line_says_why() {
        let reasons = [
            ("t123911", "the length `9` is no digit from 0 to 8"),
            ("t12321", "`t12321` ends before its data do"),
            ("t8000", "the identifier 800 is above 7FF, the largest of 11 bits"),
            ("T200000040", "the identifier 20000004 is above 1FFFFFFF, the largest of 29 bits"),
            ("t1230EA60", "`EA60` after the data is no stamp, four hexadecimal digits below EA60"),
            ("t12301", "`1` after the data is no stamp, four hexadecimal digits below EA60"),
            ("t1230\rt1230", "carriage returns end the frames of this line; make lines of them with `tr '\\r' '\\n'`"),
            ("é", "`é` is no frame of SLCAN, which begins with t, T, r or R"),
        ];
        for (line, reason) in reasons {
            assert_eq!(read(line).expect_err("it is refused"), reason, "{line}");
        }
    }
}
