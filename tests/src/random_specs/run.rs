//! Many random specs: what is rejected, which keys they set, and what the compiler says of their Rust.

use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::path::Path;

use canspec_codegen::emit::Scaled;

use super::Spec;
use super::compiled::{Crate, rust};
use super::keys::Keys;

/// What came of random specs.
#[derive(Debug, Default)]
pub struct Run {
    /// How many specs there were.
    pub specs: usize,
    /// How many of them each rule rejected, and the first of these with its first error.
    pub rejected: BTreeMap<String, (usize, String)>,
    /// How many modules were compiled.
    pub modules: usize,
    /// What the compiler says of them, a line each.
    pub complaints: Vec<String>,
    /// The keys that they set.
    pub keys: Keys,
}

impl Run {
    /// Makes the specs of some seeds, and compiles those that are accepted as one crate in a folder.
    ///
    /// # Errors
    ///
    /// If files cannot be written, or cargo does not start.
    pub fn add(&mut self, seeds: impl Iterator<Item = u64>, folder: &Path) -> io::Result<()> {
        let mut modules = Crate::new(folder)?;
        for seed in seeds {
            let spec = Spec::new(seed);
            self.specs += 1;
            self.keys.add(&spec.tree);
            if let Err(errors) = self.add_spec(&spec, &mut modules)? {
                self.reject(seed, &errors);
            }
        }
        self.complaints.extend(modules.compile()?);
        Ok(())
    }

    fn add_spec(&mut self, spec: &Spec, modules: &mut Crate) -> io::Result<Result<(), String>> {
        let scaled = match spec.seed % 3 {
            0 => Scaled::F64,
            1 => Scaled::F32,
            _ => Scaled::Steps,
        };
        // Single precision does not suit every spec.
        let code = match rust(&spec.text, scaled).or_else(|_| rust(&spec.text, Scaled::F64)) {
            Ok(code) => code,
            Err(errors) => return Ok(Err(errors)),
        };
        modules.add(&format!("spec_{}", spec.seed), &code)?;
        self.modules += 1;
        Ok(Ok(()))
    }

    fn reject(&mut self, seed: u64, errors: &str) {
        let error = errors.lines().find(|line| line.contains("error[")).unwrap_or(errors);
        let rule = error.split_once("error[").and_then(|(_, rest)| rest.split_once(']'));
        let rule = rule.map_or("?", |(rule, _)| rule).to_owned();
        self.rejected.entry(rule).or_insert_with(|| (0, format!("spec {seed}: {error}"))).0 += 1;
    }

    /// Returns how many specs were rejected.
    pub fn rejections(&self) -> usize {
        self.rejected.values().map(|(count, _)| count).sum()
    }
}

impl fmt::Display for Run {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { specs, rejected, modules, complaints, keys } = self;
        writeln!(formatter, "{}", keys.table())?;
        complaints.iter().try_for_each(|line| writeln!(formatter, "{line}"))?;
        writeln!(formatter, "{} of {specs} specs are rejected:", self.rejections())?;
        for (rule, (count, first)) in rejected {
            writeln!(formatter, "{count} by `{rule}`, the first of them is {first}")?;
        }
        writeln!(formatter, "{modules} modules are compiled, with {} complaints", complaints.len())
    }
}
