//! Compiles specs from a build script.

use std::ffi::OsStr;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use crate::diagnostic::{Diagnostics, Severity};
use crate::model::Protocol;
use crate::source::Source;
use crate::{compile, emit};

/// Compiles specs into `OUT_DIR`, where `lib.rs` includes them.
///
/// ```no_run
/// // build.rs
/// canspec_codegen::Builder::new().folder("specs").build();
/// ```
///
/// ```ignore
/// // lib.rs: one module a protocol
/// include!(concat!(env!("OUT_DIR"), "/protocols.rs"));
/// ```
///
/// A wrong spec stops the build: each diagnostic is an error of cargo, and nothing is written.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    folders: Vec<PathBuf>,
    specs: Vec<PathBuf>,
}

impl Builder {
    /// Returns a builder without specs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one spec, by its path from the crate's root.
    #[must_use]
    pub fn spec(mut self, path: impl Into<PathBuf>) -> Self {
        self.specs.push(path.into());
        self
    }

    /// Adds every `*.yaml` of a folder, by its path from the crate's root; a folder without any is fine.
    #[must_use]
    pub fn folder(mut self, path: impl Into<PathBuf>) -> Self {
        self.folders.push(path.into());
        self
    }

    /// Compiles the specs and writes `PROTOCOL.rs` for each and `protocols.rs` for all of them.
    ///
    /// Errors are printed for cargo, which then fails the build.
    pub fn build(self) {
        match self.compiled() {
            Ok(protocols) => {
                let written = env::var_os("OUT_DIR")
                    .ok_or_else(|| io::Error::other("OUT_DIR is not set: this is for build scripts"))
                    .and_then(|out| write(Path::new(&out), &protocols));
                if let Err(error) = written {
                    tell("error", format_args!("the generated code cannot be written: {error}"));
                }
            }
            Err(lines) => lines.iter().for_each(|line| tell("error", line)),
        }
    }

    /// Compiles every spec; returns the errors of all of them.
    fn compiled(self) -> Result<Vec<Protocol>, Vec<String>> {
        let (mut protocols, mut errors) = (Vec::new(), Vec::new());
        for path in self.paths().map_err(|error| vec![error])? {
            tell("rerun-if-changed", path.display());
            match compile_file(&path) {
                Ok(protocol) => protocols.push(protocol),
                Err(diagnostics) => errors.extend(diagnostics.concise().lines().map(str::to_owned)),
            }
        }
        if errors.is_empty() { Ok(protocols) } else { Err(errors) }
    }

    /// Returns every spec, in order.
    fn paths(&self) -> Result<Vec<PathBuf>, String> {
        let mut paths = self.specs.clone();
        for folder in &self.folders {
            tell("rerun-if-changed", folder.display());
            let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
            let files = entries.flatten().map(|entry| entry.path());
            paths.extend(files.filter(|path| path.extension() == Some(OsStr::new("yaml"))));
        }
        paths.sort();
        Ok(paths)
    }
}

/// Compiles one spec; its warnings are printed for cargo.
fn compile_file(path: &Path) -> Result<Protocol, Diagnostics> {
    let outcome = compile(Source::read(path)?);
    match outcome.protocol {
        Some(protocol) => {
            let warnings = outcome.diagnostics.located().filter(|known| known.severity == Severity::Warning);
            warnings.for_each(|warning| tell("warning", warning.message));
            Ok(protocol)
        }
        None => Err(outcome.diagnostics),
    }
}

/// Gives cargo an instruction.
#[expect(clippy::print_stdout, reason = "cargo reads what a build script prints")]
fn tell(instruction: &str, text: impl Display) {
    println!("cargo::{instruction}={text}");
}

/// Writes a file for each protocol, and one that includes them all as modules.
fn write(out: &Path, protocols: &[Protocol]) -> io::Result<()> {
    for protocol in protocols {
        write_changed(&out.join(format!("{}.rs", protocol.name)), &emit::rust(protocol))?;
    }
    let modules: Vec<_> = protocols.iter().map(module).collect();
    write_changed(&out.join("protocols.rs"), &modules.concat())
}

/// Returns the module that includes the file of a protocol.
fn module(protocol: &Protocol) -> String {
    let (name, title) = (&protocol.name, format!("{}.", protocol.title));
    format!("#[doc = {title:?}]\npub mod {name} {{\n    include!(concat!(env!(\"OUT_DIR\"), \"/{name}.rs\"));\n}}\n")
}

/// Leaves a file alone that has the text already, so that nothing is built again.
fn write_changed(path: &Path, text: &str) -> io::Result<()> {
    let known = fs::read(path).is_ok_and(|known| known == text.as_bytes());
    if known { Ok(()) } else { fs::write(path, text) }
}
