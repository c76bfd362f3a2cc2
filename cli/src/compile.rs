//! `canspec compile`.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use canspec_codegen::emit;
use clap::Args;

use crate::failure::{Failure, Finish};
use crate::protocols;

/// Compile a spec to Rust.
///
/// Nothing is written if the spec has errors, and a file that would not change is left alone.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec compile protocol.yaml --output src/protocol.rs")]
pub struct Compile {
    /// The spec file.
    #[arg(required_unless_present = "protocol", conflicts_with = "protocol")]
    spec: Option<PathBuf>,
    /// A built-in protocol instead of a file.
    #[arg(long, value_name = "NAME")]
    protocol: Option<String>,
    /// Where to write; standard output without it.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Compile {
    /// Writes the Rust code of the chosen spec.
    pub fn run(&self) -> Result<Finish, Failure> {
        let source = protocols::choose(self.protocol.as_deref(), self.spec.as_deref())?;
        let code = emit::rust(&protocols::load(source)?);
        match &self.output {
            Some(path) => update(path, &code)?,
            None => io::stdout().lock().write_all(code.as_bytes())?,
        }
        Ok(Finish::Done)
    }
}

/// Writes a file unless it has this content already.
fn update(path: &Path, code: &str) -> Result<(), Failure> {
    if fs::read(path).is_ok_and(|old| old == code.as_bytes()) {
        return Ok(());
    }
    fs::write(path, code).map_err(|error| Failure::input(&path.display().to_string(), &error))
}
