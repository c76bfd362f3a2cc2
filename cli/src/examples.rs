//! `canspec examples`.

use std::io::{self, BufWriter, Write};

use canspec_codegen::model::{Example, Protocol};
use canspec_codegen::text::Text;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::columns::{self, Row};
use crate::failure::{Failure, Finish};
use crate::log;
use crate::output::output;
use crate::protocols::One;

/// List the example frames of a protocol's document.
///
/// Each is shown with its section and the result that decoding must give: `ok`, or a failure that
/// an erratum explains.
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
        let protocol = self.protocol.load()?;
        let mut out = BufWriter::new(output()?);
        let documented = protocol.examples.iter().filter(|example| example.is_documented());
        match self.format {
            Format::Text => {
                let rows: Vec<Row> = documented.map(|example| row(&protocol, example)).collect();
                columns::write(&mut out, &["FRAME", "KIND", "MESSAGE", "SECTION", "EXPECT", "ERRATA"], "NOTE", &rows)?;
            }
            Format::Jsonl => documented.map(Object::new).try_for_each(|object| object.write(&mut out))?,
        }
        out.flush()?;
        Ok(Finish::Done)
    }
}

fn row(protocol: &Protocol, example: &Example) -> Row {
    let Object { id, data, section, expect, erratum, note } = Object::new(example);
    let cells = vec![
        data.map_or(id.clone(), |data| format!("{id}#{data}")),
        example.kind.name().to_owned(),
        example.message.map_or(String::new(), |message| protocol.messages[message].name.clone()),
        section.map_or("", Text::for_people).to_owned(),
        expect.to_owned(),
        erratum.unwrap_or_default(),
    ];
    let words = note.map_or("", Text::for_people).split(' ');
    Row { cells, last: words.map(str::to_owned).collect(), separator: " ", ..Row::default() }
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
}

impl<'a> Object<'a> {
    fn new(example: &'a Example) -> Self {
        let errata: Vec<_> = example.doc.errata.iter().map(Text::for_people).collect();
        Self {
            id: log::identifier_digits(example.id, example.extended),
            data: example.data.as_deref().map(log::hexadecimal),
            section: example.doc.section.as_ref(),
            expect: example.fails.map_or("ok", canspec_codegen::model::Failure::name),
            erratum: (!errata.is_empty()).then(|| errata.join(", ")),
            note: example.doc.note.as_ref(),
        }
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        serde_json::to_writer(&mut *out, self)?;
        writeln!(out)
    }
}
