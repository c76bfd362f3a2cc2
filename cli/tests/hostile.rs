//! Broken and hostile files: each ends in an error that names its place, soon and in little memory.
//!
//! The time is that of the processor, so that other programs on the machine do not count.

use std::error::Error;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use wait4::Wait4;

/// Longest time of the processor for one file.
const TIME: Duration = Duration::from_secs(20);

/// Most memory for one file, in bytes.
const MEMORY: u64 = 200 << 20;

/// Bytes that are written at once: what this process holds counts for the one it starts.
const CHUNK: usize = 1 << 16;

/// A spec without messages, of seven lines.
const WHOLE: &str = "\
canspec: 1
protocol: mini
title: Mini
document: {title: Mini CAN, version: V1}
length: 8
identifier: {command: {bits: 10..0}}
access: {read: {request: {}, reply: {}}}
";

type Result<T = ()> = std::result::Result<T, Box<dyn Error>>;

/// The content of a file: a start, and then a text that is repeated `times` times.
struct Content<'a> {
    start: &'a [u8],
    repeated: &'a str,
    times: usize,
}

/// A file that is written down as it is.
fn text(start: &[u8]) -> Content<'_> {
    Content { start, repeated: "", times: 0 }
}

/// A file in which something is repeated.
fn many(repeated: &str, times: usize) -> Content<'_> {
    Content { start: b"a:\n ", repeated, times }
}

impl Content<'_> {
    fn write(&self, path: &Path) -> Result {
        let mut file = File::create(path)?;
        file.write_all(self.start)?;
        let at_once = (CHUNK / self.repeated.len().max(1)).max(1);
        let chunk = self.repeated.repeat(at_once.min(self.times));
        for _ in 0..self.times / at_once {
            file.write_all(chunk.as_bytes())?;
        }
        Ok(file.write_all(self.repeated.repeat(self.times % at_once).as_bytes())?)
    }
}

/// Checks a file and returns the first complaint after the file's name; time and memory are those of the whole command.
fn complaint(path: &Path) -> Result<String> {
    let mut child = Command::new(env!("CARGO_BIN_EXE_canspec"))
        .args(["check", "--message-format", "short"])
        .arg(path)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let mut said = String::new();
    child.stderr.take().ok_or("no standard error")?.read_to_string(&mut said)?;
    let used = child.wait4()?;
    let time = used.rusage.utime + used.rusage.stime;
    let name = path.display().to_string();
    let first = said.lines().next().unwrap_or_default();
    let first = first.strip_prefix(&name).ok_or_else(|| format!("{name} is not named: {first}"))?.to_owned();
    let shown = path.file_name().unwrap_or_default().to_string_lossy();
    eprintln!("{shown:32} {:4} ms {:4} MB {first}", time.as_millis(), used.rusage.maxrss >> 20);
    assert_eq!(used.status.code(), Some(1), "{name}: {said}");
    assert!(time < TIME, "{name} takes {time:?}");
    assert!(used.rusage.maxrss < MEMORY, "{name} takes {} bytes", used.rusage.maxrss);
    Ok(first)
}

/// Checks files with these contents. The first complaint must have the given place and message.
fn check(files: &[(&str, Content, &str, &str)]) -> Result {
    let folder = tempfile::tempdir()?;
    for (name, content, place, message) in files {
        let path = folder.path().join(format!("{}.yaml", name.replace(' ', "_")));
        content.write(&path)?;
        let found = complaint(&path)?;
        assert!(found.starts_with(place) && found.ends_with(message), "{name}: {found}");
        fs::remove_file(&path)?;
    }
    Ok(())
}

#[test]
fn what_is_no_text_is_refused_with_its_place() -> Result {
    check(&[
        ("not utf-8", text(b"a: \xC3\xA9\nb: \xE9\n"), ":2:4: ", "byte 9 of the file, 0xE9, is not UTF-8"),
        ("nul", text(b"a: b\nc: \0\n"), ":2:4: ", "the control character U+0000 may not stand in a spec"),
        ("tab", text(b"a:\n\tb: c\n"), ":2:2: ", "a tab stands where only spaces may"),
        ("byte order mark", text(b"\xEF\xBB\xBFx: 1\n"), ":1:1: ", "unknown key `x`"),
        (
            "byte order mark inside",
            text(b"a: \xEF\xBB\xBFb\n"),
            ":1:4: ",
            "the byte order mark U+FEFF may not stand in a spec",
        ),
        ("crlf", text(b"a: b\r\nc: d: e\r\n"), ":2:5: ", "a `:` that ends no key"),
        ("empty", text(b""), ":1:1: ", "the file is empty"),
    ])
}

