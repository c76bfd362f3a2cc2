//! Prints random frames of a protocol as a log, for programs that are compared with canspec.
//!
//! canspec recognises all of them. One in 250 goes to or comes from an address that the document does not foresee.
#![expect(clippy::print_stdout, reason = "the log is what people call it for")]

use std::env;

use canspec_codegen::interpret::{Frame, decode};
use canspec_tests::{Frames, protocol};

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [spec, count, seed] = &arguments[..] else { panic!("name a spec, how many frames, and a seed") };
    let number = |text: &str| text.parse::<u64>().unwrap_or_else(|_| panic!("`{text}` is no number"));
    let protocol = protocol(spec);
    let mut frames = Frames::new(&protocol, number(seed));
    for index in 0..number(count) {
        let is_wanted = |frame: &Frame| {
            let Ok(decoded) = decode(&protocol, None, frame) else { return false };
            index % 250 == 0 || !decoded.notes.iter().any(|note| note.rule.starts_with("address"))
        };
        let frame = std::iter::repeat_with(|| frames.next_frame()).find(is_wanted);
        println!("{}", frame.map(|frame| line(&frame)).unwrap_or_default());
    }
}

/// Writes a frame as `candump -L` does, without time and channel.
fn line(frame: &Frame) -> String {
    let digits = if frame.extended { 8 } else { 3 };
    let data: Vec<_> = frame.data.iter().map(|byte| format!("{byte:02X}")).collect();
    format!("{:0digits$X}#{}", frame.id, data.concat())
}
