//! The C that cantools makes of the DBC, compiled when the table is made.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};
use std::{fs, io};

use canspec_benches::frame::Frame;

/// Files of this package.
const DBC: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/infy.dbc");
const GENERATE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/cantools/generate.py");
const MAIN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/cantools/main.c");
/// The version of cantools.
const REQUIREMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/peers/requirements.txt");

/// Builds the program in a folder, with link-time optimization and without, and writes its frames.
///
/// Returns the commands in this order. The error says what is missing.
pub fn programs(folder: &Path, frames: &[Frame]) -> Result<[Vec<OsString>; 2], &'static str> {
    let python = folder.join("venv/bin/python");
    let (input, code) = (folder.join("frames"), folder.join("infy.c"));
    fs::create_dir_all(folder).and_then(|()| write(&input, frames)).map_err(|_| "a folder to write to")?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", REQUIREMENTS];
    let is_installed = succeeds(Command::new("python3").args(["-m", "venv"]).arg(folder.join("venv")))
        && succeeds(Command::new(&python).args(install));
    if !is_installed || !succeeds(Command::new(&python).args([GENERATE, DBC]).arg(folder)) {
        return Err("python3 with venv, and PyPI at its first run");
    }
    let compiled = |name: &str, option: &str| {
        let program = folder.join(name);
        let mut compiler = Command::new("cc");
        compiler.args(["-O3", option, MAIN, "-I"]).arg(folder).arg(&code).arg("-o").arg(&program);
        succeeds(&mut compiler).then(|| vec![program.into(), input.clone().into()]).ok_or("a C compiler")
    };
    if !succeeds(Command::new(&compiled("check", "-DCHECK")?[0]).arg(&input).args(["decode", "1"])) {
        return Err("frames that its C encodes back");
    }
    Ok([compiled("lto", "-flto")?, compiled("release", "-fno-lto")?])
}

/// Writes frames as `main.c` reads them.
fn write(path: &Path, frames: &[Frame]) -> io::Result<()> {
    let bytes = frames.iter().flat_map(|frame| {
        let id = frame.raw_id() | 1 << 31;
        id.to_ne_bytes().into_iter().chain(frame.bytes())
    });
    fs::write(path, bytes.collect::<Vec<u8>>())
}

fn succeeds(command: &mut Command) -> bool {
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}
