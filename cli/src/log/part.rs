//! What the lines of all formats are made of: stamps, channels, identifiers and data.

use std::borrow::Cow;

use canspec_codegen::interpret::{Form, Frame};
use canspec_codegen::source::forbidden;
use serde_json::value::RawValue;

/// Set in the printed identifier of an error frame.
pub const ERROR_FLAG: u32 = 1 << 29;
pub const LARGEST_EXTENDED: u32 = 0x1FFF_FFFF;
pub const LARGEST_STANDARD: u32 = 0x7FF;
/// Data bytes of a classic and of an FD frame.
pub const CLASSIC: usize = 8;
pub const FLEXIBLE: usize = 64;
/// Characters of the name of an interface, which has 15 on Linux, and of a stamp.
pub const LONGEST_NAME: usize = 64;

/// The seconds of a line: the text of a number of JSON.
pub type Stamp<'a> = Cow<'a, str>;

/// Keeps a stamp whose text is dropped.
pub fn owned<'a>(stamp: Stamp<'_>) -> Stamp<'a> {
    Cow::Owned(stamp.into_owned())
}

/// Reads `(SECONDS)`.
pub fn stamp(word: &str) -> Result<Stamp<'_>, String> {
    let refusal = || format!("the stamp {} is no number in parentheses", quoted(word));
    let seconds = word.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).ok_or_else(refusal)?;
    short("stamp", word, LONGEST_NAME + "()".len())?;
    number(seconds, word, refusal)
}

/// Reads seconds without parentheses.
pub fn seconds(word: &str) -> Result<Stamp<'_>, String> {
    short("stamp", word, LONGEST_NAME)?;
    number(word, word, || format!("the stamp {} is no number", quoted(word)))
}

/// Reads a number as JSON has it, but for leading zeros. `word` is short, so only an exponent makes it infinite.
fn number<'a>(text: &'a str, word: &str, refusal: impl FnOnce() -> String) -> Result<Stamp<'a>, String> {
    let text = without_leading_zeros(text);
    if is_decimal(text.as_bytes()) {
        return Ok(Cow::Borrowed(text));
    }
    let value = serde_json::from_str::<&RawValue>(text).ok().filter(|value| is_number(value));
    let value = value.ok_or_else(refusal)?.get();
    if is_finite(value) {
        Ok(Cow::Borrowed(value))
    } else {
        Err(format!("the stamp {} is larger than any number of JSON", quoted(word)))
    }
}

/// Returns a number of smaller units in seconds, by moving its point to the left.
pub fn moved(word: &str, places: usize) -> Result<Stamp<'_>, String> {
    let (sign, digits) = word.split_at(usize::from(word.starts_with('-')));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let is_plain = |digits: &str| digits.len() <= LONGEST_NAME && digits.bytes().all(|digit| digit.is_ascii_digit());
    if places == 0 || whole.is_empty() || !is_plain(whole) || !is_plain(fraction) {
        return seconds(word);
    }
    let filled = format!("{whole:0>width$}", width = places + 1);
    let (whole, moved) = filled.split_at(filled.len() - places);
    seconds(&format!("{sign}{whole}.{moved}{fraction}")).map(owned)
}

/// Reads a date and a time of day as seconds since 1970. Without an offset at its end the time is that of UTC.
pub fn date(date: &str, time: &str) -> Result<Stamp<'static>, String> {
    let refusal = || format!("the stamp {} is no date with a time", quoted(&format!("{date} {time}")));
    let [year, month, day] = numbers(date, '-').filter(is_day).ok_or_else(refusal)?;
    let (time, offset) = without_offset(time).ok_or_else(refusal)?;
    let (time, fraction) = time.split_once('.').unwrap_or((time, ""));
    let [hour, minute, second] = numbers(time, ':').filter(is_time).ok_or_else(refusal)?;
    let is_fraction = fraction.bytes().all(|digit| digit.is_ascii_digit());
    let total = ((days(year, month, day) * 24 + hour) * 60 + minute - offset) * 60 + second;
    let point = if fraction.is_empty() { "" } else { "." };
    let is_since_1970 = total >= 0;
    if is_fraction && is_since_1970 { seconds(&format!("{total}{point}{fraction}")).map(owned) } else { Err(refusal()) }
}

