//! Fuzz targets, what they start from, and how an input becomes another one.
//!
//! libFuzzer runs them from `tests/fuzz`, the ordinary tests for a few seconds from `tests/tests/fuzz.rs`.

mod change;
mod dbc;
mod emitted;
mod frames;
mod front_end;
mod lines;
mod logs;
mod names;
mod specs;

use std::fs;
use std::path::{Path, PathBuf};

use fastrand::Rng;

/// One thing to feed with bytes.
#[derive(Clone, Copy)]
pub struct Target {
    /// Name of the target, and of its folders.
    pub name: &'static str,
    /// Runs on any bytes, and panics if something is wrong with what comes of them.
    pub run: fn(&[u8]),
    /// Returns the inputs to start from.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Makes another input of one, which is close to it.
    pub mutated: fn(&[u8], &mut Rng) -> Vec<u8>,
}

/// Takes any bytes for a spec.
pub const FRONT_END: Target =
    Target { name: "front_end", run: front_end::run, seeds: specs::seeds, mutated: change::mutated };

/// Takes any bytes for a frame and a value of one of the protocols.
pub const FRAMES: Target = Target { name: "frames", run: frames::run, seeds: frames::seeds, mutated: frames::mutated };

/// Takes any bytes for a log, of candump or of JSON lines.
pub const LOGS: Target = Target { name: "logs", run: logs::run, seeds: lines::logs, mutated: lines::mutated };

/// Takes any bytes for a DBC.
pub const DBC: Target = Target { name: "dbc", run: dbc::run, seeds: lines::dbcs, mutated: lines::mutated };

/// All targets.
pub const TARGETS: [Target; 4] = [FRONT_END, FRAMES, LOGS, DBC];

/// Returns the inputs that were once found to break a target; one without a folder has none.
pub fn regressions(target: &Target) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/regressions").join(target.name);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}
