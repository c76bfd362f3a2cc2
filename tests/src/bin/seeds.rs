//! Writes the inputs that the fuzz targets start from, a folder a target: `seeds FOLDER`.

use std::path::PathBuf;
use std::{env, fs, io};

use canspec_tests::fuzz::TARGETS;

fn main() -> io::Result<()> {
    let folder = env::args().nth(1).map(PathBuf::from).ok_or_else(|| io::Error::other("call it as `seeds FOLDER`"))?;
    for target in TARGETS {
        let inputs = folder.join(target.name);
        fs::create_dir_all(&inputs)?;
        for (index, seed) in (target.seeds)().iter().enumerate() {
            fs::write(inputs.join(format!("seed-{index}")), seed)?;
        }
    }
    Ok(())
}
