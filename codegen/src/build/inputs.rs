//! The spec files that a builder compiles.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::read::bases::Bases;
use crate::read::source::{self, Source};
use crate::report::diagnostic::{At, Diagnostic, Diagnostics};

/// The specs to compile.
pub struct Inputs {
    /// Every spec once: first the named ones, then those of each folder in the order of their
    /// names.
    pub specs: Vec<Result<Source, Diagnostics>>,
    /// The files of the specs, and those that they are based on.
    pub files: Vec<PathBuf>,
    /// What is wrong with the folders.
    pub refused: Vec<Diagnostics>,
}

/// Finds the named specs, and those of the folders, and reads them.
pub fn find(specs: &[PathBuf], folders: &[PathBuf], bases: &Bases) -> Inputs {
    let (mut specs, mut refused) = (specs.to_vec(), Vec::new());
    for folder in folders {
        match entries(folder) {
            Ok(files) => {
                let (right, wrong): (Vec<_>, Vec<_>) = files.into_iter().partition(|path| ending(path) == "yaml");
                specs.extend(right);
                refused.extend(wrong.iter().map(|path| misnamed(path)));
            }
            Err(error) => refused.push(unreadable(folder, &error)),
        }
    }
    let files = distinct(specs);
    let specs: Vec<_> = files.iter().map(|path| bases.read(path)).collect();
    let read = specs.iter().map(|read| read.as_ref().unwrap_or_else(|refused| refused.source()));
    let bases = read.flat_map(Source::paths_of_bases).map(Path::to_owned);
    let files = distinct(files.iter().cloned().chain(bases).collect());
    Inputs { specs, files, refused }
}

/// Returns the files of a folder that end like a spec, in small or capital letters.
fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
        if !hidden && !path.is_dir() && ["yaml", "yml"].contains(&ending(&path).to_lowercase().as_str()) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn ending(path: &Path) -> &str {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default()
}

/// Keeps the first of several paths to one file.
fn distinct(mut paths: Vec<PathBuf>) -> Vec<PathBuf> {
    let mut seen = BTreeSet::new();
    paths.retain(|path| seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())));
    paths
}

fn misnamed(path: &Path) -> Diagnostics {
    let name = path.with_extension("yaml");
    let what = format!("the folder's specs end in `.yaml`, this file in `.{}`", ending(path));
    refused(
        path,
        Diagnostic::error(&crate::read::source::rules::FILE, At::File, what)
            .help(format!("rename it to {}", name.display())),
    )
}

fn unreadable(folder: &Path, error: &io::Error) -> Diagnostics {
    #[expect(clippy::wildcard_enum_match_arm, reason = "the standard library's enum is open")]
    let what = match error.kind() {
        io::ErrorKind::NotFound => "there is no such folder".to_owned(),
        io::ErrorKind::NotADirectory => "this is a file, not a folder of specs".to_owned(),
        _ => format!("the folder cannot be read: {error}"),
    };
    refused(
        folder,
        Diagnostic::error(&crate::read::source::rules::FILE, At::File, what)
            .help("check the path and the folder it starts from"),
    )
}

fn refused(path: &Path, problem: Diagnostic) -> Diagnostics {
    source::refused(&path.display().to_string(), String::new(), problem)
}
