//! Any bytes as a DBC: what can be read is a spec that has a text for each place, and that `check` accepts.

use canspec::files::imported;
use canspec_codegen::compile;
use canspec_codegen::source::Source;

/// Imports the bytes, and compiles the spec.
pub fn run(data: &[u8]) {
    let Ok(spec) = imported(data.to_vec()) else { return };
    let source = Source::new("a.yaml", spec.clone().into_bytes()).unwrap_or_else(|found| panic!("{found}\n{spec}"));
    let diagnostics = compile(source).diagnostics;
    assert!(!diagnostics.has_errors(), "{diagnostics}\n{spec}");
}
