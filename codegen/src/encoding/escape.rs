//! Texts as people and specs write them: control characters and backslashes are escapes.

use std::fmt::Write;

/// Writes a text with `\n`, `\r`, `\t`, `\\`, and `\x1B` for any other control character.
///
/// ```
/// use canspec_codegen::interpret::escape;
///
/// assert_eq!(escape::written("A\\B\r\n\u{1B}"), r"A\\B\r\n\x1B");
/// assert_eq!(escape::read(r"A\\B\r\n\x1B").as_deref(), Ok("A\\B\r\n\u{1B}"));
/// ```
pub fn written(text: &str) -> String {
    let mut written = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '\\' => written.push_str(r"\\"),
            '\n' => written.push_str(r"\n"),
            '\r' => written.push_str(r"\r"),
            '\t' => written.push_str(r"\t"),
            _ if letter.is_control() => {
                let _ = write!(written, r"\x{:02X}", u32::from(letter));
            }
            _ => written.push(letter),
        }
    }
    written
}

/// Reads a text with escapes. `\x` and two hexadecimal digits are any ASCII character.
///
/// # Errors
///
/// A backslash begins no escape.
pub fn read(text: &str) -> Result<String, String> {
    let mut parts = text.split('\\');
    let mut read = parts.next().unwrap_or_default().to_owned();
    while let Some(part) = parts.next() {
        // Two backslashes have nothing between them.
        let (letter, rest) = match part.chars().next() {
            None => ('\\', parts.next().ok_or_else(|| no_escape(text))?),
            Some(_) => character(part).ok_or_else(|| no_escape(text))?,
        };
        read.push(letter);
        read.push_str(rest);
    }
    Ok(read)
}

/// Returns the character that stands behind a backslash, and what follows it.
fn character(part: &str) -> Option<(char, &str)> {
    let (letter, rest) = part.split_at_checked(1)?;
    match letter {
        "n" => Some(('\n', rest)),
        "r" => Some(('\r', rest)),
        "t" => Some(('\t', rest)),
        "x" => {
            let (digits, rest) = rest.split_at_checked(2)?;
            let [byte] = *crate::words::hex::bytes(digits)? else { return None };
            byte.is_ascii().then_some((byte.into(), rest))
        }
        _ => None,
    }
}

fn no_escape(text: &str) -> String {
    format!(r"a backslash of `{text}` begins no escape; write `\\`, `\n`, `\r`, `\t`, or `\x1B` by its number")
}

#[cfg(test)]
mod tests {
    use super::{read, written};

    #[test]
    fn every_ascii_text_of_two_characters_comes_back() {
        for first in 0..128_u8 {
            for second in 0..128_u8 {
                let text = String::from_utf8(vec![first, second]).expect("ASCII");
                let shown = written(&text);
                assert!(shown.bytes().all(|byte| matches!(byte, b' '..=b'~')), "{shown:?}");
                assert_eq!(read(&shown), Ok(text));
            }
        }
    }

    #[test]
    fn what_is_no_escape_is_refused() {
        for text in [r"\", r"A\", r"\\\", r"\q", r"\x", r"\x1", r"\x1G", r"\x80", r"\xé", r"\é", r"\u{1B}"] {
            assert!(read(text).is_err(), "{text}");
        }
        assert_eq!(read(r"\x1b\x41\\n").as_deref(), Ok("\u{1B}A\\n"));
    }
}
