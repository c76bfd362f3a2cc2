//! The generated Rust, whole, as a pull request shows it.

use canspec_codegen::emit;
use canspec_tests::protocol;

/// Snapshots of one-feature specs stay short enough to be read.
const LINES: usize = 300;

#[test]
fn each_feature_generates_the_rust_that_was_reviewed() {
    insta::glob!("../specs/features", "*.yaml", |path| {
        let code = emit::rust(&protocol(path));
        let lines = code.lines().count();
        assert!(lines <= LINES, "{}: {lines} lines of Rust are more than anybody reviews", path.display());
        insta::assert_binary_snapshot!(".rs", code.into_bytes());
    });
}

#[test]
fn each_protocol_generates_the_rust_that_was_reviewed() {
    insta::glob!("../../specs", "*.yaml", |path| {
        insta::assert_binary_snapshot!(".rs", emit::rust(&protocol(path)).into_bytes());
    });
}

#[test]
fn generation_is_deterministic() {
    insta::glob!("../../specs", "*.yaml", |path| {
        assert_eq!(emit::rust(&protocol(path)), emit::rust(&protocol(path)));
    });
}
