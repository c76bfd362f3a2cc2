//! Finds a spec by its built-in name or its file, and compiles it.

use std::path::{Path, PathBuf};

use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::model::Protocol;
use canspec_codegen::source::Source;
use canspec_codegen::{Bases, Outcome, compile, compile_proven, nearest};
use canspec_specs::{SPECS, Spec};
use clap::Args;

use crate::choose::settings::Settings;
use crate::failure::{Failure, shown};

/// Chooses one protocol.
#[derive(Args)]
#[group(multiple = false)]
pub struct One {
    /// A built-in protocol.
    #[arg(long, value_name = "NAME")]
    protocol: Option<String>,
    /// A spec file.
    #[arg(long, value_name = "FILE")]
    spec: Option<PathBuf>,
}

impl One {
    /// Returns what is chosen here or by the settings.
    pub fn choice(&self) -> Result<Settings, Failure> {
        chosen(self.protocol.as_slice(), self.spec.as_slice())
    }

    /// Compiles the chosen spec.
    pub fn load(&self) -> Result<Protocol, Failure> {
        load_one(&self.choice()?)
    }

    /// Compiles the chosen spec, although examples or other checks contradict it. What is wrong comes with it.
    pub fn load_unproven(&self) -> Result<(Protocol, Option<Box<Diagnostics>>), Failure> {
        let choice = self.choice()?;
        match (load_one(&choice), choice.specs.as_slice()) {
            (Ok(protocol), _) => Ok((protocol, None)),
            (Err(Failure::Spec(diagnostics)), [path]) => match compile_proven(chosen_file(&choice, path)?) {
                Ok(protocol) => Ok((protocol, Some(diagnostics))),
                Err(_) => Err(Failure::Spec(diagnostics)),
            },
            (Err(failure), _) => Err(failure),
        }
    }
}

/// Chooses protocols, in the order in which they are tried.
#[derive(Args)]
#[group(multiple = true)]
pub struct Several {
    /// A built-in protocol, or several as `A,B`; the first one that recognises a frame wins.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    protocol: Vec<String>,
    /// A spec file; repeatable, and tried before the built-in protocols.
    #[arg(long, value_name = "FILE")]
    spec: Vec<PathBuf>,
}

impl Several {
    /// Returns what is chosen here or by the settings.
    pub fn choice(&self) -> Result<Settings, Failure> {
        chosen(&self.protocol, &self.spec)
    }
}

/// Returns what the call chooses, or else what the settings do.
pub fn chosen(protocols: &[String], specs: &[PathBuf]) -> Result<Settings, Failure> {
    if protocols.is_empty() && specs.is_empty() {
        return Settings::find();
    }
    Ok(Settings { protocols: protocols.to_vec(), specs: specs.to_vec(), ..Settings::default() })
}

/// Compiles the one spec of a choice.
pub fn load_one(choice: &Settings) -> Result<Protocol, Failure> {
    let protocols = load_all(choice)?;
    let names: Vec<String> = protocols.iter().map(|protocol| format!("`{}`", protocol.name)).collect();
    let [protocol] = <[Protocol; 1]>::try_from(protocols).map_err(|_| {
        let why = format!("one protocol is needed, and here are {}", names.join(", "));
        choice.refuse(&format!("{why}; choose one with --protocol NAME or --spec FILE"))
    })?;
    Ok(protocol)
}

/// Compiles all specs of a choice, which has at least one.
pub fn load_all(choice: &Settings) -> Result<Vec<Protocol>, Failure> {
    let files = choice.specs.iter().map(|path| load(chosen_file(choice, path)?));
    let named = choice.protocols.iter().map(|name| load_built_in(built_in(name).map_err(|why| choice.refuse(&why))?));
    let protocols: Vec<Protocol> = files.chain(named).collect::<Result<_, _>>()?;
    if protocols.is_empty() { Err(nothing_chosen()) } else { Ok(protocols) }
}

fn nothing_chosen() -> Failure {
    let call = "name a protocol with --protocol NAME or a file with --spec FILE";
    Failure::Call(format!("{call}; CANSPEC_PROTOCOL or a file canspec.toml can name it too"))
}

/// Returns the text of a spec file. Settings that name no file are wrong.
pub fn chosen_file(choice: &Settings, path: &Path) -> Result<Source, Failure> {
    if choice.origin.is_some() && !path.exists() {
        let why = format!("there is no spec file `{}`", shown(path));
        return Err(choice.refuse(&format!("{why}; a path in this file starts at its folder")));
    }
    file(path)
}

