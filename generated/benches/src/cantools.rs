//! The C that cantools makes of the DBC, compiled when the table is made.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{fs, io};

use canspec_benches::frame::Frame;

/// The folder of this package.
const PACKAGE: &str = env!("CARGO_MANIFEST_DIR");
/// The version of cantools.
const REQUIREMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/peers/requirements.txt");

/// Builds the program of a protocol in a folder, with link-time optimization and without, and writes its frames.
///
/// Returns the commands for each kind of frames, in this order. The error says what is missing.
pub fn programs(folder: &Path, protocol: &str, kinds: &[Vec<Frame>]) -> Result<Vec<[Vec<OsString>; 2]>, &'static str> {
    let python = folder.join("venv/bin/python");
    let code = folder.join(protocol);
    let inputs: Vec<_> = (0..kinds.len()).map(|kind| code.join(format!("frames_{kind}"))).collect();
    let written = || inputs.iter().zip(kinds).try_for_each(|(input, frames)| write(input, frames));
    fs::create_dir_all(&code).and_then(|()| written()).map_err(|_| "a folder to write to")?;
    let [generate, main, own] = ["cantools/generate.py", "cantools/main.c", &format!("cantools/{protocol}")]
        .map(|file| Path::new(PACKAGE).join(file));
    let dbc = Path::new(PACKAGE).join(format!("{protocol}.dbc"));
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", REQUIREMENTS];
    let is_installed = succeeds(Command::new("python3").args(["-m", "venv"]).arg(folder.join("venv")))
        && succeeds(Command::new(&python).args(install));
    if !is_installed || !succeeds(Command::new(&python).args([&generate, &dbc, &code])) {
        return Err("python3 with venv, and PyPI at its first run");
    }
    let compiled = |name: &str, option: &str| {
        let program = code.join(name);
        let mut compiler = Command::new("cc");
        compiler.args(["-O3", option, "-I"]).arg(&code).arg("-I").arg(&own);
        compiler.args([&main, &code.join(format!("{protocol}.c"))]).arg("-o").arg(&program);
        succeeds(&mut compiler).then_some(program).ok_or("a C compiler")
    };
    let check = compiled("check", "-DCHECK")?;
    if !inputs.iter().all(|input| succeeds(Command::new(&check).arg(input).args(["decode", "1"]))) {
        return Err("frames that its C encodes back");
    }
    let profiles = [compiled("lto", "-flto")?, compiled("release", "-fno-lto")?];
    let command = |program: &PathBuf, input: &PathBuf| vec![program.into(), input.into()];
    Ok(inputs.iter().map(|input| profiles.each_ref().map(|program| command(program, input))).collect())
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
