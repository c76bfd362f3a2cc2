//! Finds the specs that a spec is based on.

use std::borrow::Cow;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use indexmap::IndexMap;

use crate::read::source::rules::BASED_ON;
use crate::read::source::{SIZE_LIMIT, Source};
use crate::read::syntax;
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::words::nearest::nearest;

/// Most specs that stand behind a spec, each the base of the one before.
const MOST: usize = 4;

/// Specs that others can be based on, by name, beside those in their folder.
///
/// ```
/// use canspec_codegen::{Bases, source::Source};
///
/// let bases: Bases = [("heater", "canspec: 1")].into_iter().collect();
/// let source = Source::new("small.yaml", b"based_on: heater".to_vec())?;
/// assert_eq!(bases.add_to(source)?.text(), "based_on: heater\ncanspec: 1");
/// # Ok::<(), canspec_codegen::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Bases(IndexMap<String, Cow<'static, str>>);

impl<N: Into<String>, T: Into<Cow<'static, str>>> FromIterator<(N, T)> for Bases {
    fn from_iter<I: IntoIterator<Item = (N, T)>>(specs: I) -> Self {
        Self(specs.into_iter().map(|(name, text)| (name.into(), text.into())).collect())
    }
}

impl Bases {
    /// Reads a spec file and the specs that it is based on. They stand beside it, or are these.
    ///
    /// A file `NAME.yaml` beside it comes first. A base that is no file is based on these alone.
    ///
    /// # Errors
    ///
    /// [`Source::read`] refuses the spec or a base, or there is no such base. The spec is based on
    /// itself, on more than four specs in a row, or larger than [`SIZE_LIMIT`] with all of them.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<Source, Diagnostics> {
        let path = path.as_ref();
        self.complete(Source::read(path)?, path.parent())
    }

    /// Adds to a spec those that it is based on, out of these.
    ///
    /// # Errors
    ///
    /// As [`Bases::read`] has them.
    pub fn add_to(&self, source: Source) -> Result<Source, Diagnostics> {
        self.complete(source, None)
    }

    fn complete(&self, mut source: Source, mut folder: Option<&Path>) -> Result<Source, Diagnostics> {
        let mut chain = vec![stem(source.name()).to_owned()];
        while let Some((name, at)) = syntax::based_on(&source) {
            chain.push(name);
            let base = match self.base(&source, &chain, folder) {
                Ok(base) => base,
                Err(Flaw::Own { message, help }) => {
                    let problem = Diagnostic::error(&BASED_ON, at, message).help(help);
                    return Err(Diagnostics::new(source).with([problem]));
                }
                Err(Flaw::OfBase(diagnostics)) => return Err(diagnostics),
            };
            folder = folder.filter(|_| base.is_file());
            source = source.with_base(base);
        }
        Ok(source)
    }

    /// Finds the base that a chain ends with, or says why there is none.
    fn base(&self, source: &Source, chain: &[String], folder: Option<&Path>) -> Result<Source, Flaw> {
        let name = chain.last().filter(|name| is_name(name)).ok_or_else(|| misnamed(chain))?;
        let found = self.find(name, folder).map_err(Flaw::OfBase)?;
        let base = found.ok_or_else(|| self.missing(name, chain, folder))?;
        flaw(source, &base, chain).map_or(Ok(base), Err)
    }

    /// Finds a spec in a folder, or else among these.
    fn find(&self, name: &str, folder: Option<&Path>) -> Result<Option<Source>, Diagnostics> {
        let file = format!("{name}.yaml");
        let beside = folder.map(|folder| folder.join(&file)).filter(|path| is_there(path));
        let known = || self.0.get(name).map(|text| Source::new(file, text.as_bytes().to_vec()));
        beside.map(|path| Source::read(&path)).or_else(known).transpose()
    }

    fn missing(&self, name: &str, chain: &[String], folder: Option<&Path>) -> Flaw {
        let beside = folder.map(names_in).unwrap_or_default();
        let others = beside.iter().chain(self.0.keys()).filter(|other| !chain.contains(other));
        let help = match nearest(name, others.map(String::as_str)) {
            Some(meant) => format!("did you mean `{meant}`?"),
            None if self.0.is_empty() => format!(
                "put it beside this file as `{name}.yaml`; a build script names built-in specs by `Builder::bases`"
            ),
            None => {
                let known: Vec<_> = self.0.keys().map(String::as_str).collect();
                format!("put it beside this file as `{name}.yaml`, or take one of {}", known.join(", "))
            }
        };
        Flaw::Own { message: format!("there is no spec `{name}`"), help }
    }
}

/// Why a spec cannot be based on another one.
enum Flaw {
    /// What is wrong with the name of the base, and what to do.
    Own { message: String, help: String },
    /// The base cannot be read.
    OfBase(Diagnostics),
}

fn flaw(source: &Source, base: &Source, chain: &[String]) -> Option<Flaw> {
    let row = || chain.join(" → ");
    if source.holds(base) {
        let message = format!("a spec is based on itself: {}", row());
        let help = match chain {
            [own, _] => format!("name another spec; if you mean the built-in `{own}`, rename this file"),
            _ => "base one of them on no other spec".to_owned(),
        };
        return Some(Flaw::Own { message, help });
    }
    if chain.len() > MOST + 1 {
        let message = format!("more than {MOST} specs stand behind this one: {}", row());
        return Some(Flaw::Own { message, help: "base a spec of the row on one that is further back".to_owned() });
    }
    if source.text().len() + base.text().len() >= SIZE_LIMIT {
        let message = format!("the spec and those that it is based on are larger than {} MiB", SIZE_LIMIT >> 20);
        return Some(Flaw::Own { message, help: "check that these are the specs you mean".to_owned() });
    }
    None
}

fn misnamed(chain: &[String]) -> Flaw {
    let name = chain.last().map_or("", String::as_str);
    let plain: String = stem(name).chars().filter(|letter| is_of_name(*letter)).collect();
    let help = if is_name(&plain) {
        format!("write `{plain}` for the file `{plain}.yaml` beside this one")
    } else {
        "write the name of a file beside this one without `.yaml`, or of a built-in protocol".to_owned()
    };
    Flaw::Own { message: format!("`{name}` is not the name of a spec"), help }
}

/// Tests the form of a name. It becomes the name of a file and of a document.
fn is_name(name: &str) -> bool {
    name.starts_with(|letter: char| letter.is_ascii_alphabetic()) && name.chars().all(is_of_name)
}

fn is_of_name(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

/// Tests whether something has the name of a file, though it may be no file that can be read.
fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).map_or_else(|error| error.kind() != ErrorKind::NotFound, |_| true)
}

/// Returns the name of a file without folders and ending.
fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// Returns the names of the specs in a folder.
fn names_in(folder: &Path) -> Vec<String> {
    let here = if folder == Path::new("") { Path::new(".") } else { folder };
    let entries = fs::read_dir(here).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".yaml")?.to_owned()));
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}
