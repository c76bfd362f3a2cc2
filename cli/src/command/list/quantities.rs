//! A table of where quantities are read and set.

use std::io::{self, Write};

use canspec_codegen::model::{Protocol, QuantityPaths, SignalPath};

use crate::show::columns::{self, Row};

/// Writes the table, if there are quantities.
pub fn write(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    let rows: Vec<_> = protocol.quantities.iter().map(|known| row(protocol, known)).collect();
    if rows.is_empty() {
        return Ok(());
    }
    let limit = (!protocol.limits.is_empty()).then_some("LIMIT");
    let headings: Vec<_> = ["QUANTITY", "UNIT"].into_iter().chain(limit).chain(["READ"]).collect();
    writeln!(out)?;
    columns::write(out, &headings, "SET", &rows)
}

fn row(protocol: &Protocol, known: &QuantityPaths) -> Row {
    let QuantityPaths { name, read, set, also, .. } = known;
    let unit = protocol.unit_of(known).map_or_else(String::new, |unit| unit.symbol.to_string());
    let [read, set] = [read, set].map(|path| path.as_ref().map(|path| text(protocol, path)));
    let also = also.iter().map(|also| format!("{}.{}", protocol[also.message].name, also.field));
    let limit = protocol.limit_of(known).map(|limit| format!("{}..{}", limit.range.minimum, limit.range.maximum));
    let limit = (!protocol.limits.is_empty()).then(|| limit.unwrap_or_default());
    let cells = [name.clone(), unit].into_iter().chain(limit).chain([read.unwrap_or_default()]);
    Row { cells: cells.collect(), last: set.into_iter().chain(also).collect(), separator: ", ", ..Row::default() }
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
