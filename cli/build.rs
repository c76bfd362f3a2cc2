//! Compiles the built-in specs, so that the command need not read their YAML at each start.
//!
//! A spec with mistakes is left out. The command compiles it at the start then, and shows the mistakes.

use std::env;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use canspec_codegen::source::Source;
use canspec_codegen::{Bases, compile_proven};
use canspec_specs::{SPECS, Spec};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = PathBuf::from(env::var("OUT_DIR")?);
    let bases: Bases = SPECS.iter().map(|spec| (spec.name, spec.text)).collect();
    let mut table = String::from("&[\n");
    for spec in SPECS {
        if let Some(model) = compiled(spec, &bases)? {
            fs::write(folder.join(spec.name), model)?;
            writeln!(table, "    ({0:?}, include_bytes!(concat!(env!(\"OUT_DIR\"), \"/\", {0:?}))),", spec.name)?;
        }
    }
    table.push_str("]\n");
    Ok(fs::write(folder.join("models.rs"), table)?)
}

/// Returns the stored model of a spec, unless it has mistakes.
fn compiled(spec: &Spec, bases: &Bases) -> Result<Option<Vec<u8>>, postcard::Error> {
    let source = Source::new(spec.file, spec.text.as_bytes().to_vec());
    let protocol = source.and_then(|source| bases.add_to(source)).and_then(compile_proven);
    protocol.ok().map(|protocol| postcard::to_allocvec(&protocol)).transpose()
}
