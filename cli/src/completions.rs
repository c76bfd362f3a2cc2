//! `canspec completions`.

use std::io::Write;

use clap::{Args, CommandFactory};
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
  canspec completions bash > ~/.local/share/bash-completion/completions/canspec
  canspec completions zsh > ~/.zfunc/_canspec
  canspec completions fish > ~/.config/fish/completions/canspec.fish";

impl Completions {
    /// Writes the script for the shell.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut Canspec::command(), "canspec", &mut script);
        output()?.write_all(&script)?;
        Ok(Finish::Done)
    }
}
