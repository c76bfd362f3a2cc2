//! The command `canspec` checks CAN protocol specs, compiles them to Rust, and decodes and encodes
//! logs.
//!
//! It is also a library, so that tests can reach the readers of logs and DBC files.

#![warn(clippy::wildcard_enum_match_arm)]

mod capture;
mod channels;
mod check;
mod columns;
mod compile;
mod completions;
mod decode;
mod doubt;
mod encode;
mod examples;
mod export;
mod failure;
mod fields;
pub mod files;
mod identify;
mod import;
mod input;
mod kept;
mod line;
mod list;
mod log;
mod manual;
mod model;
mod outcome;
mod output;
mod progress;
mod protocols;
mod rules;
mod schema;
mod settings;
mod severity;
mod signature;
mod table;
mod tips;
mod value;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::{Failure, Finish, tell};
use output::output;
use tips::with_tip;

/// CAN protocols described once in YAML: check them, compile them to Rust, decode and encode logs by them.
#[derive(Parser)]
#[command(name = "canspec", version, after_long_help = EXIT_STATUS)]
struct Canspec {
    #[command(subcommand)]
    command: Command,
}

const EXIT_STATUS: &str = "Exit status: 0 done, 1 the input had errors, 2 the call was wrong.";

#[derive(Subcommand)]
enum Command {
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
    fn run(&self) -> Result<Finish, Failure> {
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

/// Runs the command line.
pub fn main() -> ExitCode {
    match Canspec::try_parse() {
        Ok(call) => call.command.run().map_or_else(|failure| failure.report(), ExitCode::from),
        Err(refusal) => refuse(&with_tip(refusal)),
    }
}

/// Shows what is wrong with the call, or the requested help.
fn refuse(refusal: &clap::Error) -> ExitCode {
    if !refusal.use_stderr() {
        let printed = output().and_then(|_| refusal.print());
        return printed.map_or_else(|error| Failure::from(error).report(), |()| ExitCode::SUCCESS);
    }
    let text = refusal.render().to_string();
    tell(text.strip_prefix("error").map_or(text.clone(), |text| format!("canspec{text}")).trim_end());
    ExitCode::from(2)
}
