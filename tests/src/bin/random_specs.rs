//! Compiles random specs, and the Rust of those that are accepted: `random_specs COUNT [FIRST]`.

use std::path::Path;
use std::{env, io};

use canspec_tests::random_specs::run::Run;

/// How many specs are compiled as one crate.
const BATCH: usize = 250;

#[expect(clippy::print_stdout, reason = "people read what came of the specs")]
fn main() -> io::Result<()> {
    let mut numbers = env::args().skip(1).map(|text| text.parse().map_err(io::Error::other));
    let count = numbers.next().unwrap_or_else(|| Err(io::Error::other("call it as `random_specs COUNT [FIRST]`")))?;
    let first = numbers.next().unwrap_or(Ok(0))?;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/random_specs");
    let mut run = Run::default();
    let seeds: Vec<_> = (first..first + count).collect();
    for batch in seeds.chunks(BATCH) {
        run.add(batch.iter().copied(), &folder)?;
        eprintln!("{} specs, {} rejected, {} complaints", run.specs, run.rejections(), run.complaints.len());
    }
    println!("{run}");
    if run.complaints.is_empty() { Ok(()) } else { Err(io::Error::other("some Rust does not compile")) }
}