/// Splits `Z`, `+HH:MM`, `+HHMM` or `+HH` from a time of day, and returns the minutes that it is ahead of UTC.
fn without_offset(time: &str) -> Option<(&str, i64)> {
    if let Some(time) = time.strip_suffix('Z') {
        return Some((time, 0));
    }
    let Some(start) = time.find(['+', '-']) else { return Some((time, 0)) };
    let (time, offset) = time.split_at(start);
    let (sign, digits) = offset.split_at(1);
    let (hours, minutes) = match digits.len() {
        5 => digits.split_once(':')?,
        4 => digits.split_at_checked(2)?,
        _ => (digits, "00"),
    };
    let number = |digits: &str, end: i64| -> Option<i64> {
        let is_number = digits.len() == 2 && digits.bytes().all(|digit| digit.is_ascii_digit());
        digits.parse().ok().filter(|number| is_number && *number < end)
    };
    let ahead = number(hours, 24)? * 60 + number(minutes, 60)?;
    Some((time.trim_ascii_end(), if sign == "-" { -ahead } else { ahead }))
}

fn is_day([year, month, day]: &[i64; 3]) -> bool {
    (1970..=9999).contains(year) && (1..=12).contains(month) && (1..=31).contains(day)
}

fn is_time([hour, minute, second]: &[i64; 3]) -> bool {
    (0..24).contains(hour) && (0..60).contains(minute) && (0..=60).contains(second)
}

/// Splits three numbers from one another.
fn numbers(text: &str, separator: char) -> Option<[i64; 3]> {
    let number = |digits: &str| digits.parse().ok().filter(|_| digits.bytes().all(|digit| digit.is_ascii_digit()));
    let numbers: Vec<i64> = text.split(separator).map(number).collect::<Option<_>>()?;
    numbers.try_into().ok()
}

/// Returns the days from 1970 to a date.
fn days(year: i64, month: i64, day: i64) -> i64 {
    // The year begins with March here, so that the day that only leap years have is its last.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year / 4 - year / 100 + year / 400;
    year * 365 + leap_days + (month * 153 + 2) / 5 + day - 1 - 719_468
}

/// Tests for digits with at most one point between them.
fn is_decimal(text: &[u8]) -> bool {
    let are_digits = |text: &[u8]| !text.is_empty() && text.iter().all(u8::is_ascii_digit);
    match text.iter().position(|byte| *byte == b'.') {
        Some(point) => are_digits(&text[..point]) && are_digits(&text[point + 1..]),
        None => are_digits(text),
    }
}

/// Tests for seconds that JSON has as they are: digits with a point between them, and no zero before them.
pub fn is_usual_stamp(text: &str) -> bool {
    let others = |text: &str| text.bytes().position(|byte| !byte.is_ascii_digit());
    let point = others(text).filter(|point| *point > 0 && !text.starts_with('0'));
    let fraction = point.and_then(|point| text[point..].strip_prefix('.'));
    fraction.is_some_and(|fraction| !fraction.is_empty() && others(fraction).is_none())
}

/// Tests whether JSON is a number.
pub fn is_number(value: &RawValue) -> bool {
    value.get().starts_with(|first: char| first == '-' || first.is_ascii_digit())
}

/// Tests whether a number is one for readers of JSON that know doubles alone.
pub fn is_finite(number: &str) -> bool {
    number.parse().is_ok_and(f64::is_finite)
}

/// candump fills up seconds with zeros, which JSON does not allow.
fn without_leading_zeros(number: &str) -> &str {
    if !number.starts_with('0') {
        return number;
    }
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
    let is_usual = name.bytes().all(|byte| byte.is_ascii_alphanumeric());
    let plain = |letter: char| !letter.is_whitespace() && forbidden(letter).is_none() && letter != '#';
    if name.is_empty() || name.starts_with('(') || !(is_usual || name.chars().all(plain)) {
        let rule = "a name has no blanks, no `#` and nothing invisible, and does not begin with `(`";
        return Err(format!("the channel {} is no name; {rule}", quoted(name)));
    }
    short("channel", name, LONGEST_NAME)?;
    Ok(name)
}