/// Returns the text of a spec file.
pub fn file(path: &Path) -> Result<Source, Failure> {
    bases().read(path).map_err(|diagnostics| Failure::Spec(Box::new(diagnostics)))
}

/// Returns the text of a built-in spec.
pub fn text(spec: &Spec) -> Result<Source, Failure> {
    source(spec).map_err(|diagnostics| Failure::Spec(Box::new(diagnostics)))
}

/// Returns the text of a built-in spec, or why it cannot be read.
pub fn source(spec: &Spec) -> Result<Source, Diagnostics> {
    Source::new(spec.file, spec.text.into()).and_then(|source| bases().add_to(source))
}

/// Returns the built-in specs, on which others can be based.
pub fn bases() -> Bases {
    SPECS.iter().map(|spec| (spec.name, spec.text)).collect()
}

/// Compiles a built-in spec or else a file.
pub fn load_chosen(name: Option<&str>, path: Option<&Path>) -> Result<Protocol, Failure> {
    match (name, path) {
        (Some(name), _) => load_built_in(built_in(name).map_err(Failure::Call)?),
        (None, Some(path)) => load(file(path)?),
        (None, None) => Err(nothing_chosen()),
    }
}

/// Returns the text of the built-in spec of a name.
pub fn text_of(name: &str) -> Result<Source, Failure> {
    text(built_in(name).map_err(Failure::Call)?)
}

/// Finds a built-in spec, or says which names there are.
fn built_in(name: &str) -> Result<&'static Spec, String> {
    canspec_specs::find(name).ok_or_else(|| unknown(name, SPECS))
}

/// Compiles a spec, or fails with all its mistakes.
pub fn load(source: Source) -> Result<Protocol, Failure> {
    let Outcome { protocol, diagnostics, .. } = compile(source);
    protocol.filter(|_| !diagnostics.has_errors()).ok_or_else(|| Failure::Spec(Box::new(diagnostics)))
}

/// The models that the build script made of built-in specs, by name.
const MODELS: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/models.rs"));

/// Returns the model of a built-in spec, or its mistakes.
pub fn load_built_in(spec: &Spec) -> Result<Protocol, Failure> {
    stored(spec).map_or_else(|| load(text(spec)?), Ok)
}

/// Returns the model of a built-in spec that the build script found without mistakes.
fn stored(spec: &Spec) -> Option<Protocol> {
    let (_, model) = MODELS.iter().find(|(name, _)| *name == spec.name)?;
    postcard::from_bytes(model).ok()
}

/// Says which names could be meant.
fn unknown(name: &str, specs: &[Spec]) -> String {
    let names: Vec<&str> = specs.iter().map(|spec| spec.name).collect();
    let help = match nearest(name, names.iter().copied()) {
        _ if name.contains(',') => "this command takes one".to_owned(),
        Some(known) => format!("did you mean `{known}`?"),
        None => "a spec of your own is named by its file".to_owned(),
    };
    match names.as_slice() {
        [] => format!("unknown protocol `{name}`; none is built in; {help}"),
        names => format!("unknown protocol `{name}`; built in: {}; {help}", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use canspec_codegen::{Outcome, compile};

    use super::{Spec, stored, text, unknown};

    const SPECS: &[Spec] =
        &[Spec { name: "acme", file: "acme.yaml", text: "" }, Spec { name: "zeta", file: "zeta.yaml", text: "" }];

    #[test]
    fn the_stored_model_of_a_built_in_spec_is_what_its_text_means() {
        for spec in canspec_specs::SPECS {
            let source = text(spec).expect("a built-in spec is text");
            let Outcome { protocol, diagnostics, .. } = compile(source);
            assert_eq!(diagnostics.concise(), "", "{}", spec.name);
            let stored = stored(spec).expect("the build script stored it");
            assert_eq!(format!("{stored:?}"), format!("{:?}", protocol.expect("it has no errors")), "{}", spec.name);
        }
    }

    #[test]
    fn an_unknown_protocol_gets_the_nearest_name() {
        assert_eq!(unknown("amce", SPECS), "unknown protocol `amce`; built in: acme, zeta; did you mean `acme`?");
    }

    #[test]
    fn a_name_like_no_other_gets_the_way_to_a_file() {
        let help = "a spec of your own is named by its file";
        assert_eq!(unknown("x.yaml", SPECS), format!("unknown protocol `x.yaml`; built in: acme, zeta; {help}"));
        assert!(unknown("acme,zeta", SPECS).ends_with("; this command takes one"));
        assert_eq!(unknown("x", &[]), format!("unknown protocol `x`; none is built in; {help}"));
    }
}
