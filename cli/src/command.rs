//! The subcommands, one a file.
//!
//! Each reads its arguments with clap, and its `run` does the work: it chooses protocols and models
//! (`choose`), reads a log or a text (`log`), and shows what becomes of it (`show`). What went
//! wrong comes back as a failure, from which `main` makes the exit status. A subcommand with a
//! folder keeps the parts of its work there.

mod check;
mod compile;
mod completions;
pub mod decode;
pub mod encode;
mod examples;
mod export;
mod identify;
pub mod import;
mod list;
mod manual;
mod rules;
mod schema;

use clap::Subcommand;

use crate::failure::{Failure, Finish};

#[derive(Subcommand)]
pub enum Command {
    Check(check::Check),
    Compile(compile::Compile),
    Completions(completions::Completions),
    Decode(decode::Decode),
    Encode(encode::Encode),
    Examples(examples::Examples),
    Export(export::Export),
    Identify(identify::Identify),
    Import(import::Import),
    List(list::List),
    Manual(manual::Manual),
    Rules(rules::Rules),
    Schema(schema::Schema),
}

impl Command {
    /// Runs the subcommand.
    pub fn run(&self) -> Result<Finish, Failure> {
        match self {
            Self::Check(check) => check.run(),
            Self::Compile(compile) => compile.run(),
            Self::Completions(completions) => completions.run(),
            Self::Decode(decode) => decode.run(),
            Self::Encode(encode) => encode.run(),
            Self::Examples(examples) => examples.run(),
            Self::Export(export) => export.run(),
            Self::Identify(identify) => identify.run(),
            Self::Import(import) => import.run(),
            Self::List(list) => list.run(),
            Self::Manual(manual) => manual.run(),
            Self::Rules(rules) => rules.run(),
            Self::Schema(_) => schema::Schema::run(),
        }
    }
}