/// Refuses what is longer than anybody writes it.
fn short(what: &str, text: &str, most: usize) -> Result<(), String> {
    // There are at least as many bytes as characters.
    let count = if text.len() > most { text.chars().count() } else { 0 };
    if count > most {
        return Err(format!("the {what} {} has {count} characters, more than {most}", quoted(text)));
    }
    Ok(())
}

/// Returns the identifier, whether it has 29 bits, and whether it is that of an error frame.
pub fn identifier(digits: &str) -> Result<(u32, bool, bool), String> {
    let number = hexadecimal(digits).ok_or_else(|| format!("the identifier {} is not hexadecimal", quoted(digits)))?;
    match digits.len() {
        8 if number & !LARGEST_EXTENDED == ERROR_FLAG => Ok((number & LARGEST_EXTENDED, true, true)),
        8 => fitting(number, true, digits).map(|number| (number, true, false)),
        3 => fitting(number, false, digits).map(|number| (number, false, false)),
        count => Err(format!("the identifier {digits} has {count} digits instead of 3 or 8")),
    }
}

/// Makes a data frame of the digits of its identifier and of its data.
pub fn data_frame(id: &str, data: &str) -> Result<Frame, String> {
    let (id, extended, error) = identifier(id)?;
    if error {
        return Err("an error frame has no data to send".to_owned());
    }
    Ok(Frame { id, extended, data: bytes(data, CLASSIC)?, form: Form::Data })
}

/// Refuses an identifier that its bits have no room for.
pub fn fitting(number: u32, extended: bool, digits: &str) -> Result<u32, String> {
    match extended {
        true if number > LARGEST_EXTENDED => {
            Err(format!("the identifier {digits} is above 1FFFFFFF, the largest of 29 bits"))
        }
        false if number > LARGEST_STANDARD => {
            Err(format!("the identifier {digits} is above 7FF, the largest of 11 bits"))
        }
        _ => Ok(number),
    }
}

/// The value of each hexadecimal digit; what is none has more bits.
const VALUES: [u8; 256] = {
    let mut values = [u8::MAX; 256];
    let digits = b"0123456789ABCDEFabcdef";
    let mut index: u8 = 0;
    while (index as usize) < digits.len() {
        values[digits[index as usize] as usize] = if index < 16 { index } else { index - 6 };
        index += 1;
    }
    values
};

/// Reads a number of 32 bits in hexadecimal digits.
pub fn hexadecimal(digits: &str) -> Option<u32> {
    if let Ok(digits) = digits.as_bytes().try_into() {
        return eight_digits(digits);
    }
    let number = digits.bytes().try_fold(0, |number, digit| {
        let value = VALUES[usize::from(digit)];
        (value < 16 && number >> 28 == 0).then(|| number << 4 | u32::from(value))
    });
    number.filter(|_| !digits.is_empty())
}

/// Reads eight hexadecimal digits, which are tested all at once.
fn eight_digits(digits: [u8; 8]) -> Option<u32> {
    let values = digits.map(|digit| VALUES[usize::from(digit)]);
    let number = values.iter().fold(0, |number, value| number << 4 | u32::from(value & 0x0F));
    (values.iter().fold(0, |seen, value| seen | value) < 16).then_some(number)
}

/// Reads data in hexadecimal digits without anything between them.
pub fn bytes(digits: &str, most: usize) -> Result<Vec<u8>, String> {
    match even_bytes(digits) {
        Some(bytes) => fewer(bytes.len(), most).map(|()| bytes),
        None if is_hexadecimal(digits) => Err(format!("the data have an odd number of digits, {}", digits.len())),
        None => Err(format!("the data {} are not hexadecimal", quoted(digits))),
    }
}