#[test]
fn what_a_spec_does_without_is_refused_with_its_place() -> Result {
    let added = |line: &str| format!("{WHOLE}{line}\n").into_bytes();
    let doubled = (0..20).map(|level| format!("a{0}: &a{0} [*a{level}, *a{level}]\n", level + 1));
    let bomb = format!("a0: &a0 [x, x]\n{}", doubled.collect::<Vec<_>>().concat());
    check(&[
        ("two documents", text(&added("---\na: b")), ":8:1: ", "a second document starts here"),
        ("alias", text(&added("types: *a")), ":8:8: ", "an alias may not stand in a spec"),
        ("anchor", text(&added("types: &a {}")), ":8:8: ", "an anchor may not stand in a spec"),
        ("alias bomb", text(bomb.as_bytes()), ":1:1: ", "unknown key `a0`"),
        ("tag", text(&added("types: !!map {}")), ":8:8: ", "a tag may not stand in a spec"),
        ("explicit key", text(&added("? types\n: {}")), ":8:1: ", "a `?` before a key may not stand in a spec"),
    ])
}

#[test]
fn numbers_that_others_read_differently_are_refused_with_their_place() -> Result {
    let digits = "123456789012345678901234567890123456789012345";
    let time = |number: &str| format!("{WHOLE}timing: {{pause: {{time: {number} s, section: \"1\"}}}}\n").into_bytes();
    check(&[
        ("45 digits", text(&time(digits)), ":8:24: ", ""),
        ("capital x", text(&time("0X1F")), ":8:24: ", ""),
        ("underscore", text(&time("1_000")), ":8:24: ", ""),
    ])
}

#[test]
fn nesting_without_end_is_refused_with_its_place() -> Result {
    let message = "maps and lists are nested deeper than 64 levels";
    check(&[
        ("lists in flow style", many("[", 100_000), ":2:", message),
        ("maps in flow style", many("{a: ", 100_000), ":2:", message),
        ("lists over lines", many("[\n ", 100_000), ":", message),
        ("maps over lines", many("{a:\n ", 100_000), ":", message),
        ("lists in block style", many("- ", 100_000), ":2:", message),
        ("explicit keys", many("? ", 100_000), ":2:", ""),
        ("mixed", many("[{a: ", 100_000), ":2:", message),
        ("quotes", many("\"", 100_000), ":2:", ""),
    ])
}

#[test]
fn files_of_unlikely_size_are_refused() -> Result {
    check(&[
        ("a million keys", many("k: 1\n ", 1_000_000), "", "the file is larger than 4 MiB"),
        ("keys up to the size", many("k: 1\n ", 590_000), ":", ""),
        ("a line of 20 MB", many("x", 20_000_000), "", "the file is larger than 4 MiB"),
        ("a line of 4 MB", many("x", 4_000_000), ":", ""),
        ("a list of 4 MB", Content { start: b"a: [", repeated: "x,", times: 2_000_000 }, ":", ""),
        ("a file of 50 MB", many("k: some text\n ", 3_600_000), "", "the file is larger than 4 MiB"),
    ])
}

#[test]
fn mistakes_without_number_are_reported_soon() -> Result {
    let modes = "addressing: {all: {request: {direction: 0}, one: {direction: 1}}}\n";
    let start = WHOLE
        .replace("reply: {}}}", "reply: {}, answers: {all: one}}}")
        .replace("command: {bits: 10..0}", "direction: {bits: 10}, node: {bits: 9..0}");
    let examples = format!(
        "{start}{modes}messages:\n  one:\n    section: \"1\"\n    access: [read]\n    value: {{bytes: 7}}\n    examples:\n"
    );
    let keys = format!("{start}{modes}messages:\n  one:\n    access: [read]\n    examples:\n");
    check(&[
        (
            "wrong examples",
            Content {
                start: examples.as_bytes(),
                repeated: "      - {request: 000#0000000000000001, means: 2}\n",
                times: 30_000,
            },
            ":13:5: ",
            "no example confirms `one.value`, and 30000 contradict it",
        ),
        (
            "wrong keys",
            Content { start: keys.as_bytes(), repeated: "      - {requests: x}\n", times: 60_000 },
            ":13:10: ",
            "unknown key `requests`",
        ),
    ])
}

#[test]
fn what_is_no_file_is_refused_by_its_name() -> Result {
    let folder = tempfile::tempdir()?;
    assert_eq!(complaint(folder.path())?, ": error[file]: this is a folder, not a spec");
    assert_eq!(complaint(&folder.path().join("none.yaml"))?, ": error[file]: there is no such file");
    Ok(())
}

