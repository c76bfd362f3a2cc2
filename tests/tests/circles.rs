//! No modules of a crate need each other in a circle.

use std::path::Path;

use canspec_tests::modules::{circles, files};

/// Asserts that no folder of a crate has a circle.
fn assert_no_circle(name: &str) {
    let files = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).join("src"));
    assert!(files.len() > 20, "only {} files of {name} were found", files.len());
    let circles = circles(&files);
    assert!(circles.is_empty(), "modules of {name} need each other in a circle:\n{}", circles.join("\n"));
}

#[test]
fn the_compiler_has_no_circle() {
    assert_no_circle("codegen");
}

#[test]
fn the_command_has_no_circle() {
    assert_no_circle("cli");
}
