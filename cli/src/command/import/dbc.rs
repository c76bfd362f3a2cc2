//! `canspec import dbc`.

mod index;
mod limits;
mod messages;
mod names;
mod places;
mod read;
mod signals;
mod spec;
mod variants;
mod yaml;

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;

use crate::failure::{Failure, Finish, tell};
use crate::output::output;
use names::snake_case;
use spec::Spec;

/// Begin a spec from a DBC.
///
/// Every message becomes a report with one whole identifier. Comments with the word DECIDE show
/// where the vendor's document must say more. Comments at the top list what the DBC says and the
/// spec does not.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = EXAMPLES)]
pub struct Dbc {
    /// The DBC.
    file: PathBuf,
    /// Name of the protocol, in place of the file's name.
    #[arg(long, value_name = "NAME", value_parser = protocol)]
    protocol: Option<String>,
    /// A new file for the spec; standard output without it, or for `-`.
    #[arg(short, long, value_name = "SPEC")]
    out: Option<PathBuf>,
}

const EXAMPLES: &str = "Examples:
  canspec import dbc vehicle.dbc > vehicle.yaml
  canspec import dbc vehicle.dbc --protocol battery -o battery.yaml";

impl Dbc {
    /// Writes the spec, and says how much of the DBC it contains.
    pub fn run(&self) -> Result<Finish, Failure> {
        let dbc = read::read(&self.file)?;
        let name = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let (file, stem) = (name(self.file.file_name()), name(self.file.file_stem()));
        let protocol = self.protocol.clone().unwrap_or_else(|| snake_case(&stem, "protocol"));
        let spec = messages::spec(&dbc, &file, &protocol);
        self.write(&spec.to_string())?;
        tell(format_args!("canspec: {}", summary(&spec, dbc.messages.len())));
        Ok(Finish::Done)
    }

    /// Writes the spec. It leaves an existing file alone, because somebody may have worked on it.
    fn write(&self, text: &str) -> Result<(), Failure> {
        let Some(path) = self.out.as_deref().filter(|path| *path != Path::new("-")) else {
            return Ok(output()?.write_all(text.as_bytes())?);
        };
        let written = File::create_new(path).and_then(|mut file| file.write_all(text.as_bytes()));
        written.map_err(|error| {
            if error.kind() == io::ErrorKind::AlreadyExists {
                return Failure::input(path, &"there is such a file already; name a new one");
            }
            Failure::input(path, &error)
        })
    }
}

/// Makes a spec of a DBC in memory.
pub fn imported(bytes: Vec<u8>) -> Result<String, String> {
    let dbc = read::parse(bytes).map_err(|refusal| refusal.why)?;
    Ok(messages::spec(&dbc, "a.dbc", "a").to_string())
}

fn summary(spec: &Spec, messages: usize) -> String {
    let lost = match spec.limits.len() {
        0 => "nothing is left out".to_owned(),
        1 => "1 remark at the top says what is left out".to_owned(),
        count => format!("{count} remarks at the top say what is left out"),
    };
    format!("{}: messages: {messages} of the DBC, {} of the spec; {lost}", spec.file, spec.messages.len())
}

/// Reads the name of a protocol.
fn protocol(text: &str) -> Result<String, String> {
    let is_name = !text.is_empty() && snake_case(text, "protocol") == text;
    is_name.then(|| text.to_owned()).ok_or_else(|| {
        "names are lower-case letters, digits and single `_` between them, and start with a letter".to_owned()
    })
}

#[cfg(test)]
mod tests {
    use canspec_codegen::compile;
    use canspec_codegen::source::Source;

    use super::imported;

    #[test]
    fn check_does_not_warn_of_what_the_importer_wrote() {
        let of = |signals: &str, rest: &str| format!("BO_ 1 Long_Name: 8 x\n{signals}BO_ 2 b: 8 x\n{rest}");
        let plain = " SG_ Speed : 0|16@1+ (1,0) [0|0] \"rpm\" y\n";
        let limited = " SG_ Speed : 0|16@1+ (0.5,0) [0|100] \"\" y\n SG_ Other : 16|16@1+ (1,0) [0|10] \"V\" y\n";
        let between =
            " SG_ Speed : 0|16@1+ (0.5,0) [0.25|100.3] \"\" y\n SG_ Other : 16|16@1- (1,-40) [-39.9|200.5] \"V\" y\n";
        let cycle = "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 1000;\nBA_ \"GenMsgCycleTime\" BO_ 1 100;\n";
        let special = "VAL_ 1 Speed 65535 \"broken\" ;\n";
        let more = "BO_ 3 c: 8 x\nBO_ 4 d: 8 x\nBO_ 5 Eee_F: 8 x\n";
        let cases = [
            String::new(),
            of("", ""),
            of(plain, ""),
            of(limited, ""),
            of(between, ""),
            of(" SG_ Speed : 0|16@1+ (1,0) [0|100] \"rpm\" y\n", special),
            of(limited, &[more, cycle].concat()),
        ];
        for text in cases {
            let spec = imported(text.clone().into_bytes()).expect("the DBC is right");
            let source = Source::new("a.yaml", spec.clone().into_bytes()).expect("the spec is text");
            assert_eq!(compile(source).diagnostics.concise(), "", "{text}\n{spec}");
        }
    }
    #[test]
    fn limits_between_steps_are_narrowed_to_the_steps_inside_them() {
        let field = |number: &str| {
            let text = format!("BO_ 1 m: 8 x\n SG_ s : 0|8@1+ {number} \"V\" y\n");
            let spec = imported(text.into_bytes()).expect("the DBC is right");
            spec.lines().find_map(|line| line.strip_prefix("      s: {bytes: 0, ")).map(str::to_owned)
        };
        for (number, expected) in [
            (
                "(0.5,0) [0.25|100.3]",
                "scale: 0.5, unit: V, range: 0.5..100}  # DECIDE: the limits 0.25..100.3 of the DBC, which lie between steps",
            ),
            (
                "(1,-40) [-39.9|200]",
                "offset: -40, unit: V, range: -39..200}  # DECIDE: the limits -39.9..200 of the DBC, which lie between steps",
            ),
            (
                "(-0.5,10) [-1.3|9.9]",
                "scale: -0.5, offset: 10, unit: V, range: -1..9.5}  # DECIDE: the limits -1.3..9.9 of the DBC, which lie between steps",
            ),
            (
                "(0.3,0) [0.31|0.32]",
                "scale: 0.3, unit: V}  # DECIDE: the limits 0.31..0.32 of the DBC, between which there is no step",
            ),
            ("(0.5,0) [0.5|100]", "scale: 0.5, unit: V, range: 0.5..100}"),
            (
                "(0.5,0) [1|1.2]",
                "scale: 0.5, unit: V, range: 1..1}  # DECIDE: the limits 1..1.2 of the DBC, which lie between steps",
            ),
        ] {
            assert_eq!(field(number).as_deref(), Some(expected), "{number}");
        }
    }
}
