//! `canspec import`.

mod dbc;

use clap::{Args, Subcommand};

use crate::failure::{Failure, Finish};

/// Begin a spec from the file of another tool.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub struct Import {
    #[command(subcommand)]
    source: Source,
}

#[derive(Subcommand)]
enum Source {
    Dbc(dbc::Dbc),
}

/// Makes a spec of a DBC in memory.
pub fn imported(bytes: Vec<u8>) -> Result<String, String> {
    dbc::imported(bytes)
}

impl Import {
    /// Writes the spec.
    pub fn run(&self) -> Result<Finish, Failure> {
        match &self.source {
            Source::Dbc(dbc) => dbc.run(),
        }
    }
}
