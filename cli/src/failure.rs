//! How a command ends.

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use canspec_codegen::diagnostic::Diagnostics;

/// How a command ends that was carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// All was well.
    Done,
    /// Some of the input had errors, which were reported.
    Errors,
}

impl From<Finish> for ExitCode {
    fn from(finish: Finish) -> Self {
        match finish {
            Finish::Done => Self::SUCCESS,
            Finish::Errors => Self::from(1),
        }
    }
}

/// Why a command was not carried out.
#[derive(Debug)]
pub enum Failure {
    /// The call was wrong.
    Call(String),
    /// The input has an error without a line.
    Input(String),
    /// A spec has errors.
    Spec(Box<Diagnostics>),
    /// Some of several specs have errors.
    Specs(Vec<Diagnostics>),
    /// Standard output cannot be written.
    Output(io::Error),
}

impl Failure {
    /// Makes the failure of a file that cannot be read or written.
    pub fn input(name: &str, error: &impl Display) -> Self {
        Self::Input(format!("{name}: {error}"))
    }

    /// Tells standard error what happened, and the caller by the exit status.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe => return ExitCode::SUCCESS,
            Self::Output(error) => tell(format_args!("canspec: standard output: {error}")),
            Self::Call(why) | Self::Input(why) => tell(format_args!("canspec: {why}")),
            Self::Spec(diagnostics) => tell(diagnostics.render(true).trim_end()),
            Self::Specs(refused) => refused.iter().for_each(|one| tell(one.render(true).trim_end())),
        }
        ExitCode::from(if matches!(self, Self::Call(_)) { 2 } else { 1 })
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// Writes a line to standard error, in colour on a terminal only; where that is closed nobody wants to know.
pub fn tell(line: impl Display) {
    let _ = writeln!(anstream::stderr(), "{line}");
}
