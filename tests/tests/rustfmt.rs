//! Generated Rust is laid out as rustfmt would.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, io};

/// Returns the snapshots of generated Rust below a folder.
fn snapshots(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(snapshots(&path)?);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            files.push(path);
        }
    }
    Ok(files)
}

#[test]
fn rustfmt_leaves_generated_code_as_it_is() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = snapshots(&tests.join("snapshots")).expect("the snapshots can be listed");
    assert!(files.len() > 20, "only {} snapshots of Rust were found", files.len());
    let mut rustfmt = Command::new("rustfmt");
    rustfmt.args(["--check", "--edition", "2024", "--config-path"]).arg(tests.join("../rustfmt.toml"));
    let output = rustfmt.args(files).output().expect("rustfmt is part of the toolchain");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}
