//! What nobody says in a call: the protocols and the device model that a folder or the environment names.

use std::env;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use canspec_codegen::source::{SIZE_LIMIT, read_whole};
use serde::Deserialize;

use crate::failure::{Failure, shown};

/// The file that is looked for from the current folder upward.
const FILE: &str = "canspec.toml";

/// Names a built-in protocol, or several with commas between them.
const VARIABLE: &str = "CANSPEC_PROTOCOL";

/// What is wrong with other values.
const QUOTES: &str = "text needs quotes, as in `protocol = \"NAME\"`";

/// What the settings name.
#[derive(Debug, Default)]
pub struct Settings {
    /// Names of built-in protocols.
    pub protocols: Vec<String>,
    /// Spec files.
    pub specs: Vec<PathBuf>,
    /// The device model.
    pub model: Option<String>,
    /// The variable or the file that says so, unless the call does.
    pub origin: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    protocol: Option<OneOrMany>,
    spec: Option<OneOrMany>,
    model: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a text or a list of texts")]
enum OneOrMany {
    One(String),
    Many(Vec<String>),
}

impl OneOrMany {
    fn names(written: Option<Self>) -> Vec<String> {
        match written {
            None => Vec::new(),
            Some(Self::One(name)) => vec![name],
            Some(Self::Many(names)) => names,
        }
    }
}

impl Settings {
    /// Returns the settings of the environment, or else those of the nearest file.
    ///
    /// # Errors
    ///
    /// Where the file cannot be read, or says something else.
    pub fn find() -> Result<Self, Failure> {
        let protocols = parted(&[env::var(VARIABLE).unwrap_or_default()]);
        if !protocols.is_empty() {
            return Ok(Self { protocols, origin: Some(VARIABLE.to_owned()), ..Self::default() });
        }
        for folder in folders() {
            let path = folder.join(FILE);
            match text(&path) {
                Ok(text) => return Self::read(&path, &text),
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(Failure::input(&path, &error)),
            }
        }
        Ok(Self::default())
    }

    fn read(path: &Path, text: &str) -> Result<Self, Failure> {
        let Written { protocol, spec, model } = toml::from_str(text).map_err(|error| {
            let before = text.get(..error.span().map_or(0, |span| span.start)).unwrap_or_default();
            let line = before.lines().count().max(1);
            let is_bare = text.lines().nth(line - 1).is_some_and(lacks_quotes);
            let why = if is_bare { QUOTES } else { error.message() };
            Failure::Call(format!("{}:{line}: {why}", shown(path)))
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let specs = OneOrMany::names(spec).into_iter().map(|spec| folder.join(spec)).collect();
        Ok(Self { protocols: parted(&OneOrMany::names(protocol)), specs, model, origin: Some(shown(path)) })
    }

    /// Makes the failure of a wrong name, which says where the name stands.
    pub fn refuse(&self, why: &str) -> Failure {
        let origin = self.origin.as_ref().map_or(String::new(), |origin| format!("{origin}: "));
        Failure::Call(format!("{origin}{why}"))
    }
}

fn text(path: &Path) -> io::Result<String> {
    let bytes = read_whole(path, SIZE_LIMIT)?;
    String::from_utf8(bytes).map_err(|_| io::Error::new(ErrorKind::InvalidData, "this is not text in UTF-8"))
}

/// Parts names with commas between them.
fn parted(texts: &[String]) -> Vec<String> {
    let names = texts.iter().flat_map(|text| text.split(',')).map(str::trim);
    names.filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

/// Tests whether a value in a line of the file begins with a letter or a digit, as no text does.
fn lacks_quotes(line: &str) -> bool {
    let is_bare = |value: &str| value.trim_start().starts_with(char::is_alphanumeric);
    line.split_once('=').is_some_and(|(_, values)| values.split(['[', ',']).any(is_bare))
}

/// Returns the current folder and those above it, as seen from the current one.
fn folders() -> impl Iterator<Item = PathBuf> {
    let depth = env::current_dir().map_or(0, |folder| folder.ancestors().count());
    let up = |count: usize| std::iter::repeat_n("..", count).collect::<PathBuf>();
    (0..depth).map(up)
}
