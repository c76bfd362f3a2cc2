//! Changes of the lines of a log or of a DBC.

use std::fs;
use std::path::Path;

use canspec_codegen::emit;
use fastrand::Rng;

use crate::{protocol, specs};

/// What stands in lines, and what should not.
const PIECES: [&str; 44] = [
    "\t",
    " ",
    "  ",
    "#",
    "##1",
    "#R8",
    "(",
    ")",
    "(1e400)",
    "(-0)",
    "\u{FEFF}",
    "\u{202E}",
    "\u{1b}[2J",
    "\r",
    "\"",
    ";",
    ",",
    "[8]",
    "base dec",
    "0x",
    ":",
    "|",
    "@1-",
    "@0+",
    "M",
    "m0",
    "m1M",
    "BO_ ",
    "SG_ ",
    "VAL_ ",
    "CM_ ",
    "SIG_VALTYPE_ ",
    "SG_MUL_VAL_ ",
    "BA_ ",
    "0",
    "1",
    "-1",
    "63",
    "64",
    "2048",
    "2147483648",
    "4294967295",
    "1e308",
    "0.1",
];

/// Returns files of the workspace with one of these endings.
fn files(folders: &[&str], ending: &str) -> Vec<Vec<u8>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let entries = folders.iter().flat_map(|folder| fs::read_dir(root.join(folder)).expect("the folder exists"));
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|known| known == ending));
    paths.sort();
    paths.iter().map(|path| fs::read(path).expect("the file can be read")).collect()
}

/// Returns the logs of the workspace.
pub fn logs() -> Vec<Vec<u8>> {
    let lines = files(&["tests/commands/encode.in"], "jsonl");
    let others = ["asc", "csv", "log", "plain", "slcan"].map(|ending| files(&["cli/tests/logs"], ending));
    [files(&["tests/logs", "tests/commands/decode.in"], "log"), others.concat(), lines].concat()
}

/// Returns the DBC files of the workspace, and those of its specs.
pub fn dbcs() -> Vec<Vec<u8>> {
    let exported = ["tests/specs/features", "tests/specs/devices"].into_iter().flat_map(specs);
    let exported = exported.map(|spec| emit::dbc(&protocol(spec), None).text.into_bytes());
    files(&["tests/commands/import.in", "generated/benches"], "dbc").into_iter().chain(exported).collect()
}

/// Changes a few lines of a file, and keeps at most forty lines.
pub fn mutated(bytes: &[u8], random: &mut Rng) -> Vec<u8> {
    let text = String::from_utf8_lossy(bytes);
    let lines: Vec<&str> = text.lines().collect();
    let first = random.usize(0..=lines.len().saturating_sub(40));
    let mut lines: Vec<String> = lines.into_iter().skip(first).take(40).map(str::to_owned).collect();
    for _ in 0..random.usize(1..4) {
        let place = random.usize(0..=lines.len());
        match random.u8(0..6) {
            0 => lines.insert(place, lines.get(random.usize(0..=lines.len())).cloned().unwrap_or_default()),
            1 if place < lines.len() => drop(lines.remove(place)),
            _ => lines.get_mut(place).into_iter().for_each(|line| change(line, random)),
        }
    }
    lines.join("\n").into_bytes()
}

/// Puts a piece into a line, or in the place of a word or a number.
fn change(line: &mut String, random: &mut Rng) {
    let piece = PIECES[random.usize(..PIECES.len())];
    let edges: Vec<usize> = line.char_indices().map(|(at, _)| at).chain([line.len()]).collect();
    let start = edges[random.usize(..edges.len())];
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    let end = line[start..].find(|letter| !is_part(letter)).map_or(line.len(), |length| start + length);
    let end = if random.bool() { start } else { end };
    line.replace_range(start..end, piece);
}
