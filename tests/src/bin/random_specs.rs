//! Compiles random specs, and the Rust of those that are accepted: `random_specs COUNT [FIRST]`.

use std::path::Path;
use std::{env, io};

use canspec_tests::random_specs::run::Run;

/// How many specs are compiled as one crate.
const BATCH: u64 = 250;

fn main() -> io::Result<()> {
    let mut numbers = env::args().skip(1).map(|text| text.parse().map_err(io::Error::other));
    let count = numbers.next().unwrap_or_else(|| Err(io::Error::other("call it as `random_specs COUNT [FIRST]`")))?;
    let first = numbers.next().unwrap_or(Ok(0))?;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/random_specs");
    let mut run = Run::default();
    for start in (first..first + count).step_by(250) {
        run.add(start..(start + BATCH).min(first + count), &folder)?;
        eprintln!("{} specs, {} rejected, {} complaints", run.specs, run.rejections(), run.complaints.len());
    }
    println!("{run}");
    if run.complaints.is_empty() { Ok(()) } else { Err(io::Error::other("some Rust does not compile")) }
}
