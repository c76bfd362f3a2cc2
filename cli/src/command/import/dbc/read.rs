//! Reads a DBC.

use std::path::Path;

use can_dbc::{Dbc, decode_cp1252};
use can_dbc_pest::{DbcParser, Parser as _, Rule};
use canspec_codegen::source::read_whole;
use pest::error::LineColLocation;

use crate::failure::{Failure, shown};

/// Largest DBC that is read, in bytes.
const LARGEST: usize = 64 << 20;

/// Why bytes are no DBC, and the line of the mistake.
#[derive(Debug, PartialEq, Eq)]
pub struct Refusal {
    pub line: Option<usize>,
    pub why: String,
}

impl From<&str> for Refusal {
    fn from(why: &str) -> Self {
        Self { line: None, why: why.to_owned() }
    }
}

/// Reads a file.
pub fn read(path: &Path) -> Result<Dbc, Failure> {
    let bytes = read_whole(path, LARGEST).map_err(|error| Failure::input(path, &error))?;
    parse(bytes).map_err(|Refusal { line, why }| match line {
        None => Failure::input(path, &why),
        Some(line) => Failure::Input(format!("{}:{line}: {why}", shown(path))),
    })
}

/// Reads bytes in UTF-8, or else in Windows-1252, which most tools write.
pub fn parse(bytes: Vec<u8>) -> Result<Dbc, Refusal> {
    let text = String::from_utf8(bytes).or_else(|error| {
        decode_cp1252(error.as_bytes()).map(Into::into).ok_or("it is neither UTF-8 nor Windows-1252")
    })?;
    let text = text.trim_start_matches('\u{FEFF}');
    let dbc = Dbc::try_from(text)
        .map_err(|error| unreadable(text).unwrap_or_else(|| format!("this is no DBC: {error}").as_str().into()))?;
    impossible_identifier(text).map_or(Ok(dbc), Err)
}

/// Finds the line that the reader's grammar does not allow.
fn unreadable(text: &str) -> Option<Refusal> {
    let (LineColLocation::Pos(place) | LineColLocation::Span(place, _)) =
        DbcParser::parse(Rule::file, text).err()?.line_col;
    let line = place.0;
    let mut before = text.lines().take(line.saturating_sub(1));
    let found = text.lines().nth(line.saturating_sub(1)).unwrap_or_default().trim();
    let why = match found {
        "" => "the statement before this line does not end".to_owned(),
        _ if before.all(|line| line.trim().is_empty()) => {
            format!("this begins with `{found}`, which is no statement of a DBC")
        }
        _ => format!("`{found}` is no statement of a DBC; correct it, or take it out"),
    };
    Some(Refusal { line: Some(line), why })
}

/// Finds a number that is no identifier, because the reader would drop bits of it. The reader's own
/// grammar finds the numbers.
fn impossible_identifier(text: &str) -> Option<Refusal> {
    let words = DbcParser::parse(Rule::file, text).ok()?.flatten();
    let mut identifiers = words.filter(|word| word.as_rule() == Rule::message_id);
    let wrong = identifiers.find(|id| !id.as_str().parse().is_ok_and(is_identifier))?;
    let why = "one of 29 bits has bit 31 set beside it, one of 11 bits is below 2048";
    Some(Refusal { line: Some(wrong.line_col().0), why: format!("{} is no identifier: {why}", wrong.as_str()) })
}

/// Tests for 11 bits, for 29 bits with bit 31, and for the number of the message for signals
/// without a message.
fn is_identifier(number: u64) -> bool {
    number < 0x800 || (0x8000_0000..0xA000_0000).contains(&number) || number == 0xC000_0000
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn a_number_that_is_no_identifier_is_found() {
        let parse = |text: &str| parse(text.as_bytes().to_vec());
        assert!(parse("BO_ 2047 a: 8 x\nBO_ 2684354559 b: 8 x\nBO_ 3221225472 c: 0 x\n").is_ok());
        for number in ["2048", "65537", "2147483647", "2684354560", "4294967295"] {
            let refusal = parse(&format!("BO_ 1 a: 8 x\nBO_ {number} b: 8 x\n")).expect_err("it is refused");
            assert_eq!(refusal.line, Some(2));
            assert!(refusal.why.starts_with(&format!("{number} is no identifier")), "{}", refusal.why);
        }
        assert_eq!(parse("BO_ 4294967296 a: 8 x\n").expect_err("it is refused").line, None);
    }

    #[test]
    fn a_statement_that_no_dbc_has_is_named_with_its_line() {
        let refusal = |text: &str| parse(text.as_bytes().to_vec()).expect_err("it is refused");
        let broken = refusal("BU_: x\nBO_ 1 a: 8 x\n SG_ s : 0|8@1+ (1,0 [0|255] \"\" x\n");
        assert_eq!(broken.line, Some(3));
        let why = "`SG_ s : 0|8@1+ (1,0 [0|255] \"\" x` is no statement of a DBC";
        assert!(broken.why.starts_with(why), "{}", broken.why);
        let unknown = refusal("BU_: x\n\nFOO_ bar;\n");
        assert_eq!(unknown.line, Some(3));
        assert!(unknown.why.contains("`FOO_ bar;`"), "{}", unknown.why);
        let open = refusal("BU_: x\nBO_ 1 a:\n");
        assert_eq!(open.line, Some(2));
        assert!(open.why.starts_with("`BO_ 1 a:` is no statement"), "{}", open.why);
        let other = refusal("\ntime,id,data\n");
        assert_eq!(other.line, Some(2));
        assert_eq!(other.why, "this begins with `time,id,data`, which is no statement of a DBC");
    }
}
