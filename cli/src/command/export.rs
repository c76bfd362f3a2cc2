//! `canspec export`.

mod dbc;
mod wireshark;

use clap::{Args, Subcommand};

use crate::failure::{Failure, Finish};

/// Export a protocol to the format of another tool.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub struct Export {
    #[command(subcommand)]
    target: Target,
}

#[derive(Subcommand)]
enum Target {
    Dbc(dbc::Dbc),
    Wireshark(wireshark::Wireshark),
}

impl Export {
    /// Writes the protocol in the other format.
    pub fn run(&self) -> Result<Finish, Failure> {
        match &self.target {
            Target::Dbc(dbc) => dbc.run(),
            Target::Wireshark(wireshark) => wireshark.run(),
        }
    }
}
