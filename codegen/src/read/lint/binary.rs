#![doc = include_str!("../../../docs/rules/binary.md")]

use super::Written;
use super::table::Table;
use crate::report::diagnostic::Diagnostic;
use crate::report::rule::rules;

rules! {
    BINARY "binary" Lint WARNING;
}

pub fn lint(written: &Written) -> Vec<Diagnostic> {
    written.tables.iter().filter(|table| table.kind == "values").filter_map(binary).collect()
}

fn binary(table: &Table) -> Option<Diagnostic> {
    let (first, _) = table.entries.first()?;
    let is_binary = |key: &String| key.len() == first.len() && key.bytes().all(|digit| matches!(digit, b'0' | b'1'));
    let is_padded = first.len() > 1 && table.entries.keys().any(|key| key.starts_with('0'));
    if !is_padded || !table.entries.keys().all(is_binary) {
        return None;
    }
    let shown = table.entries.keys().find(|key| !key.starts_with('0')).unwrap_or(first);
    let text = format!("`{shown}` is a decimal number here, and these look binary");
    let help = format!("write `0b{shown}` if the document means bits, else decimals without leading zeros");
    Some(Diagnostic::warning(&BINARY, table.path.key(shown).at_key(), text).help(help))
}
