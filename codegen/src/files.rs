//! Files of generated code: what state they are in, and writing all of them or none.

use std::path::{Path, PathBuf};
use std::{fs, io, process};

/// A file and the text that it should have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    path: PathBuf,
    text: String,
}

/// How a file on disk compares with its text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It has the text.
    Current,
    /// It has another text.
    Stale,
    /// There is no such file.
    Missing,
}

impl File {
    /// Describes a file; nothing is written yet.
    pub fn new(path: PathBuf, text: String) -> Self {
        Self { path, text }
    }

    /// Returns where the file stands.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Compares the file on disk with the text.
    ///
    /// # Errors
    ///
    /// The file is there and cannot be read.
    pub fn state(&self) -> io::Result<State> {
        match fs::read(&self.path) {
            Ok(known) if known == self.text.as_bytes() => Ok(State::Current),
            Ok(_) => Ok(State::Stale),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(State::Missing),
            Err(error) => Err(at(&self.path, &error)),
        }
    }

    /// Writes the text beside the file.
    fn stage(&self) -> io::Result<Staged<'_>> {
        let (folder, name) = (self.path.parent().unwrap_or(Path::new("")), self.path.file_name().unwrap_or_default());
        let beside = folder.join(format!(".{}.{}", name.display(), process::id()));
        let staged = Staged { file: self, beside };
        fs::create_dir_all(folder).map_err(|error| at(folder, &error))?;
        fs::write(&staged.beside, &self.text).map_err(|error| at(&self.path, &error))?;
        Ok(staged)
    }
}

/// A file of which the text is on disk under another name, until it is put in place or dropped.
struct Staged<'a> {
    file: &'a File,
    beside: PathBuf,
}

impl Staged<'_> {
    fn put(&self) -> io::Result<()> {
        fs::rename(&self.beside, &self.file.path).map_err(|error| at(&self.file.path, &error))
    }
}

impl Drop for Staged<'_> {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.beside);
    }
}

/// Writes the files that do not have their text, and the folders they stand in.
///
/// Each text is on disk before the first file is replaced, and a file is replaced in one step.
///
/// # Errors
///
/// A folder or file cannot be read or written; the error names it.
pub fn write(files: &[File]) -> io::Result<()> {
    let mut staged = Vec::new();
    for file in files {
        if file.state()? != State::Current {
            staged.push(file.stage()?);
        }
    }
    staged.iter().try_for_each(Staged::put)
}

/// Removes files that may be gone already.
pub(crate) fn remove(paths: &[PathBuf]) -> io::Result<()> {
    for path in paths {
        match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(at(path, &error)),
            _ => {}
        }
    }
    Ok(())
}

fn at(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}
