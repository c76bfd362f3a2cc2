//! Compares generated files with the disk, and writes all of them or none.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::{fs, io, process};

use crate::emit::MARK;
use crate::read::source::open_whole;
use crate::words::visible::visible;

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
    /// It was generated and has another text, or it is empty.
    Stale,
    /// It was not generated, so it is left alone.
    NotOurs,
    /// There is no such file.
    Missing,
}

impl File {
    /// Describes a file. It writes nothing yet.
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
    /// The file exists but cannot be read.
    pub fn state(&self) -> io::Result<State> {
        match read(&self.path) {
            Ok(known) if known == self.text.as_bytes() => Ok(State::Current),
            Ok(known) if known.is_empty() || is_ours(&known) => Ok(State::Stale),
            Ok(_) => Ok(State::NotOurs),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(State::Missing),
            Err(error) => Err(at(&self.path, &error)),
        }
    }

    /// Says what to do about a file that was not generated.
    pub fn not_ours(&self) -> io::Error {
        let what = "canspec did not generate this file; move it, or write to another folder";
        at(&self.path, &io::Error::new(io::ErrorKind::AlreadyExists, what))
    }

    /// Tests whether the text must be written.
    fn must_be_written(&self) -> io::Result<bool> {
        match self.state()? {
            State::Current => Ok(false),
            State::Stale | State::Missing => Ok(true),
            State::NotOurs => Err(self.not_ours()),
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

/// A file whose text is on disk under another name, until it is put in place or dropped.
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

/// Writes the files that do not have their text yet, and creates their folders.
///
/// It puts every text on disk before it replaces the first file, and replaces each file in one
/// step.
///
/// # Errors
///
/// A folder or file cannot be read or written, or a file that was not generated is in the way. The
/// error names it.
pub fn write(files: &[File]) -> io::Result<()> {
    let mut changed = Vec::new();
    for file in files {
        if file.must_be_written()? {
            changed.push(file);
        }
    }
    let staged = changed.into_iter().map(File::stage).collect::<io::Result<Vec<_>>>()?;
    staged.iter().try_for_each(Staged::put)
}

/// Removes the generated ones among the files. They may be gone already.
pub(crate) fn remove(paths: &[PathBuf]) -> io::Result<()> {
    let mut generated = paths.iter().filter(|path| read(path).is_ok_and(|text| is_ours(&text)));
    generated.try_for_each(|path| fs::remove_file(path).map_err(|error| at(path, &error)))
}

/// Reads what should be a generated file. Others may have put something in its place that has no end.
pub(crate) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_whole(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn is_ours(text: &[u8]) -> bool {
    text.starts_with(MARK.as_bytes())
}

fn at(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", visible(&path.display().to_string())))
}
