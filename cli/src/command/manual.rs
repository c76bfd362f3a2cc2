//! `canspec manual`.

use std::io::Write;

use canspec_codegen::nearest;
use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;

use crate::Canspec;
use crate::failure::{Failure, Finish};
use crate::output::output;

/// Print a page of the manual, for `man`.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Manual {
    /// The subcommand; the page of canspec itself without one.
    #[arg(value_name = "COMMAND")]
    names: Vec<String>,
}

const EXAMPLES: &str = "Examples:
  canspec manual decode | man -l -
  canspec manual > /usr/local/share/man/man1/canspec.1
  canspec manual export dbc > /usr/local/share/man/man1/canspec-export-dbc.1";

impl Manual {
    /// Writes the page.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut command = Canspec::command();
        // The subcommands learn their whole names.
        command.build();
        let mut chosen = &command;
        for name in &self.names {
            chosen = chosen.find_subcommand(name).ok_or_else(|| unknown(chosen, name))?;
        }
        let mut page = Vec::new();
        Man::new(chosen.clone()).source(concat!("canspec ", env!("CARGO_PKG_VERSION"))).render(&mut page)?;
        output()?.write_all(&page)?;
        Ok(Finish::Done)
    }
}

fn unknown(command: &Command, name: &str) -> Failure {
    let names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
    let help = match nearest(name, names.iter().copied()) {
        Some(known) => format!("did you mean `{known}`?"),
        None if names.is_empty() => "it has no subcommands".to_owned(),
        None => format!("known are {}", names.join(", ")),
    };
    Failure::Call(format!("`{}` has no subcommand `{name}`; {help}", command.get_bin_name().unwrap_or_default()))
}
