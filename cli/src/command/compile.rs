//! `canspec compile`.

use std::io::{self, Write};
use std::path::PathBuf;

use canspec_codegen::emit::{Goal, Options, Scaled, Switch};
use canspec_codegen::files::{self, File, State};
use canspec_codegen::{Builder, Generated, generate};
use clap::{Args, ValueEnum};

use crate::choose::protocols;
use crate::failure::{Failure, Finish, draw, shown, tell};
use crate::output::output;

/// Compile specs to Rust.
///
/// Nothing is written if a spec has errors. A file that would not change is left alone. A file that
/// canspec did not generate is left alone, too, and is an error.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Compile {
    /// The spec files; several need `--out`.
    #[arg(value_name = "SPEC", required_unless_present = "protocol", conflicts_with = "protocol")]
    specs: Vec<PathBuf>,
    /// A built-in protocol instead of files.
    #[arg(long, value_name = "NAME")]
    protocol: Option<String>,
    /// Folder for the `PROTOCOL.rs` of each spec; standard output without it.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write nothing; exit with status 1 if a file of `--out` is missing or would change.
    #[arg(long, requires = "out")]
    check: bool,
    /// What scaled values are: a type of float, or whole steps as raw integers.
    #[arg(long, value_enum, default_value_t = Values::F64)]
    scaled: Values,
    /// What programs are optimized for.
    #[arg(long, value_enum, default_value_t = Purpose::Speed)]
    goal: Purpose,
    /// Implement the traits of serde: `always`, `never`, or if the crate has this feature.
    #[arg(long, value_name = "WHEN", value_parser = switch, default_value = "never")]
    serde: Switch,
    /// Implement `defmt::Format`: `always`, `never`, or if the crate has this feature.
    #[arg(long, value_name = "WHEN", value_parser = switch, default_value = "never")]
    defmt: Switch,
    /// Implement `arbitrary::Arbitrary`: `always`, `never`, or if the crate has this feature.
    #[arg(long, value_name = "WHEN", value_parser = switch, default_value = "never")]
    arbitrary: Switch,
}

const EXAMPLES: &str = "Examples:
  canspec compile protocol.yaml --out src
  canspec compile protocol.yaml --out src --check
  canspec compile protocol.yaml --scaled steps --defmt always --serde my_feature";

#[derive(Clone, Copy, ValueEnum)]
enum Values {
    F64,
    F32,
    Steps,
}

/// What programs are optimized for.
#[derive(Clone, Copy, ValueEnum)]
enum Purpose {
    /// Each place that builds a request has all code for it.
    Speed,
    /// The compiler decides where that code stands.
    Size,
}

impl From<Purpose> for Goal {
    fn from(purpose: Purpose) -> Self {
        match purpose {
            Purpose::Speed => Self::Speed,
            Purpose::Size => Self::Size,
        }
    }
}

impl From<Values> for Scaled {
    fn from(values: Values) -> Self {
        match values {
            Values::F64 => Self::F64,
            Values::F32 => Self::F32,
            Values::Steps => Self::Steps,
        }
    }
}

impl Compile {
    /// Compiles the chosen specs, then writes or compares the Rust code.
    pub fn run(&self) -> Result<Finish, Failure> {
        if self.specs.len() > 1 && self.out.is_none() {
            return Err(Failure::Call("name a folder for the code of several specs with --out DIR".to_owned()));
        }
        let generated = self.compiled()?;
        for one in generated.iter().filter(|one| !one.warnings.is_empty()) {
            draw(&one.warnings.render(true));
        }
        self.deliver(&generated)
    }

    fn compiled(&self) -> Result<Vec<Generated>, Failure> {
        let Some(name) = &self.protocol else { return self.builder().compile().map_err(Failure::Specs) };
        let source = protocols::text_of(name)?;
        generate(source, &self.options()).map(|one| vec![one]).map_err(|refused| Failure::Specs(vec![refused]))
    }

    fn builder(&self) -> Builder {
        self.specs.iter().fold(Builder::new().options(self.options()).bases(protocols::bases()), Builder::spec)
    }

    fn options(&self) -> Options {
        Options {
            scaled: self.scaled.into(),
            goal: self.goal.into(),
            serde: self.serde.clone(),
            defmt: self.defmt.clone(),
            arbitrary: self.arbitrary.clone(),
        }
    }

    fn deliver(&self, generated: &[Generated]) -> Result<Finish, Failure> {
        let Some(folder) = &self.out else { return print(generated) };
        let files: Vec<_> = generated.iter().map(|one| one.file_in(folder)).collect();
        let done = if self.check { compare(&files) } else { files::write(&files).map(|()| Finish::Done) };
        done.map_err(|error| Failure::Input(error.to_string()))
    }
}

fn print(generated: &[Generated]) -> Result<Finish, Failure> {
    let mut out = output()?;
    for one in generated {
        out.write_all(one.code.as_bytes())?;
    }
    Ok(Finish::Done)
}

/// Tells which files differ from what would be written.
fn compare(files: &[File]) -> io::Result<Finish> {
    let mut finish = Finish::Done;
    for file in files {
        let what = match file.state()? {
            State::Current => continue,
            State::Stale => "is stale",
            State::Missing => "is missing",
            State::NotOurs => return Err(file.not_ours()),
        };
        tell(format_args!("canspec: {} {what}; the same call without `--check` writes it", shown(file.path())));
        finish = Finish::Errors;
    }
    Ok(finish)
}

/// Reads whether and when a trait is implemented.
fn switch(text: &str) -> Result<Switch, String> {
    match text {
        "always" => Ok(Switch::Always),
        "never" => Ok(Switch::Never),
        feature if is_feature(feature) => Ok(Switch::Gated(feature.to_owned())),
        _ => Err("this is not the name of a feature".to_owned()),
    }
}

fn is_feature(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|letter| letter.is_alphanumeric() || "_-+.".contains(letter))
}

#[cfg(test)]
mod tests {
    use canspec_codegen::emit::{Goal, Options, Scaled, Switch};
    use clap::Parser;

    #[derive(Parser)]
    struct Call {
        #[command(flatten)]
        compile: super::Compile,
    }

    fn options(call: &str) -> Option<Options> {
        Call::try_parse_from(call.split(' ')).ok().map(|call| call.compile.options())
    }

    #[test]
    fn each_choice_reaches_its_option() {
        let call = "compile a.yaml --scaled f32 --goal size --serde always --defmt log --arbitrary fuzz-1";
        let gated = |feature: &str| Switch::Gated(feature.to_owned());
        let expected = Options {
            scaled: Scaled::F32,
            goal: Goal::Size,
            serde: Switch::Always,
            defmt: gated("log"),
            arbitrary: gated("fuzz-1"),
        };
        assert_eq!(options(call), Some(expected));
        assert_eq!(options("compile a.yaml --serde never --scaled f64"), Some(Options::default()));
        let steps = Options { scaled: Scaled::Steps, ..Options::default() };
        assert_eq!(options("compile a.yaml --scaled steps"), Some(steps));
        assert_eq!(options("compile a.yaml"), Some(Options::default()));
    }

    #[test]
    fn what_no_feature_can_be_called_is_refused() {
        for call in ["compile a.yaml --serde a/b", "compile a.yaml --serde ", "compile a.yaml --serde \""] {
            assert_eq!(options(call), None, "{call}");
        }
    }
}
