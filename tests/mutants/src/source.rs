//! The sources of a part, and the mistakes that can be made in them.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::copy::{Copy, Verdict};
use super::mistake::Mistake;
use super::part::Part;
use super::plant;

/// A file of a part.
pub struct Source {
    /// Path below the folder of the workspace.
    pub path: PathBuf,
    module: String,
    syntax: syn::File,
    mistakes: Vec<Mistake>,
}

/// A mistake in its file.
pub struct Place<'a> {
    /// The file.
    pub source: &'a Source,
    /// What can be mistaken there.
    pub mistake: &'a Mistake,
    number: usize,
}

impl Source {
    /// Reads the files of a part.
    pub fn all(part: &Part, root: &Path) -> io::Result<Vec<Self>> {
        part.files(root)?.into_iter().map(|path| Self::read(path, root)).collect()
    }

    fn read(path: PathBuf, root: &Path) -> io::Result<Self> {
        let syntax = syn::parse_file(&fs::read_to_string(root.join(&path))?).map_err(io::Error::other)?;
        let module = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mistakes = plant::mistakes(&syntax, &module);
        Ok(Self { path, module, syntax, mistakes })
    }

    /// Returns the mistakes that can be made in the file.
    pub fn places(&self) -> impl Iterator<Item = Place<'_>> {
        self.mistakes.iter().enumerate().map(|(number, mistake)| Place { source: self, mistake, number })
    }

    /// Writes the file into a copy, as it is printed from its syntax, so that a mistake changes nothing else.
    pub fn print(&self, copy: &Copy) -> io::Result<()> {
        copy.write(&self.path, &self.syntax)
    }
}

impl Place<'_> {
    /// Plants the mistake, runs the tests, and takes it out again.
    pub fn verdict(&self, copy: &Copy) -> io::Result<Verdict> {
        let Self { source, number, .. } = self;
        copy.write(&source.path, &plant::planted(&source.syntax, &source.module, *number))?;
        let verdict = copy.verdict();
        source.print(copy)?;
        verdict
    }
}
