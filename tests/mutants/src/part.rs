//! The parts of the sources in which mistakes are planted.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// A part of the sources, and the cheapest tests that find mistakes in it.
pub struct Part {
    /// What the list of accepted survivors is called too.
    pub name: &'static str,
    /// Files and folders of the workspace.
    pub sources: &'static [&'static str],
    /// Files and folders among them in which no test looks: other tests do, or nothing runs them.
    without: &'static [&'static str],
    /// What cargo is asked to test.
    pub tests: &'static [&'static str],
    /// How far cargo optimizes.
    pub optimization: &'static str,
}

/// All parts.
pub const PARTS: [Part; 3] = [
    Part {
        name: "runtime",
        sources: &["runtime/src"],
        without: &["tests.rs", "tests", "with_arbitrary.rs", "with_defmt.rs", "with_serde.rs", "with_serde"],
        tests: &["--package", "canspec-runtime", "--lib", "--features", "slcan,socketcan"],
        optimization: "1",
    },
    Part {
        name: "interpreter",
        sources: &[
            "codegen/src/interpret.rs",
            "codegen/src/interpret",
            "codegen/src/encoding.rs",
            "codegen/src/encoding",
            "codegen/src/model/encoding.rs",
            "codegen/src/model/signal.rs",
        ],
        without: &[],
        tests: &["--package", "canspec-codegen", "--test", "interpreter"],
        optimization: "0",
    },
    Part {
        name: "emitter",
        sources: &["codegen/src/emit/rust.rs", "codegen/src/emit/rust"],
        without: &["doc.rs", "layout.rs", "layout", "manual.rs", "manual", "parts.rs", "usage.rs"],
        tests: &["--manifest-path", "tests/downstream/Cargo.toml", "--test", "*"],
        optimization: "0",
    },
];

impl Part {
    /// Tells whether a file below its folders belongs to it.
    pub fn has(&self, file: &Path) -> bool {
        let is_left_out = |name| self.without.iter().any(|without| name == *without);
        file.extension().is_some_and(|ending| ending == "rs") && !file.iter().any(is_left_out)
    }

    /// Returns its files, in order, as paths below the folder of the workspace.
    pub fn files(&self, root: &Path) -> io::Result<Vec<PathBuf>> {
        let mut files = Vec::new();
        for source in self.sources {
            collect(root, Path::new(source), &mut files)?;
        }
        files.retain(|file| self.has(file));
        files.sort();
        Ok(files)
    }
}

fn collect(root: &Path, path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if root.join(path).is_file() {
        files.push(path.to_owned());
        return Ok(());
    }
    for entry in fs::read_dir(root.join(path)).map_err(|error| missing(path, &error))? {
        collect(root, &path.join(entry?.file_name()), files)?;
    }
    Ok(())
}

fn missing(path: &Path, error: &io::Error) -> io::Error {
    io::Error::other(format!("{}, which `tests/mutants/src/part.rs` names: {error}", path.display()))
}
