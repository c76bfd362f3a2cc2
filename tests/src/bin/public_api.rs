//! Compares what the published libraries offer with `tests/public_api`; `--bless` writes it anew.
#![expect(clippy::print_stdout, reason = "people read what has changed")]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs, io};

/// The libraries that people call: from firmware, and from a build script.
const LIBRARIES: [&str; 2] = ["canspec-runtime", "canspec-codegen"];

fn main() -> io::Result<ExitCode> {
    let is_blessed = env::args().nth(1).as_deref() == Some("--bless");
    let mut is_same = true;
    for library in LIBRARIES {
        let (path, offered) = (root().join("tests/public_api").join(library).with_extension("txt"), offered(library)?);
        if is_blessed {
            fs::write(path, offered)?;
        } else {
            is_same &= is_known(library, &fs::read_to_string(path)?, &offered);
        }
    }
    Ok(if is_same { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns a line for each public item of a library, without those that every type has.
fn offered(library: &str) -> io::Result<String> {
    let json = documented(library)?;
    let api = public_api::Builder::from_rustdoc_json(json)
        .omit_blanket_impls(true)
        .omit_auto_trait_impls(true)
        .omit_auto_derived_impls(true)
        .build();
    api.map(|api| api.to_string()).map_err(io::Error::other)
}

/// Lets rustdoc describe a library in JSON. Returns the path of the file.
fn documented(library: &str) -> io::Result<PathBuf> {
    let target = env::current_exe()?.with_file_name("rustdoc_json");
    // The format is not yet stable. The version of the library that reads it belongs to the compiler of the gate.
    let status = Command::new("cargo")
        .args(["rustdoc", "--quiet", "--lib", "--package", library, "--target-dir"])
        .arg(&target)
        .args(["--", "-Z", "unstable-options", "--output-format", "json"])
        .env("RUSTC_BOOTSTRAP", "1")
        .current_dir(root())
        .status()?;
    if !status.success() {
        return Err(io::Error::other(format!("rustdoc cannot describe {library}")));
    }
    Ok(target.join("doc").join(library.replace('-', "_")).with_extension("json"))
}

/// Tests whether a library offers what it did, and prints what has changed.
fn is_known(library: &str, before: &str, now: &str) -> bool {
    let (gone, new) = (only_in(before, now), only_in(now, before));
    for (sign, line) in gone.iter().map(|line| ('-', line)).chain(new.iter().map(|line| ('+', line))) {
        println!("{sign} {line}");
    }
    let is_known = gone.is_empty() && new.is_empty();
    if !is_known {
        println!("{library} offers something else; name it in CHANGELOG.md, and call this with `--bless`");
    }
    is_known
}

fn only_in<'a>(one: &'a str, other: &str) -> Vec<&'a str> {
    let known: std::collections::HashSet<_> = other.lines().collect();
    one.lines().filter(|line| !known.contains(line)).collect()
}