/// Reads data of any length; `None` from what is not hexadecimal or has half a byte.
pub fn even_bytes(digits: &str) -> Option<Vec<u8>> {
    let (pairs, odd) = digits.as_bytes().as_chunks();
    let mut seen = 0;
    let byte = |[high, low]: &[u8; 2]| {
        let [high, low] = [high, low].map(|digit| VALUES[usize::from(*digit)]);
        seen |= high | low;
        high << 4 | low & 0x0F
    };
    let bytes = pairs.iter().map(byte).collect();
    (odd.is_empty() && seen <= 0x0F).then_some(bytes)
}

/// Refuses data that no frame has room for.
pub fn fewer(count: usize, most: usize) -> Result<(), String> {
    if count > most { Err(format!("the data have {count} bytes, more than {most}")) } else { Ok(()) }
}

/// Refuses another number of bytes than the line itself says.
pub fn as_many(said: usize, count: usize) -> Result<(), String> {
    if said == count { Ok(()) } else { Err(format!("the line says that there are {said} data bytes, and has {count}")) }
}

pub fn is_hexadecimal(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// Shows a text of the log in a message: no control characters, and not too much of it.
pub fn quoted(text: &str) -> String {
    let shown: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    let more = if text.chars().nth(40).is_some() { "..." } else { "" };
    format!("`{shown}{more}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(value: Result<Stamp<'_>, String>) -> Result<String, String> {
        value.map(Stamp::into_owned)
    }

    #[test]
    fn a_date_is_seconds_since_1970() {
        // The numbers are those of `date -u -d DATE +%s`.
        let dates = [
            ("1970-01-01", "00:00:00", "0"),
            ("2000-02-29", "23:59:59.25", "951868799.25"),
            ("2023-11-14", "22:13:20.000000", "1700000000.000000"),
            ("2100-03-01", "00:00:00", "4107542400"),
            ("2023-11-14", "22:13:20.5Z", "1700000000.5"),
            ("2023-11-14", "23:13:20.5+01:00", "1700000000.5"),
            ("2023-11-14", "16:43:20-0530", "1700000000"),
            ("2023-11-15", "08:13:20 +10", "1700000000"),
            ("1970-01-01", "01:00:00+01:00", "0"),
        ];
        for (day, time, seconds) in dates {
            assert_eq!(text(date(day, time)), Ok(seconds.to_owned()), "{day} {time}");
        }
        let refused = [
            ("2023-13-01", "0:0:0"),
            ("2023-11", "0:0:0"),
            ("2023-11-14", "24:00:00"),
            ("2023-11-14", "1:2:3.x"),
            ("2023-11-14", "1:2:3ZZ"),
            ("2023-11-14", "1:2:3+1"),
            ("2023-11-14", "1:2:3+24:00"),
            ("2023-11-14", "1:2:3+01:60"),
            ("2023-11-14", "1:2:3+0°0"),
            ("1970-01-01", "0:59:59.5+01:00"),
        ];
        for (day, time) in refused {
            assert_eq!(text(date(day, time)), Err(format!("the stamp `{day} {time}` is no date with a time")));
        }
    }

    #[test]
    fn smaller_units_become_seconds_without_arithmetic() {
        let cases =
            [("1234", 3, "1.234"), ("7", 3, "0.007"), ("-7.5", 3, "-0.0075"), ("0", 6, "0.000000"), ("1.5", 0, "1.5")];
        for (word, places, expected) in cases {
            assert_eq!(text(moved(word, places)), Ok(expected.to_owned()), "{word}");
        }
        assert_eq!(text(moved("x°y", 3)), Err("the stamp `x°y` is no number".to_owned()));
    }

    #[test]
    fn a_message_shows_no_control_characters_and_not_too_much() {
        assert_eq!(quoted("\u{1b}[2J"), "`\\u{1b}[2J`");
        assert_eq!(quoted(&"x".repeat(41)), format!("`{}...`", "x".repeat(40)));
    }
}
