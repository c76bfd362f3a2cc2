//! `canspec rules`.

use std::io::{self, Write};

use canspec_codegen::model::NoteRule;
use canspec_codegen::nearest;
use canspec_codegen::rules::RULES;
use clap::Args;

use crate::failure::{Failure, Finish};
use crate::output::output;

/// Explain the rules that a spec must keep, and the notes on frames.
///
/// With the name of a rule, it says why the rule exists, shows an example, and says what to write
/// instead. With the name of a note, it says what the note means. Without a name, it lists all.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec rules overlap")]
pub struct Rules {
    /// A rule, as in `error[overlap]`, or a note such as `reserved_bit`.
    #[arg(value_name = "RULE")]
    rule: Option<String>,
}

impl Rules {
    /// Writes the documents of a name, or the list of rules and notes.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut out = output()?;
        match &self.rule {
            None => list(&mut out)?,
            Some(name) => {
                let documents: Vec<_> = all().filter(|(known, _)| known == name).map(|(_, text)| text).collect();
                if documents.is_empty() {
                    return Err(Failure::Call(unknown(name)));
                }
                write!(out, "{}", documents.join("\n"))?;
            }
        }
        Ok(Finish::Done)
    }
}

/// What `check` counts beside its rules and notes.
const UNPROVEN: (&str, &str) = ("unproven", include_str!("rules/unproven.md"));

/// Returns every rule and then every note, with its document. `addressing` is both.
fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    let rules = RULES.iter().map(|rule| (rule.name, rule.document));
    rules.chain(NoteRule::ALL.into_iter().map(|(note, name)| (name, note.document()))).chain([UNPROVEN])
}

fn list(out: &mut impl Write) -> io::Result<()> {
    let width = all().map(|(name, _)| name.len()).max().unwrap_or_default();
    let summary = |document: &'static str| document.lines().next().unwrap_or_default();
    all().try_for_each(|(name, document)| writeln!(out, "{name:width$}  {}", summary(document)))
}

fn unknown(name: &str) -> String {
    let nearest = nearest(name, all().map(|(name, _)| name));
    let help =
        nearest.map_or_else(|| "`canspec rules` lists them".to_owned(), |known| format!("did you mean `{known}`?"));
    format!("there is no rule and no note `{name}`; {help}")
}
