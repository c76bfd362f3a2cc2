//! What a build script tells cargo.

use std::io;
use std::path::PathBuf;

use crate::diagnostic::{Diagnostics, Located};

/// Asks to run the build script again when one of the paths changes, and what is in it.
pub fn rerun<'a>(paths: impl Iterator<Item = &'a PathBuf>) -> Vec<String> {
    paths.map(|path| format!("cargo::rerun-if-changed={}", path.display())).collect()
}

/// Reports each diagnostic with its place, in a line.
pub fn diagnostics(diagnostics: &Diagnostics) -> Vec<String> {
    diagnostics.located().map(|found| diagnostic(&found)).collect()
}

fn diagnostic(found: &Located) -> String {
    let help = found.help.map(|help| format!("; help: {help}"));
    format!("cargo::{}={found}{}", found.severity, help.unwrap_or_default())
}

/// Reports that the generated code cannot be written.
pub fn unwritten(error: &io::Error) -> String {
    format!("cargo::error=the generated code cannot be written: {error}")
}
