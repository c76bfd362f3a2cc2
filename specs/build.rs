//! Lists the spec files of this folder as a Rust table, so that a new one needs no line of code.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let target = PathBuf::from(env::var("OUT_DIR")?).join("specs.rs");
    println!("cargo::rerun-if-changed={}", folder.display());
    let table = table(&specs(&folder)?)?;
    if fs::read_to_string(&target).ok().as_deref() != Some(&table) {
        fs::write(target, table)?;
    }
    Ok(())
}

/// Returns the spec files of a folder, sorted by name.
fn specs(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut specs = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_file() && path.extension().is_some_and(|extension| extension == "yaml") {
            specs.push(path);
        }
    }
    specs.sort();
    Ok(specs)
}

fn table(specs: &[PathBuf]) -> Result<String, Box<dyn Error>> {
    let mut table = String::from("&[\n");
    for spec in specs {
        let text = |part: Option<&std::ffi::OsStr>| part.and_then(|part| part.to_str()).map(str::to_owned);
        let (Some(name), Some(file), Some(path)) = (text(spec.file_stem()), text(spec.file_name()), spec.to_str())
        else {
            return Err(format!("{} has a name that is not UTF-8", spec.display()).into());
        };
        println!("cargo::rerun-if-changed={path}");
        writeln!(table, "    Spec {{ name: {name:?}, file: {file:?}, text: include_str!({path:?}) }},")?;
    }
    table.push_str("]\n");
    Ok(table)
}
