//! Modules report unasked: with the frames of the documents, and as the interpreter reads them.

use canspec_codegen::interpret::{self, Decoded, Form, decode};
use canspec_codegen::model::{Kind as ModelKind, NoteRule, Protocol};
use canspec_runtime::{Error, Frame, Kind, Received, embedded_can::Frame as _};
use canspec_tests::features_fast_packets::{self as boat, CellsPart};
use canspec_tests::{Frames, Signals, Visitor, protocol, received, visit};

/// How many random frames each protocol sees.
const FRAMES: usize = 5_000;

#[test]
fn a_module_reports_with_the_frame_that_the_document_prints() {
    let data = canspec_runtime::Bytes::new([0x05, 0x01, 0xE4, 0x0C, 0xE5, 0x0C, 0xFF]);
    let part = CellsPart { part: 0, counter: 0, data };
    let report = |node, content| CellsPart::REPORT.report_from(node, content).map(|frame: Frame| frame.to_string());
    assert_eq!(report(0x23, boat::Message::CellsPart(part)).as_deref(), Ok("19FF0123#000501E40CE50CFF"));
    assert!(matches!(report(252, boat::Message::CellsPart(part)), Err(Error::Address { number: 252, .. })));
    let wide = CellsPart { part: 32, ..part };
    assert!(report(0x23, boat::Message::CellsPart(wide)).is_err(), "five bits number the part");
    let other = boat::EnginePart { part: 0, counter: 0, data };
    assert!(matches!(report(0x23, boat::Message::EnginePart(other)), Err(Error::Identifier { message: "cells", .. })));
}

/// Counts the reports that the interpreter reads as such.
struct Reports(usize);

impl Visitor for Reports {
    fn visit<P: canspec_runtime::Protocol + Signals>(&mut self, path: &str) {
        let protocol = protocol(path);
        let mut frames = Frames::new(&protocol, 0x4E90);
        for _ in 0..FRAMES {
            let sent = frames.next_frame();
            let Ok(received) = received::<P>(None, &sent) else { continue };
            if received.kind() == Kind::Report && !received.is_error_reply() {
                let said = decode(&protocol, None, &sent).expect("both engines agree");
                self.0 += usize::from(is_reported(&protocol, &received, &said));
            }
        }
    }
}

#[test]
fn the_interpreter_reads_each_report_as_that_of_the_module() {
    let mut reports = Reports(0);
    visit(&mut reports);
    assert!(reports.0 > 5_000, "{} are few", reports.0);
}

/// Lets the module send the report once more, and tests what the interpreter reads.
fn is_reported<P: canspec_runtime::Protocol>(protocol: &Protocol, received: &Received<P>, said: &Decoded) -> bool {
    let node = received.node().unwrap_or(3);
    let Ok(report) = received.exchange().report_from(node, *received.content()) else { return false };
    let data = report.data().to_vec();
    let frame = interpret::Frame { id: report.raw_id(), extended: report.is_extended(), data, form: Form::Data };
    let read = decode(protocol, None, &frame).expect("a report is of the protocol");
    assert_eq!((read.kind, read.message, read.access), (ModelKind::Report, said.message, said.access), "{report}");
    let bits = |decoded: &Decoded| decoded.signals.iter().map(|reading| reading.bits).collect::<Vec<_>>();
    assert_eq!(bits(&read), bits(said), "{report}");
    let forbidden = [NoteRule::Address, NoteRule::Addressing, NoteRule::ErrorCode, NoteRule::ReservedBit];
    assert!(read.notes.iter().all(|note| !forbidden.contains(&note.rule)), "{report}: {:?}", read.notes);
    let again = Received::<P>::decode(&report).expect("both engines agree");
    assert!(again.node().is_none_or(|reporting| reporting == node), "{report}");
    true
}
