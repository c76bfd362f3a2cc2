//! `canspec rules`.

use std::io::{self, Write};

use canspec_codegen::model::NoteRule;
use canspec_codegen::nearest;
use canspec_codegen::rules::RULES;
use clap::Args;

use crate::failure::{Failure, Finish};
use crate::output::{self, output};
use crate::show::columns::{self, Columns};

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
                document(&mut out, output::width(), &documents.join("\n"))?;
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
    let mut columns = Columns::new(&[""]).within(output::width());
    all().for_each(|(name, _)| columns.widen(&[name]));
    let mut text = Vec::new();
    for (name, document) in all() {
        let mut lines = columns.row(&mut text, &[name]);
        lines.add(document.lines().next().unwrap_or_default(), "");
        lines.end();
    }
    out.write_all(&text)
}

/// Writes a document. On a terminal that is too narrow, paragraphs are as wide as that, and code stays as it is.
fn document(out: &mut impl Write, terminal: Option<usize>, text: &str) -> io::Result<()> {
    if terminal.is_none_or(|terminal| text.lines().all(|line| line.len() <= terminal)) {
        return write!(out, "{text}");
    }
    let (mut is_code, mut paragraph) = (false, Vec::new());
    for line in text.lines() {
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        if !is_code && !is_fence && !line.is_empty() {
            paragraph.push(line);
            continue;
        }
        if !paragraph.is_empty() {
            columns::text_within(terminal, out, &std::mem::take(&mut paragraph).join(" "))?;
        }
        writeln!(out, "{line}")?;
    }
    if paragraph.is_empty() { Ok(()) } else { columns::text_within(terminal, out, &paragraph.join(" ")) }
}

fn unknown(name: &str) -> String {
    let nearest = nearest(name, all().map(|(name, _)| name));
    let help =
        nearest.map_or_else(|| "`canspec rules` lists them".to_owned(), |known| format!("did you mean `{known}`?"));
    format!("there is no rule and no note `{name}`; {help}")
}

#[cfg(test)]
mod tests {
    use super::document;

    #[test]
    fn a_paragraph_is_as_wide_as_the_terminal_and_code_as_it_is() {
        let code = format!("```yaml\nkey: {}\n\nother: 1\n```\n", "word ".repeat(12));
        let text = format!("one two three\nfour five six seven eight nine ten\n\nten\n\n{code}\nthe\nend\n");
        let shown = |terminal| {
            let mut out = Vec::new();
            document(&mut out, terminal, &text).expect("a vector takes everything");
            String::from_utf8(out).expect("it is text")
        };
        assert_eq!([shown(None), shown(Some(100))], [text.clone(), text.clone()]);
        let narrow = "one two three four five six seven eight\nnine ten\n\nten\n\n";
        assert_eq!(shown(Some(40)), format!("{narrow}{code}\nthe end\n"));
    }
}
