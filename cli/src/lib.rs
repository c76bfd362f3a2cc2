//! The command `canspec` checks CAN protocol specs, compiles them to Rust, and decodes and encodes
//! logs.
//!
//! It is also a library, so that tests can reach the readers of logs and DBC files.

#![warn(clippy::wildcard_enum_match_arm)]

mod choose;
mod command;
mod failure;
pub mod files;
mod log;
mod output;
mod show;
mod tips;

use std::process::ExitCode;

use clap::Parser;

use command::Command;
use failure::{Failure, tell};
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
