//! What a linked program consists of.

use std::ops::Sub;
use std::path::Path;
use std::{fs, io};

use object::{File, Object, ObjectSection, ObjectSymbol, Section};

/// A linked program.
#[derive(Clone, Debug)]
pub struct Binary(Vec<u8>);

/// Bytes of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Bytes of code.
    pub code: u64,
    /// Bytes of constants.
    pub constants: u64,
}

impl Sub for Size {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { code: self.code.saturating_sub(other.code), constants: self.constants.saturating_sub(other.constants) }
    }
}

impl Binary {
    /// Reads a program.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn read(path: &Path) -> io::Result<Self> {
        fs::read(path).map(Self)
    }

    /// Returns how large it is.
    pub fn size(&self) -> Size {
        let file = self.file();
        let sum = |is_one: fn(&str) -> bool| {
            file.sections().filter(|section| section.name().is_ok_and(is_one)).map(|section| section.size()).sum()
        };
        Size { code: sum(is_code), constants: sum(is_constant) }
    }

    /// Returns its constants, texts among them.
    pub fn constants(&self) -> Vec<u8> {
        let file = self.file();
        let sections = file.sections().filter(|section| section.name().is_ok_and(is_constant));
        sections.flat_map(|section| data(&section).to_vec()).collect()
    }

    /// Returns the names of its functions and statics.
    pub fn symbols(&self) -> Vec<String> {
        self.file().symbols().filter_map(|symbol| symbol.name().ok().map(str::to_owned)).collect()
    }

    fn file(&self) -> File<'_> {
        File::parse(&*self.0).expect("the linker writes object files")
    }
}

fn data<'a>(section: &Section<'a, '_>) -> &'a [u8] {
    section.data().expect("the section lies within the file")
}

fn is_code(section: &str) -> bool {
    section.starts_with(".text")
}

fn is_constant(section: &str) -> bool {
    section.starts_with(".rodata") || section.starts_with(".data.rel.ro")
}
