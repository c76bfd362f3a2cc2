//! `canspec schema`.

use std::io::Write;

use clap::Args;

use crate::failure::{Failure, Finish};
use crate::output::output;

/// Print the JSON Schema of the language, for an editor.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLE)]
pub struct Schema {}

const EXAMPLE: &str = "\
Example:
  canspec schema > canspec.schema.json

An editor with a YAML language server finds it by the first line of a spec:
  # yaml-language-server: $schema=canspec.schema.json";

impl Schema {
    /// Writes the schema.
    pub fn run() -> Result<Finish, Failure> {
        output()?.write_all(canspec_codegen::schema::schema().as_bytes())?;
        Ok(Finish::Done)
    }
}
