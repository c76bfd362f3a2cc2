//! cantools, a program in Python that decodes logs by a DBC.

use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};

/// The DBC of INFY. It has each message with the addresses that the mask leaves out.
const DBC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../generated/benches/infy.dbc");
const MASK: &str = "0x3FC0C0";

/// The version of cantools.
const REQUIREMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/peers/requirements.txt");

/// Returns the command that decodes a log, or `None` without Python, `venv` or `PyPI`.
pub fn command(folder: &Path, log: &Path) -> Option<Command> {
    let python = folder.join("bin/python");
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", REQUIREMENTS];
    let is_installed = succeeds(Command::new("python3").args(["-m", "venv"]).arg(folder))
        && succeeds(Command::new(&python).args(install));
    let mut command = Command::new(python);
    command.args(["-m", "cantools", "decode", "--single-line", "--frame-id-mask", MASK, DBC]);
    command.stdin(File::open(log).ok()?);
    is_installed.then_some(command)
}

fn succeeds(command: &mut Command) -> bool {
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}
