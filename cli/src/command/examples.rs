//! `canspec examples`.

use std::io::{self, BufWriter, Write};

use canspec_codegen::diagnostic::Diagnostics;
use canspec_codegen::model::{Erratum, Example, Protocol};
use canspec_codegen::text::Text;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::choose::protocols::One;
use crate::failure::{Failure, Finish};
use crate::log;
use crate::output::output;
use crate::show::columns::{self, Row};

/// List the example frames of a protocol's document.
///
/// Each is shown with its section, the result that decoding must give, and whether it holds. That
/// result is `ok`, or a failure that an erratum explains.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = "Example:\n  canspec examples --protocol NAME --format jsonl")]
pub struct Examples {
    #[command(flatten)]
    protocol: One,
    /// A table, or one JSON object for each frame.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    Text,
    Jsonl,
}

impl Examples {
    /// Writes the frames that the document prints.
    pub fn run(&self) -> Result<Finish, Failure> {
        let (protocol, wrong) = self.protocol.load_unproven()?;
        let mut out = BufWriter::new(output()?);
        let documented = protocol.examples.iter().filter(|example| example.is_documented());
        let mut objects = documented.map(|example| Object::of(&protocol, wrong.as_deref(), example));
        match self.format {
            Format::Text => {
                let headings = ["FRAME", "KIND", "MESSAGE", "SECTION", "EXPECT", "HOLDS", "ERRATA"];
                columns::write(&mut out, &headings, "NOTE", &objects.map(Object::row).collect::<Vec<_>>())?;
            }
            Format::Jsonl => objects.try_for_each(|object| object.write(&mut out))?,
        }
        out.flush()?;
        wrong.map_or(Ok(Finish::Done), |diagnostics| Err(Failure::Spec(diagnostics)))
    }
}

#[derive(Serialize)]
struct Object<'a> {
    id: String,
    /// `None` if the document prints only an identifier.
    data: Option<String>,
    section: Option<&'a Text>,
    expect: &'static str,
    /// Names of errata, one after another.
    erratum: Option<String>,
    note: Option<&'a Text>,
    kind: &'static str,
    message: Option<&'a str>,
    /// Whether the frame decodes and encodes back, or fails as it should.
    holds: bool,
    errata: Vec<Departure<'a>>,
}

/// An erratum that an example names.
#[derive(Serialize)]
struct Departure<'a> {
    name: &'a Text,
    prints: &'a Text,
    uses: &'a Text,
    because: &'a Text,
}

impl<'a> From<&'a Erratum> for Departure<'a> {
    fn from(Erratum { name, prints, uses, because, .. }: &'a Erratum) -> Self {
        Self { name, prints, uses, because }
    }
}

impl Departure<'_> {
    fn sentence(&self) -> String {
        let [name, prints, uses, because] = [self.name, self.prints, self.uses, self.because].map(Text::for_people);
        format!("{name} prints: {prints}; uses: {uses}; because: {because}")
    }
}

impl<'a> Object<'a> {
    fn of(protocol: &'a Protocol, wrong: Option<&Diagnostics>, example: &'a Example) -> Self {
        let names: Vec<_> = example.doc.errata.iter().map(Text::for_people).collect();
        let errata = protocol.errata.iter().filter(|erratum| example.doc.errata.contains(&erratum.name));
        Self {
            id: log::identifier_digits(example.id, example.extended),
            data: example.data.as_deref().map(log::hexadecimal),
            section: example.doc.section.as_ref(),
            expect: example.fails.map_or("ok", canspec_codegen::model::Failure::name),
            erratum: (!names.is_empty()).then(|| names.join(", ")),
            note: example.doc.note.as_ref(),
            kind: example.kind.name(),
            message: example.message.map(|message| protocol[message].name.as_str()),
            holds: !wrong.is_some_and(|wrong| wrong.has_errors_in(&example.doc.path)),
            errata: errata.map(Departure::from).collect(),
        }
    }

    fn row(self) -> Row {
        let Self { id, data, section, expect, erratum, note, kind, message, holds, errata } = self;
        let cells = vec![
            data.map_or(id.clone(), |data| format!("{id}#{data}")),
            kind.to_owned(),
            message.unwrap_or_default().to_owned(),
            section.map_or("", Text::for_people).to_owned(),
            expect.to_owned(),
            if holds { "yes" } else { "no" }.to_owned(),
            erratum.unwrap_or_default(),
        ];
        let words = note.map_or("", Text::for_people).split(' ');
        let below = errata.iter().map(Departure::sentence).collect();
        Row { cells, last: words.map(str::to_owned).collect(), separator: " ", below }
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        serde_json::to_writer(&mut *out, self)?;
        writeln!(out)
    }
}
