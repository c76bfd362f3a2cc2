//! Reading a DBC.

use std::fs;
use std::path::Path;

use can_dbc::{Dbc, decode_cp1252};

use crate::failure::Failure;

/// Reads a file in UTF-8 or else in Windows-1252, in which most tools write it.
pub fn read(path: &Path) -> Result<Dbc, Failure> {
    let name = path.display().to_string();
    let bytes = fs::read(path).map_err(|error| Failure::input(&name, &error))?;
    let text = String::from_utf8(bytes)
        .or_else(|error| decode_cp1252(error.as_bytes()).map(Into::into).ok_or("it is neither UTF-8 nor Windows-1252"))
        .map_err(|error| Failure::input(&name, &error))?;
    if let Some(number) = impossible_identifier(&text) {
        let why =
            format!("{number} is no identifier: one of 29 bits has bit 31 set beside it, one of 11 bits is below 2048");
        return Err(Failure::input(&name, &why));
    }
    let text = text.trim_start_matches('\u{FEFF}');
    Dbc::try_from(text).map_err(|error| Failure::input(&name, &format!("this is no DBC\n{error}")))
}

/// Finds the number of a message that is no identifier, of which the reader would drop bits.
fn impossible_identifier(text: &str) -> Option<&str> {
    let messages = text.lines().filter_map(|line| line.trim_start().strip_prefix("BO_ "));
    let mut numbers = messages.filter_map(|line| line.split_whitespace().next());
    numbers.find(|number| number.parse::<u64>().is_ok_and(|id| !is_identifier(id)))
}

/// Tests for 11 bits, for 29 bits beside bit 31, and for the number of the message of signals that belong to none.
fn is_identifier(number: u64) -> bool {
    number < 0x800 || (0x8000_0000..0xA000_0000).contains(&number) || number == 0xC000_0000
}

#[cfg(test)]
mod tests {
    use super::impossible_identifier;

    #[test]
    fn a_number_that_is_no_identifier_is_found() {
        assert_eq!(impossible_identifier("BO_ 2047 a: 8 x\nBO_ 2684354559 b: 8 x\nBO_ 3221225472 c: 0 x"), None);
        for number in ["2048", "65537", "2147483647", "2684354560", "4294967295", "4294967296"] {
            assert_eq!(impossible_identifier(&format!("BO_ 1 a: 8 x\nBO_ {number} b: 8 x")), Some(number));
        }
    }
}
