//! A table of where quantities are read and set.

use std::io::{self, Write};

use canspec_codegen::model::{Protocol, QuantityPaths, SignalPath};

use crate::columns::{self, Row};

/// Writes the table, if there are quantities.
pub fn write(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let rows: Vec<_> = protocol.quantities.iter().map(|known| row(protocol, known)).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out)?;
    columns::write(out, &["QUANTITY", "UNIT", "READ"], "SET", &rows)
}

fn row(protocol: &Protocol, QuantityPaths { name, read, set, .. }: &QuantityPaths) -> Row {
    let known = read.as_ref().or(set.as_ref());
    let unit = known.and_then(|path| protocol.unit_at(path)).map_or_else(String::new, |unit| unit.symbol.to_string());
    let [read, set] = [read, set].map(|path| path.as_ref().map_or_else(String::new, |path| text(protocol, path)));
    Row { cells: vec![name.clone(), unit, read], last: vec![set], separator: " ", ..Row::default() }
}

/// Writes a path, and what a switch is while it is on and off.
fn text(protocol: &Protocol, path: &SignalPath) -> String {
    let states = path.states.map_or_else(String::new, |states| {
        let [inactive, active] = states.map(|bits| state(protocol, path, bits));
        format!(" (active: {active}, inactive: {inactive})")
    });
    protocol.path_text(path) + &states
}

/// Writes a state by its name, or as its raw value.
fn state(protocol: &Protocol, path: &SignalPath, bits: u64) -> String {
    let known = protocol.signal_at(path).encoding.enumeration();
    let named = known.and_then(|id| protocol[id].named(bits));
    named.map_or_else(|| bits.to_string(), |named| named.name.clone())
}
