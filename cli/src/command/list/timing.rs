//! Tables of what a program must do in time and in order.

use std::io::{self, Write};

use canspec_codegen::model::{Procedure, Protocol, Quantity, Silence, Timing};
use canspec_codegen::text::Text;

use super::remarks::{errata, sentences, title, words};
use super::rows;
use crate::show::columns::Row;

/// Writes a table of the times, one of what silence does and one of the procedures, if there are any.
pub fn write(out: &mut impl Write, protocol: &Protocol) -> io::Result<()> {
    times(out, protocol, protocol.timing.iter())?;
    let silence: Vec<_> = protocol.after_silence.iter().map(silence).collect();
    rows::table(out, &["AFTER SILENCE", "SECTION"], &silence)?;
    let procedures: Vec<_> = protocol.procedures.iter().flat_map(procedure).collect();
    rows::table(out, &["PROCEDURE", "SECTION"], &procedures)
}

/// Writes a table of times.
pub fn times<'a>(
    out: &mut impl Write,
    protocol: &Protocol,
    times: impl IntoIterator<Item = &'a Timing>,
) -> io::Result<()> {
    let rows: Vec<_> = times.into_iter().map(|time| timing(protocol, time)).collect();
    rows::table(out, &["TIMING", "TIME", "MINIMUM", "ROLE", "SECTION"], &rows)
}

fn timing(protocol: &Protocol, timing: &Timing) -> Row {
    let Timing { name, doc, range, unit, minimum, .. } = timing;
    let time = if range.minimum == range.maximum {
        range.minimum.to_string()
    } else {
        format!("{}..{}", range.minimum, range.maximum)
    };
    let minimum = minimum.map_or(String::new(), |Quantity { value, unit, .. }| {
        format!("{value}{}", unit.map_or(String::new(), |unit| format!(" {}", unit.symbol)))
    });
    let time = format!("{time} {}", unit.symbol);
    let cells = vec![name.clone(), time, minimum, role(protocol, timing), words(doc.section.as_ref())];
    let meaning: Vec<_> = [title(doc), doc.note.as_ref().map(Text::for_people)].into_iter().flatten().collect();
    let last = [meaning.join("; ")].into_iter().chain(errata(doc)).collect::<Vec<_>>().join(" ");
    Row { cells, last: split(&last), separator: " ", ..Row::default() }
}

/// Returns a row for what silence does.
fn silence(silence: &Silence) -> Row {
    let Silence { doc, output, .. } = silence;
    let meaning = format!("The output {}.", output.meaning());
    let meaning: Vec<_> = title(doc).map(str::to_owned).into_iter().chain([meaning]).collect();
    let cells = vec![output.name().to_owned(), words(doc.section.as_ref())];
    Row { cells, last: split(&meaning.join(": ")), separator: " ", below: sentences(doc) }
}

/// Says what a time is for, and what it is about.
fn role(protocol: &Protocol, timing: &Timing) -> String {
    let Some(role) = timing.role else { return String::new() };
    let messages: Vec<_> = timing.messages.iter().map(|id| protocol[*id].name.as_str()).collect();
    let about = if messages.is_empty() { String::new() } else { format!(" of {}", messages.join(", ")) };
    let tries = timing.tries.map_or_else(String::new, |tries| format!(", {tries} tries"));
    format!("{}{about}{tries}", role.name())
}

/// Returns a row for a procedure, and one for each of its steps.
fn procedure(procedure: &Procedure) -> impl Iterator<Item = Row> {
    let head = vec![procedure.name.clone(), words(procedure.doc.section.as_ref())];
    let last = split(title(&procedure.doc).unwrap_or_default());
    let head = Row { cells: head, last, separator: " ", below: sentences(&procedure.doc) };
    let steps = procedure.steps.iter().zip(1..).map(|(step, number): (_, usize)| Row {
        cells: vec![format!("  {number}"), String::new()],
        last: split(step.for_people()),
        separator: " ",
        ..Row::default()
    });
    std::iter::once(head).chain(steps)
}

fn split(text: &str) -> Vec<String> {
    text.split(' ').map(str::to_owned).collect()
}
