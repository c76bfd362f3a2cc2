//! Compiles a spec to generated code.

use std::path::Path;

use super::inputs::Inputs;
use super::list;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::emit::{self, Options};
use crate::files::File;
use crate::source::Source;
use crate::syntax::tree;
use crate::{Outcome, check, compile};

/// Rust that was generated from one spec.
#[derive(Clone, Debug)]
pub struct Generated {
    /// Name of the protocol.
    pub name: String,
    /// Documentation of the module, as inner doc comments to stand before its content.
    pub manual: String,
    /// Content of a module.
    pub code: String,
    /// Warnings about the spec.
    pub warnings: Diagnostics,
}

impl Generated {
    /// Returns the code as the file `PROTOCOL.rs` in a folder.
    pub fn file_in(&self, folder: &Path) -> File {
        File::new(folder.join(format!("{}.rs", self.name)), self.code.clone())
    }
}

/// Compiles one spec to Rust.
///
/// # Errors
///
/// The spec has errors, or does not suit the chosen type of scaled values.
pub fn generate(source: Source, options: &Options) -> Result<Generated, Diagnostics> {
    let Outcome { protocol, mut diagnostics, .. } = compile(source);
    if let Some(protocol) = &protocol {
        check::fits(protocol, options.scaled, &mut diagnostics);
    }
    match protocol.filter(|_| !diagnostics.has_errors()) {
        Some(protocol) => {
            let (manual, code) = emit::module(&protocol, options);
            Ok(Generated { name: protocol.name, manual, code, warnings: diagnostics })
        }
        None => Err(diagnostics),
    }
}

/// Compiles every spec, or returns all that is wrong with them.
pub fn all(inputs: Inputs, options: &Options) -> Result<Vec<Generated>, Vec<Diagnostics>> {
    let (mut generated, mut refused) = (Vec::new(), inputs.refused);
    for source in inputs.specs {
        let compiled = source.and_then(|source| generate(source, options));
        match compiled.and_then(|one| unclaimed(one, &generated)) {
            Ok(one) => generated.push(one),
            Err(diagnostics) => refused.push(diagnostics),
        }
    }
    if refused.is_empty() { Ok(generated) } else { Err(refused) }
}

/// Refuses a protocol whose file name belongs to another protocol, or to the list of protocols.
fn unclaimed(one: Generated, others: &[Generated]) -> Result<Generated, Diagnostics> {
    let other = others.iter().find(|other| other.name == one.name);
    let what = match other {
        Some(other) => format!("the protocol `{}` is also that of {}", one.name, other.warnings.source().name()),
        None if one.name == list::NAME => format!("`{}.rs` is the list of all protocols", list::NAME),
        None => return Ok(one),
    };
    let place = tree::Path::default().key("protocol");
    Err(one.warnings.with([
        Diagnostic::error(&crate::check::rust_name::RUST_NAME, place.at_value(), what).help("choose another name")
    ]))
}
