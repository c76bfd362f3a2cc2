//! Reading a DBC.

use std::fmt::Display;
use std::fs;
use std::path::Path;

use can_dbc::{Dbc, decode_cp1252};
use can_dbc_pest::{DbcParser, Parser as _, Rule};

use crate::failure::{Failure, shown};

/// Reads a file in UTF-8 or else in Windows-1252, in which most tools write it.
pub fn read(path: &Path) -> Result<Dbc, Failure> {
    let refused = |error: &dyn Display| Failure::input(path, &error);
    let bytes = fs::read(path).map_err(|error| refused(&error))?;
    let text = String::from_utf8(bytes)
        .or_else(|error| decode_cp1252(error.as_bytes()).map(Into::into).ok_or("it is neither UTF-8 nor Windows-1252"))
        .map_err(|error| refused(&error))?;
    parse(&text).map_err(|refusal| match refusal {
        Refusal::NoDbc(why) => refused(&format_args!("this is no DBC\n{why}")),
        Refusal::Identifier { line, number } => {
            let why = "one of 29 bits has bit 31 set beside it, one of 11 bits is below 2048";
            Failure::Input(format!("{}:{line}: {number} is no identifier: {why}", shown(path)))
        }
    })
}

/// Why a text is not read.
#[derive(Debug, PartialEq, Eq)]
pub enum Refusal {
    NoDbc(String),
    Identifier { line: usize, number: String },
}

/// Reads a text.
pub fn parse(text: &str) -> Result<Dbc, Refusal> {
    let text = text.trim_start_matches('\u{FEFF}');
    let dbc = Dbc::try_from(text).map_err(|error| Refusal::NoDbc(error.to_string()))?;
    impossible_identifier(text).map_or(Ok(dbc), Err)
}

/// Finds a number that is no identifier, and of which the reader drops bits; its own grammar says where they stand.
fn impossible_identifier(text: &str) -> Option<Refusal> {
    let words = DbcParser::parse(Rule::file, text).ok()?.flatten();
    let mut identifiers = words.filter(|word| word.as_rule() == Rule::message_id);
    let wrong = identifiers.find(|id| !id.as_str().parse().is_ok_and(is_identifier))?;
    Some(Refusal::Identifier { line: wrong.line_col().0, number: wrong.as_str().to_owned() })
}

/// Tests for 11 bits, for 29 bits beside bit 31, and for the number of the message of signals that belong to none.
fn is_identifier(number: u64) -> bool {
    number < 0x800 || (0x8000_0000..0xA000_0000).contains(&number) || number == 0xC000_0000
}

#[cfg(test)]
mod tests {
    use super::{Refusal, parse};

    #[test]
    fn a_number_that_is_no_identifier_is_found() {
        assert!(parse("BO_ 2047 a: 8 x\nBO_ 2684354559 b: 8 x\nBO_ 3221225472 c: 0 x\n").is_ok());
        for number in ["2048", "65537", "2147483647", "2684354560", "4294967295"] {
            let refusal = Refusal::Identifier { line: 2, number: number.to_owned() };
            assert_eq!(parse(&format!("BO_ 1 a: 8 x\nBO_ {number} b: 8 x\n")), Err(refusal));
        }
        assert!(matches!(parse("BO_ 4294967296 a: 8 x\n"), Err(Refusal::NoDbc(_))));
    }
}
