//! The lines that a build script prints for cargo.

use std::fmt::Display;
use std::io;
use std::path::PathBuf;

use crate::report::diagnostic::{Diagnostics, Located};
use crate::words::visible::visible;

/// Asks to run the build script again when one of the paths or its content changes.
///
/// Cargo cannot find a path that does not fit a line. It then runs the build script each time.
pub fn rerun<'a>(paths: impl Iterator<Item = &'a PathBuf>) -> Vec<String> {
    paths.map(|path| directive("rerun-if-changed", path.display())).collect()
}

/// Reports each diagnostic with its place, in one line.
pub fn diagnostics(diagnostics: &Diagnostics) -> Vec<String> {
    diagnostics.located().map(|found| diagnostic(&found)).collect()
}

fn diagnostic(found: &Located) -> String {
    let help = found.help.map(|help| format!("; help: {help}")).unwrap_or_default();
    directive(&found.severity.to_string(), format_args!("{found}{help}"))
}

/// Reports that the generated code cannot be written.
pub fn unwritten(error: &io::Error) -> String {
    directive("error", format_args!("the generated code cannot be written: {error}"))
}

/// Returns one line. Texts of specs and file names cannot begin a second line in it, which cargo
/// would obey.
fn directive(name: &str, value: impl Display) -> String {
    format!("cargo::{name}={}", visible(&value.to_string()))
}
