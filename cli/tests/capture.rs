//! Captures on disk: they never replace the log that they are made of, and a stopped one has every frame that arrived.
#![cfg(unix)]

use std::fs;
use std::io::Write;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

const LOG: &str = "(1.5) can0 123#AB\n(2.5) can1 123#AB\n(3.5) can0 00000123#\n";

/// Kind of the block of a frame.
const PACKET: u32 = 6;

/// How long the program may take for a few frames, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(20);

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
fn a_file_that_canspec_did_not_write_last_is_replaced_only_by_force() {
    let folder = folder_with_log();
    let path = folder.path().join("bus.pcapng");
    assert!(convert(&folder, &["bus.pcapng", "bus.log"]).status.success());
    let ours = fs::read(&path).expect("the capture is there");
    // Another program's name in the first block; a block that is cut off; the notes of somebody.
    let other = ours.iter().map(|byte| if *byte == b'c' { b'C' } else { *byte }).collect();
    // As editcap and tshark leave it, which keep the first block: without its last frame, with that frame once more, with
    // another time. The last one has a comment.
    let last = &ours[ours.len() - 40..];
    let mut moved = ours.clone();
    moved[ours.len() - 24] ^= 1;
    let comment = [&last[..36], b"\x01\0\x04\0mine\0\0\0\0", &52_u32.to_le_bytes()].concat();
    let comment = [&comment[..4], &52_u32.to_le_bytes(), &comment[8..]].concat();
    let rest = &ours[..ours.len() - 40];
    let changed = [rest.to_vec(), [&ours[..], last].concat(), moved, [rest, &comment].concat()];
    for theirs in [other, ours[..20].to_vec(), b"my notes\n".to_vec()].into_iter().chain(changed) {
        fs::write(&path, &theirs).expect("the folder can be written");
        let output = convert(&folder, &["bus.pcapng", "bus.log"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(
            said.contains(
                "bus.pcapng: the file is no capture that canspec wrote last, so it is kept; name another one"
            ),
            "{said}"
        );
        assert_eq!(fs::read(&path).expect("the file is there"), theirs);
        assert!(convert(&folder, &["bus.pcapng", "bus.log", "--force"]).status.success());
        assert_eq!(fs::read(&path).expect("the file is there"), ours);
    }
}

#[test]
fn force_does_not_let_a_capture_replace_its_own_log() {
    let folder = folder_with_log();
    assert_refused(&folder, &convert(&folder, &["bus.log", "bus.log", "--force"]));
}

#[test]
fn a_capture_of_canspec_and_an_empty_file_are_replaced() {
    let folder = folder_with_log();
    let path = folder.path().join("bus.pcapng");
    fs::write(folder.path().join("long.log"), LOG.repeat(9)).expect("the folder can be written");
    fs::write(&path, "").expect("the folder can be written");
    assert!(convert(&folder, &["bus.pcapng", "long.log"]).status.success());
    assert_eq!(packets(&path), Ok(27));
    assert!(convert(&folder, &["bus.pcapng", "bus.log"]).status.success());
    assert_eq!(packets(&path), Ok(3));
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

/// Begins a live capture, and waits until three frames are on disk and a fourth has come in part.
fn live(folder: &TempDir) -> Child {
    let mut child = canspec(folder)
        .args(["decode", "--to", "pcapng", "out"])
        .stdin(Stdio::piped())
        .spawn()
        .expect("the command was built");
    let stdin = child.stdin.as_mut().expect("standard input is a pipe");
    stdin.write_all(format!("{LOG}(4.5) can0 12").as_bytes()).expect("the command reads");
    let (out, started) = (folder.path().join("out"), Instant::now());
    while packets(&out) != Ok(3) && started.elapsed() < PATIENCE {
        sleep(Duration::from_millis(5));
    }
    assert_eq!(packets(&out), Ok(3), "after {PATIENCE:?} of silence");
    child
}

#[test]
fn a_capture_that_is_stopped_has_every_frame_that_arrived() {
    for signal in ["INT", "TERM", "HUP", "KILL"] {
        let folder = folder_with_log();
        let mut child = live(&folder);
        let number = child.id().to_string();
        let sent = Command::new("kill").args(["-s", signal, &number]).status().expect("every Unix has it");
        assert!(sent.success());
        child.wait().expect("it was started");
        assert_eq!(packets(&folder.path().join("out")), Ok(3), "{signal}");
    }
}

#[test]
fn a_capture_of_a_closed_pipe_has_every_frame_that_arrived() {
    let folder = folder_with_log();
    let mut child = live(&folder);
    child.stdin.as_mut().expect("standard input is a pipe").write_all(b"3#00").expect("the command reads");
    let output = child.wait_with_output().expect("it was started");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(packets(&folder.path().join("out")), Ok(4));
}

#[test]
fn a_dash_is_standard_output() {
    let folder = folder_with_log();
    assert!(convert(&folder, &["out", "bus.log"]).status.success());
    let output = convert(&folder, &["-", "bus.log"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let file = fs::read(folder.path().join("out")).expect("the capture is there");
    // Only a file has a seal in its first block.
    let blocks = |bytes: &[u8]| bytes[usize::from(bytes[4])..].to_vec();
    assert_eq!(blocks(&output.stdout), blocks(&file));
    assert!(!folder.path().join("-").exists());
}

#[test]
fn a_long_log_is_captured_whole() {
    let folder = folder_with_log();
    let line = |number: usize| format!("({number}.000001) can{} 123#0011223344556677\n", number % 3);
    fs::write(folder.path().join("long.log"), (0..20_000).map(line).collect::<String>()).expect("a new name");
    assert!(convert(&folder, &["out", "long.log"]).status.success());
    assert_eq!(packets(&folder.path().join("out")), Ok(20_000));
}
