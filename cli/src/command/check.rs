//! `canspec check`.

use std::io::{self, Write};
use std::path::PathBuf;

use canspec_codegen::check::{Unproven, unproven};
use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::source::Source;
use canspec_codegen::{Outcome, Summary, compile_with_examples};
use canspec_specs::SPECS;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::choose::protocols;
use crate::failure::{Failure, Finish, draw};
use crate::output::output;
use crate::show::line::Members;

/// Check specs and the examples of their documents.
///
/// Without files, it checks all built-in specs. Mistakes go to standard error, with their places. A
/// summary of each spec goes to standard output.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec check protocol.yaml")]
pub struct Check {
    /// Summaries as text, or as one JSON object for each spec.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Mistakes with the text underlined, one in a line, or each as a JSON object.
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Style::Human)]
    message_format: Style,
    /// Also list the values that no example states.
    #[arg(short, long)]
    verbose: bool,
    /// Percentage of the messages that must have an example.
    #[arg(long, value_name = "PERCENT", value_parser = clap::value_parser!(u8).range(0..=100))]
    min_example_coverage: Option<u8>,
    /// The spec files.
    #[arg(value_name = "SPEC")]
    specs: Vec<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Json,
}

#[derive(Clone, Copy, ValueEnum)]
enum Style {
    Human,
    Short,
    Json,
}

impl Check {
    /// Checks the specs one after another.
    pub fn run(&self) -> Result<Finish, Failure> {
        let mut out = output()?;
        let mut finish = Finish::Done;
        for (diagnostics, summary) in self.outcomes() {
            self.report(&diagnostics)?;
            self.summarise(&mut out, &summary)?;
            if diagnostics.has_errors() {
                finish = Finish::Errors;
            }
        }
        Ok(finish)
    }

    /// Compiles each spec when it is its turn.
    fn outcomes(&self) -> Box<dyn Iterator<Item = (Diagnostics, Object)> + '_> {
        if self.specs.is_empty() {
            return Box::new(SPECS.iter().map(|spec| self.outcome(protocols::source(spec))));
        }
        let bases = protocols::bases();
        Box::new(self.specs.iter().map(move |path| self.outcome(bases.read(path))))
    }

    /// Compiles a source. If it cannot be read, only its name is known.
    fn outcome(&self, source: Result<Source, Diagnostics>) -> (Diagnostics, Object) {
        match source.map(|source| compile_with_examples(source, self.min_example_coverage)) {
            Ok(Outcome { protocol, diagnostics, summary }) => {
                let listed =
                    protocol.filter(|_| self.verbose).map(|protocol| unproven(&protocol).map(listed).collect());
                (diagnostics, Object { listed: listed.unwrap_or_default(), ..summary.into() })
            }
            Err(diagnostics) => {
                let spec = diagnostics.source().name().to_owned();
                let object = Object { spec, errors: diagnostics.errors(), ..Object::default() };
                (diagnostics, object)
            }
        }
    }

    fn report(&self, diagnostics: &Diagnostics) -> io::Result<()> {
        let text = match self.message_format {
            Style::Human => diagnostics.render(true),
            Style::Short => diagnostics.concise(),
            Style::Json => json_lines(diagnostics)?,
        };
        if !text.trim_end().is_empty() {
            draw(&text);
        }
        Ok(())
    }

    fn summarise(&self, out: &mut impl Write, summary: &Object) -> io::Result<()> {
        match self.format {
            Format::Text => {
                writeln!(out, "{}", sentence(summary))?;
                summary.listed.iter().try_for_each(|line| writeln!(out, "  {line}"))
            }
            Format::Json => {
                serde_json::to_writer(&mut *out, summary)?;
                writeln!(out)
            }
        }
    }
}

fn json_lines(diagnostics: &Diagnostics) -> io::Result<String> {
    let mut lines = Vec::new();
    for located in diagnostics.located() {
        lines.push(serde_json::to_string(&located)?);
    }
    Ok(lines.join("\n"))
}

/// Sums a spec up in a line. If it has errors, the line only counts them.
fn sentence(summary: &Object) -> String {
    let Object { spec, errors, warnings, .. } = summary;
    match (errors, warnings) {
        (0, 0) => format!("{spec}: good: {}", content(summary)),
        (0, _) => format!("{spec}: {}: {}", count(*warnings, "warning"), content(summary)),
        (_, 0) => format!("{spec}: {}", count(*errors, "error")),
        _ => format!("{spec}: {}, {}", count(*errors, "error"), count(*warnings, "warning")),
    }
}

fn content(summary: &Object) -> String {
    let Object {
        messages,
        signals,
        status_bits,
        examples,
        frames,
        identifiers,
        expected_failures,
        unproven,
        errata,
        ..
    } = summary;
    let contents = [count(*messages, "message"), count(*signals, "signal"), count(*status_bits, "status bit")];
    let values = examples.saturating_sub(frames + identifiers + expected_failures);
    let outcomes = [
        format!("{} both ways", count(*frames, "frame")),
        count(*identifiers, "identifier"),
        count(values, "value"),
        count(*expected_failures, "expected failure"),
    ];
    let unproven = if *unproven == 0 { String::new() } else { format!("; {} unproven", count(*unproven, "value")) };
    let examples = count(*examples, "example");
    let errata = if *errata == 1 { "1 erratum".to_owned() } else { format!("{errata} errata") };
    format!("{}; {examples}: {}{unproven}; {errata}", contents.join(", "), outcomes.join(", "))
}

fn count(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

/// Names the values that an example leaves out.
fn listed(Unproven { example, signals }: Unproven) -> String {
    let names: Vec<_> = signals.iter().map(|name| format!("`{name}`")).collect();
    format!("{}: unproven: {}", example.doc.path, names.join(", "))
}

/// The JSON object of a spec.
#[derive(Default, Serialize)]
struct Object {
    spec: String,
    protocol: Option<String>,
    messages: usize,
    selectors: Members<String, usize>,
    signals: usize,
    status_bits: usize,
    examples: usize,
    frames: usize,
    identifiers: usize,
    expected_failures: usize,
    unproven: usize,
    errata: usize,
    errors: usize,
    warnings: usize,
    /// The unproven values, in lines of text.
    #[serde(skip)]
    listed: Vec<String>,
}

impl From<Summary> for Object {
    fn from(summary: Summary) -> Self {
        Self {
            spec: summary.spec,
            protocol: summary.protocol,
            messages: summary.messages,
            selectors: Members(summary.selectors),
            signals: summary.signals,
            status_bits: summary.status_bits,
            examples: summary.examples,
            frames: summary.frames,
            identifiers: summary.identifiers,
            expected_failures: summary.expected_failures,
            unproven: summary.unproven,
            errata: summary.errata,
            errors: summary.errors,
            warnings: summary.warnings,
            listed: Vec::new(),
        }
    }
}
