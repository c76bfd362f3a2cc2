//! A table of the departures from the document.

use std::io::{self, Write};

use canspec_codegen::model::{Erratum, Protocol};
use canspec_codegen::text::Text;

use super::remarks::words;
use super::rows;
use crate::show::columns::Row;

/// Writes those errata of a protocol that pass a test.
pub fn write(out: &mut impl Write, protocol: &Protocol, is_shown: impl Fn(&Text) -> bool) -> io::Result<()> {
    let shown = protocol.errata.iter().filter(|erratum| is_shown(&erratum.name));
    rows::table(out, &["ERRATUM", "KIND", "SECTION"], &shown.map(row).collect::<Vec<_>>())
}

fn row(erratum: &Erratum) -> Row {
    let Erratum { name, kind, section, .. } = erratum;
    let cells = vec![name.for_people().to_owned(), kind.clone(), words(section.as_ref())];
    Row { cells, below: sentences(erratum).to_vec(), ..Row::default() }
}

/// Says what the document prints, what the spec uses, and why.
pub fn sentences(Erratum { prints, uses, because, .. }: &Erratum) -> [String; 3] {
    [("prints", prints), ("uses", uses), ("because", because)]
        .map(|(word, text)| format!("{word}: {}", text.for_people()))
}
