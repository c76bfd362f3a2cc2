//! The generated Rust, whole, as a pull request shows it.

use std::fs;
use std::path::{Path, PathBuf};

use canspec_codegen::emit;
use canspec_tests::protocol;

/// Snapshots of one-feature specs stay short enough to be read.
const LINES: usize = 300;

/// Returns the specs of a folder, by its path from this crate.
fn specs(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).expect("the folder exists").flatten().map(|entry| entry.path());
    entries.filter(|path| path.extension().is_some_and(|ending| ending == "yaml")).collect()
}

/// Compares the Rust of a spec with `snapshots/FOLDER/SPEC.snap.rs`.
fn compare(path: &Path, folder: &str) -> String {
    let code = emit::rust(&protocol(path));
    let name = path.file_stem().expect("a spec has a name").to_string_lossy();
    let mut settings = insta::Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_snapshot_path(format!("../snapshots/{folder}"));
    settings.bind(|| insta::assert_binary_snapshot!(&format!("{name}.rs"), code.clone().into_bytes()));
    code
}

#[test]
fn each_feature_generates_the_rust_that_was_reviewed() {
    for path in specs("specs/features") {
        let lines = compare(&path, "features").lines().count();
        assert!(lines <= LINES, "{}: {lines} lines of Rust are more than anybody reviews", path.display());
    }
}

#[test]
fn each_protocol_generates_the_rust_that_was_reviewed() {
    for path in specs("../specs") {
        compare(&path, "protocols");
    }
}

#[test]
fn generation_is_deterministic() {
    for path in specs("../specs") {
        assert_eq!(emit::rust(&protocol(&path)), emit::rust(&protocol(&path)));
    }
}