/// Puts a pipe that nobody writes to, and then a device, at a path. Each call must end at once, with the complaint.
#[cfg(unix)]
fn refuses_what_has_no_end(path: &Path, call: &[&str], complaint: &str) -> Result {
    let refused = |what: &str| -> Result {
        let mut canspec = Command::new(env!("CARGO_BIN_EXE_canspec"));
        let folder = path.parent().ok_or("the path has a folder")?;
        let output = canspec.args(call).current_dir(folder).stdin(Stdio::null()).output()?;
        let said = String::from_utf8(output.stderr)?;
        assert_eq!(said.lines().next(), Some(complaint), "{what}");
        assert_ne!(output.status.code(), Some(0), "{what}");
        Ok(fs::remove_file(path)?)
    };
    assert!(Command::new("mkfifo").arg(path).status()?.success());
    refused("a pipe that nobody writes to")?;
    std::os::unix::fs::symlink("/dev/zero", path)?;
    refused("a link to a device")
}

#[test]
#[cfg(unix)]
fn a_pipe_or_a_device_as_a_spec_is_refused_and_not_waited_for() -> Result {
    let folder = tempfile::tempdir()?;
    let refused = "error[file]: this is a pipe or a device, not a spec";
    let check = |name: &'static str| ["check", "--message-format", "short", name];
    refuses_what_has_no_end(&folder.path().join("a.yaml"), &check("a.yaml"), &format!("a.yaml: {refused}"))?;
    let spec = ["decode", "--spec", "a.yaml"];
    refuses_what_has_no_end(
        &folder.path().join("a.yaml"),
        &spec,
        "error[file]: this is a pipe or a device, not a spec",
    )?;
    fs::write(folder.path().join("derived.yaml"), "based_on: base\n")?;
    let base = folder.path().join("base.yaml");
    refuses_what_has_no_end(&base, &check("derived.yaml"), &format!("base.yaml: {refused}"))
}

#[test]
#[cfg(unix)]
fn a_pipe_or_a_device_as_settings_or_as_a_dbc_is_refused_and_not_waited_for() -> Result {
    let folder = tempfile::tempdir()?;
    let why = "this is a pipe or a device, not a file";
    let settings = format!("canspec: canspec.toml: {why}");
    refuses_what_has_no_end(&folder.path().join("canspec.toml"), &["decode"], &settings)?;
    let dbc = format!("canspec: a.dbc: {why}");
    refuses_what_has_no_end(&folder.path().join("a.dbc"), &["import", "dbc", "a.dbc"], &dbc)
}

#[test]
#[cfg(unix)]
fn what_a_shell_has_open_may_be_a_spec_or_a_dbc_up_to_a_size() -> Result {
    let shell = |call: &str| Command::new("sh").args(["-c", call, env!("CARGO_BIN_EXE_canspec")]).output();
    let dbc = "printf 'BO_ 1 m: 8 x\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" y\n'";
    let imported = shell(&format!("{dbc} | \"$0\" import dbc /dev/stdin --protocol p"))?;
    assert!(String::from_utf8(imported.stdout)?.contains("protocol: p\n"));
    let endless = shell("\"$0\" import dbc /dev/stdin </dev/zero")?;
    assert_eq!(String::from_utf8(endless.stderr)?, "canspec: /dev/stdin: the file is larger than 64 MiB\n");
    let spec = shell("cat /dev/zero | \"$0\" check --message-format short /dev/stdin")?;
    let said = String::from_utf8(spec.stderr)?;
    assert!(said.starts_with("/dev/stdin: error[file]: the file is larger than 4 MiB"), "{said}");
    Ok(())
}

#[test]
#[cfg(unix)]
fn decoded_lines_without_end_are_refused() -> Result {
    let shell = |call: &str| Command::new("sh").args(["-c", call, env!("CARGO_BIN_EXE_canspec")]).output();
    for (call, why) in [
        ("\"$0\" encode --protocol infy --from jsonl /dev/zero", "/dev/zero: the file is binary"),
        (
            "tr '\\0' x </dev/zero | \"$0\" encode --protocol infy --from jsonl",
            "<stdin>: line 1 has no end after 256 MiB",
        ),
    ] {
        let output = shell(call)?;
        assert_eq!(output.status.code(), Some(1), "{call}");
        assert_eq!(String::from_utf8(output.stderr)?, format!("canspec: {why}\n"));
    }
    Ok(())
}

#[test]
#[cfg(target_os = "linux")]
fn a_file_that_cannot_be_read_is_refused_by_its_name() -> Result {
    assert!(complaint(Path::new("/proc/self/mem"))?.starts_with(": error[file]: "));
    assert_eq!(complaint(Path::new("/dev/zero"))?, ": error[file]: this is a pipe or a device, not a spec");
    Ok(())
}
