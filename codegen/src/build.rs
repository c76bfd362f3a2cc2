//! Compiles specs from a build script, and writes what was generated.
//!
//! The [`Builder`] finds the specs, compiles and checks each, and has their Rust emitted. `files`
//! writes all files or none, and never over one that somebody wrote by hand. `cargo` tells Cargo
//! what to watch, and shows it each diagnostic. The command uses `generate` and `files`, too.

mod cargo;
pub mod files;
mod generated;
mod inputs;
mod list;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::{env, io};

use crate::emit::{Goal, Options, Scaled, Switch};
use crate::read::bases::Bases;
use crate::report::diagnostic::Diagnostics;
pub use generated::{Generated, generate};
use inputs::Inputs;

/// Compiles specs into `OUT_DIR`. The crate includes them from there.
///
/// ```no_run
/// // build.rs
/// canspec_codegen::Builder::new().folder("specs").build();
/// ```
///
/// ```rs
/// // lib.rs: the module of one protocol
/// pub mod heater {
///     canspec_runtime::include_protocol!("heater");
/// }
/// ```
///
/// ```rs
/// // or a module for each protocol
/// include!(concat!(env!("OUT_DIR"), "/protocols.rs"));
/// ```
///
/// A wrong spec stops the build: cargo shows each diagnostic as an error, and nothing is written.
#[derive(Clone, Debug)]
pub struct Builder {
    folders: Vec<PathBuf>,
    specs: Vec<PathBuf>,
    out_dir: Option<PathBuf>,
    bases: Bases,
    options: Options,
}

impl Builder {
    /// Returns a builder without specs. Its [goal](Self::goal) is that of the profile that cargo builds.
    pub fn new() -> Self {
        let options = Options { goal: goal_of(env::var("OPT_LEVEL").ok().as_deref()), ..Options::default() };
        let (folders, specs) = (Vec::new(), Vec::new());
        Self { folders, specs, out_dir: None, bases: Bases::default(), options }
    }

    /// Adds one spec, by its path from the crate's root. A file that is added twice counts once.
    #[must_use]
    pub fn spec(mut self, path: impl Into<PathBuf>) -> Self {
        self.specs.push(path.into());
        self
    }

    /// Adds every `*.yaml` of a folder, by the folder's path from the crate's root. The folder may
    /// have none.
    ///
    /// It skips hidden files, and folders in the folder. A `*.yml` is an error that asks for
    /// another name.
    #[must_use]
    pub fn folder(mut self, path: impl Into<PathBuf>) -> Self {
        self.folders.push(path.into());
        self
    }

    /// Sets the specs that others can be based on, beside those in the folder of each.
    ///
    /// A build script that depends on `canspec-specs` adds the built-in specs by
    /// `canspec_specs::SPECS.iter().map(|spec| (spec.name, spec.text)).collect()`.
    #[must_use]
    pub fn bases(self, bases: Bases) -> Self {
        Self { bases, ..self }
    }

    /// Sets a folder to write to instead of `OUT_DIR`, by its path from the crate's root.
    ///
    /// Each builder needs a folder of its own. It replaces the `protocols.rs` there, and removes
    /// protocols that the old list names and the new one does not. It never replaces or removes a
    /// file that it did not generate. If such a file is in the way, the build fails.
    #[must_use]
    pub fn out_dir(self, path: impl Into<PathBuf>) -> Self {
        Self { out_dir: Some(path.into()), ..self }
    }

    /// Sets all options of the generated code.
    #[must_use]
    pub fn options(self, options: Options) -> Self {
        Self { options, ..self }
    }

    /// Sets what scaled values are: `f64`, `f32` or whole steps.
    #[must_use]
    pub fn scaled(mut self, scaled: Scaled) -> Self {
        self.options.scaled = scaled;
        self
    }

    /// Sets what programs are optimized for. A build script has size if the `opt-level` of the profile is `s` or `z`,
    /// and else speed.
    #[must_use]
    pub fn goal(mut self, goal: Goal) -> Self {
        self.options.goal = goal;
        self
    }

    /// Sets whether generated types implement `serde::Serialize` and `serde::Deserialize`.
    #[must_use]
    pub fn serde(mut self, switch: Switch) -> Self {
        self.options.serde = switch;
        self
    }

    /// Sets whether generated types implement `defmt::Format`.
    #[must_use]
    pub fn defmt(mut self, switch: Switch) -> Self {
        self.options.defmt = switch;
        self
    }

    /// Sets whether generated types implement `arbitrary::Arbitrary`.
    #[must_use]
    pub fn arbitrary(mut self, switch: Switch) -> Self {
        self.options.arbitrary = switch;
        self
    }

    /// Compiles the specs and writes `PROTOCOL.rs` for each and `protocols.rs` for all of them.
    ///
    /// It prints errors and warnings for cargo, which fails the build if there is an error. It
    /// writes nothing before all specs are compiled, and never rewrites a file that would not
    /// change.
    #[expect(clippy::print_stdout, reason = "cargo reads what a build script prints")]
    pub fn build(&self) {
        self.run().iter().for_each(|line| println!("{line}"));
    }

    /// Compiles the specs and writes nothing.
    ///
    /// # Errors
    ///
    /// A spec or folder cannot be read, a spec has errors, or two specs have one protocol name.
    pub fn compile(&self) -> Result<Vec<Generated>, Vec<Diagnostics>> {
        generated::all(self.inputs(), &self.options)
    }

    /// Does the work of [`Builder::build`], and returns the lines for cargo.
    fn run(&self) -> Vec<String> {
        let inputs = self.inputs();
        let mut lines = cargo::rerun(self.folders.iter().chain(&inputs.files));
        match generated::all(inputs, &self.options) {
            Ok(generated) => {
                lines.extend(generated.iter().flat_map(|one| cargo::diagnostics(&one.warnings)));
                lines.extend(self.write(&generated).err().map(|error| cargo::unwritten(&error)));
            }
            Err(refused) => lines.extend(refused.iter().flat_map(cargo::diagnostics)),
        }
        lines
    }

    fn inputs(&self) -> Inputs {
        inputs::find(&self.specs, &self.folders, &self.bases)
    }

    fn write(&self, generated: &[Generated]) -> io::Result<()> {
        let folder = self.out_dir.clone().or_else(|| env::var_os("OUT_DIR").map(PathBuf::from));
        let folder = folder.ok_or_else(|| io::Error::other("OUT_DIR is not set: this is for build scripts"))?;
        write(&folder, generated)
    }
}

impl Default for Builder {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns what a profile with such an `opt-level` optimizes for.
fn goal_of(level: Option<&str>) -> Goal {
    if let Some("s" | "z") = level { Goal::Size } else { Goal::Speed }
}

/// Replaces the protocols of a folder.
fn write(folder: &Path, generated: &[Generated]) -> io::Result<()> {
    let mut files: Vec<_> = generated.iter().map(|one| one.file_in(folder)).collect();
    files.push(list::file_in(folder, generated));
    let gone = list::listed(folder).into_iter().filter(|path| files.iter().all(|file| file.path() != path));
    let gone: Vec<_> = gone.collect();
    files::write(&files)?;
    files::remove(&gone)
}
