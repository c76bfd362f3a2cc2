//! Generated Rust of many specs in one crate, which is compiled with warnings denied.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use canspec_codegen::emit::{Goal, Options, Scaled, Switch};
use canspec_codegen::generate;
use canspec_codegen::source::Source;

/// Returns the Rust of a spec, with all optional traits.
///
/// # Errors
///
/// What is wrong with the spec, or with scaled values of this type.
pub fn rust(text: &str, scaled: Scaled) -> Result<String, String> {
    let goal = if scaled == Scaled::Steps { Goal::Size } else { Goal::Speed };
    let every = Options { scaled, goal, serde: Switch::Always, defmt: Switch::Always, arbitrary: Switch::Always };
    let source = Source::new("spec.yaml", text.as_bytes().to_vec()).map_err(|errors| errors.concise())?;
    generate(source, &every).map(|generated| generated.code).map_err(|errors| errors.concise())
}

/// Modules of one crate.
#[derive(Debug)]
pub struct Crate {
    folder: PathBuf,
    modules: BTreeSet<String>,
}

impl Crate {
    /// Starts a crate in a folder, which other crates can have had before.
    ///
    /// # Errors
    ///
    /// If the folder cannot be written.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let folder = folder.to_owned();
        fs::create_dir_all(&folder)?;
        Ok(Self { folder, modules: BTreeSet::new() })
    }

    /// Adds a module.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn add(&mut self, name: &str, code: &str) -> io::Result<()> {
        self.modules.insert(name.to_owned());
        fs::write(self.file(name), code)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.rs"))
    }

    /// Compiles all modules; returns what the compiler says, a line each.
    ///
    /// What is wrong with one module can hide what is wrong with others, so these are compiled again without it.
    ///
    /// # Errors
    ///
    /// If files cannot be written, or cargo does not start.
    pub fn compile(mut self) -> io::Result<Vec<String>> {
        let mut complaints = Vec::new();
        loop {
            let lines = self.check()?;
            let wrong: BTreeSet<_> = lines.iter().filter_map(|line| Some(line.split_once(".rs:")?.0)).collect();
            let count = self.modules.len();
            self.modules.retain(|name| !wrong.contains(name.as_str()));
            let is_last = self.modules.len() == count;
            complaints.extend(lines);
            if is_last {
                return Ok(complaints);
            }
        }
    }

    /// Compiles the modules that are left.
    fn check(&self) -> io::Result<Vec<String>> {
        let modules = self.folder.join("modules.rs");
        let module = |name: &String| {
            format!("/// A protocol.\npub mod {name} {{ include!(\"{}\"); }}\n", self.file(name).display())
        };
        fs::write(&modules, self.modules.iter().map(module).collect::<String>())?;
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let manifest = root.join("compiled");
        // The versions of this workspace; all of them are on the machine already.
        fs::copy(root.join("../Cargo.lock"), manifest.join("Cargo.lock"))?;
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["check", "--offline", "--quiet", "--message-format", "short", "--target-dir"])
            .arg(self.folder.join("target"))
            .env("CANSPEC_MODULES", &modules)
            .env("CARGO_INCREMENTAL", "0")
            .env_remove("RUSTFLAGS")
            .current_dir(manifest)
            .output()?;
        let said = String::from_utf8_lossy(&output.stderr);
        let lines = said.lines().filter(|_| !output.status.success());
        Ok(lines.map(|line| line.replace(&format!("{}/", self.folder.display()), "")).collect())
    }
}
