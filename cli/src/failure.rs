//! How a command ends.

use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::source::forbidden;

/// A complaint lists no more names.
pub const MOST_NAMES: usize = 20;

/// How a command ends if it was carried out.
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
    /// The call was wrong, or the settings that complete it.
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
    pub fn input(path: &Path, error: &impl Display) -> Self {
        Self::Input(format!("{}: {error}", shown(path)))
    }

    /// Tells standard error what happened, and the caller by the exit status.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe => return ExitCode::SUCCESS,
            Self::Output(error) => tell(format_args!("canspec: standard output: {error}")),
            Self::Call(why) | Self::Input(why) => tell(format_args!("canspec: {why}")),
            Self::Spec(diagnostics) => draw(&diagnostics.render(true)),
            Self::Specs(refused) => refused.iter().for_each(|one| draw(&one.render(true))),
        }
        ExitCode::from(if matches!(self, Self::Call(_)) { 2 } else { 1 })
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// Writes lines to standard error, without what could steer a terminal.
pub fn tell(text: impl Display) {
    draw(&text.to_string().lines().map(escaped).collect::<Vec<_>>().join("\n"));
}

/// Writes a drawing to standard error, in colour only on a terminal. It ignores a closed standard
/// error.
pub fn draw(text: &str) {
    let _ = writeln!(anstream::stderr(), "{}", text.trim_end());
}

/// Returns the name of a file in one line.
pub fn shown(path: &Path) -> String {
    escaped(&path.display().to_string())
}

/// Escapes characters that begin a line, steer a terminal, or cannot be seen.
pub fn escaped(text: &str) -> String {
    let acts = |letter: char| letter.is_control() || forbidden(letter).is_some();
    let escape = |letter: char| if acts(letter) { letter.escape_default().to_string() } else { letter.into() };
    text.chars().map(escape).collect()
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn a_complaint_does_not_steer_the_terminal() {
        assert_eq!(escaped("a\u{1b}[2J°\u{7f}\n\u{202E}"), "a\\u{1b}[2J°\\u{7f}\\n\\u{202e}");
    }
}
