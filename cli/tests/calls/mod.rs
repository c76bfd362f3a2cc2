//! Calls of the command with a spec.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Calls canspec with a spec and an input, and returns both outputs.
pub fn canspec(spec: &Path, arguments: &[&str], input: &str) -> (String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    let command = command.args(arguments).arg("--spec").arg(spec).stdin(Stdio::piped());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("canspec runs");
    let mut stdin = child.stdin.take().expect("it reads");
    // A call that is refused does not read.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().expect("canspec ends");
    let [out, complaints] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).expect("it is text"));
    (out, complaints)
}
