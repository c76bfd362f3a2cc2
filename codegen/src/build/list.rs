//! Writes `protocols.rs`, which has a module for each protocol of a folder.

use std::path::{Path, PathBuf};

use super::Generated;
use crate::build::files::{self, File};
use crate::emit::MARK;

/// Name of the file without its ending. No protocol may have this name.
pub const NAME: &str = "protocols";

/// Returns the list of protocols.
pub fn file_in(folder: &Path, generated: &[Generated]) -> File {
    let modules: String = generated.iter().map(module).collect();
    File::new(path_in(folder), format!("{MARK}; do not edit.\n\n{modules}"))
}

/// Returns the files that an earlier list in the folder includes.
pub fn listed(folder: &Path) -> Vec<PathBuf> {
    let list = files::read(&path_in(folder)).ok().and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default();
    let names = list.lines().filter_map(|line| line.strip_prefix("    include!(\"")?.strip_suffix("\");"));
    let beside = names.filter(|name| Path::new(name).file_name() == Some(name.as_ref()));
    beside.map(|name| folder.join(name)).collect()
}

fn path_in(folder: &Path) -> PathBuf {
    folder.join(format!("{NAME}.rs"))
}

/// Returns a module that includes the file of a protocol from the list's folder.
fn module(generated: &Generated) -> String {
    let Generated { name, manual, .. } = generated;
    let manual = manual.lines().map(|line| format!("    {line}")).collect::<Vec<_>>().join("\n");
    let lints = "clippy::inline_always, clippy::missing_errors_doc";
    format!("#[allow({lints})]\npub mod {name} {{\n{manual}\n\n    include!(\"{name}.rs\");\n}}\n")
}
