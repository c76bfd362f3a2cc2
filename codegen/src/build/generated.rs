//! Compiles a spec to generated code.

use std::path::Path;

use super::inputs::Inputs;
use super::list;
use crate::build::files::File;
use crate::emit::{self, Options};
use crate::model::Protocol;
use crate::read::source::Source;
use crate::report::diagnostic::{Diagnostic, Diagnostics};
use crate::report::tree;
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
    accepted(source, options).map(|known| emitted(known, options))
}

/// Compiles every spec, or returns all that is wrong with them.
pub fn all(inputs: Inputs, options: &Options) -> Result<Vec<Generated>, Vec<Diagnostics>> {
    let (mut generated, mut refused) = (Vec::new(), inputs.refused);
    for source in inputs.specs {
        let known = source.and_then(|source| accepted(source, options));
        match known.and_then(|known| unclaimed(known, &generated)) {
            Ok(known) => generated.push(emitted(known, options)),
            Err(diagnostics) => refused.push(diagnostics),
        }
    }
    if refused.is_empty() { Ok(generated) } else { Err(refused) }
}

/// A protocol that Rust can be written of, and the warnings about its spec.
type Accepted = (Protocol, Diagnostics);

fn accepted(source: Source, options: &Options) -> Result<Accepted, Diagnostics> {
    let Outcome { protocol, mut diagnostics, .. } = compile(source);
    if let Some(protocol) = &protocol {
        check::fits(protocol, options.scaled, &mut diagnostics);
    }
    match protocol.filter(|_| !diagnostics.has_errors()) {
        Some(protocol) => Ok((protocol, diagnostics)),
        None => Err(diagnostics),
    }
}

fn emitted((protocol, warnings): Accepted, options: &Options) -> Generated {
    let warnings = warnings.without_tree();
    let (manual, code) = emit::module(&protocol, options);
    Generated { name: protocol.name, manual, code, warnings }
}

/// Refuses a protocol whose file name belongs to another protocol, or to the list of protocols.
fn unclaimed((protocol, warnings): Accepted, others: &[Generated]) -> Result<Accepted, Diagnostics> {
    let name = &protocol.name;
    let other = others.iter().find(|other| other.name == *name);
    let what = match other {
        Some(other) => format!("the protocol `{name}` is also that of {}", other.warnings.source().name()),
        None if name == list::NAME => format!("`{}.rs` is the list of all protocols", list::NAME),
        None => return Ok((protocol, warnings)),
    };
    let place = tree::Path::default().key("protocol");
    Err(warnings.with([
        Diagnostic::error(&crate::check::rust_name::RUST_NAME, place.at_value(), what).help("choose another name")
    ]))
}
