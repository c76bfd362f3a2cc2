//! `canspec rules`.

use std::io::{self, Write};

use canspec_codegen::nearest;
use canspec_codegen::rules::{self, RULES};
use clap::Args;

use crate::failure::{Failure, Finish};
use crate::output::output;

/// Explain the rules that a spec must keep.
///
/// With the name of a rule, it says why the rule exists, shows an example, and says what to write
/// instead. Without a name, it lists all rules.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec rules overlap")]
pub struct Rules {
    /// A rule, as in `error[overlap]`.
    #[arg(value_name = "RULE")]
    rule: Option<String>,
}

impl Rules {
    /// Writes the document of a rule, or the list of rules.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut out = output()?;
        match &self.rule {
            None => list(&mut out)?,
            Some(name) => {
                let rule = rules::find(name).ok_or_else(|| Failure::Call(unknown(name)))?;
                writeln!(out, "{}", rule.document.trim_end())?;
            }
        }
        Ok(Finish::Done)
    }
}

fn list(out: &mut impl Write) -> io::Result<()> {
    let width = RULES.iter().map(|rule| rule.name.len()).max().unwrap_or_default();
    RULES.iter().try_for_each(|rule| writeln!(out, "{:width$}  {}", rule.name, rule.summary()))
}

fn unknown(name: &str) -> String {
    let nearest = nearest(name, RULES.iter().map(|rule| rule.name));
    let help =
        nearest.map_or_else(|| "`canspec rules` lists them".to_owned(), |known| format!("did you mean `{known}`?"));
    format!("there is no rule `{name}`; {help}")
}
