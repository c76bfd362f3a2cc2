//! Prints random frames of a protocol as a log, the same ones each time, for programs that are
//! compared with canspec. Called as `frames any SPEC COUNT SEED` or `frames known SPEC COUNT SEED`.
//!
//! One in four of `any` frames is whatever comes. canspec recognises the others, and all `known`
//! ones. Of the known ones, one in 250 has an address that the document does not name.

use std::env;
use std::io::{self, BufWriter, Write};

use canspec_codegen::interpret::{Frame, decode};
use canspec_codegen::model::{NoteRule, Protocol};
use canspec_tests::{Frames, protocol};

fn main() -> io::Result<()> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [choice, spec, count, seed] = arguments.as_slice() else {
        return Err(io::Error::other("call it as `frames any SPEC COUNT SEED` or `frames known SPEC COUNT SEED`"));
    };
    let protocol = protocol(spec);
    let mut frames = Frames::new(&protocol, number(seed)?);
    let mut out = BufWriter::new(io::stdout().lock());
    for index in 0..number(count)? {
        let is_wanted = |frame: &Frame| match choice.as_str() {
            "known" => is_known(&protocol, frame, index % 250 == 0),
            _ => index % 4 == 0 || is_known(&protocol, frame, true),
        };
        let frame = std::iter::repeat_with(|| frames.next_frame()).find(is_wanted);
        frame.map_or(Ok(()), |frame| write(&mut out, index, &frame))?;
    }
    out.flush()
}

fn number(text: &str) -> io::Result<u64> {
    text.parse().map_err(|_| io::Error::other(format!("`{text}` is no number")))
}

/// Tests whether canspec recognises a frame, at any address or at those that the document foresees.
fn is_known(protocol: &Protocol, frame: &Frame, at_any_address: bool) -> bool {
    let decoded = decode(protocol, None, frame);
    decoded.is_ok_and(|known| {
        at_any_address || !known.notes.iter().any(|note| matches!(note.rule, NoteRule::Address | NoteRule::Addressing))
    })
}

/// Writes a frame as `candump -L` does, one each millisecond.
fn write(out: &mut impl Write, index: u64, frame: &Frame) -> io::Result<()> {
    let digits = if frame.extended { 8 } else { 3 };
    write!(out, "({}.{:06}) can{} {:0digits$X}#", index / 1000, index % 1000 * 1000, index % 2, frame.id)?;
    frame.data.iter().try_for_each(|byte| write!(out, "{byte:02X}"))?;
    writeln!(out)
}
