//! `canspec completions`.

use std::io::Write;

use canspec_specs::SPECS;
use clap::builder::PossibleValuesParser;
use clap::{Args, Command, CommandFactory};
use clap_complete::{Shell, generate};

use crate::Canspec;
use crate::failure::{Failure, Finish};
use crate::output::output;

/// Print what a shell needs to complete calls of canspec.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Completions {
    /// The shell.
    shell: Shell,
}

const EXAMPLES: &str = "Examples:
  mkdir -p ~/.local/share/bash-completion/completions
  canspec completions bash > ~/.local/share/bash-completion/completions/canspec
  mkdir -p ~/.zfunc
  canspec completions zsh > ~/.zfunc/_canspec
  mkdir -p ~/.config/fish/completions
  canspec completions fish > ~/.config/fish/completions/canspec.fish";

impl Completions {
    /// Writes the script for the shell.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut with_names(Canspec::command()), "canspec", &mut script);
        output()?.write_all(&script)?;
        Ok(Finish::Done)
    }
}

/// Offers the built-in protocols wherever one is named.
fn with_names(command: Command) -> Command {
    let names = || PossibleValuesParser::new(SPECS.iter().map(|spec| spec.name));
    let command = command.mut_args(|arg| if arg.get_id() == "protocol" { arg.value_parser(names()) } else { arg });
    command.mut_subcommands(with_names)
}
