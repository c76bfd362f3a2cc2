//! Captures on disk: they never replace the log that they are made of.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

const LOG: &str = "(1.5) can0 123#AB\n(2.5) can1 123#AB\n(3.5) can0 00000123#\n";

/// Kind of the block of a frame.
const PACKET: u32 = 6;

fn canspec(folder: &TempDir) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_canspec"));
    command.current_dir(folder.path()).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn convert(folder: &TempDir, arguments: &[&str]) -> Output {
    canspec(folder).args(["decode", "--to", "pcapng"]).args(arguments).output().expect("the command was built")
}

/// Returns a folder with `bus.log`.
fn folder_with_log() -> TempDir {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    fs::write(folder.path().join("bus.log"), LOG).expect("the folder can be written");
    folder
}

#[track_caller]
fn assert_refused(folder: &TempDir, output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("is the log itself; name another file for the capture"), "{said}");
    assert_eq!(fs::read_to_string(folder.path().join("bus.log")).expect("the log is there"), LOG);
}

#[test]
fn a_capture_never_replaces_its_own_log() {
    let folder = folder_with_log();
    let path = |name: &str| folder.path().join(name);
    symlink("bus.log", path("link")).expect("a new name");
    symlink("link", path("link_of_link")).expect("a new name");
    symlink(".", path("here")).expect("a new name");
    fs::hard_link(path("bus.log"), path("hard")).expect("a new name");
    fs::create_dir(path("below")).expect("a new name");
    let absolute = path("bus.log").to_string_lossy().into_owned();
    let names =
        ["bus.log", "./bus.log", "below/../bus.log", "link", "link_of_link", "here/bus.log", "hard", absolute.as_str()];
    for out in names {
        for log in names {
            assert_refused(&folder, &convert(&folder, &[out, log]));
        }
        let log = fs::File::open(path("bus.log")).expect("the log is there");
        let output = canspec(&folder).args(["decode", "--to", "pcapng", out]).stdin(log).output();
        assert_refused(&folder, &output.expect("the command was built"));
    }
}

#[test]
fn a_copy_of_the_log_can_be_replaced() {
    let folder = folder_with_log();
    fs::copy(folder.path().join("bus.log"), folder.path().join("copy")).expect("a new name");
    assert!(convert(&folder, &["copy", "bus.log"]).status.success());
    assert_eq!(packets(&folder.path().join("copy")), Ok(3));
}

/// Counts the frames of a capture, which must end where a block ends.
fn packets(path: &Path) -> Result<usize, String> {
    let bytes = fs::read(path).unwrap_or_default();
    let number = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let (mut at, mut count) = (0, 0);
    while let (Some(kind), Some(length)) = (number(at), number(at + 4)) {
        count += usize::from(kind == PACKET);
        at += length as usize;
    }
    if at == bytes.len() && at > 0 { Ok(count) } else { Err(format!("a block ends at {at} of {} bytes", bytes.len())) }
}
